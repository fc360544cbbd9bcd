//! Sums between two evaluations.

use crate::math::quaternion::Vector;
use crate::math::rotation::{difference, scaled, sum};
use crate::units::{AngleIncrement, Instant, SpecificForce};

/// Number of bits by which forces are rounded down before they are summed, so that 64 of them fit
/// at full range; 64 µm/s² are 7 µrad of tilt.
const SHIFT: u32 = 6;

/// Least number of rate differences that determine a noise.
const FEWEST: u32 = 4;

/// Sums of the forces since the latest attitude update.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Sums in steps of 64 µm/s².
    pub(super) sums: [i32; 3],
    /// Number of forces.
    pub(super) count: u32,
}

/// Sums of a window of rest detection.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Window {
    /// Length, s.
    pub(super) seconds: f32,
    /// Rotation against the Earth about the body's axes, including the biases, rad.
    pub(super) turned: Vector,
    /// Rotation about the vertical, rad.
    pub(super) about: f32,
    /// Integral of the force on the body's axes, m/s.
    pub(super) impulse: Vector,
    /// Time with valid forces, s.
    pub(super) forced: f32,
    /// Time without samples through which a rest went on, s, and rotation that may have been lost in it, rad.
    pub(super) missing: f32,
    pub(super) lost: f32,
    /// Sum of half the squared differences of the rates between attitude updates, times their
    /// interval, rad²/s.
    scatter: Vector,
    /// Number of differences.
    steps: u32,
    /// Rates of the latest interval, rad/s.
    latest: Option<Vector>,
}

impl Window {
    /// Adds a rotation with its biases, rad, over a time, s.
    pub(super) fn turn(&mut self, turned: &Vector, seconds: f32) {
        self.seconds += seconds;
        self.turned = sum(&self.turned, turned);
        let rate = scaled(turned, 1.0 / seconds);
        if let Some(before) = self.latest.replace(rate) {
            let [x, y, z] = difference(&rate, &before);
            let squares = scaled(&[x * x, y * y, z * z], 0.5 * seconds);
            self.scatter = sum(&self.scatter, &squares);
            self.steps += 1;
        }
    }

    /// Squared angle random walk from the scatter of the rates between attitude updates, rad²/s, to
    /// which constant rotation does not contribute; `None` with too few of them.
    pub(super) fn walk(&self) -> Option<Vector> {
        (self.steps >= FEWEST).then(|| scaled(&self.scatter, 1.0 / self.steps as f32))
    }

    /// Mean rates about the body's axes, rad/s.
    pub(super) fn rate(&self) -> Vector {
        scaled(&self.turned, 1.0 / self.seconds)
    }

    /// Mean force, m/s²; `None` without force readings.
    pub(super) fn force(&self) -> Option<Vector> {
        (self.forced > 0.0).then(|| scaled(&self.impulse, 1.0 / self.forced))
    }
}

/// Rotation over a time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turned {
    /// Length, s.
    pub(super) seconds: f32,
    /// Rotation about the body's axes, including the biases, rad.
    pub(super) angles: Vector,
}

impl Turned {
    /// Adds a time that follows.
    pub(super) fn add(&mut self, seconds: f32, angles: &Vector) {
        self.seconds += seconds;
        self.angles = sum(&self.angles, angles);
    }

    /// Mean rates, rad/s.
    pub(super) fn rates(&self) -> Vector {
        scaled(&self.angles, 1.0 / self.seconds)
    }
}

/// What the gyros have shown since the latest look at it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seen {
    /// Rotation, of the Earth and biases included.
    pub(super) turned: Turned,
    /// Whether a gyro was at the limit of its range.
    pub(super) is_clipped: bool,
}

/// Part of a rest that has not updated the biases yet. The mean rate of each part counts, and each
/// part is as long as all before, because shaking turns the body to and fro.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rested {
    /// Part so far.
    pub(super) part: Turned,
    /// Intended length of this part, s.
    pub(super) due: f32,
}

/// Values of the previous sample.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Before {
    /// Time of the previous sample.
    pub(super) time: Option<Instant>,
    /// Increments of the previous sample.
    pub(super) turned: [AngleIncrement; 3],
    /// Recent rate beyond the biases, rad/s.
    pub(super) lately: f32,
    /// Rotation that may have been lost since a gyro saturated, rad.
    pub(super) clipped: f32,
}

impl Sums {
    /// Adds a force.
    #[inline]
    pub(super) fn push(&mut self, [x, y, z]: [SpecificForce; 3]) {
        self.sums[0] = self.sums[0].saturating_add(x.0 >> SHIFT);
        self.sums[1] = self.sums[1].saturating_add(y.0 >> SHIFT);
        self.sums[2] = self.sums[2].saturating_add(z.0 >> SHIFT);
        self.count += 1;
    }

    /// Mean force, m/s²; the sums begin again.
    pub(super) fn take(&mut self) -> Option<Vector> {
        let Self { sums, count } = core::mem::take(self);
        let part = 1e-6 * (1 << SHIFT) as f32 / count as f32;
        (count > 0).then(|| [sums[0] as f32 * part, sums[1] as f32 * part, sums[2] as f32 * part])
    }
}
