//! Strapdown attitude in inertial space (inertial-frame alignment): small rotations are summed at
//! the sample rate, the attitude is updated fifty times a second (Szymanowski 2003; P. G. Savage,
//! Strapdown Inertial Navigation Integration Algorithm Design, Part 1, 1998).
//!
//! ```text
//!  angle increments ─▶ sum, coning (integer, f32) ─50 Hz─▶ quaternion (i64) ─▶ frozen start frame
//!  forces ────────────▶ mean ────────────────────────────▶ turned there      ─▶ sums
//! ```
//!
//! The reference frame is that of the body at the first sample, frozen in inertial space, so no
//! azimuth is needed to carry the attitude. The sensitivity of the attitude to gyro errors is
//! carried beside it: ∂/∂bias and ∂/∂scale, 3×3 each, so a drive of any length takes the same
//! memory. Two rates are used because an update of the quaternion takes three times what a sum does.

use super::InertialSample;
use super::increment::{Increment, STEADY, STEP};
use crate::math::quaternion::Attitude;
use crate::math::rotation::{difference, dot, sum, turned};
use crate::units::{AngleIncrement, Instant};

/// Time between attitude updates, µs: 50 Hz.
const PERIOD: u64 = 20_000;
/// Averaging time of the recent change of the rates, s.
const WATCH: f32 = 1.0;
/// Angle that a rate may gain over the mean of both ends of a gap, in units of the recent angular
/// acceleration and the squared length of the gap: a quarter if the acceleration changes its sign
/// halfway. For a sine of any frequency it exceeds the RMS of what is missing.
const WITHIN: f32 = 0.25;
/// Least angular acceleration of a body in motion, rad/s²: a vehicle that begins to steer.
const STEERING: f32 = 0.05;
/// A 3×3 matrix in single precision, row by row.
pub(crate) type Rough = [[f32; 3]; 3];

/// Attitude, with its sensitivity to the gyros' errors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Carried {
    /// Rotation from the body axes to the frozen start axes.
    pub attitude: Attitude,
    /// Rotation of the start frame per gyro bias, rad per rad/s; rows are start axes, columns body
    /// axes.
    pub bias: Rough,
    /// Rotation of the start frame per relative scale-factor error, rad; rows are start axes,
    /// columns body axes.
    pub scale: Rough,
    /// Variance about each axis of the rotation in which samples are missing, rad².
    pub lost: f32,
}

/// Sums since they were last taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Sums of the angle increments, in steps of [`AngleIncrement`].
    pub turned: [i64; 3],
    /// Sums of the angle increments about the body axes, rad: the present, the least and the
    /// greatest value.
    pub swept: [[f32; 3]; 3],
    /// Sums of the specific forces on the body axes, µm/s².
    pub force: [i64; 3],
    /// Sums of the specific forces on the frozen start axes, m/s².
    pub start_force: [f32; 3],
    /// Number of force readings in these sums.
    pub count: u32,
    /// Whether a shock turned the body so quickly that the forces are not usable.
    pub is_blown: bool,
    /// Whether the forces of more than an attitude update are missing.
    pub is_interrupted: bool,
}

impl Sums {
    /// Updates the present, least and greatest angle about each axis.
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

    /// Angle of the sway about each axis beyond the net rotation, rad: the range less the magnitude
    /// of the present value.
    pub(crate) fn swung(&self) -> [f32; 3] {
        let [now, least, greatest] = &self.swept;
        core::array::from_fn(|axis| greatest[axis] - least[axis] - now[axis].abs())
    }
}

/// State of the strapdown attitude computation.
#[derive(Clone, Debug, Default)]
pub struct Strapdown {
    /// Rotation since the last attitude update.
    increment: Increment,
    /// Attitude and sensitivities at the last update.
    pub carried: Carried,
    /// Mean rates between the last three attitude updates, rad/s, the latest first.
    rates: [[f32; 3]; 2],
    /// Recent mean square of the change of these rates from one update to the next, (rad/s)².
    changes: [f32; 3],
    /// Attitude of the last update as a matrix.
    matrix: Rough,
    /// Time of the last attitude update.
    since: Instant,
    /// Sums of the forces since that update, µm/s², and their number.
    force: [i64; 3],
    count: u32,
    /// Sums up to the last update.
    sums: Sums,
}

impl Strapdown {
    /// Begins at the given time, at which the interval of the first sample starts.
    #[must_use]
    pub fn since(time: Instant) -> Self {
        let matrix = Attitude::default().rough_matrix();
        Self { since: time, matrix, ..Self::default() }
    }

    /// Takes a sample; returns whether the attitude was updated, which is due every 20 ms and after
    /// any large rotation.
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

    /// Updates the attitude at the given time, which must be that of the last sample.
    #[inline(never)]
    pub fn update(&mut self, now: Instant) {
        let seconds = now.0.saturating_sub(self.since.0) as f32 * 1e-6;
        self.since = now;
        let steps = self.increment.sums;
        let small = steps.map(|sum| sum as f32 * STEP);
        let carried = &mut self.carried;
        let (turned, by_order) = self.increment.take_exactly();
        carried.attitude.turn_by(&turned, &by_order);
        let after = carried.attitude.rough_matrix();
        // Sum of the attitudes at both ends: twice the one in the middle.
        let both: Rough = core::array::from_fn(|row| sum(&self.matrix[row], &after[row]));
        self.matrix = after;
        carried.bias = gained(&carried.bias, &both, &[0.5 * seconds; 3]);
        carried.scale = gained(&carried.scale, &both, &small.map(|turn| 0.5 * turn));
        if seconds > 0.0 {
            let inverse = 1.0 / seconds;
            self.rates = [small.map(|turn| turn * inverse), self.rates[0]];
            self.watch(seconds);
        }
        self.sums.turned = sum(&self.sums.turned, &steps.map(i64::from));
        self.sums.sweep(&small);
        self.sums.is_blown |= dot(&small, &small) > STEADY * STEADY;
        self.turn_force(&both);
    }

    /// Averages the change of the rates over an update of this length, s. A second that ends between
    /// two updates cuts one short.
    fn watch(&mut self, seconds: f32) {
        if seconds < 0.5e-6 * PERIOD as f32 {
            return;
        }
        let part = if self.changes[0] > 0.0 { (seconds / WATCH).min(1.0) } else { 1.0 };
        let [now, before] = &self.rates;
        for (axis, mean) in self.changes.iter_mut().enumerate() {
            let change = now[axis] - before[axis];
            *mean += part * (change * change - *mean);
        }
    }

    /// Bridges samples that are missing for this time before a sample, s: the rate there is taken as
    /// the mean of both ends. Its variance is that of the rates at both ends, and of what the recent
    /// angular acceleration may have turned beyond; the stated squared angle random walk of the gyros,
    /// rad²/s, is no acceleration.
    #[cold]
    pub(crate) fn bridge(
        &mut self,
        sample: &InertialSample,
        [missing, period]: [f32; 2],
        walk: f32,
        is_at_rest: bool,
    ) {
        let before = self.rates[0];
        let after = sample.turned.map(|turned| turned.0 as f32 * STEP / period);
        let steps = |axis: usize| (0.5 * missing / STEP * (before[axis] + after[axis])) as i32;
        let turned = core::array::from_fn(|axis| AngleIncrement(steps(axis)));
        let end = Instant(sample.time.0.saturating_sub((period * 1e6) as u64));
        let jump = difference(&after, &before).map(|jump| jump * jump);
        let interval = period.max(PERIOD as f32 * 1e-6);
        let variances = core::array::from_fn::<f32, 3, _>(|axis| {
            let change = self.changes[axis];
            let least = if is_at_rest { 0.0 } else { STEERING * interval };
            let within = (change - 2.0 * walk / interval).max(least * least);
            let gained = WITHIN * missing / interval;
            missing * missing * (0.25 * (jump[axis] + 2.0 * change) + gained * gained * within)
        });
        self.carried.lost += variances.into_iter().fold(0.0, f32::max);
        self.sums.is_interrupted |= missing * 1e6 > PERIOD as f32;
        self.push(&InertialSample { time: end, turned, force: None });
    }

    /// Transforms the forces since the last update to the start axes, with the mean of the
    /// attitudes at both ends.
    fn turn_force(&mut self, both: &Rough) {
        let force = core::mem::take(&mut self.force);
        let sums = &mut self.sums;
        let turned = turned(both, &force.map(|sum| sum as f32 * 0.5e-6));
        sums.start_force = sum(&sums.start_force, &turned);
        sums.force = sum(&sums.force, &force);
        sums.count += core::mem::take(&mut self.count);
    }

    /// Rate at the last attitude update, rad/s, extrapolated linearly from the two mean rates
    /// before it.
    pub(crate) fn rate(&self) -> [f32; 3] {
        let [latest, earlier] = self.rates;
        core::array::from_fn(|axis| 1.5 * latest[axis] - 0.5 * earlier[axis])
    }

    /// Takes the sums up to the last update, which begin again. It must be called now and then:
    /// rounding changes the quaternion's norm by at most 1e-9 a rotation, and the norm is restored here.
    pub fn take(&mut self) -> Sums {
        self.carried.attitude.normalise();
        core::mem::take(&mut self.sums)
    }
}

/// Sensitivity after a further interval: each column of the attitude is added with its weight.
fn gained(sensitivity: &Rough, attitude: &Rough, by: &[f32; 3]) -> Rough {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| sensitivity[row][column] + attitude[row][column] * by[column])
    })
}
