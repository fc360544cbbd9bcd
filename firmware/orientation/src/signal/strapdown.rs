//! Strapdown attitude in inertial space: small rotations summed at the sample rate, attitude fifty times a
//! second (equations.md §5; P. G. Savage, Strapdown Inertial Navigation Integration Algorithm Design,
//! Part 1, 1998).
//!
//! ```text
//!  angle increments ─▶ sum, coning (integer, f32) ─50 Hz─▶ quaternion (f64) ─▶ frozen start frame
//!  forces ────────────▶ mean ────────────────────────────▶ turned there      ─▶ sums
//! ```
//!
//! The frame is that of the body at the first sample, held fixed in inertial space: no azimuth is needed
//! to carry it. How errors of the gyros have turned it is carried beside it: ∂/∂bias and ∂/∂scale, 3×3
//! each, so that a drive of any length takes the same memory.

use super::InertialSample;
use crate::math::rotation::{Quaternion, dot, sum, turned};
use crate::units::{AngleIncrement, Instant};

/// Time from one attitude to the next, µs: 50 Hz.
const PERIOD: u64 = 20_000;
/// Rotation about an axis after which the attitude is taken at once, rad: up to it, the products of small
/// rotations that are left out are 1e-6 of them.
const LARGE: f32 = 0.02;
/// The same in steps of an increment.
const LARGE_STEPS: u32 = (LARGE / STEP) as u32;
/// Rotation of one sample about an axis up to which rates are taken to change steadily from sample to sample, rad: a
/// blow is no steady change.
const STEADY: f32 = 0.1;
/// How a sample that follows another is turned by the change of the axis between them (Savage's equation
/// for rates that change linearly): 1/12.
const CONING: f32 = 1.0 / 12.0;

/// The same in steps of an increment.
const STEADY_STEPS: u32 = (STEADY / STEP) as u32;
/// One step of an increment, rad.
const STEP: f32 = AngleIncrement::STEP as f32;

/// A matrix in single precision.
pub type Rough = [[f32; 3]; 3];

/// The rotation since the last attitude, in steps of an increment and their squares. Written out, for loops
/// of three cost more than what they do.
#[derive(Clone, Copy, Debug, Default)]
struct Increment {
    /// Sums of the increments: exact, so that nothing is lost however long it takes.
    sums: [i32; 3],
    /// What the order of rotations adds.
    coning: [f32; 3],
    /// A twelfth of the sample before, or zero where that was a blow.
    lead: [f32; 3],
}

impl Increment {
    #[inline]
    fn push(&mut self, [a, b, c]: [AngleIncrement; 3]) {
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
    #[inline]
    fn is_large(&self) -> bool {
        let [x, y, z] = self.sums;
        x.unsigned_abs().max(y.unsigned_abs()).max(z.unsigned_abs()) > LARGE_STEPS
    }

    /// The rotation vector, rad, whose sums then begin again.
    fn take(&mut self) -> [f64; 3] {
        let rotation = core::array::from_fn(|axis| {
            f64::from(self.sums[axis]) * AngleIncrement::STEP
                + f64::from(self.coning[axis] * (STEP * STEP))
        });
        *self = Self { lead: self.lead, ..Self::default() };
        rotation
    }
}

/// Attitude, and what of it depends on the gyros' errors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Carried {
    /// From body axes to the start's.
    pub attitude: Quaternion,
    /// Rotation of the start frame that a bias makes, rad per rad/s, on the start's axes by the body's.
    pub bias: Rough,
    /// The same of relative scale errors, rad.
    pub scale: Rough,
}

/// What was summed since it was taken last.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Angle increments.
    pub turned: [i64; 3],
    /// Specific forces on the body's axes, µm/s².
    pub force: [i64; 3],
    /// The same on the start's axes, m/s².
    pub start_force: [f32; 3],
    /// Of how many forces.
    pub count: u32,
    /// Whether a blow turned the body so quickly that the forces mean nothing.
    pub is_blown: bool,
}

/// The strapdown at work.
#[derive(Clone, Debug, Default)]
pub struct Strapdown {
    increment: Increment,
    carried: Carried,
    /// The attitude's matrix.
    matrix: Rough,
    /// When the attitude was taken last.
    since: Instant,
    /// Sums of the forces since then, µm/s², and of how many.
    force: [i64; 3],
    count: u32,
    /// Sums until then.
    sums: Sums,
}

impl Strapdown {
    /// Begins at a time: that at which the first sample began.
    #[must_use]
    pub fn since(time: Instant) -> Self {
        let matrix = Quaternion::ONE.rough_matrix();
        Self { since: time, matrix, ..Self::default() }
    }

    /// Takes a sample.
    #[inline]
    pub fn push(&mut self, sample: &InertialSample) {
        self.increment.push(sample.turned);
        if let Some([x, y, z]) = sample.force {
            self.force[0] += i64::from(x.0);
            self.force[1] += i64::from(y.0);
            self.force[2] += i64::from(z.0);
            self.count += 1;
        }
        let elapsed = sample.time.0.saturating_sub(self.since.0);
        if elapsed >= PERIOD || self.increment.is_large() {
            self.update(sample.time);
        }
    }

    /// Takes the attitude at a time, that of the last sample.
    #[inline(never)]
    pub fn update(&mut self, now: Instant) {
        let seconds = now.0.saturating_sub(self.since.0) as f32 * 1e-6;
        self.since = now;
        let steps = self.increment.sums;
        let small = steps.map(|sum| sum as f32 * STEP);
        let carried = &mut self.carried;
        carried.attitude = carried.attitude.turned(&self.increment.take()).normalised();
        let after = carried.attitude.rough_matrix();
        let middle: Rough = core::array::from_fn(|row| {
            core::array::from_fn(|column| 0.5 * (self.matrix[row][column] + after[row][column]))
        });
        self.matrix = after;
        carried.bias = gained(&carried.bias, &middle, &[seconds; 3]);
        carried.scale = gained(&carried.scale, &middle, &small);
        self.sums.turned = sum(&self.sums.turned, &steps.map(i64::from));
        self.sums.is_blown |= dot(&small, &small) > STEADY * STEADY;
        self.turn_force(&middle);
    }

    /// Turns the forces since the last attitude to the start's axes.
    fn turn_force(&mut self, middle: &Rough) {
        let force = core::mem::take(&mut self.force);
        let sums = &mut self.sums;
        let turned = turned(middle, &force.map(|sum| sum as f32 * 1e-6));
        sums.start_force = sum(&sums.start_force, &turned);
        sums.force = sum(&sums.force, &force);
        sums.count += core::mem::take(&mut self.count);
    }

    /// What is carried.
    #[must_use]
    pub fn carried(&self) -> &Carried {
        &self.carried
    }

    /// What was summed until the last attitude, which then begins again.
    pub fn take(&mut self) -> Sums {
        core::mem::take(&mut self.sums)
    }
}

/// A sensitivity after a further time: each column of the attitude counts so much.
fn gained(sensitivity: &Rough, attitude: &Rough, by: &[f32; 3]) -> Rough {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| sensitivity[row][column] + attitude[row][column] * by[column])
    })
}
