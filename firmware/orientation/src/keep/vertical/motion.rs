//! How fast the body moves, as tilt cannot imitate it, and where gravity must be if the filter is wrong.
//!
//! A level that is tilted by δ shows a steady level force g·δ, which adds up to a speed; a body that moves shows a
//! force that comes and goes. So the level force is taken less its own mean: what is left of it, added up, is the speed
//! in the band that hides tilt (`swing`). Slower motion, as a vehicle's, is seen only in the sum of the force itself
//! (`drift`), which counts as far as the tilt's own uncertainty does not explain it, and not beyond ten times the
//! swing: a body that never swings does not drift.
//!
//! The mean itself is the floor: the direction of the force low-passed in the gyros' frame. Where it is beside the
//! filter's vertical by more than swing and tilt's σ allow, the filter is too sure of itself and its σ is widened.

use super::GRAVITY;
use super::stretch::Stretch;

/// Time over which the mean level force is taken, and the band's speed fades, s.
const BAND: f32 = 7.0;
/// Time over which the band's speeds are averaged, s: quicker ones hide no tilt.
const QUICK: f32 = 1.5;
/// Time after which the speed of slow motion fades, and over which it is averaged, s.
const FADING: f32 = 10.0;
const SLOW: f32 = 3.0;
/// Time over which mean squares of speeds are taken, s, and for how long the greatest is remembered, s.
const WATCH: f32 = 5.0;
const MEMORY: f32 = 30.0;
/// Least speed that is allowed for, m/s: that of a body that stands.
pub(super) const LEAST_SPEED: f32 = 0.05;
/// Standard deviations of the tilt within which it explains a drift.
const EXPLAINED: f32 = 2.0;
/// Greatest mean square of a drift, in those of the swing.
const GREATEST_DRIFT: f32 = 10.0;
/// Standard deviations by which the floor may be beside the filter's vertical.
const FLOOR: f32 = 5.0;
/// Time in which the filter's σ is widened by what the floor is beside it, s.
const WIDENING: f32 = 2.0;

/// A speed in one band of frequencies, m/s.
#[derive(Clone, Copy, Debug, Default)]
struct Speed {
    /// The sum of the forces, which fades, and its average.
    sum: [f32; 2],
    average: [f32; 2],
    /// Mean square of one axis over [`WATCH`], m²/s².
    square: f32,
}

/// The motion of the body, watched stretch by stretch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    /// Mean level force, north and east, m/s².
    mean: [f32; 2],
    swing: Speed,
    drift: Speed,
    /// The greatest mean square of the swing lately, m²/s².
    greatest: f32,
}

impl Speed {
    /// Adds what a force sums up to within so many seconds, m/s.
    fn push(&mut self, impulse: [f32; 2], seconds: f32, fading: f32, averaging: f32) {
        for (axis, impulse) in impulse.into_iter().enumerate() {
            self.sum[axis] += impulse - self.sum[axis] * (seconds / fading);
            self.average[axis] += (seconds / averaging) * (self.sum[axis] - self.average[axis]);
        }
        self.square += (seconds / WATCH) * (self.now() - self.square);
    }

    /// Mean square of both axes now, m²/s².
    fn now(&self) -> f32 {
        let [north, east] = self.average;
        0.5 * (north * north + east * east)
    }
}

impl Motion {
    /// Watches a stretch in which there were forces.
    pub(super) fn watch(&mut self, stretch: &Stretch) {
        let [north, east, _] = stretch.impulse;
        let seconds = stretch.seconds;
        let away = [north - self.mean[0] * seconds, east - self.mean[1] * seconds];
        for (mean, away) in self.mean.iter_mut().zip(away) {
            *mean += away / BAND;
        }
        self.swing.push(away, seconds, BAND, QUICK);
        self.drift.push([north, east], seconds, FADING, SLOW);
        let faded = self.greatest * (1.0 - (seconds / MEMORY).min(1.0));
        self.greatest = faded.max(self.swing.now()).max(self.swing.square);
    }

    /// Density of the speed about zero, m²/s, where the level is good to this variance, rad².
    pub(super) fn density(&self, tilt: f32) -> f32 {
        let swing = self.swing.square.max(self.swing.now());
        let drift = self.drift.square.max(2.0 * self.drift.now());
        let imitated = FADING * GRAVITY * EXPLAINED;
        let drift = if drift > imitated * imitated * tilt { drift } else { 0.0 };
        // The slower speed lasts longer.
        let drift = (SLOW / QUICK * drift).min(GREATEST_DRIFT * self.greatest);
        swing.max(drift).max(LEAST_SPEED * LEAST_SPEED) * 2.0 * QUICK
    }

    /// By how much the variance of the level, rad², is to grow within so many seconds, for the floor is beside it.
    pub(super) fn disagreement(&self, tilt: f32, seconds: f32) -> f32 {
        let [north, east] = self.mean;
        let square = GRAVITY * GRAVITY;
        let beside = 0.5 * (north * north + east * east) / square;
        let swing = self.greatest.max(LEAST_SPEED * LEAST_SPEED) / (BAND * BAND * square);
        let beyond = beside - FLOOR * FLOOR * (tilt + swing);
        beyond.max(0.0) * (seconds / WIDENING).min(1.0)
    }

    /// The body stands: what it did is over.
    pub(super) fn stand(&mut self) {
        let Self { swing, drift, greatest, .. } = *self;
        let over = |speed: Speed| Speed { square: speed.square, ..Speed::default() };
        *self = Self { mean: [0.0; 2], swing: over(swing), drift: over(drift), greatest };
    }
}
