//! Whether the body stands: a zero-velocity detector that knows its gyros' noise from what they show.
//!
//! Half a second is steady if its mean rates and forces are those of the half second before within the gyros' noise,
//! and quiet if the rates are the biases' as well, within their uncertainty, in it alone and in all that it follows. Three
//! quiet ones in a row are a rest. Noise decides, not the attitude; but where the force is not gravity as the attitude has
//! it, and a steady acceleration would look just so, a rest must last for a minute, or until that would have made the
//! body too fast: a vehicle that speeds up steadily on a straight road is quiet too. A body that was just tumbled about
//! does not do that, and a force that is felt as at the latest rest is gravity as it was there.
//!
//! Rates that are steady but not the biases' are a turn, or biases beyond what was stated. A turn about a level axis
//! would carry the force along, which shows at once which it is. A steady turn about the vertical and a bias look alike:
//! within what was stated of the bias, a rest is believed; beyond that, rates that stay even for 20 s, of a gyro that has
//! never rested. Of one that rested only for seconds, that rest may have been a turn itself: even rates are believed in its
//! place if they last longer and make the biases less.
//!
//! The stop criteria of [`crate::signal::rest`] ask another question: whether the rate is the Earth's, of gyros that
//! show it. They judge an average on its own and need no one before it, which coarse gyros cannot.

use super::Vector;
use crate::math::rotation::{cross, difference, dot, scaled, sum};

/// Standard deviations that a mean may be off.
const BOUND: f32 = 4.0;
/// Length of a window, s.
pub const WINDOW: f32 = 0.5;
/// Quiet windows that make a rest.
const ENOUGH: u32 = 3;
/// Windows that make one where a steady acceleration would look just so: a minute.
const PATIENCE: u32 = 120;
/// Windows for which no turn is even, but the bias of a gyro that has never rested: 20 s.
const EVEN: u32 = 40;
/// Windows more for each in which it rested for less than that, with a bias that was greater.
const OUTLASTING: u32 = 3;
/// Greatest speed to which a vehicle is taken to speed up steadily, m/s: a take-off's.
const TOO_FAST: f32 = 100.0;
/// How far wind and engine turn a body that stands within a window at most, rad: 20″.
const SHAKING: f32 = 1e-4;
/// How much a mean force may change at rest, m/s²: 3 mg.
const FORCE_CHANGE: f32 = 0.03;
/// Least force that a body feels which does not fall, m/s²: half of gravity.
const LEAST_FORCE: f32 = 4.9;
/// A turn is denied if it would have moved the force by so many times what that moved, and what it moved at least as far
/// as can be told, m/s²: 1 mg.
const DENIED: f32 = 3.0;
const UNSEEN: f32 = 0.01;
/// Windows that a turn must last to be denied: what shakes the body turns it back within them.
const DENYING: u32 = 6;
/// Greatest and least noise that is believed, squared, in those of what was stated: five times, a tenth.
const GREATEST_NOISE: f32 = 25.0;
const LEAST_NOISE: f32 = 0.01;
/// Weight of one window in the mean noise at rest.
const AVERAGED: f32 = 0.125;
/// Greatest noise that one window counts with, squared, in that known before: it may be a motion's first.
const GREATEST_RISE: f32 = 2.0;
/// Part by which the squared noise may rise from window to window in motion.
const ADDED: f32 = 0.01;
/// Part of its squared noise to which a gyro falls as a motion ends.
const SETTLED: f32 = 0.5;

/// What a window shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Means {
    /// Mean rates less what the Earth turns, rad/s.
    pub rate: Vector,
    /// Mean forces, m/s²; none where there was none.
    pub force: Option<Vector>,
    /// Angle random walk as the rates within the window show it, squared, rad²/s.
    pub walk: Vector,
    /// Acceleration that the force may show although nothing changes, if the attitude is right, m/s²; none where it is
    /// gravity, or where the body does not speed up steadily.
    pub acceleration: Option<f32>,
}

/// What is known of the gyros.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known {
    /// Biases, rad/s, and their variances.
    pub biases: Vector,
    pub variances: Vector,
    /// Variances of the biases, (rad/s)², and angle random walk, squared, rad²/s, as they were stated.
    pub stated: Vector,
    pub walk: Vector,
}

/// What a window belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// The body moves, or may.
    Motion,
    /// The body stands.
    Rest,
    /// It stands, but its rates are no biases that were to be expected.
    StrangeBias,
}

/// The detector at work.
#[derive(Clone, Copy, Debug, Default)]
pub struct ZeroVelocityDetector {
    before: Option<Means>,
    /// Noise of the gyros as they show it, squared, rad²/s; none before the first window.
    walk: Option<Vector>,
    quiet: u32,
    /// What the body has turned beside the biases since it is steady or the biases were learnt, rad, and for how long, s.
    turned: Vector,
    seconds: f32,
    steady: Steady,
    is_at_rest: bool,
    /// Mean force of the latest rest, m/s².
    force: Option<Vector>,
    /// Windows in which each gyro has rested with its bias, up to [`EVEN`].
    rested: [u32; 3],
}

/// Windows in a row that are steady, though not quiet.
#[derive(Clone, Copy, Debug, Default)]
struct Steady {
    windows: u32,
    /// What the body would have turned beside the biases meanwhile, rad.
    turned: Vector,
    /// The force in the first of them, m/s², and how far it was from that at most, squared.
    force: Vector,
    moved: f32,
}

impl ZeroVelocityDetector {
    /// Takes a window, and says what it belongs to.
    pub fn push(&mut self, means: Means, known: &Known) -> Found {
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

    /// The gyros' noise as they show it: the least of lately, for motion only adds to it. As it falls, a motion ends, and
    /// what the body turned until then says nothing of its rest.
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

    /// Quiet windows that make a rest. A force that is felt as at the latest rest is gravity as it was there.
    fn enough(&self, means: &Means, force: &Vector) -> u32 {
        let Some(acceleration) = means.acceleration else { return ENOUGH };
        if self.is_at_rest || self.force.is_some_and(|rested| is_steady(force, &rested)) {
            return ENOUGH;
        }
        ((TOO_FAST / (acceleration * WINDOW)) as u32).clamp(ENOUGH, PATIENCE)
    }

    fn begin_motion(&mut self) -> Found {
        self.steady = Steady::default();
        (self.quiet, self.is_at_rest) = (0, false);
        self.count_anew();
        Found::Motion
    }

    /// Whether the rates have been even for longer than a turn lasts: about axes whose gyros have never rested, or so
    /// shortly that this may have been a turn itself, if what they show now is less beside what was stated of them.
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

    /// What the body would have turned beside the biases while its rates were even, rad.
    #[must_use]
    pub fn turned_evenly(&self) -> Vector {
        self.steady.turned
    }

    /// What the body turns beside the biases counts from now on: they were learnt, or a motion ended.
    pub fn count_anew(&mut self) {
        (self.turned, self.seconds) = ([0.0; 3], 0.0);
    }

    /// Whether the body stands.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.is_at_rest
    }

    /// Begins anew, but for what is known of the gyros.
    pub fn disturb(&mut self) {
        *self = Self { walk: self.walk, force: self.force, rested: self.rested, ..Self::default() };
    }

    /// Begins anew with another gyro about an axis: nothing is known of its noise.
    pub fn exchange(&mut self, axis: usize, walk: f32) {
        self.disturb();
        self.rested[axis] = 0;
        if let Some(known) = &mut self.walk {
            known[axis] = GREATEST_NOISE * walk;
        }
    }
}

impl Steady {
    fn push(&mut self, turned: &Vector, force: Vector) {
        if self.windows == 0 {
            (self.force, self.moved) = (force, UNSEEN * UNSEEN);
        }
        let moved = difference(&force, &self.force);
        self.moved = self.moved.max(dot(&moved, &moved));
        self.windows = self.windows.saturating_add(1);
        self.turned = sum(&self.turned, turned);
    }

    /// Whether the force would have been carried along by the turn that the rates show, and stands. In a bend it is carried
    /// with the body and stands too, so only a turn that is rather about level axes is denied.
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

/// How far a body that stands may seem to turn beside the bias in so many seconds, rad: by noise (angle random walk,
/// squared, rad²/s), by what the bias is uncertain (its variance, (rad/s)²), and by wind.
fn greatest_turn(walk: f32, variance: f32, seconds: f32) -> f32 {
    BOUND * libm::sqrtf(walk * seconds + variance * seconds * seconds) + SHAKING
}

/// The force of a window whose means are those of the one before within the noise; none where they are not, or where
/// the body fell or its force was not known.
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

/// Whether two mean forces are the same, as far as they are at rest.
fn is_steady(one: &Vector, other: &Vector) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() <= FORCE_CHANGE)
}
