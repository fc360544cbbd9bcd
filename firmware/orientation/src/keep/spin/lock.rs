//! The phase lock: from turn to turn the lift's phase puts the angle right and tells the gyro's scale.
//!
//! Two states, the angle's error and the scale's, in a Kalman filter over the turns. Where the lift is below the
//! noise nothing is learnt: the gyro holds the angle, its scale known, and σ grows by what is not known of it.

use super::fit::{Fit, Sums};
use super::wheel::Wheel;
use super::{Setting, State};
use crate::signal::SpinSample;
use crate::units::{AngleIncrement, Instant, TURN};

/// One turn in steps of the angle.
const TURN_STEPS: u64 = 1 << 40;
/// Turns that are looked at together. Of one turn alone, a slow change of the forces takes three fifths of what
/// tells the phase (6/π² of a ramp turns with it), of four it takes 4 %.
const TOGETHER: u32 = 4;
/// Samples of the longest turns that count as spinning, together: ten a second at 10 kHz.
const LONGEST: u32 = 4096;
/// Samples of a turn as long as none was seen.
const USUAL: f32 = 100.0;
/// Lift over its noise from which it is believed to begin with, and from which it is used.
const FOUND: f32 = 5.0;
const USED: f32 = 3.0;
/// Standard deviations by which a turn's phase may be off.
const BOUND: f64 = 4.0;
/// Turns in a row that are off by more until all is searched anew.
const PATIENCE: u32 = 8;
/// 1σ of the scale where what was known of it has proved wrong: the most that leaves four turns in step.
const WRONG: f64 = 0.03;
/// Looks over which the noise is averaged.
const NOISE_LOOKS: f32 = 8.0;
/// By how much a look may be noisier than those before and count fully: one blow does not make all that follows noisy.
const NOISE_RISE: f32 = 4.0;
/// How the scale wanders, 1/√s: with the gyro's temperature.
const SCALE_WALK: f64 = 1e-6;
/// Rate below which a body does not spin, rad/s.
const SLOWEST: f64 = 1.0;
/// Part of the rate by which it may have changed where samples are missing.
const CHANGE: f32 = 0.01;
/// What may be lost of the rotation within turns that are used, rad: it bends their phase by half of that.
const BROKEN: f32 = 0.01;
/// 1σ of the angle that says nothing any more, rad: that of any angle at all.
const NOTHING: f64 = 1.8;
/// 1σ of the angle for which a phase near half a turn off is a lift that pushes down, rad.
const SURE: f64 = 0.4;

/// What kept the latest turn from being used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trouble {
    None,
    NoLift,
    TooSlow,
    NoForce,
    NoRotation,
}

/// The lock at work.
#[derive(Clone, Debug)]
pub(super) struct Lock {
    /// N², rad²/s, and the sample period, s.
    walk: f64,
    period: f64,
    /// 1σ of the gyro's bias, rad/s.
    bias: f64,
    /// Seconds a radian, lately, and for how long the body does not spin, s.
    slowness: Option<f64>,
    still: f64,
    /// Variance of the scale to begin with.
    first: f64,
    /// Variances of angle, rad², and scale, and what they share.
    angle: f64,
    scale: f64,
    shared: f64,
    /// The scale error.
    error: f64,
    sums: Sums,
    /// Whether too much of the rotation was lost since then for the turns to be used.
    is_broken: bool,
    /// The angle at which the turn began, and at which the states were told last.
    begun: i64,
    told: i64,
    /// How far it is to turn until the turns are looked at.
    wanted: u64,
    /// Samples since then.
    since: u32,
    /// Mean variance of what is left of a sample, (m/s²)².
    noise: Option<f32>,
    lift: Option<f32>,
    is_found: bool,
    strays: u32,
    trouble: Trouble,
    troubled: Option<Instant>,
}

impl Lock {
    pub(super) fn new(setting: &Setting) -> Self {
        Self {
            walk: setting.angle_random_walk * setting.angle_random_walk,
            period: setting.sample_seconds,
            bias: setting.bias_sigma,
            slowness: None,
            still: 0.0,
            first: setting.scale_sigma * setting.scale_sigma,
            angle: TURN * TURN,
            scale: setting.scale_sigma * setting.scale_sigma,
            shared: 0.0,
            error: 0.0,
            sums: Sums::of(USUAL),
            is_broken: false,
            begun: 0,
            told: 0,
            wanted: TURN_STEPS,
            since: 0,
            noise: None,
            lift: None,
            is_found: false,
            strays: 0,
            trouble: Trouble::None,
            troubled: None,
        }
    }

    /// Takes a sample, by which the wheel has turned already.
    #[inline]
    pub(super) fn push(&mut self, sample: &SpinSample, wheel: &mut Wheel) {
        self.sums.push(wheel.angle(), sample.force);
        self.since += 1;
        let turned = wheel.whole().wrapping_sub(self.begun).unsigned_abs();
        if turned >= self.wanted || self.sums.samples() >= LONGEST {
            self.finish(sample.time, wheel);
        }
    }

    /// So many samples are missing, and of so many the increment is lost: about this one, in its steps, which changed by
    /// so much meanwhile.
    pub(super) fn lose(&mut self, missing: f32, lost: f32, mean: f32, change: f32) {
        self.since = self.since.saturating_add(missing as u32);
        self.sums.pass(missing as u32);
        let lost = lost * (0.5 * change + CHANGE * mean.abs()) * AngleIncrement::STEP as f32;
        self.angle += f64::from(lost) * f64::from(lost);
        self.is_broken |= lost > BROKEN;
        if self.angle > SURE * SURE {
            self.trouble = Trouble::NoRotation;
        }
    }

    /// The turns are over.
    #[inline(never)]
    fn finish(&mut self, now: Instant, wheel: &mut Wheel) {
        let turned = wheel.whole().wrapping_sub(self.begun).unsigned_abs();
        let is_whole = turned >= self.wanted;
        let samples = self.sums.samples() as f32 / turned as f32;
        let angle = f64::from(Wheel::between(self.told, wheel.whole()));
        self.carry(angle, f64::from(self.since) * self.period);
        let half = f64::from(self.sums.part_after_middle())
            * f64::from(Wheel::between(self.begun, wheel.whole()));
        let trouble = match (is_whole, core::mem::take(&mut self.is_broken)) {
            (false, _) => Trouble::TooSlow,
            (true, true) => Trouble::None,
            (true, false) => self.use_turn(half, wheel),
        };
        self.note(trouble, now);
        self.wanted = TURN_STEPS * u64::from(if self.is_found { TOGETHER } else { 1 });
        self.sums = Sums::of(if is_whole { samples * self.wanted as f32 } else { USUAL });
        self.begun = wheel.whole();
        self.told = self.begun;
        self.since = 0;
    }

    /// The states after the body has turned by an angle, rad, in that time, s.
    fn carry(&mut self, angle: f64, seconds: f64) {
        self.angle += angle * (angle * self.scale - 2.0 * self.shared) + self.walk * seconds;
        self.shared -= angle * self.scale;
        self.scale += SCALE_WALK * SCALE_WALK * seconds;
        self.stray_by_bias(angle, seconds);
        if self.angle > TURN * TURN {
            self.forget_angle();
        }
    }

    /// What an unknown bias does: on a body that spins it is a scale error that changes with the rate, and on one that does
    /// not it turns the angle.
    fn stray_by_bias(&mut self, angle: f64, seconds: f64) {
        let square = |part: f64| part * part;
        let slowness = seconds / angle.abs().max(SLOWEST * seconds);
        let before = self.slowness.replace(slowness).unwrap_or(slowness);
        self.scale += square(self.bias * (slowness - before));
        if slowness * SLOWEST >= 1.0 {
            let still = self.still + seconds;
            self.angle += square(self.bias) * (square(still) - square(self.still));
            self.still = still;
        } else {
            self.still = 0.0;
        }
    }

    /// Any angle is possible: it shares nothing with the scale any more, for nobody counted its turns.
    fn forget_angle(&mut self) {
        self.angle = TURN * TURN;
        self.shared = 0.0;
    }

    /// Learns from turns; the middle of them is so far ago, rad.
    fn use_turn(&mut self, half: f64, wheel: &mut Wheel) -> Trouble {
        if self.sums.count() * 2 < self.sums.samples() {
            return Trouble::NoForce;
        }
        let Some(fit) = self.sums.fit() else { return Trouble::NoForce };
        let noise = self.noise(&fit);
        let sigma = libm::sqrtf(noise * fit.share);
        let lift = libm::sqrtf(fit.lift.power());
        if lift < sigma * if self.is_found { USED } else { FOUND } {
            self.lift = Some(0.0);
            return Trouble::NoLift;
        }
        let phase = f64::from(libm::atan2f(fit.lift.imaginary, fit.lift.real));
        let square = |part: f64| part * part;
        // A lift that changes while the scale is not known yet shows a phase of its own.
        let bent = self.scale * square(half) * square(f64::from(fit.change / lift));
        self.lift = Some(lift);
        self.learn(phase, square(f64::from(sigma / lift)) + bent, half, wheel);
        Trouble::None
    }

    /// The noise of the forces, averaged over turns, or that of these where it is greater: a blow, or forces that the
    /// fit does not describe.
    fn noise(&mut self, fit: &Fit) -> f32 {
        let before = self.noise.unwrap_or(fit.noise);
        let noise = before + (fit.noise.min(NOISE_RISE * before) - before) / NOISE_LOOKS;
        self.noise = Some(noise);
        noise.max(fit.noise)
    }

    fn learn(&mut self, phase: f64, variance: f64, half: f64, wheel: &mut Wheel) {
        // The phase is that at the middle: the angle's error now, and what the scale has made of it since.
        let with_angle = self.angle + half * self.shared;
        let with_scale = self.shared + half * self.scale;
        let whole = with_angle + half * with_scale + variance;
        let phase = self.upright(phase, whole);
        if phase * phase > BOUND * BOUND * whole && self.is_found {
            return self.stray();
        }
        self.strays = 0;
        self.is_found = true;
        let (angle_gain, scale_gain) = (with_angle / whole, with_scale / whole);
        self.angle -= angle_gain * with_angle;
        self.shared -= angle_gain * with_scale;
        self.scale -= scale_gain * with_scale;
        self.error += scale_gain * phase;
        wheel.correct(angle_gain * phase);
        wheel.scale(self.error);
    }

    /// A phase near half a turn off, where the angle is sure, is a lift that pushes down.
    fn upright(&mut self, phase: f64, variance: f64) -> f64 {
        let half = 0.5 * TURN;
        if variance > SURE * SURE || phase.abs() < 0.5 * half {
            return phase;
        }
        self.lift = self.lift.map(|lift| -lift);
        phase - libm::copysign(half, phase)
    }

    /// A phase that cannot be: too many in a row, and everything is possible again.
    fn stray(&mut self) {
        self.strays += 1;
        if self.strays >= PATIENCE {
            self.strays = 0;
            self.forget_angle();
            self.scale = self.first.max(WRONG * WRONG);
        }
    }

    fn note(&mut self, trouble: Trouble, now: Instant) {
        let is_lost = trouble == Trouble::None && self.angle > SURE * SURE;
        self.trouble = if is_lost { Trouble::NoRotation } else { trouble };
        let since = self.troubled.unwrap_or(now);
        self.troubled = (self.trouble != Trouble::None).then_some(since);
    }

    /// 1σ of the angle, rad; none where any is possible.
    pub(super) fn sigma(&self, wheel: &Wheel) -> Option<f64> {
        let angle = f64::from(Wheel::between(self.told, wheel.whole()));
        let seconds = f64::from(self.since) * self.period;
        let grown = angle * (angle * self.scale - 2.0 * self.shared) + self.walk * seconds;
        let sigma = libm::sqrt(self.angle + grown);
        (self.is_found && sigma < NOTHING).then_some(sigma)
    }

    /// The scale error and its 1σ.
    pub(super) fn scale(&self) -> [f64; 2] {
        [self.error, libm::sqrt(self.scale)]
    }

    pub(super) fn lift(&self) -> Option<f64> {
        self.lift.map(f64::from)
    }

    pub(super) fn state(&self, now: Instant) -> State {
        let since = self.troubled.unwrap_or(now);
        let seconds = now.seconds() - since.seconds();
        match self.trouble {
            Trouble::TooSlow => State::NotSpinning { seconds },
            Trouble::NoForce => State::ForceLost { seconds },
            Trouble::NoRotation if self.is_found => State::RotationLost { seconds },
            _ if !self.is_found => State::Searching,
            Trouble::NoLift => State::Holding { seconds },
            Trouble::None | Trouble::NoRotation => State::Locked,
        }
    }
}
