//! The rotation since the last attitude: small rotations summed at the sample rate, with what their order adds
//! (P. G. Savage, Strapdown Inertial Navigation Integration Algorithm Design, Part 1, 1998).

use crate::units::AngleIncrement;

/// Rotation about an axis after which the attitude is taken at once, rad: up to it, the products of small
/// rotations that are left out are 1e-6 of them.
const LARGE: f32 = 0.02;
/// The same in steps of an increment.
const LARGE_STEPS: u32 = (LARGE / STEP) as u32;
/// Rotation of one sample about an axis up to which rates are taken to change steadily from sample to sample, rad: a
/// blow is no steady change.
pub const STEADY: f32 = 0.1;
/// The same in steps of an increment.
const STEADY_STEPS: u32 = (STEADY / STEP) as u32;
/// How a sample that follows another is turned by the change of the axis between them (Savage's equation
/// for rates that change linearly): 1/12.
const CONING: f32 = 1.0 / 12.0;
/// One step of an increment, rad.
pub const STEP: f32 = AngleIncrement::STEP as f32;

/// The rotation since the last attitude, in steps of an increment and their squares. Written out, for loops
/// of three cost more than what they do.
#[derive(Clone, Copy, Debug, Default)]
pub struct Increment {
    /// Sums of the increments: exact, so that nothing is lost however long it takes.
    sums: [i32; 3],
    /// What the order of rotations adds.
    coning: [f32; 3],
    /// A twelfth of the sample before, or zero where that was a blow.
    lead: [f32; 3],
}

impl Increment {
    /// Adds a sample.
    #[expect(
        clippy::inline_always,
        reason = "a call with nine numbers costs a tenth of the sample"
    )]
    #[inline(always)]
    pub fn push(&mut self, [a, b, c]: [AngleIncrement; 3]) {
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

    /// Whether the attitude is to be taken at once.
    #[must_use]
    #[inline]
    pub fn is_large(&self) -> bool {
        let [x, y, z] = self.sums;
        x.unsigned_abs().max(y.unsigned_abs()).max(z.unsigned_abs()) > LARGE_STEPS
    }

    /// Sums of the increments since the last attitude, in their steps.
    #[must_use]
    #[inline]
    pub fn steps(&self) -> [i32; 3] {
        self.sums
    }

    /// The rotation vector, rad, whose sums then begin again.
    #[inline]
    pub fn take(&mut self) -> [f64; 3] {
        let rotation = core::array::from_fn(|axis| {
            f64::from(self.sums[axis]) * AngleIncrement::STEP
                + f64::from(self.coning[axis] * (STEP * STEP))
        });
        self.restart();
        rotation
    }

    /// The same to 6e-8 of it.
    pub fn take_rough(&mut self) -> [f32; 3] {
        let ([x, y, z], [about_x, about_y, about_z]) = (self.sums, self.coning);
        self.restart();
        [
            STEP * (x as f32 + STEP * about_x),
            STEP * (y as f32 + STEP * about_y),
            STEP * (z as f32 + STEP * about_z),
        ]
    }

    #[inline]
    fn restart(&mut self) {
        *self = Self { lead: self.lead, ..Self::default() };
    }
}
