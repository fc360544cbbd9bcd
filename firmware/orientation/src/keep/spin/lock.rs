//! The phase lock: from turn to turn the lift's phase puts the angle right and tells the gyro's scale.
//!
//! Two states, the angle's error and the scale's, in a Kalman filter over the turns. Where the lift is below the
//! noise nothing is learnt: the gyro holds the angle, its scale known, and σ grows by what is not known of it.

use super::circle::Circle;
use super::fit::{Fit, Sums};
use super::phase_accumulator::PhaseAccumulator;
use super::{Accelerometer, Setting, State};
use crate::signal::SpinSample;
use crate::units::{AngleIncrement, Instant, TURN};

/// One turn in steps of the angle.
const TURN_STEPS: u64 = 1 << 40;
/// What is passed over first: sensors may begin with anything.
const SKIPPED: u64 = TURN_STEPS / 4;
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
/// 1σ of the scale where what was known of it has proved wrong.
const WRONG: f64 = 0.1;
/// 1σ of the angle, rad, from which a phase may be a turn off: it tells the angle anew, and nothing of the scale.
const AMBIGUOUS: f64 = 0.785;
/// How far the turns that are looked at together may get out of step, 1σ, rad.
const IN_STEP: f64 = 0.4;
/// Looks in a row that must agree before the roll is told, and those that must not before the scale is doubted.
const AGREED: u8 = 3;
const DISAGREED: u32 = 3;
/// Part of the lift, beside the noise, that may go round against it.
const ELLIPTIC: f32 = 0.2;
/// Looks over which what they add to the filter is averaged, the greatest mean in standard deviations and the greatest
/// mean square that chance makes, and by how much the variances are too small where it is more.
const CALM_LOOKS: f32 = 16.0;
const CALM_MEAN: f32 = 0.75;
const CALM_SQUARE: f32 = 2.75;
const FADE: f64 = 4.0;
/// Looks over which the noise is averaged.
const NOISE_LOOKS: f32 = 8.0;
/// By how much a look may be noisier than those before and count fully: one blow does not make all that follows noisy.
const NOISE_RISE: f32 = 4.0;
/// Standard deviations by which a look is noisier than those before by more than chance: of n samples on two axes one is
/// 1/√n of the noise's square.
const NOISE_SIGMAS: f32 = 4.0;
/// How the scale wanders, 1/√s: with the gyro's temperature.
const SCALE_WALK: f64 = 1e-6;
/// Rate below which a body does not spin, rad/s.
const SLOWEST: f64 = 1.0;
/// Part of the rate by which it may have changed where samples are missing.
const CHANGE: f32 = 0.01;
/// Part of its rate by which that may change in a second, beside what it does.
const QUICKENING: f32 = 0.02;
/// What may be lost of the rotation within turns that are used, rad (1σ).
const BROKEN: f64 = 0.01;
/// 1σ of the angle that says nothing any more, rad: that of any angle at all.
const NOTHING: f64 = 1.8;
/// 1σ of the angle beyond which the rotation is lost, rad.
const SURE: f64 = 0.4;
/// 1σ of the angle for which a phase near half a turn off is a lift that pushes down, rad.
const UPRIGHT: f64 = 0.1;

/// What kept the latest turn from being used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trouble {
    None,
    NoLift,
    TooSlow,
    NoForce,
    NoRotation,
    Stuck(Accelerometer),
    Mirrored,
    Elliptic,
    Contradicted,
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
    /// Part of its rate by which that changes in a second, either way.
    quickening: f32,
    /// Variance of the scale to begin with.
    first: f64,
    /// Variances of angle, rad², and scale, and what they share.
    angle: f64,
    scale: f64,
    shared: f64,
    /// By what part of what the gyro shows that is too much: s/(1 + s) of a scale error s, in which phases are linear.
    error: f64,
    sums: Sums,
    /// Variance of the rotation that was lost since then, rad².
    lost: f64,
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
    /// Looks that have agreed with each other, and those on end that have not.
    agreed: u8,
    strays: u32,
    /// The phase of the latest one that has not, rad: either it is wrong, or the roll.
    stray: f32,
    /// Mean and mean square of what looks add, in standard deviations.
    calm: [f32; 2],
    circle: Circle,
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
            quickening: 0.0,
            first: setting.scale_sigma * setting.scale_sigma,
            angle: TURN * TURN,
            scale: setting.scale_sigma * setting.scale_sigma,
            shared: 0.0,
            error: 0.0,
            sums: Sums::of(USUAL),
            lost: f64::INFINITY,
            begun: 0,
            told: 0,
            wanted: SKIPPED,
            since: 0,
            noise: None,
            lift: None,
            is_found: false,
            agreed: 0,
            strays: 0,
            stray: 0.0,
            calm: [0.0, 1.0],
            circle: Circle::default(),
            trouble: Trouble::None,
            troubled: None,
        }
    }

    /// Takes a sample, by which the phase accumulator has turned already.
    #[inline]
    pub(super) fn push(&mut self, sample: &SpinSample, phase_accumulator: &mut PhaseAccumulator) {
        self.sums.push(phase_accumulator.angle(), sample.force);
        self.since += 1;
        let turned = phase_accumulator.whole().wrapping_sub(self.begun).unsigned_abs();
        if turned >= self.wanted || self.sums.samples() >= LONGEST {
            self.finish(sample.time, phase_accumulator);
        }
    }

    /// So many samples are missing, and of so many on end, before and now, the increment is lost: about this one, in its
    /// steps, which changed by so much meanwhile.
    pub(super) fn lose(&mut self, missing: f32, [known, lost]: [f32; 2], mean: f32, change: f32) {
        self.since = self.since.saturating_add(missing as u32);
        self.sums.pass(missing as u32);
        let each = (0.5 * change + CHANGE * mean.abs()) * AngleIncrement::STEP as f32;
        let variance = f64::from(each) * f64::from(each) * f64::from(lost * lost - known * known);
        self.angle += variance;
        self.lost += variance;
        if self.angle > SURE * SURE {
            self.trouble = Trouble::NoRotation;
        }
    }

    /// So many samples on end that the gyro does not tell, in samples of which nothing is known: the body leaves the rate
    /// that it had as fast as it lately changed it, and a little.
    pub(super) fn strayed(&self, samples: f32) -> f32 {
        let left = (self.quickening + QUICKENING) * samples * self.period as f32;
        samples * (0.5 * left / CHANGE).min(1.0)
    }

    /// The turns are over.
    #[inline(never)]
    fn finish(&mut self, now: Instant, phase_accumulator: &mut PhaseAccumulator) {
        let turned = phase_accumulator.whole().wrapping_sub(self.begun).unsigned_abs();
        let is_whole = turned >= self.wanted;
        let samples = self.sums.samples() as f32 / turned as f32;
        let angle = f64::from(PhaseAccumulator::between(self.told, phase_accumulator.whole()));
        self.carry(angle, f64::from(self.since) * self.period);
        let half = f64::from(self.sums.part_after_middle())
            * f64::from(PhaseAccumulator::between(self.begun, phase_accumulator.whole()));
        let trouble = match (is_whole, self.lost > BROKEN * BROKEN) {
            (false, _) => Trouble::TooSlow,
            (true, true) => Trouble::None,
            (true, false) => self.use_turn(half, phase_accumulator),
        };
        self.lost = 0.0;
        self.note(trouble, now);
        self.wanted = TURN_STEPS * u64::from(self.together());
        self.sums = Sums::of(if is_whole { samples * self.wanted as f32 } else { USUAL });
        self.begun = phase_accumulator.whole();
        self.told = self.begun;
        self.since = 0;
    }

    /// Turns that stay in step, whatever the scale.
    fn together(&self) -> u32 {
        let one = TURN * libm::sqrt(self.scale);
        match self.agreed {
            AGREED.. if f64::from(TOGETHER) * one < IN_STEP => TOGETHER,
            1.. if 2.0 * one < IN_STEP => 2,
            _ => 1,
        }
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
        self.quickening = ((slowness - before) / (slowness * seconds)).abs() as f32;
        if slowness * SLOWEST >= 1.0 {
            let still = self.still + seconds;
            self.angle += square(self.bias) * (square(still) - square(self.still));
            self.still = still;
        } else {
            self.still = 0.0;
        }
    }

    /// Any angle is possible: it shares nothing with the scale any more, since its turns were not counted.
    fn forget_angle(&mut self) {
        self.angle = TURN * TURN;
        self.shared = 0.0;
        self.agreed = 0;
    }

    /// Learns from turns; the middle of them is so far ago, rad.
    fn use_turn(&mut self, half: f64, phase_accumulator: &mut PhaseAccumulator) -> Trouble {
        if self.sums.count() * 2 < self.sums.samples() {
            return Trouble::NoForce;
        }
        if let Some(which) = self.sums.stuck() {
            return Trouble::Stuck(which);
        }
        let turns = (self.wanted / TURN_STEPS).max(1) as u32;
        let Some(fit) = self.sums.fit(turns) else { return Trouble::NoForce };
        let quiet = self.noise.unwrap_or(fit.noise);
        let noise = self.noise(&fit);
        let sigma = libm::sqrtf(noise * fit.share);
        let lift = libm::sqrtf(fit.lift.power());
        let trouble = self.judge(lift, libm::sqrtf(fit.ripple.against().power()), sigma);
        if trouble != Trouble::None {
            self.lift = Some(0.0);
            return trouble;
        }
        let phase = f64::from(libm::atan2f(fit.lift.imaginary, fit.lift.real));
        let square = |part: f64| part * part;
        // A lift that changes while the scale is not known yet shows a phase of its own.
        let bent = self.scale * square(half) * square(f64::from(fit.change / lift))
            + square(f64::from(fit.crowded() / lift));
        self.lift = Some(lift);
        let variance = square(f64::from(sigma / lift)) + bent + self.lost;
        let is_used = self.learn(phase, variance, half, phase_accumulator);
        if !is_used && (noise > NOISE_RISE * quiet || lift < FOUND * sigma) {
            // The forces are to blame, or chance, not the gyro.
            self.stray = 0.0;
        }
        // What was lost after the middle is still to be known.
        self.angle += self.lost;
        if is_used && self.agreed >= AGREED {
            self.circle.take(&fit, noise);
        }
        if self.stray == 0.0 { Trouble::None } else { Trouble::Contradicted }
    }

    /// Whether a lift can be believed, beside what goes round against it and the noise of either part, m/s².
    fn judge(&self, lift: f32, against: f32, sigma: f32) -> Trouble {
        let felt = sigma * if self.agreed > 0 { USED } else { FOUND };
        if lift.max(against) < felt {
            Trouble::NoLift
        } else if against > lift {
            Trouble::Mirrored
        } else if against > ELLIPTIC * lift + BOUND as f32 * sigma {
            Trouble::Elliptic
        } else if lift < felt {
            Trouble::NoLift
        } else {
            Trouble::None
        }
    }

    /// The noise of the forces, averaged over turns, or that of these where it is greater by more than chance: a blow, or
    /// forces that the fit does not describe.
    fn noise(&mut self, fit: &Fit) -> f32 {
        let before = self.noise.unwrap_or(fit.noise).min(NOISE_RISE * fit.noise);
        let noise = before + (fit.noise.min(NOISE_RISE * before) - before) / NOISE_LOOKS;
        self.noise = Some(noise);
        let chance = NOISE_SIGMAS / libm::sqrtf(fit.count);
        if fit.noise > noise * (1.0 + chance) { fit.noise } else { noise }
    }

    /// Takes a phase of such a variance, that of the middle so far ago, rad; whether it could be.
    fn learn(
        &mut self,
        phase: f64,
        variance: f64,
        half: f64,
        phase_accumulator: &mut PhaseAccumulator,
    ) -> bool {
        // The phase is that at the middle: the angle's error now, and what the scale has made of it since.
        let with_angle = self.angle + half * self.shared;
        let with_scale = self.shared + half * self.scale;
        let whole = with_angle + half * with_scale + variance;
        if self.agreed == 0 || whole > AMBIGUOUS * AMBIGUOUS {
            self.begin(phase, variance, half, phase_accumulator);
            return true;
        }
        let phase = self.upright(phase, whole);
        if phase * phase > BOUND * BOUND * whole {
            self.disagree(phase, variance, half, phase_accumulator);
            return false;
        }
        self.strays = 0;
        self.stray = 0.0;
        self.agreed = self.agreed.saturating_add(1);
        self.is_found |= self.agreed >= AGREED;
        let (angle_gain, scale_gain) = (with_angle / whole, with_scale / whole);
        self.angle -= angle_gain * with_angle;
        self.shared -= angle_gain * with_scale;
        self.scale -= scale_gain * with_scale;
        self.error += scale_gain * phase;
        phase_accumulator.correct(angle_gain * phase);
        phase_accumulator.scale(self.error);
        self.watch((phase / libm::sqrt(whole)) as f32);
        true
    }

    /// Takes the angle from a phase alone: whatever was known of it leaves open which turn it is.
    fn begin(
        &mut self,
        phase: f64,
        variance: f64,
        half: f64,
        phase_accumulator: &mut PhaseAccumulator,
    ) {
        self.agreed = 1;
        self.stray = 0.0;
        self.calm = [0.0, 1.0];
        self.angle = variance + half * half * self.scale;
        self.shared = -half * self.scale;
        phase_accumulator.correct(phase);
    }

    /// A phase that cannot be. Before the roll is told, that begins anew; afterwards, where too many come in a row.
    fn disagree(
        &mut self,
        phase: f64,
        variance: f64,
        half: f64,
        phase_accumulator: &mut PhaseAccumulator,
    ) {
        self.strays += 1;
        self.stray = phase as f32;
        let is_told = self.agreed >= AGREED;
        if self.strays >= if is_told { PATIENCE } else { DISAGREED } {
            self.strays = 0;
            self.scale = self.first.max(WRONG * WRONG);
            self.forget_angle();
            self.begin(phase, variance, half, phase_accumulator);
        } else if !is_told {
            self.begin(phase, variance, half, phase_accumulator);
        } else if self.strays > 1 {
            self.fade();
        }
    }

    /// The variances are too small.
    fn fade(&mut self) {
        self.angle *= FADE;
        self.shared *= FADE;
        self.scale *= FADE;
    }

    /// What looks add must be chance: where it is not, the body turns as the filter does not expect, and more than the
    /// variances say is open.
    fn watch(&mut self, added: f32) {
        let [mean, square] = &mut self.calm;
        *mean += (added - *mean) / CALM_LOOKS;
        *square += (added * added - *square) / CALM_LOOKS;
        if mean.abs() > CALM_MEAN || *square > CALM_SQUARE {
            self.calm = [0.0, 1.0];
            self.fade();
        }
    }

    /// A phase near half a turn off, where the angle is sure, is a lift that pushes down.
    fn upright(&mut self, phase: f64, variance: f64) -> f64 {
        let half = 0.5 * TURN;
        let is_sure = self.agreed >= AGREED && variance < UPRIGHT * UPRIGHT;
        if !is_sure || phase.abs() < 0.5 * half {
            return phase;
        }
        self.lift = self.lift.map(|lift| -lift);
        phase - libm::copysign(half, phase)
    }

    fn note(&mut self, trouble: Trouble, now: Instant) {
        let is_lost =
            trouble == Trouble::None && (self.agreed < AGREED || self.angle > SURE * SURE);
        self.trouble = if is_lost { Trouble::NoRotation } else { trouble };
        let since = self.troubled.unwrap_or(now);
        self.troubled = (self.trouble != Trouble::None).then_some(since);
    }

    /// 1σ of the angle, rad; none where any is possible.
    pub(super) fn sigma(&self, phase_accumulator: &PhaseAccumulator) -> Option<f64> {
        let angle = f64::from(PhaseAccumulator::between(self.told, phase_accumulator.whole()));
        let seconds = f64::from(self.since) * self.period;
        let grown = angle * (angle * self.scale - 2.0 * self.shared) + self.walk * seconds;
        let stray = f64::from(self.stray) * f64::from(self.stray);
        let of_sensors = f64::from(self.circle.variance());
        let sigma = libm::sqrt(self.angle + grown + stray + of_sensors);
        (self.agreed >= AGREED && sigma < NOTHING).then_some(sigma)
    }

    /// The scale error and its 1σ.
    pub(super) fn scale(&self) -> [f64; 2] {
        [self.error / (1.0 - self.error), libm::sqrt(self.scale)]
    }

    pub(super) fn lift(&self) -> Option<f64> {
        self.lift.map(f64::from)
    }

    pub(super) fn state(&self, now: Instant) -> State {
        let since = self.troubled.unwrap_or(now);
        let seconds = now.seconds() - since.seconds();
        match self.trouble {
            Trouble::Stuck(which) => State::AccelerometerStuck { which, seconds },
            Trouble::Mirrored => State::Mirrored { seconds },
            Trouble::Elliptic => State::Elliptic { seconds },
            Trouble::Contradicted => State::Contradicted { seconds },
            Trouble::TooSlow => State::NotSpinning { seconds },
            Trouble::NoForce => State::ForceLost { seconds },
            Trouble::NoRotation if self.is_found => State::RotationLost { seconds },
            _ if !self.is_found => State::Searching,
            Trouble::NoLift => State::Holding { seconds },
            Trouble::None | Trouble::NoRotation => State::Locked,
        }
    }
}
