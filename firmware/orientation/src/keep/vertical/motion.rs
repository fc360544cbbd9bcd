//! How fast the body moves, as tilt cannot imitate it.
//!
//! A level that is tilted by δ shows a steady level force g·δ, which adds up to a speed; a body that moves shows a
//! force that comes and goes. So the level force is taken less its own mean: what is left of it, added up, is the speed
//! in the band that hides tilt (`swing`). Slower motion, as a vehicle's, is seen only in the sum of the force itself
//! (`drift`), which counts as far as the tilt's own uncertainty does not explain it, and not beyond three times
//! the swing of lately: a body that never swings does not drift.
//!
//! A level that errs more each moment, behind gyros that are worse than stated, would imitate a swing. It does not change
//! the force's size: what that adds up to is a speed as well (`heave`). A body that is tumbled about, in a hand or
//! by waves, is moved up and down as it is to and fro, and its swing counts as far as its heave agrees. A
//! vehicle's wheels keep it level and from heaving: its swing counts as it is.

use super::stretch::Stretch;
use super::{GRAVITY, Vector};

/// Time over which the band's speed fades, s: as that of the mean which is taken from the force.
pub(super) const BAND: f32 = 7.0;
/// Time over which the band's speeds are averaged, s: quicker ones hide no tilt.
const QUICK: f32 = 1.5;
/// Time after which the speed of slow motion fades, and over which it is averaged, s.
pub(super) const FADING: f32 = 10.0;
const SLOW: f32 = 3.0;
/// Time over which mean squares of speeds and rates are taken, s, and for how long the greatest is remembered, s.
const WATCH: f32 = 5.0;
const MEMORY: f32 = 30.0;
/// Least speed that is allowed for, m/s: that of a body that stands.
pub(super) const LEAST_SPEED: f32 = 0.05;
/// Speed of a body of which it is not known yet, m/s: a hand's, a swell's.
const EXPECTED: f32 = 1.0;
/// Standard deviations of the tilt within which it explains a drift.
const EXPLAINED: f32 = 2.0;
/// Greatest mean square of a drift, in those of the swing.
const GREATEST_DRIFT: f32 = 10.0;
/// Mean square of the rate about level axes from which a body is tumbled about, rad²/s²: wheels do not turn so.
const TUMBLING: f32 = 0.25;
/// Mean rate about a level axis over half a second from which a body counts as tumbled, rad/s, and for how long, s.
const QUICK_ROLL: f32 = 0.15;
const ROLLING: f32 = 0.5;
const TUMBLED: f32 = 60.0;
/// Greatest mean square of a swing, in those of the heave, of a body that is tumbled about; and the square that is not
/// asked for one, m²/s².
const GREATEST_SWING: f32 = 4.0;
const LEAST_SWING: f32 = 0.01;

/// A speed in one band of frequencies, along some axes, m/s.
#[derive(Clone, Copy, Debug)]
struct Speed<const AXES: usize> {
    /// The sum of the forces, which fades, and its average.
    sum: [f32; AXES],
    average: [f32; AXES],
    /// Mean square of one axis over [`WATCH`], m²/s².
    square: f32,
}

/// The motion of the body, watched stretch by stretch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    swing: Speed<2>,
    drift: Speed<2>,
    heave: Speed<1>,
    /// Mean size of the force, m/s².
    size: f32,
    /// The greatest mean square of the swing lately, m²/s².
    greatest: f32,
    /// Mean square of the rate about level axes, rad²/s².
    tumbling: f32,
    /// Mean rate about north and east within half a second, rad/s, and for how long the body counts as tumbled, s.
    rolling: [f32; 2],
    tumbled: f32,
}

impl<const AXES: usize> Default for Speed<AXES> {
    fn default() -> Self {
        Self { sum: [0.0; AXES], average: [0.0; AXES], square: 0.0 }
    }
}

impl<const AXES: usize> Speed<AXES> {
    /// Adds what a force sums up to within so many seconds, m/s.
    fn push(&mut self, impulse: [f32; AXES], seconds: f32, fading: f32, averaging: f32) {
        for (axis, impulse) in impulse.into_iter().enumerate() {
            self.sum[axis] += impulse - self.sum[axis] * (seconds / fading);
            self.average[axis] += (seconds / averaging) * (self.sum[axis] - self.average[axis]);
        }
        self.square += (seconds / WATCH) * (self.now() - self.square);
    }

    /// Mean square of the axes now, m²/s².
    fn now(&self) -> f32 {
        self.average.iter().map(|speed| speed * speed).sum::<f32>() / AXES as f32
    }

    /// The greater of the mean square now and lately, m²/s².
    fn greater(&self) -> f32 {
        self.square.max(self.now())
    }

    /// The body stands: what it did lately stays known.
    fn over(self) -> Self {
        Self { square: self.square, ..Self::default() }
    }
}

impl Motion {
    /// Watches a stretch in which there was a force of this size, whose mean on the level frame is known, m/s².
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
        self.tumbled = if a * a + b * b > QUICK_ROLL * QUICK_ROLL {
            TUMBLED
        } else {
            (self.tumbled - seconds).max(0.0)
        };
        let faded = self.greatest * (1.0 - (seconds / MEMORY).min(1.0));
        self.greatest = faded.max(self.swing());
    }

    /// The body may be moving, at a speed that is not known yet.
    pub(super) fn expect_motion(&mut self) {
        let square = EXPECTED * EXPECTED;
        for lately in [&mut self.swing.square, &mut self.heave.square, &mut self.greatest] {
            *lately = lately.max(square);
        }
    }

    /// Mean square of the swing, as far as it is believed, m²/s².
    fn swing(&self) -> f32 {
        let swing = self.swing.greater();
        if self.is_tumbled() {
            swing.min(GREATEST_SWING * self.heave.greater() + LEAST_SWING)
        } else {
            swing
        }
    }

    /// The greatest mean square of the swing lately, m²/s².
    pub(super) fn greatest(&self) -> f32 {
        self.greatest.max(LEAST_SPEED * LEAST_SPEED)
    }

    /// Whether the body is tumbled about, or was lately turned as no vehicle on wheels is.
    pub(super) fn is_tumbled(&self) -> bool {
        self.tumbling > TUMBLING || self.tumbled > 0.0
    }

    /// Density of the speed about zero, m²/s, where the level is good to this variance, rad².
    pub(super) fn density(&self, tilt: f32) -> f32 {
        let drift = self.drift.square.max(2.0 * self.drift.now());
        let imitated = FADING * GRAVITY * EXPLAINED;
        let drift = if drift > imitated * imitated * tilt { drift } else { 0.0 };
        // The slower speed lasts longer.
        let drift = (SLOW / QUICK * drift).min(GREATEST_DRIFT * self.greatest);
        self.swing().max(drift).max(LEAST_SPEED * LEAST_SPEED) * 2.0 * QUICK
    }

    /// The body stands: what it did is over.
    pub(super) fn stand(&mut self) {
        let Self { swing, drift, heave, .. } = *self;
        *self = Self { swing: swing.over(), drift: drift.over(), heave: heave.over(), ..*self };
    }
}
