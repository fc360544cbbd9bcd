//! From what a platform's turns left to a verdict: an azimuth with σ, or the reason why there is none.

use heapless::Vec;

use super::Setting;
use super::average::{Average, steady_part, typical_size, variance_of_neighbours};
use super::coupling::Coupling;
use super::follower::{Follower, STRETCHES};
use super::solution::{Fit, Pair, Problem, SPEEDS, force_density, of_turn};
use super::turn::{Sense, Stretch};
use crate::align::conclusion::Azimuth;
use crate::device::Device;
use crate::error::Refusal;
use crate::math::{Complex, chi_square_tail};
use crate::noise::model::GyroNoise;
use crate::units::{DEGREES_PER_RADIAN as DEGREES, TURN};

/// What the speeds of both senses may differ by, relative.
const EQUAL_SPEEDS: f64 = 0.01;
/// Probability of healthy turns' scatter below which they are refused.
const SCATTER_PROBABILITY: f64 = 1e-6;
/// What is a difference and no chance, in σ.
const DIFFERENT: f64 = 5.0;
/// What both senses of a flat sensor may differ by beyond that, of the Earth rate: half of what the base
/// may have turned between them, in rad.
const SENSES_TOLERANCE: f64 = 0.01;
/// What the Earth-rate ratio may be off beyond five of its σ.
const RATIO_TOLERANCE: f64 = 0.005;
/// What the accelerometer's two axes may differ by, of the force that turns with the platform: their
/// scales, angles and delays.
const STRAYING: f64 = 0.2;
/// What the tilt may differ by between stretches beyond five σ, g.
const TILT_TOLERANCE: f64 = 1e-5;
/// Degrees of freedom at which a bound on a scatter that is itself estimated doubles.
const FEW: f64 = 10.0;
/// Mean force over whole turns beyond which an accelerometer does not lie in the platform's plane, m/s²,
/// beyond five of its bias's σ.
const FORCE_TOLERANCE: f64 = 1.0;
/// Greatest phase of a sensor, rad: 60°.
const GREATEST_PHASE: f64 = TURN / 6.0;
/// Greatest measured part of an integrated g-sensitivity.
const GREATEST_MOLECULAR: f64 = 0.5;

/// All that a turning platform found.
#[derive(Clone, Debug)]
pub struct Conclusion {
    /// The azimuth, or why there is none.
    pub verdict: Result<Azimuth, Refusal>,
    /// The fit, where both senses were there; its azimuth counts only with the verdict.
    pub fit: Option<Fit>,
    /// How the gyro feels the platform's rate, found or stored, at one speed or at each.
    pub couplings: Vec<Coupling, SPEEDS>,
    /// Both senses at each speed.
    pub pairs: Vec<Pair, SPEEDS>,
    /// Angle random walk used, rad/√s: known, or from the scatter of the turns.
    pub angle_random_walk: f64,
    /// Scatter of the turns over what noise makes of it: chi-square and its degrees of freedom.
    pub chi_square: f64,
    /// Degrees of freedom of that.
    pub degrees: u32,
}

impl Default for Conclusion {
    /// Of nothing: refused.
    fn default() -> Self {
        Self {
            verdict: Err(Refusal::TurnsTooFew { sense: Sense::Clockwise, turns: 0 }),
            fit: None,
            couplings: Vec::new(),
            pairs: Vec::new(),
            angle_random_walk: 0.0,
            chi_square: 0.0,
            degrees: 0,
        }
    }
}

impl Conclusion {
    /// Judges what a follower has, solves, and decides, in place of a [`Self::default`].
    pub fn draw(&mut self, setting: &Setting, follower: &Follower) {
        self.verdict = self.decide(setting, follower);
    }

    fn decide(&mut self, setting: &Setting, follower: &Follower) -> Result<Azimuth, Refusal> {
        let latitude = setting.common.latitude;
        if !latitude.has_north() {
            return Err(Refusal::LatitudeTooHigh { latitude: latitude.rad() * DEGREES });
        }
        self.couple(setting, follower)?;
        Self::judge_followed(follower)?;
        self.pair(setting, follower.stretches())?;
        self.judge_turns(setting)?;
        let fit = self.solve(setting).ok_or(Refusal::CouplingUnknown)?;
        self.fit = Some(fit);
        self.judge_force(setting, &fit)?;
        judge(setting, &fit, self.degrees)?;
        within_budget(setting, &fit)
    }

    /// The couplings from the uneven turns, or the stored ones.
    #[inline(never)]
    fn couple(&mut self, setting: &Setting, follower: &Follower) -> Result<(), Refusal> {
        let mut noise = setting.common.noise;
        if !setting.common.white_known {
            noise.angle_random_walk = estimate(follower.stretches(), &self.couplings);
        }
        let found = follower.uneven().iter().filter_map(|uneven| uneven.coupling(&noise));
        self.couplings = found.collect();
        if self.couplings.is_empty() {
            self.couplings = setting.couplings.iter().flatten().copied().collect();
        }
        if !setting.common.white_known {
            noise.angle_random_walk = estimate(follower.stretches(), &self.couplings);
        }
        self.angle_random_walk = noise.angle_random_walk;
        if self.couplings.is_empty() && !setting.sensor.is_flat {
            return Err(Refusal::CouplingUnknown);
        }
        self.couplings.iter().try_for_each(|coupling| setting.accept(coupling))
    }

    fn judge_followed(follower: &Follower) -> Result<(), Refusal> {
        if let Some(trouble) = follower.accelerometer() {
            return Err(Refusal::Device { device: Device::Accelerometer, trouble });
        }
        if follower.slip() != 0.0 {
            return Err(Refusal::EncoderSlipped { angle: follower.slip() * DEGREES });
        }
        Ok(())
    }

    /// The gyro's noise, with the N that is known or was found.
    fn noise(&self, setting: &Setting) -> GyroNoise {
        GyroNoise { angle_random_walk: self.angle_random_walk, ..setting.common.noise }
    }

    /// Variance of either part of one turn's phasor, (rad/s)², for a sensor of gain one.
    fn of_one_turn(&self, setting: &Setting, speed: f64) -> f64 {
        of_turn(speed, self.noise(setting).density_of_period(speed / TURN))
    }

    /// Finds both senses of every speed.
    #[inline(never)]
    fn pair(&mut self, setting: &Setting, stretches: &[Stretch]) -> Result<(), Refusal> {
        let averages = self.averages(setting, stretches);
        let of = |sense: Sense| averages.iter().filter(move |average| average.sense == sense);
        for sense in [Sense::Clockwise, Sense::CounterClockwise] {
            if of(sense).next().is_none() {
                let count = stretches.iter().filter(|stretch| stretch.sense == sense);
                return Err(Refusal::TurnsTooFew { sense, turns: count.map(Stretch::count).sum() });
            }
        }
        for clockwise in of(Sense::Clockwise) {
            let apart = |average: &Average| (average.speed - clockwise.speed).abs();
            let nearest = of(Sense::CounterClockwise)
                .reduce(|best, next| if apart(next) < apart(best) { next } else { best });
            let Some(counter) = nearest else { continue };
            if apart(counter) > EQUAL_SPEEDS * clockwise.speed {
                return Err(unequal(clockwise, counter));
            }
            // Four stretches hold no more than two of one sense that have a partner.
            let _ = self.pairs.push(Pair { clockwise: *clockwise, counter: *counter });
        }
        let alone = of(Sense::CounterClockwise)
            .find(|average| self.pairs.iter().all(|pair| pair.counter.speed != average.speed));
        match (alone, self.pairs.first()) {
            (Some(counter), Some(pair)) => Err(unequal(&pair.clockwise, counter)),
            _ => Ok(()),
        }
    }

    /// The means of the stretches, disturbed turns left out.
    fn averages(&self, setting: &Setting, stretches: &[Stretch]) -> Vec<Average, STRETCHES> {
        let couplings = &self.couplings;
        let horizontal = setting.common.latitude.horizontal_rate();
        let steady = steady_part(stretches);
        let mut averages = Vec::new();
        for stretch in stretches {
            let joined = stretch.count() / stretch.turns().len().max(1) as u32;
            let speed = stretch.speed();
            let variance = self.of_one_turn(setting, speed) / f64::from(joined);
            // What the sensor's gain makes of its noise, which counts at its input.
            let is_flat = setting.sensor.is_flat;
            let gain = if is_flat { 1.0 } else { typical_size(stretch, couplings) / horizontal };
            let average = Average::of(stretch, couplings, steady, variance * gain * gain);
            if let Some(average) = average {
                // There are no more stretches than these.
                let _ = averages.push(average);
            }
        }
        averages
    }

    /// Chi-square of the turns about their means, and their drift.
    #[inline(never)]
    fn judge_turns(&mut self, setting: &Setting) -> Result<(), Refusal> {
        let drift = self.scatter(setting);
        let averages = || self.pairs.iter().flat_map(Pair::senses);
        let left_out: u32 = averages().map(|average| average.left_out).sum();
        let turns: u32 = left_out + averages().map(|average| average.turns).sum::<u32>();
        if 4 * left_out > turns {
            return Err(Refusal::TurnsDisturbed { disturbed: left_out, turns });
        }
        let degrees = f64::from(self.degrees.max(1));
        let is_known = setting.common.white_known;
        if is_known && chi_square_tail(self.chi_square, degrees) < SCATTER_PROBABILITY {
            return Err(Refusal::ResidualsNotWhite { ratio: self.chi_square / degrees });
        }
        let different = if is_known { DIFFERENT } else { different(self.degrees) };
        if drift > different {
            return Err(Refusal::DirectionDrifts { sigmas: drift });
        }
        Ok(())
    }

    /// Sums up chi-square; the greatest drift of a stretch's phasor, in σ.
    fn scatter(&mut self, setting: &Setting) -> f64 {
        let horizontal = setting.common.latitude.horizontal_rate();
        let (mut chi_square, mut degrees, mut drift) = (0.0, 0, 0.0f64);
        for pair in &self.pairs {
            let gain = if setting.sensor.is_flat { 1.0 } else { pair.gain(horizontal) };
            for average in pair.senses() {
                let one = self.of_one_turn(setting, average.speed) * gain * gain;
                let variance = one / average.joined();
                chi_square += average.scatter / variance;
                degrees += average.degrees;
                drift = drift.max(average.trend / variance);
            }
        }
        (self.chi_square, self.degrees) = (chi_square, degrees);
        libm::sqrt(drift)
    }

    #[inline(never)]
    fn solve(&self, setting: &Setting) -> Option<Fit> {
        let noise = self.noise(setting);
        let density = |speed: f64| noise.density_at(speed / TURN);
        let walk = self.angle_random_walk;
        let white = if setting.common.white_known { walk * walk } else { 0.0 };
        let (pairs, couplings) = (&self.pairs, &self.couplings);
        Problem { setting, pairs, couplings, density: &density, white }.solve()
    }

    /// Whether the accelerometer lies in the platform's plane and saw one tilt.
    fn judge_force(&self, setting: &Setting, fit: &Fit) -> Result<(), Refusal> {
        let gravity = setting.common.latitude.gravity();
        let allowed = FORCE_TOLERANCE + DIFFERENT * setting.common.accelerometer_bias_sigma;
        let (density, degrees) = force_density(&self.pairs);
        let different = different(degrees);
        for average in self.pairs.iter().flat_map(Pair::senses) {
            if average.mean_force.abs() > allowed {
                let ratio = average.mean_force / gravity;
                return Err(Refusal::AccelerometerImplausible { ratio });
            }
            let sigma = libm::sqrt(density / average.seconds) / gravity;
            // A quarter of a turn further the other axis feels the same.
            let beside = average.across - Complex::new(0.0, 1.0) * average.force;
            let strays = beside.size() / gravity;
            let allowed = different * 2.0 * sigma + STRAYING * average.force.size() / gravity;
            if average.across != Complex::default() && strays > allowed + TILT_TOLERANCE {
                return Err(Refusal::AccelerometerAstray { scatter: strays * 1e3 });
            }
            let apart = average.force.scaled(1.0 / gravity) - fit.tilt;
            if apart.size() > different * sigma + TILT_TOLERANCE {
                return Err(Refusal::TiltChanged { change: apart.size() * 1e3 });
            }
        }
        Ok(())
    }
}

/// N from the scatter of neighbouring turns, rad/√s.
fn estimate(stretches: &[Stretch], couplings: &[Coupling]) -> f64 {
    let variance = variance_of_neighbours(stretches, couplings);
    let speed = stretches.first().map_or(0.0, Stretch::speed);
    libm::sqrt(variance / of_turn(speed, 1.0).max(f64::MIN_POSITIVE))
}

/// What is a difference, in a σ that is itself known from so many degrees of freedom: from few it may be
/// far too small.
fn different(degrees: u32) -> f64 {
    DIFFERENT * (1.0 + FEW / f64::from(degrees.max(1)))
}

fn unequal(clockwise: &Average, counter: &Average) -> Refusal {
    let [clockwise, counter] = [clockwise, counter].map(|average| average.speed * DEGREES);
    Refusal::SpeedsUnequal { clockwise, counter }
}

/// Every test that a fit must pass by itself.
fn judge(setting: &Setting, fit: &Fit, degrees: u32) -> Result<(), Refusal> {
    let (tilt, allowed) = (libm::asin(fit.tilt.size().min(1.0)), setting.common.allowed_tilt);
    if tilt > allowed {
        let [tilt, allowed] = [tilt, allowed].map(|angle| angle * DEGREES);
        return Err(Refusal::TiltTooGreat { tilt, allowed });
    }
    if setting.sensor.is_flat {
        judge_flat(setting, fit, degrees)
    } else {
        judge_lagging(setting, fit)
    }
}

fn judge_flat(setting: &Setting, fit: &Fit, degrees: u32) -> Result<(), Refusal> {
    let sigmas = libm::sqrt(fit.difference);
    let is_molecular = setting.sensor.molecular_sigma > 0.0;
    let different = different(degrees);
    let tolerance = SENSES_TOLERANCE + different * fit.senses_sigma;
    if !is_molecular && sigmas > different && fit.molecular.size() > tolerance {
        return Err(Refusal::SensesDisagree { sigmas });
    }
    let (ratio, sigma) = (fit.ratio, fit.ratio_sigma);
    let sigma_and_scale = libm::hypot(sigma, setting.common.amplitude_sigma());
    if (ratio - 1.0).abs() > DIFFERENT * sigma_and_scale + RATIO_TOLERANCE {
        return Err(Refusal::EarthRateMismatch { ratio, sigma });
    }
    Ok(())
}

fn judge_lagging(setting: &Setting, fit: &Fit) -> Result<(), Refusal> {
    let phase =
        fit.phases.iter().fold(0.0, |most: f64, x| if x.abs() > most.abs() { *x } else { most });
    if phase.abs() > GREATEST_PHASE {
        return Err(Refusal::PhaseAmbiguous { phase: phase * DEGREES });
    }
    if setting.sensor.molecular_sigma == 0.0 {
        return Ok(());
    }
    if fit.disagreement > DIFFERENT {
        return Err(Refusal::SpeedsDisagree { sigmas: fit.disagreement });
    }
    let ratio = fit.molecular.im.abs();
    if ratio > GREATEST_MOLECULAR {
        return Err(Refusal::MolecularTooGreat { ratio });
    }
    Ok(())
}

/// The azimuth, unless its standard deviation is none, or more than is accepted.
fn within_budget(setting: &Setting, fit: &Fit) -> Result<Azimuth, Refusal> {
    let (sigma, required) = (fit.sigma(), setting.common.required_sigma);
    if sigma <= required {
        return Ok(Azimuth { angle: fit.azimuth, sigma });
    }
    let source = fit.budget.greatest().0;
    Err(Refusal::BudgetNotMet { sigma: sigma * DEGREES, required: required * DEGREES, source })
}
