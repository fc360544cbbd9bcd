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
use crate::math::rotation::{Quaternion, cross, dot, sum, turned};
use crate::units::{AngleIncrement, Instant, SpecificForce};

/// Time from one attitude to the next, µs: 50 Hz.
const PERIOD: u64 = 20_000;
/// Rotation after which the attitude is taken at once, rad: to it, the products of small rotations that
/// are left out are 1e-6 of them.
const LARGE: f32 = 0.02;
/// Rotation of one sample up to which rates are taken to change steadily from sample to sample, rad: a
/// blow is no steady change.
const STEADY: f32 = 0.1;
/// How a sample that follows another is turned by the change of the axis between them (Savage's equation
/// for rates that change linearly): 1/12.
const CONING: f32 = 1.0 / 12.0;

/// A matrix in single precision.
pub type Rough = [[f32; 3]; 3];

/// The rotation since the last attitude.
#[derive(Clone, Copy, Debug, Default)]
struct Increment {
    /// Sums of the increments: exact, so that nothing is lost however long it takes.
    sums: [i64; 3],
    /// The same, rad, as the products of rotations need it.
    rotation: [f32; 3],
    /// What the order of rotations adds, rad.
    coning: [f32; 3],
    /// The sample before, rad.
    before: [f32; 3],
}

impl Increment {
    #[inline]
    fn push(&mut self, turned: &[AngleIncrement; 3]) {
        let small = turned.map(|part| part.0 as f32 * AngleIncrement::STEP as f32);
        let lead = if is_steady(&small) && is_steady(&self.before) { CONING } else { 0.0 };
        let arm: [f32; 3] =
            core::array::from_fn(|axis| 0.5 * self.rotation[axis] + lead * self.before[axis]);
        let order = cross(&arm, &small);
        for (whole, part) in self.sums.iter_mut().zip(turned) {
            *whole += i64::from(part.0);
        }
        self.rotation = sum(&self.rotation, &small);
        self.coning = sum(&self.coning, &order);
        self.before = small;
    }

    /// The rotation vector, rad, whose sums then begin again.
    fn take(&mut self) -> [f64; 3] {
        let rotation = core::array::from_fn(|axis| {
            self.sums[axis] as f64 * AngleIncrement::STEP + f64::from(self.coning[axis])
        });
        *self = Self { before: self.before, ..Self::default() };
        rotation
    }
}

fn is_steady(rotation: &[f32; 3]) -> bool {
    dot(rotation, rotation) < STEADY * STEADY
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
    forces: [i64; 3],
    count: u32,
    /// Sums of the forces on the start's axes, m/s² times samples, and of how many samples.
    turned_forces: [f32; 3],
    turned_count: u32,
    is_blown: bool,
}

/// Forces that were summed since they were taken last.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Forces {
    /// Their sum on the start's axes, m/s².
    pub sum: [f32; 3],
    /// Of how many.
    pub count: u32,
    /// Whether a blow turned the body so quickly that they mean nothing.
    pub is_blown: bool,
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
        self.increment.push(&sample.turned);
        if let Some(force) = sample.force {
            for (sum, SpecificForce(part)) in self.forces.iter_mut().zip(force) {
                *sum += i64::from(part);
            }
            self.count += 1;
        }
        let elapsed = sample.time.0.saturating_sub(self.since.0);
        let rotation = &self.increment.rotation;
        if elapsed >= PERIOD || dot(rotation, rotation) > LARGE * LARGE {
            self.update(sample.time);
        }
    }

    /// Takes the attitude at a time, that of the last sample.
    #[inline(never)]
    pub fn update(&mut self, now: Instant) {
        let seconds = now.0.saturating_sub(self.since.0) as f32 * 1e-6;
        self.since = now;
        let small = self.increment.rotation;
        let carried = &mut self.carried;
        carried.attitude = carried.attitude.turned(&self.increment.take()).normalised();
        let after = carried.attitude.rough_matrix();
        let middle: Rough = core::array::from_fn(|row| {
            core::array::from_fn(|column| 0.5 * (self.matrix[row][column] + after[row][column]))
        });
        self.matrix = after;
        carried.bias = gained(&carried.bias, &middle, &[seconds; 3]);
        carried.scale = gained(&carried.scale, &middle, &small);
        self.is_blown |= !is_steady(&small);
        self.turn_forces(&middle);
    }

    /// Turns the forces since the last attitude to the start's axes.
    fn turn_forces(&mut self, middle: &Rough) {
        let force = self.forces.map(|sum| sum as f32 * 1e-6);
        self.turned_forces = sum(&self.turned_forces, &turned(middle, &force));
        self.turned_count += self.count;
        (self.forces, self.count) = ([0; 3], 0);
    }

    /// What is carried.
    #[must_use]
    pub fn carried(&self) -> &Carried {
        &self.carried
    }

    /// The forces since they were taken last.
    pub fn take_forces(&mut self) -> Forces {
        Forces {
            sum: core::mem::take(&mut self.turned_forces),
            count: core::mem::take(&mut self.turned_count),
            is_blown: core::mem::take(&mut self.is_blown),
        }
    }
}

/// A sensitivity after a further time: each column of the attitude counts so much.
fn gained(sensitivity: &Rough, attitude: &Rough, by: &[f32; 3]) -> Rough {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| sensitivity[row][column] + attitude[row][column] * by[column])
    })
}
