//! Phase lock: from turn to turn the lift's phase corrects the angle and estimates the gyro's scale
//! error.
//!
//! A Kalman filter over the turns has two states, the errors of angle and scale. Where the lift is
//! below the noise no update is made: the gyro holds the angle with its estimated scale, and σ
//! grows by the scale's uncertainty.

use super::circle::Circle;
use super::fit::{Fit, Sums};
use super::phase_accumulator::PhaseAccumulator;
use super::setting::Setting;
use super::state::Condition;
use crate::signal::SpinSample;
use crate::units::{AngleIncrement, Instant, TURN};

/// One turn in steps of the angle.
const TURN_STEPS: u64 = 1 << 40;
/// Rotation that is skipped at the start, because sensors may begin with arbitrary values.
const SKIPPED: u64 = TURN_STEPS / 4;
/// Number of turns evaluated together. With one turn, a slow change of the forces takes three
/// fifths of the phase information (6/π² of a ramp rotates with the turn), with four turns 4 %.
const TOGETHER: u32 = 4;
/// Greatest number of samples of the turns that count as spinning: ten turns a second at 10 kHz,
/// four together.
const LONGEST: u32 = 4096;
/// Assumed samples of a turn before one was measured.
const USUAL: f32 = 100.0;
/// Ratio of the lift to its noise from which it is accepted at first.
const FOUND: f32 = 5.0;
/// Ratio of the lift to its noise from which it is used later.
const USED: f32 = 3.0;
/// Significance, in σ, at which a turn's phase is rejected.
const BOUND: f64 = 4.0;
/// Number of successive rejected turns after which the search begins anew.
const REJECTED: u32 = 8;
/// Standard deviation of the scale error after its estimate has proved wrong, 1σ.
const WRONG: f64 = 0.1;
/// Standard deviation of the angle, rad, from which a phase may be off by a turn: it then sets the
/// angle and does not update the scale.
const AMBIGUOUS: f64 = 0.785;
/// Greatest loss of phase among turns that are evaluated together, 1σ, rad.
const IN_STEP: f64 = 0.4;
/// Number of successive evaluations that must agree before the roll is reported.
const AGREED: u8 = 3;
/// Number of successive contradicting evaluations before the scale is reset.
const DISAGREED: u32 = 3;
/// Greatest counter-rotating part of the force, relative to the lift, in addition to noise.
const ELLIPTIC: f32 = 0.2;
/// Number of evaluations over which the normalised innovations are averaged.
const CALM_LOOKS: f32 = 16.0;
/// Greatest mean innovation that chance makes, in σ.
const CALM_MEAN: f32 = 0.75;
/// Greatest mean squared innovation that chance makes.
const CALM_SQUARE: f32 = 2.75;
/// Factor by which the covariance is inflated where the innovations exceed these limits.
const FADE: f64 = 4.0;
/// Number of evaluations over which the noise is averaged.
const NOISE_LOOKS: f32 = 8.0;
/// Greatest factor by which an evaluation's noise raises the average: a single shock does not make
/// all later ones noisy.
const NOISE_RISE: f32 = 4.0;
/// Significance, in σ, at which an evaluation is noisier than the average: with n samples on two
/// axes, 1σ is 1/√n of the noise power.
const NOISE_SIGMAS: f32 = 4.0;
/// Random walk of the scale error, 1/√s: with the gyro's temperature.
const SCALE_WALK: f64 = 1e-6;
/// Rate below which a body does not count as spinning, rad/s.
const SLOWEST: f64 = 1.0;
/// Relative change of the rate that is assumed while samples are missing.
const CHANGE: f32 = 0.01;
/// Relative change of the rate per second that is assumed in addition to the observed one.
const QUICKENING: f32 = 0.02;
/// Greatest lost rotation within turns that are used, 1σ, rad.
const BROKEN: f64 = 0.01;
/// Standard deviation of the angle that carries no information, 1σ, rad: that of a uniform
/// distribution.
const NOTHING: f64 = 1.8;
/// Standard deviation of the angle beyond which rotation counts as lost, 1σ, rad.
const SURE: f64 = 0.4;
/// Standard deviation of the angle up to which a phase near half a turn is interpreted as negative
/// lift, 1σ, rad.
const UPRIGHT: f64 = 0.1;

/// Phase that turns show, with the sign of a correction of the angle.
#[derive(Clone, Copy)]
struct Seen {
    /// The phase, rad.
    phase: f64,
    /// Variance of the phase, rad².
    variance: f64,
    /// Rotation since the middle of these turns, rad.
    half: f64,
}

/// State of the phase lock.
#[derive(Clone, Debug, Default)]
pub(super) struct Lock {
    /// Noise power N², rad²/s, and sample period, s.
    walk: f64,
    period: f64,
    /// Standard deviation of the gyro's bias, 1σ, rad/s.
    bias: f64,
    /// Latest reciprocal rate, s/rad, and time for which the body has not been spinning, s.
    slowness: Option<f64>,
    still: f64,
    /// Relative change of the rate per second, magnitude.
    quickening: f32,
    /// Initial variance of the scale error.
    first: f64,
    /// Variances of angle, rad², and scale error, and their covariance.
    angle: f64,
    scale: f64,
    shared: f64,
    /// Estimated part of the gyro's reading that is excess: s/(1 + s) for a scale error s, in which
    /// phases are linear.
    error: f64,
    /// Sums of the turns in progress.
    sums: Sums,
    /// Variance of the rotation that was lost in these turns, rad².
    lost: f64,
    /// Angle at which the turns began, and angle of the last filter update.
    begun: i64,
    updated: i64,
    /// Rotation until the turns are evaluated.
    wanted: u64,
    /// Samples since the last filter update.
    since: u32,
    /// Average residual variance of a sample, (m/s²)².
    noise: Option<f32>,
    /// Latest lift, m/s².
    lift: Option<f32>,
    /// Whether a lift was ever found.
    is_found: bool,
    /// Number of evaluations that agreed, and number of successive contradicting ones.
    agreed: u8,
    rejected: u32,
    /// Phase of the latest contradicting evaluation, rad: either it is wrong, or the roll.
    discrepancy: f32,
    /// Mean and mean square of the normalised innovations.
    calm: [f32; 2],
    /// Sensor errors that show in the forces.
    circle: Circle,
    /// Reason for which the latest turn was not used.
    condition: Condition,
    /// Time since which turns have not been used.
    troubled: Option<Instant>,
}

impl Lock {
    /// Lock before the first sample.
    pub(super) fn new(setting: &Setting) -> Self {
        let scale = setting.scale_sigma * setting.scale_sigma;
        Self {
            walk: setting.angle_random_walk.0 * setting.angle_random_walk.0,
            period: setting.sample_seconds.0,
            bias: setting.bias_sigma.0,
            first: scale,
            angle: TURN * TURN,
            scale,
            sums: Sums::of(USUAL),
            lost: f64::INFINITY,
            wanted: SKIPPED,
            calm: [0.0, 1.0],
            condition: Condition::Locked,
            ..Self::default()
        }
    }

    /// Takes a sample; the phase accumulator must already include its rotation.
    #[inline]
    pub(super) fn push(&mut self, sample: &SpinSample, phase_accumulator: &mut PhaseAccumulator) {
        self.sums.push(phase_accumulator.angle(), sample.force);
        self.since += 1;
        let turned = phase_accumulator.whole().wrapping_sub(self.begun).unsigned_abs();
        if turned >= self.wanted || self.sums.samples >= LONGEST {
            self.finish(sample.time, phase_accumulator);
        }
    }

    /// Accounts for missing samples and for samples whose increment is unknown. `known` and `lost`
    /// are the lengths of the unknown run before and now, `mean` is the assumed increment in its
    /// steps, and `change` its change meanwhile.
    pub(super) fn lose(&mut self, missing: f32, [known, lost]: [f32; 2], mean: f32, change: f32) {
        self.since = self.since.saturating_add(missing as u32);
        self.sums.pass(missing as u32);
        let each = (0.5 * change + CHANGE * mean.abs()) * AngleIncrement::STEP as f32;
        let variance = f64::from(each) * f64::from(each) * f64::from(lost * lost - known * known);
        self.angle += variance;
        self.lost += variance;
        if self.angle > SURE * SURE {
            self.condition = Condition::RotationLost;
        }
    }

    /// Effective length of a run of samples without valid rotation: the body changes its rate as
    /// fast as it lately did, plus a margin.
    pub(super) fn unknown_length(&self, samples: f32) -> f32 {
        let left = (self.quickening + QUICKENING) * samples * self.period as f32;
        samples * (0.5 * left / CHANGE).min(1.0)
    }

    /// Evaluates the turns.
    #[inline(never)]
    fn finish(&mut self, now: Instant, phase_accumulator: &mut PhaseAccumulator) {
        let turned = phase_accumulator.whole().wrapping_sub(self.begun).unsigned_abs();
        let is_whole = turned >= self.wanted;
        let samples = self.sums.samples as f32 / turned as f32;
        let angle = f64::from(PhaseAccumulator::between(self.updated, phase_accumulator.whole()));
        self.carry(angle, f64::from(self.since) * self.period);
        let half = f64::from(self.sums.part_after_middle())
            * f64::from(PhaseAccumulator::between(self.begun, phase_accumulator.whole()));
        let condition = match (is_whole, self.lost > BROKEN * BROKEN) {
            (false, _) => Condition::NotSpinning,
            (true, true) => Condition::Locked,
            (true, false) => self.use_turn(half, phase_accumulator),
        };
        self.lost = 0.0;
        self.note(condition, now);
        self.wanted = TURN_STEPS * u64::from(self.together());
        self.sums = Sums::of(if is_whole { samples * self.wanted as f32 } else { USUAL });
        self.begun = phase_accumulator.whole();
        self.updated = self.begun;
        self.since = 0;
    }

    /// Number of turns that stay in phase for the present uncertainty of the scale.
    fn together(&self) -> u32 {
        let one = TURN * libm::sqrt(self.scale);
        match self.agreed {
            AGREED.. if f64::from(TOGETHER) * one < IN_STEP => TOGETHER,
            1.. if 2.0 * one < IN_STEP => 2,
            _ => 1,
        }
    }

    /// Propagates the states over a rotation, rad, in a time, s.
    fn carry(&mut self, angle: f64, seconds: f64) {
        self.angle += angle * (angle * self.scale - 2.0 * self.shared) + self.walk * seconds;
        self.shared -= angle * self.scale;
        self.scale += SCALE_WALK * SCALE_WALK * seconds;
        self.propagate_bias(angle, seconds);
        if self.angle > TURN * TURN {
            self.reset_angle();
        }
    }

    /// Effect of an unknown bias: on a spinning body it is a scale error that changes with the
    /// rate, on one that does not spin it rotates the angle.
    fn propagate_bias(&mut self, angle: f64, seconds: f64) {
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

    /// Resets the angle to unknown. Its covariance with the scale is dropped, because turns were
    /// not counted.
    fn reset_angle(&mut self) {
        self.angle = TURN * TURN;
        self.shared = 0.0;
        self.agreed = 0;
    }

    /// Updates the filter with turns, whose middle is the rotation `half`, rad, ago.
    fn use_turn(&mut self, half: f64, phase_accumulator: &mut PhaseAccumulator) -> Condition {
        if self.sums.count * 2 < self.sums.samples {
            return Condition::ForceLost;
        }
        if let Some(which) = self.sums.stuck() {
            return Condition::AccelerometerStuck(which);
        }
        let turns = (self.wanted / TURN_STEPS).max(1) as u32;
        let Some(fit) = self.sums.fit(turns) else { return Condition::ForceLost };
        let quiet = self.noise.unwrap_or(fit.noise);
        let noise = self.noise(&fit);
        let sigma = libm::sqrtf(noise * fit.share);
        let lift = libm::sqrtf(fit.lift.power());
        let condition = self.judge(lift, libm::sqrtf(fit.ripple.against().power()), sigma);
        if condition != Condition::Locked {
            self.lift = Some(0.0);
            return condition;
        }
        let phase = f64::from(libm::atan2f(fit.lift.im, fit.lift.re));
        let square = |part: f64| part * part;
        // A lift that changes while the scale is still uncertain has a phase error of its own.
        let bent = self.scale * square(half) * square(f64::from(fit.change / lift))
            + square(f64::from(fit.crowded() / lift));
        self.lift = Some(lift);
        let variance = square(f64::from(sigma / lift)) + bent + self.lost;
        let is_used = self.learn(Seen { phase, variance, half }, phase_accumulator);
        if !is_used && (noise > NOISE_RISE * quiet || lift < FOUND * sigma) {
            // The forces or chance are the cause, not the gyro.
            self.discrepancy = 0.0;
        }
        // Rotation lost after the middle remains uncertain.
        self.angle += self.lost;
        if is_used && self.agreed >= AGREED {
            self.circle.take(&fit, noise);
        }
        if self.discrepancy == 0.0 { Condition::Locked } else { Condition::Contradicted }
    }

    /// Checks whether a lift is significant, given the counter-rotating force and the noise of
    /// either part, m/s².
    fn judge(&self, lift: f32, against: f32, sigma: f32) -> Condition {
        let felt = sigma * if self.agreed > 0 { USED } else { FOUND };
        if lift.max(against) < felt {
            Condition::Holding
        } else if against > lift {
            Condition::Mirrored
        } else if against > ELLIPTIC * lift + BOUND as f32 * sigma {
            Condition::Elliptic
        } else if lift < felt {
            Condition::Holding
        } else {
            Condition::Locked
        }
    }

    /// Noise of the forces, averaged over turns, or that of these turns where it is significantly
    /// greater: a shock, or forces that the model does not describe.
    fn noise(&mut self, fit: &Fit) -> f32 {
        let before = self.noise.unwrap_or(fit.noise).min(NOISE_RISE * fit.noise);
        let noise = before + (fit.noise.min(NOISE_RISE * before) - before) / NOISE_LOOKS;
        self.noise = Some(noise);
        let chance = NOISE_SIGMAS / libm::sqrtf(fit.count);
        if fit.noise > noise * (1.0 + chance) { fit.noise } else { noise }
    }

    /// Updates the filter with the phase of these turns; returns whether it was accepted.
    fn learn(&mut self, seen: Seen, phase_accumulator: &mut PhaseAccumulator) -> bool {
        let Seen { phase, variance, half } = seen;
        // The measured phase is that at the middle: the present angle error, less the scale's
        // effect since.
        let with_angle = self.angle + half * self.shared;
        let with_scale = self.shared + half * self.scale;
        let whole = with_angle + half * with_scale + variance;
        if self.agreed == 0 || whole > AMBIGUOUS * AMBIGUOUS {
            self.begin(seen, phase_accumulator);
            return true;
        }
        let phase = self.upright(phase, whole);
        if phase * phase > BOUND * BOUND * whole {
            self.disagree(Seen { phase, ..seen }, phase_accumulator);
            return false;
        }
        self.rejected = 0;
        self.discrepancy = 0.0;
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

    /// Sets the angle from a phase alone, because the number of turns is ambiguous.
    fn begin(&mut self, seen: Seen, phase_accumulator: &mut PhaseAccumulator) {
        let Seen { phase, variance, half } = seen;
        self.agreed = 1;
        self.discrepancy = 0.0;
        self.calm = [0.0, 1.0];
        self.angle = variance + half * half * self.scale;
        self.shared = -half * self.scale;
        phase_accumulator.correct(phase);
    }

    /// Handles a rejected phase. Before the roll is reported it starts anew; afterwards only when
    /// too many are rejected in succession.
    fn disagree(&mut self, seen: Seen, phase_accumulator: &mut PhaseAccumulator) {
        self.rejected += 1;
        self.discrepancy = seen.phase as f32;
        let is_locked = self.agreed >= AGREED;
        if self.rejected >= if is_locked { REJECTED } else { DISAGREED } {
            self.rejected = 0;
            self.scale = self.first.max(WRONG * WRONG);
            self.reset_angle();
            self.begin(seen, phase_accumulator);
        } else if !is_locked {
            self.begin(seen, phase_accumulator);
        } else if self.rejected > 1 {
            self.fade();
        }
    }

    /// Inflates the covariance.
    fn fade(&mut self) {
        self.angle *= FADE;
        self.shared *= FADE;
        self.scale *= FADE;
    }

    /// Monitors the normalised innovations: where they are not white with variance one, the body
    /// rotates otherwise than modelled, and the covariance is inflated.
    fn watch(&mut self, added: f32) {
        let [mean, square] = &mut self.calm;
        *mean += (added - *mean) / CALM_LOOKS;
        *square += (added * added - *square) / CALM_LOOKS;
        if mean.abs() > CALM_MEAN || *square > CALM_SQUARE {
            self.calm = [0.0, 1.0];
            self.fade();
        }
    }

    /// Interprets a phase near half a turn, where the angle is certain, as a negative lift.
    fn upright(&mut self, phase: f64, variance: f64) -> f64 {
        let half = 0.5 * TURN;
        let is_sure = self.agreed >= AGREED && variance < UPRIGHT * UPRIGHT;
        if !is_sure || phase.abs() < 0.5 * half {
            return phase;
        }
        self.lift = self.lift.map(|lift| -lift);
        phase - libm::copysign(half, phase)
    }

    /// Stores the reason for which turns are not used, with its time.
    fn note(&mut self, condition: Condition, now: Instant) {
        let is_lost =
            condition == Condition::Locked && (self.agreed < AGREED || self.angle > SURE * SURE);
        self.condition = if is_lost { Condition::RotationLost } else { condition };
        let since = self.troubled.unwrap_or(now);
        self.troubled = (self.condition != Condition::Locked).then_some(since);
    }

    /// Standard deviation of the angle, 1σ, rad; `None` where it is unknown.
    pub(super) fn sigma(&self, phase_accumulator: &PhaseAccumulator) -> Option<f64> {
        let angle = f64::from(PhaseAccumulator::between(self.updated, phase_accumulator.whole()));
        let seconds = f64::from(self.since) * self.period;
        let grown = angle * (angle * self.scale - 2.0 * self.shared) + self.walk * seconds;
        let discrepancy = f64::from(self.discrepancy) * f64::from(self.discrepancy);
        let of_sensors = f64::from(self.circle.variance());
        let sigma = libm::sqrt(self.angle + grown + discrepancy + of_sensors);
        (self.agreed >= AGREED && sigma < NOTHING).then_some(sigma)
    }

    /// Scale error and its 1σ.
    pub(super) fn scale(&self) -> [f64; 2] {
        [self.error / (1.0 - self.error), libm::sqrt(self.scale)]
    }

    /// Latest lift, m/s².
    pub(super) fn lift(&self) -> Option<f64> {
        self.lift.map(f64::from)
    }

    /// Time since which the turns are not used; [`None`] while they are.
    pub(super) fn troubled(&self) -> Option<Instant> {
        self.troubled
    }

    /// Whether the turns are used, or why not. Until the roll was found for the first time, nothing is lost or held.
    #[inline]
    pub(super) fn condition(&self) -> Condition {
        let is_of_roll = matches!(
            self.condition,
            Condition::Locked | Condition::Holding | Condition::RotationLost
        );
        if is_of_roll && !self.is_found { Condition::Searching } else { self.condition }
    }
}
