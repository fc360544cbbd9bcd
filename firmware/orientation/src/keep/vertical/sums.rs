//! What is summed between two looks.

use super::Vector;
use crate::math::rotation::{difference, scaled, sum};
use crate::units::{AngleIncrement, Instant, SpecificForce};

/// Bits by which forces are rounded down before they are summed, so that 64 of them fit at full range; 64 µm/s² are
/// 7 µrad of tilt.
const SHIFT: u32 = 6;

/// Differences from attitude to attitude by which noise can be told.
const FEWEST: u32 = 4;

/// Forces since the latest attitude.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// µm/s².
    pub(super) sums: [i32; 3],
    pub(super) count: u32,
}

/// What a window of the rest watch sums.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Window {
    pub(super) seconds: f32,
    /// What the body turned against the Earth, about its axes, with its biases, rad.
    pub(super) turned: Vector,
    /// Turned about the vertical, rad.
    pub(super) about: f32,
    /// Integral of the force on the body's axes, m/s.
    pub(super) impulse: Vector,
    pub(super) forced: f32,
    /// What the rates differ by from one attitude to the next, as half their squares by time, rad²/s, summed.
    scatter: Vector,
    steps: u32,
    latest: Option<Vector>,
}

impl Window {
    /// Takes what the body turned in that time, s, with its biases, rad.
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

    /// Angle random walk, squared, as the rates scatter from one attitude to the next, rad²/s: whatever turns the body
    /// evenly does not count. None where they are too few to tell.
    pub(super) fn walk(&self) -> Option<Vector> {
        (self.steps >= FEWEST).then(|| scaled(&self.scatter, 1.0 / self.steps as f32))
    }

    /// Mean rates about the body's axes, rad/s.
    pub(super) fn rate(&self) -> Vector {
        scaled(&self.turned, 1.0 / self.seconds)
    }

    /// Mean force, m/s²; none where there was none.
    pub(super) fn force(&self) -> Option<Vector> {
        (self.forced > 0.0).then(|| scaled(&self.impulse, 1.0 / self.forced))
    }
}

/// What of a rest the biases have not been told yet: of every part the mean rate counts, each as long as all
/// before, for what shakes the body turns it to and fro.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rested {
    pub(super) seconds: f32,
    /// Length of this part, s.
    pub(super) due: f32,
    pub(super) turned: Vector,
}

/// The sample before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Before {
    pub(super) time: Option<Instant>,
    pub(super) turned: [AngleIncrement; 3],
    /// Rate lately, rad/s.
    pub(super) lately: f32,
    /// What may have been lost since a gyro clips, rad.
    pub(super) clipped: f32,
}

impl Sums {
    #[inline]
    pub(super) fn push(&mut self, [x, y, z]: [SpecificForce; 3]) {
        self.sums[0] = self.sums[0].saturating_add(x.0 >> SHIFT);
        self.sums[1] = self.sums[1].saturating_add(y.0 >> SHIFT);
        self.sums[2] = self.sums[2].saturating_add(z.0 >> SHIFT);
        self.count += 1;
    }

    /// The mean, m/s², which begins again.
    pub(super) fn take(&mut self) -> Option<Vector> {
        let Self { sums, count } = core::mem::take(self);
        let part = 1e-6 * (1 << SHIFT) as f32 / count as f32;
        (count > 0).then(|| [sums[0] as f32 * part, sums[1] as f32 * part, sums[2] as f32 * part])
    }
}
