//! Rotation since the last attitude update: small rotations summed at the sample rate, with the
//! coning term for their order (P. G. Savage, Strapdown Inertial Navigation Integration Algorithm
//! Design, Part 1, 1998).

use crate::units::AngleIncrement;

/// Rotation about one axis that triggers an attitude update at once, rad. Up to it, the products of
/// small rotations that the coning sum neglects are 1e-6 of the rotation.
const LARGE: f32 = 0.02;
/// Threshold [`LARGE`] in steps of an increment.
const LARGE_STEPS: u32 = (LARGE / STEP) as u32;
/// Rotation of one sample about one axis up to which the rate is assumed to change linearly from
/// sample to sample, rad; beyond it the sample is treated as a shock.
pub(crate) const STEADY: f32 = 0.1;
/// Threshold [`STEADY`] in steps of an increment.
const STEADY_STEPS: u32 = (STEADY / STEP) as u32;
/// Weight of the cross product of two successive increments, for rates that change linearly in time
/// (Savage 1998, coning equation): 1/12.
const CONING: f32 = 1.0 / 12.0;
/// One step of an angle increment, rad, in single precision.
pub(crate) const STEP: f32 = AngleIncrement::STEP as f32;

/// Rotation since the last attitude update, in steps of an increment and their squares. The
/// components are written out, because loops over three cost more than their bodies.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Increment {
    /// Sums of the increments since the last attitude update, in their steps: exact integers, so no
    /// rotation is lost over any time.
    pub sums: [i32; 3],
    /// Coning sums: contribution of the order of the rotations, in squared steps.
    coning: [f32; 3],
    /// A twelfth of the previous sample, or zero where that was a shock.
    lead: [f32; 3],
}

impl Increment {
    /// Adds one sample to the sums, which saturate instead of wrapping.
    #[expect(
        clippy::inline_always,
        reason = "a call with nine numbers costs a tenth of the sample"
    )]
    #[inline(always)]
    pub(crate) fn push(&mut self, [a, b, c]: [AngleIncrement; 3]) {
        let [x, y, z] = self.sums;
        let [small_x, small_y, small_z] = [a.0 as f32, b.0 as f32, c.0 as f32];
        let is_steady = a.0.unsigned_abs() < STEADY_STEPS
            && b.0.unsigned_abs() < STEADY_STEPS
            && c.0.unsigned_abs() < STEADY_STEPS;
        let [lead_x, lead_y, lead_z] = if is_steady { self.lead } else { [0.0; 3] };
        let arm_x = 0.5 * x as f32 + lead_x;
        let arm_y = 0.5 * y as f32 + lead_y;
        let arm_z = 0.5 * z as f32 + lead_z;
        self.coning[0] += arm_y * small_z - arm_z * small_y;
        self.coning[1] += arm_z * small_x - arm_x * small_z;
        self.coning[2] += arm_x * small_y - arm_y * small_x;
        self.sums = [x.saturating_add(a.0), y.saturating_add(b.0), z.saturating_add(c.0)];
        let part = if is_steady { CONING } else { 0.0 };
        self.lead = [part * small_x, part * small_y, part * small_z];
    }

    /// Whether the rotation is large enough for an attitude update at once.
    #[inline]
    pub(crate) fn is_large(&self) -> bool {
        let [x, y, z] = self.sums;
        x.unsigned_abs().max(y.unsigned_abs()).max(z.unsigned_abs()) > LARGE_STEPS
    }

    /// Sum of the increments since the last attitude update, and the part of the rotation vector that is due to their
    /// order, rad; the sums begin again.
    #[inline]
    pub(crate) fn take_exactly(&mut self) -> ([AngleIncrement; 3], [f32; 3]) {
        let taken = (self.sums.map(AngleIncrement), self.coning.map(|part| part * (STEP * STEP)));
        self.restart();
        taken
    }

    /// Rotation vector since the last attitude update, rad, in single precision (relative error
    /// 6e-8); the sums begin again.
    pub(crate) fn take(&mut self) -> [f32; 3] {
        let ([x, y, z], [about_x, about_y, about_z]) = (self.sums, self.coning);
        self.restart();
        [
            STEP * (x as f32 + STEP * about_x),
            STEP * (y as f32 + STEP * about_y),
            STEP * (z as f32 + STEP * about_z),
        ]
    }

    /// Clears the sums and keeps the last sample for the next coning term.
    #[inline]
    fn restart(&mut self) {
        *self = Self { lead: self.lead, ..Self::default() };
    }
}
