//! Speed of the body in a form that a tilt error cannot imitate.
//!
//! A level that is tilted by δ shows a constant level force g·δ, which integrates to a speed; a
//! moving body shows a force that comes and goes. So the mean is subtracted from the level force:
//! the integral of the rest is the speed in the band that hides tilt (`swing`). Slower motion, as
//! of a vehicle, shows only in the integral of the force itself (`drift`), which counts as far as
//! the tilt's own uncertainty does not explain it, and at most three times the recent swing: a body
//! that never swings does not drift.
//!
//! A level whose error grows steadily, behind gyros that are worse than configured, would imitate a
//! swing. It does not change the force's magnitude, whose integral is a speed as well (`heave`). A
//! body that tumbles, in a hand or on waves, moves up and down as it does to and fro, so its swing
//! counts as far as its heave agrees. Wheels keep a vehicle level and prevent heave: its swing
//! counts fully.

use super::stretch::Stretch;
use crate::math::quaternion::Vector;

/// Standard gravity, m/s².
pub(super) const GRAVITY: f32 = 9.806_65;
/// Fading time of the band's speed, s, and averaging time of the mean that is subtracted from the
/// force.
pub(super) const BAND: f32 = 7.0;
/// Averaging time of the band's speeds, s: faster motion hides no tilt.
const QUICK: f32 = 1.5;
/// Fading time of the speed of slow motion, s.
pub(super) const FADING: f32 = 10.0;
/// Averaging time of the speed of slow motion, s.
const SLOW: f32 = 3.0;
/// Averaging time of mean squares of speeds and rates, s.
const WATCH: f32 = 5.0;
/// Memory of the greatest mean square, s.
const MEMORY: f32 = 30.0;
/// Least speed that is assumed, m/s: that of a body at rest.
pub(super) const LEAST_SPEED: f32 = 0.05;
/// Speed that is assumed while it is unknown, m/s: of a hand, or a swell.
const EXPECTED: f32 = 1.0;
/// Significance, in σ of the tilt, up to which it explains a drift.
const EXPLAINED: f32 = 2.0;
/// Greatest mean square of a drift, in units of that of the swing.
const GREATEST_DRIFT: f32 = 10.0;
/// Mean square of the rate about level axes from which a body tumbles, rad²/s²: wheels do not turn
/// so.
const TUMBLING: f32 = 0.25;
/// Mean rate about a level axis, rad/s, from which a body that turns by as much as tumbling within a stretch counts as
/// tumbling: wheels on a ramp turn it by no more than the one, and a bump by no more than the other.
const QUICK_ROLL: f32 = 0.15;
/// Averaging time of that rate, s.
const ROLLING: f32 = 0.5;
/// Time for which the body then counts as tumbling, s.
const TUMBLED: f32 = 60.0;
/// Greatest mean square of a tumbling body's swing, in units of that of the heave.
const GREATEST_SWING: f32 = 4.0;
/// Mean square of a swing that needs no heave, m²/s².
const LEAST_SWING: f32 = 0.01;

/// Speed in one frequency band, along some axes, m/s.
#[derive(Clone, Copy, Debug)]
struct Speed<const AXES: usize> {
    /// Fading integral of the forces, and its average.
    sum: [f32; AXES],
    average: [f32; AXES],
    /// Mean square of one axis over [`WATCH`], m²/s².
    square: f32,
}

/// Motion statistics of the body, updated stretch by stretch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    /// Level speed in the band that hides tilt.
    swing: Speed<2>,
    /// Level speed of slow motion.
    drift: Speed<2>,
    /// Speed from the force's magnitude.
    heave: Speed<1>,
    /// Mean magnitude of the force, m/s².
    size: f32,
    /// Greatest recent mean square of the swing, m²/s².
    greatest: f32,
    /// Mean square of the rate about level axes, rad²/s².
    tumbling: f32,
    /// Mean rates about north and east within half a second, rad/s, and time for which the body
    /// still counts as tumbling, s.
    rolling: [f32; 2],
    tumbled: f32,
}

impl<const AXES: usize> Default for Speed<AXES> {
    fn default() -> Self {
        Self { sum: [0.0; AXES], average: [0.0; AXES], square: 0.0 }
    }
}

impl<const AXES: usize> Speed<AXES> {
    /// Adds the integral of a force over `seconds`, m/s.
    fn push(&mut self, impulse: [f32; AXES], seconds: f32, fading: f32, averaging: f32) {
        for (axis, impulse) in impulse.into_iter().enumerate() {
            self.sum[axis] += impulse - self.sum[axis] * (seconds / fading);
            self.average[axis] += (seconds / averaging) * (self.sum[axis] - self.average[axis]);
        }
        self.square += (seconds / WATCH) * (self.now() - self.square);
    }

    /// Present mean square of the axes, m²/s².
    fn now(&self) -> f32 {
        self.average.iter().map(|speed| speed * speed).sum::<f32>() / AXES as f32
    }

    /// Greater of the present and the averaged mean square, m²/s².
    fn greater(&self) -> f32 {
        self.square.max(self.now())
    }

    /// Restarts the speed at rest, and keeps its averaged mean square.
    fn over(self) -> Self {
        Self { square: self.square, ..Self::default() }
    }
}

impl Motion {
    /// Adds a stretch with a force of this magnitude, whose mean on the level frame is given, m/s².
    pub(super) fn watch(&mut self, stretch: &Stretch, size: f32, mean: &Vector) {
        let [north, east, _] = stretch.impulse;
        let seconds = stretch.seconds;
        let [mean_north, mean_east, _] = *mean;
        let away = [north - mean_north * seconds, east - mean_east * seconds];
        self.swing.push(away, seconds, BAND, QUICK);
        self.drift.push([north, east], seconds, FADING, SLOW);
        let before = if self.size > 0.0 { self.size } else { size };
        self.size = before + (size - before) * (seconds / BAND);
        self.heave.push([(size - self.size) * seconds], seconds, BAND, QUICK);
        self.tumbling += (stretch.level_rate_square() - self.tumbling) * (seconds / WATCH);
        let [about_north, about_east] = stretch.level_turn();
        for (rolling, turned) in self.rolling.iter_mut().zip([about_north, about_east]) {
            *rolling += (turned - *rolling * seconds) * (1.0 / ROLLING);
        }
        let [a, b] = self.rolling;
        let is_sudden = stretch.level_rate_square() > TUMBLING;
        self.tumbled = if is_sudden && a * a + b * b > QUICK_ROLL * QUICK_ROLL {
            TUMBLED
        } else {
            (self.tumbled - seconds).max(0.0)
        };
        let faded = self.greatest * (1.0 - (seconds / MEMORY).min(1.0));
        self.greatest = faded.max(self.swing());
    }

    /// Reports that the body may be moving at an unknown speed.
    pub(super) fn expect_motion(&mut self) {
        let square = EXPECTED * EXPECTED;
        for lately in [&mut self.swing.square, &mut self.heave.square, &mut self.greatest] {
            *lately = lately.max(square);
        }
    }

    /// Mean square of the swing that is accepted, m²/s².
    fn swing(&self) -> f32 {
        let swing = self.swing.greater();
        if self.is_tumbled() {
            swing.min(GREATEST_SWING * self.heave.greater() + LEAST_SWING)
        } else {
            swing
        }
    }

    /// Greatest recent mean square of the swing, m²/s².
    pub(super) fn greatest(&self) -> f32 {
        self.greatest.max(LEAST_SPEED * LEAST_SPEED)
    }

    /// Whether the body tumbles, or lately turned as no wheeled vehicle does.
    pub(super) fn is_tumbled(&self) -> bool {
        self.tumbling > TUMBLING || self.tumbled > 0.0
    }

    /// Noise density of the zero-velocity pseudo-measurement, m²/s, for a level of this variance,
    /// rad².
    pub(super) fn density(&self, tilt: f32) -> f32 {
        let drift = self.drift.square.max(2.0 * self.drift.now());
        let imitated = FADING * GRAVITY * EXPLAINED;
        let drift = if drift > imitated * imitated * tilt { drift } else { 0.0 };
        // The slower speed lasts longer.
        let drift = (SLOW / QUICK * drift).min(GREATEST_DRIFT * self.greatest);
        self.swing().max(drift).max(LEAST_SPEED * LEAST_SPEED) * 2.0 * QUICK
    }

    /// Restarts the speeds at rest.
    pub(super) fn stand(&mut self) {
        let Self { swing, drift, heave, .. } = *self;
        *self = Self { swing: swing.over(), drift: drift.over(), heave: heave.over(), ..*self };
    }
}
