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
use super::increment::{Increment, STEADY, STEP};
use crate::math::rotation::{Quaternion, dot, sum, turned};
use crate::units::Instant;

/// Time from one attitude to the next, µs: 50 Hz.
const PERIOD: u64 = 20_000;
/// A matrix in single precision.
pub type Rough = [[f32; 3]; 3];

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
    /// The same, rad, and the least and the greatest that they had meanwhile.
    pub swept: [[f32; 3]; 3],
    /// Specific forces on the body's axes, µm/s².
    pub force: [i64; 3],
    /// The same on the start's axes, m/s².
    pub start_force: [f32; 3],
    /// Of how many forces.
    pub count: u32,
    /// Whether a blow turned the body so quickly that the forces mean nothing.
    pub is_blown: bool,
}

impl Sums {
    /// Follows where the body swings to.
    fn sweep(&mut self, turned: &[f32; 3]) {
        let [now, least, greatest] = &mut self.swept;
        for (axis, turned) in turned.iter().enumerate() {
            now[axis] += turned;
            if now[axis] < least[axis] {
                least[axis] = now[axis];
            } else if now[axis] > greatest[axis] {
                greatest[axis] = now[axis];
            }
        }
    }

    /// By how much more than it turned in all the body swung there and back, rad.
    #[must_use]
    pub fn swung(&self) -> [f32; 3] {
        let [now, least, greatest] = &self.swept;
        core::array::from_fn(|axis| greatest[axis] - least[axis] - now[axis].abs())
    }
}

/// The strapdown at work.
#[derive(Clone, Debug, Default)]
pub struct Strapdown {
    increment: Increment,
    carried: Carried,
    /// Mean rates between the last three attitudes, rad/s, the latest first.
    rates: [[f32; 3]; 2],
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

    /// Takes a sample; whether it made a new attitude, as any large rotation does.
    #[inline]
    pub fn push(&mut self, sample: &InertialSample) -> bool {
        self.increment.push(sample.turned);
        if let Some([x, y, z]) = sample.force {
            self.force[0] += i64::from(x.0);
            self.force[1] += i64::from(y.0);
            self.force[2] += i64::from(z.0);
            self.count += 1;
        }
        let elapsed = sample.time.0.saturating_sub(self.since.0);
        let is_due = elapsed >= PERIOD || self.increment.is_large();
        if is_due {
            self.update(sample.time);
        }
        is_due
    }

    /// Takes the attitude at a time, that of the last sample.
    #[inline(never)]
    pub fn update(&mut self, now: Instant) {
        let seconds = now.0.saturating_sub(self.since.0) as f32 * 1e-6;
        self.since = now;
        let steps = self.increment.steps();
        let small = steps.map(|sum| sum as f32 * STEP);
        let carried = &mut self.carried;
        carried.attitude = carried.attitude.turned(&self.increment.take());
        let after = carried.attitude.rough_matrix();
        // Twice that in the middle.
        let both: Rough = core::array::from_fn(|row| sum(&self.matrix[row], &after[row]));
        self.matrix = after;
        carried.bias = gained(&carried.bias, &both, &[0.5 * seconds; 3]);
        carried.scale = gained(&carried.scale, &both, &small.map(|turn| 0.5 * turn));
        if seconds > 0.0 {
            let inverse = 1.0 / seconds;
            self.rates = [small.map(|turn| turn * inverse), self.rates[0]];
        }
        self.sums.turned = sum(&self.sums.turned, &steps.map(i64::from));
        self.sums.sweep(&small);
        self.sums.is_blown |= dot(&small, &small) > STEADY * STEADY;
        self.turn_force(&both);
    }

    /// Turns the forces since the last attitude to the start's axes, by the sum of both attitudes.
    fn turn_force(&mut self, both: &Rough) {
        let force = core::mem::take(&mut self.force);
        let sums = &mut self.sums;
        let turned = turned(both, &force.map(|sum| sum as f32 * 0.5e-6));
        sums.start_force = sum(&sums.start_force, &turned);
        sums.force = sum(&sums.force, &force);
        sums.count += core::mem::take(&mut self.count);
    }

    /// Rate at the last attitude, rad/s: as the mean rates before it go on.
    #[must_use]
    pub fn rate(&self) -> [f32; 3] {
        let [latest, earlier] = self.rates;
        core::array::from_fn(|axis| 1.5 * latest[axis] - 0.5 * earlier[axis])
    }

    /// What is carried.
    #[must_use]
    pub fn carried(&self) -> &Carried {
        &self.carried
    }

    /// What was summed until the last attitude, which then begins again. Call it now and then: rounding
    /// changes the attitude's length by 1e-16 a rotation, which is mended here.
    pub fn take(&mut self) -> Sums {
        self.carried.attitude = self.carried.attitude.normalised();
        core::mem::take(&mut self.sums)
    }
}

/// A sensitivity after a further time: each column of the attitude counts so much.
fn gained(sensitivity: &Rough, attitude: &Rough, by: &[f32; 3]) -> Rough {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| sensitivity[row][column] + attitude[row][column] * by[column])
    })
}
