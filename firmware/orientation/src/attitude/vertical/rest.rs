//! Zero-velocity detector (rest detection), which estimates its gyros' noise from their readings.
//!
//! A window of half a second is steady if its mean rates and forces equal those of the window
//! before within the gyros' noise, and quiet if the rates also equal the biases within their
//! uncertainty, in this window alone and in all that it continues. Three quiet windows in
//! succession are a rest. Noise decides, not the attitude; but where the force is not gravity for
//! the present attitude, and a steady acceleration would look the same, a rest must last for a
//! minute, or until that acceleration would have made the body too fast: a vehicle that accelerates
//! steadily on a straight road is quiet too. A body that just tumbled does not do that, and a force
//! equal to that of the latest rest is gravity as it was there.
//!
//! Rates that are steady but unequal to the biases are a rotation, or biases beyond their
//! configured 1σ. A rotation about a level axis would carry the force along, which distinguishes
//! the two at once. A steady rotation about the vertical and a bias look alike: within the
//! configured 1σ of the bias a rest is accepted; beyond it, rates that stay constant for 20 s, for
//! a gyro that has never rested. If it rested only for seconds, that rest may have been a rotation
//! itself: constant rates replace it if they last longer and make the biases smaller.
//!
//! The stop criteria of [`crate::signal::rest`] answer another question: whether the rate is the
//! Earth's, for gyros that resolve it. They test an average on its own without a predecessor, which
//! is impossible with coarse gyros.

use crate::math::quaternion::Vector;
use crate::math::rotation::{cross, difference, dot, scaled, sum};

/// Significance, in σ, at which a mean deviates.
const BOUND: f32 = 4.0;
/// Length of a window, s.
pub(crate) const WINDOW: f32 = 0.5;
/// Number of quiet windows that make a rest.
const ENOUGH: u32 = 3;
/// Greatest number of windows that make a rest, where a steady acceleration would look the same: a
/// minute.
const MOST: u32 = 120;
/// Number of windows after which constant rates are no rotation, but the bias of a gyro that has
/// never rested: 20 s.
const EVEN: u32 = 40;
/// Additional windows for each window of a shorter rest with a greater bias.
const OUTLASTING: u32 = 3;
/// Greatest speed of a steady acceleration, m/s: that of a take-off.
const TOO_FAST: f32 = 100.0;
/// Greatest rotation of a body at rest by wind and engine within a window, rad: 20″.
const SHAKING: f32 = 1e-4;
/// Greatest change of a mean force at rest, m/s²: 3 mg.
const FORCE_CHANGE: f32 = 0.03;
/// Least force on a body that does not fall, m/s²: half of gravity.
const LEAST_FORCE: f32 = 4.9;
/// Ratio of the force change that a rotation would have made to the observed one, beyond which the
/// rotation is denied.
const DENIED: f32 = 3.0;
/// Least observed change of the force, m/s²: 1 mg.
const UNSEEN: f32 = 0.01;
/// Least number of windows of a rotation that is denied: what shakes the body turns it back within
/// them.
const DENYING: u32 = 6;
/// Greatest squared noise that is assumed, in units of the configured one: five times.
const GREATEST_NOISE: f32 = 25.0;
/// Least squared noise that is assumed, in units of the configured one: a tenth.
const LEAST_NOISE: f32 = 0.01;
/// Weight of one window in the mean noise at rest.
const AVERAGED: f32 = 0.125;
/// Greatest squared noise with which one window counts, in units of the previous one: it may be the
/// first of a motion.
const GREATEST_RISE: f32 = 2.0;
/// Relative increase of the squared noise from window to window in motion.
const ADDED: f32 = 0.01;
/// Ratio to which a gyro's squared noise falls as a motion ends.
const SETTLED: f32 = 0.5;

/// Averages of a window.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Means {
    /// Mean rates less the Earth rate, rad/s.
    pub rate: Vector,
    /// Mean forces, m/s²; none without force readings.
    pub force: Option<Vector>,
    /// Squared angle random walk from the scatter of the rates within the window, rad²/s.
    pub walk: Vector,
    /// Acceleration that the force may show although nothing changes, if the attitude is right,
    /// m/s²; none where it is gravity, or where the body does not accelerate steadily.
    pub acceleration: Option<f32>,
}

/// Prior knowledge of the gyros.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Known {
    /// Estimated biases, rad/s.
    pub biases: Vector,
    /// Variances of the estimated biases, (rad/s)².
    pub variances: Vector,
    /// Configured variances of the biases, (rad/s)².
    pub stated: Vector,
    /// Squared angle random walk, rad²/s.
    pub walk: Vector,
}

/// Classification of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Found {
    /// The body moves, or may move.
    Motion,
    /// The body is at rest.
    Rest,
    /// The body is at rest, but its rates are biases beyond the configured ones.
    StrangeBias,
}

/// State of the detector.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ZeroVelocityDetector {
    /// Averages of the previous window.
    before: Option<Means>,
    /// Squared noise of the gyros from their readings, rad²/s; none before the first window.
    walk: Option<Vector>,
    /// Number of successive quiet windows.
    quiet: u32,
    /// Rotation beyond the biases since the body is steady or the biases were updated, rad, and its
    /// duration, s.
    turned: Vector,
    seconds: f32,
    /// Successive steady windows.
    pub(super) steady: Steady,
    /// Whether the body is at rest.
    pub is_at_rest: bool,
    /// Mean force of the latest rest, m/s².
    force: Option<Vector>,
    /// Number of windows in which each gyro has rested with its bias, up to [`EVEN`].
    rested: [u32; 3],
}

/// Successive windows that are steady, but not quiet.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Steady {
    /// Number of windows.
    windows: u32,
    /// Rotation beyond the biases in these windows, rad.
    pub(super) turned: Vector,
    /// Force in the first window, m/s², and greatest squared deviation from it.
    force: Vector,
    moved: f32,
}

impl ZeroVelocityDetector {
    /// Takes a window and classifies it.
    pub(crate) fn push(&mut self, means: Means, known: &Known) -> Found {
        let walk = self.learn_noise(&means, known);
        let Some(before) = self.before.replace(means) else { return self.begin_motion() };
        let Some(force) = steady_force(&means, &before, &walk) else { return self.begin_motion() };
        if !self.is_quiet(&means, known, &walk) {
            self.steady.push(&scaled(&difference(&means.rate, &known.biases), WINDOW), force);
            (self.quiet, self.is_at_rest) = (0, false);
            if self.outlasts_turn(known) {
                self.rested = [0; 3];
                return Found::StrangeBias;
            }
            return if self.steady.denies_turn(&walk) { Found::StrangeBias } else { Found::Motion };
        }
        self.steady = Steady::default();
        self.quiet = self.quiet.saturating_add(1);
        self.is_at_rest = self.quiet >= self.enough(&means, &force);
        if !self.is_at_rest {
            return Found::Motion;
        }
        self.rested = self.rested.map(|windows| (windows + 1).min(EVEN));
        self.force = Some(force);
        Found::Rest
    }

    /// Estimates the gyros' noise: the least of the recent values, because motion only adds to it.
    /// A fall marks the end of a motion, and earlier rotation is no evidence on the rest.
    fn learn_noise(&mut self, means: &Means, known: &Known) -> Vector {
        let walk = core::array::from_fn(|axis| {
            let most = GREATEST_NOISE * known.walk[axis];
            let before = self.walk.map_or(most, |walk| walk[axis]);
            let latest = self.before.map_or(most, |latest| latest.walk[axis]);
            let towards =
                before + AVERAGED * (means.walk[axis].min(GREATEST_RISE * before) - before);
            let rising = if self.is_at_rest { towards } else { before * (1.0 + ADDED) };
            let after = rising.min(means.walk[axis].max(latest));
            after.min(most).max(LEAST_NOISE * known.walk[axis])
        });
        let has_fallen = |before: Vector| (0..3).any(|axis| walk[axis] < SETTLED * before[axis]);
        if self.walk.replace(walk).is_none_or(has_fallen) {
            self.count_anew();
        }
        walk
    }

    /// Whether the rates equal the biases, in this window and since it is counted.
    fn is_quiet(&mut self, means: &Means, known: &Known, walk: &Vector) -> bool {
        self.seconds += WINDOW;
        let mut is_quiet = true;
        for (axis, walk) in walk.iter().enumerate() {
            let variance = known.variances[axis];
            let away = WINDOW * (means.rate[axis] - known.biases[axis]);
            self.turned[axis] += away;
            is_quiet &= away.abs() <= greatest_turn(*walk, variance, WINDOW);
            is_quiet &= self.turned[axis].abs() <= greatest_turn(*walk, variance, self.seconds);
        }
        is_quiet
    }

    /// Number of quiet windows that make a rest. A force equal to that of the latest rest is
    /// gravity as it was there.
    fn enough(&self, means: &Means, force: &Vector) -> u32 {
        let Some(acceleration) = means.acceleration else { return ENOUGH };
        if self.is_at_rest || self.force.is_some_and(|rested| is_steady(force, &rested)) {
            return ENOUGH;
        }
        ((TOO_FAST / (acceleration * WINDOW)) as u32).clamp(ENOUGH, MOST)
    }

    /// Begins a motion.
    fn begin_motion(&mut self) -> Found {
        self.steady = Steady::default();
        (self.quiet, self.is_at_rest) = (0, false);
        self.count_anew();
        Found::Motion
    }

    /// Whether the rates have been constant for longer than a rotation lasts: about axes whose
    /// gyros have never rested, or so shortly that this may have been a rotation itself, if the
    /// present rates deviate less from the configured biases.
    fn outlasts_turn(&self, known: &Known) -> bool {
        let Steady { windows, turned, .. } = self.steady;
        let seconds = windows as f32 * WINDOW;
        let biases = sum(&known.biases, &scaled(&turned, 1.0 / seconds));
        let part = |axis: usize, bias: &Vector| bias[axis] * bias[axis] / known.stated[axis];
        let less: f32 = (0..3).map(|axis| part(axis, &known.biases) - part(axis, &biases)).sum();
        windows >= EVEN
            && (0..3).all(|axis| {
                let bound = greatest_turn(known.walk[axis], known.variances[axis], seconds);
                let rested = self.rested[axis];
                let is_longer = rested < EVEN && windows >= EVEN + OUTLASTING * rested;
                turned[axis].abs() <= bound || rested == 0 || (is_longer && less > 0.0)
            })
    }

    /// Mean force of the latest window, m/s².
    pub(crate) fn latest_force(&self) -> Option<Vector> {
        self.before.and_then(|means| means.force)
    }

    /// Restarts the rotation beyond the biases: they were updated, or a motion ended.
    pub(crate) fn count_anew(&mut self) {
        (self.turned, self.seconds) = ([0.0; 3], 0.0);
    }

    /// Restarts the detection, and keeps the knowledge of the gyros.
    pub(crate) fn disturb(&mut self) {
        *self = Self { walk: self.walk, force: self.force, rested: self.rested, ..Self::default() };
    }

    /// Restarts the detection with other accelerometers.
    pub(crate) fn exchange_forces(&mut self) {
        self.disturb();
        self.force = None;
    }

    /// Restarts the detection with another gyro about an axis, whose noise is unknown.
    pub(crate) fn exchange(&mut self, axis: usize, walk: f32) {
        self.disturb();
        self.rested[axis] = 0;
        if let Some(known) = &mut self.walk {
            known[axis] = GREATEST_NOISE * walk;
        }
    }
}

impl Steady {
    /// Adds a window.
    fn push(&mut self, turned: &Vector, force: Vector) {
        if self.windows == 0 {
            (self.force, self.moved) = (force, UNSEEN * UNSEEN);
        }
        let moved = difference(&force, &self.force);
        self.moved = self.moved.max(dot(&moved, &moved));
        self.windows = self.windows.saturating_add(1);
        self.turned = sum(&self.turned, turned);
    }

    /// Whether the force stood although the rotation that the rates show would have carried it
    /// along. In a bend the force is carried with the body and stands too, so only a rotation
    /// mainly about level axes is denied.
    fn denies_turn(&self, walk: &Vector) -> bool {
        let seconds = self.windows as f32 * WINDOW;
        let is_noise =
            |axis: usize| self.turned[axis].abs() <= greatest_turn(walk[axis], 0.0, seconds);
        if self.windows < DENYING || (0..3).all(is_noise) {
            return false;
        }
        let carried = cross(&self.turned, &self.force);
        let carried = dot(&carried, &carried);
        let along = dot(&self.turned, &self.force);
        carried > DENIED * DENIED * self.moved && carried > along * along
    }
}

/// Greatest apparent rotation of a body at rest beyond the bias, rad: by noise (squared angle
/// random walk, rad²/s), by the bias's variance, (rad/s)², and by wind.
fn greatest_turn(walk: f32, variance: f32, seconds: f32) -> f32 {
    BOUND * libm::sqrtf(walk * seconds + variance * seconds * seconds) + SHAKING
}

/// Force of a window whose averages equal those of the one before within the noise; `None` where
/// they do not, or where the body fell or its force was unknown.
fn steady_force(now: &Means, before: &Means, walk: &Vector) -> Option<Vector> {
    let (force, force_before) = (now.force?, before.force?);
    if dot(&force, &force) < LEAST_FORCE * LEAST_FORCE {
        return None;
    }
    let is_steady = (0..3).all(|axis| {
        let change = WINDOW * (now.rate[axis] - before.rate[axis]);
        let bound = BOUND * libm::sqrtf(2.0 * walk[axis] * WINDOW) + SHAKING;
        change.abs() <= bound
    });
    (is_steady && self::is_steady(&force, &force_before)).then_some(force)
}

/// Whether two mean forces are equal within the tolerance at rest.
fn is_steady(one: &Vector, other: &Vector) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() <= FORCE_CHANGE)
}
