//! Decision on the azimuth of a rotating platform: from its turns to an azimuth with σ, or to a
//! refusal.

use heapless::Vec;

use super::average::{Average, steady_part, typical_size, variance_of_neighbours};
use super::change::{Mark, Marks};
use super::heading::Directions;
use super::misalignment::AxisMisalignment;
use super::solution::{Fit, Pair, Problem, force_density, of_one_turn, of_turn};
use super::tilting::Tilting;
use super::turn::{SPEEDS, STRETCHES, Sense, Stretch, Turn};
use super::turn_accumulator::TurnAccumulator;
use super::{Refusal, Setting};
use crate::alignment::{self, Azimuth, Judged, Passed, SlowMotion, refuse_if};
use crate::device::Device;
use crate::math::{Complex, chi_square_tail};
use crate::noise::GyroNoise;
use crate::units::{MilliG, Radians, RadiansPerRootSecond, RadiansPerSecond, TURN};

/// Greatest relative difference between the speeds of both senses.
const EQUAL_SPEEDS: f64 = 0.01;
/// Probability of the scatter of sound turns below which they are refused.
const SCATTER_PROBABILITY: f64 = 1e-6;
/// Factor of the stated noise power up to which σ is raised instead of a refusal.
const GREATEST_SCATTER: f64 = 3.0;
/// Probability of the scatter below which it raises σ.
const EXCESS_PROBABILITY: f64 = 0.05;
/// Greatest factor by which excluded turns raise σ.
const GREATEST_EXCESS: f64 = 2.0;
/// Greatest encoder slip seen in the forces that is included in σ, in σ.
const SMALL_SLIP: f64 = 4.0;
/// Part of such a slip by which the azimuth is off, 1σ: it belongs to the turns before or after it.
const OF_SLIP: f64 = 0.6;
/// Number of turns at an end of a stretch that may be excluded.
const FEW_DISAGREEING: u32 = 1;
/// Difference that is not chance, in σ.
const DIFFERENT: f64 = 5.0;
/// Additional tolerance for the difference of the senses of a flat sensor, relative to the Earth
/// rate: half of the angle, rad, that the base may have turned between them.
const SENSES_TOLERANCE: f64 = 0.01;
/// Greatest difference of the accelerometer's two axes, relative to the rotating force: scales,
/// angles and delays.
const AXES_TOLERANCE: f64 = 0.2;
/// Tolerance of the tilt between stretches beyond five σ, g.
const TILT_TOLERANCE: f64 = 1e-5;
/// Degrees of freedom at which a limit on an estimated scatter doubles.
const FEW: f64 = 10.0;
/// Greatest mean force over whole turns of an accelerometer in the platform's plane, m/s², beyond
/// five σ of its bias.
const FORCE_TOLERANCE: f64 = 1.0;
/// Greatest phase lag of a sensor, rad: 60°.
const GREATEST_PHASE: f64 = TURN / 6.0;
/// Greatest measured part of an integrated g-sensitivity, relative to the Earth rate.
const GREATEST_MOLECULAR: f64 = 0.5;

/// Complete result of a rotating platform.
#[derive(Clone, Debug)]
pub struct Conclusion {
    /// The azimuth, or the reason for refusing it.
    pub verdict: Judged,
    /// The fit, where both senses were measured; its azimuth is valid only together with the
    /// verdict.
    pub fit: Option<Fit>,
    /// Axis misalignment of the gyro, measured or stored, at one speed or at each.
    pub misalignments: Vec<AxisMisalignment, SPEEDS>,
    /// Averages of both senses at each speed.
    pub pairs: Vec<Pair, SPEEDS>,
    /// Angle random walk N used: known, or from the scatter of the turns.
    pub angle_random_walk: RadiansPerRootSecond,
    /// Chi-square of the turns about their means.
    pub chi_square: f64,
    /// Degrees of freedom of chi-square.
    pub degrees: u32,
}

/// What a conclusion is drawn from.
struct Evidence<'a> {
    /// Configuration of the alignment.
    setting: &'a Setting,
    /// Turns of the platform.
    turn_accumulator: &'a TurnAccumulator,
    /// Motion of a tilting base, as the forces show it.
    tilting: Tilting,
}

impl Default for Conclusion {
    /// Result without turns: a refusal.
    fn default() -> Self {
        Self {
            verdict: Err(Refusal::TurnsTooFew { sense: Sense::Clockwise, turns: 0 }.into()),
            fit: None,
            misalignments: Vec::new(),
            pairs: Vec::new(),
            angle_random_walk: RadiansPerRootSecond(0.0),
            chi_square: 0.0,
            degrees: 0,
        }
    }
}

impl Conclusion {
    /// Checks the contents of a turn accumulator, solves, and decides, in place of a
    /// [`Self::default`].
    pub(crate) fn draw(&mut self, setting: &Setting, turn_accumulator: &TurnAccumulator) {
        self.verdict = self.decide(&Evidence::of(setting, turn_accumulator));
    }

    /// Sequence of checks and computations; the first failure is the refusal.
    fn decide(&mut self, evidence: &Evidence) -> Judged {
        let Evidence { setting, turn_accumulator, tilting } = evidence;
        setting.site.check_latitude()?;
        self.couple(evidence)?;
        Self::judge_followed(turn_accumulator)?;
        let mut marks = Vec::new();
        self.pair(evidence, &mut marks)?;
        let drift = self.scatter(setting);
        let moved = |reason| {
            let tilted = |change: f64| Refusal::TiltChanged { change: MilliG(change * 1e3) }.into();
            tilting.step.map_or(reason, tilted)
        };
        self.judge_left_out(setting).map_err(moved)?;
        self.solve(evidence, marks)?;
        self.judge_turns(setting, drift)?;
        let fit = self.fit.ok_or(alignment::Refusal::MisalignmentUnknown)?;
        self.judge_force(setting, &fit, tilting)?;
        judge(setting, &fit, self.degrees)?;
        let is_accepted = setting.site.check_sigma(fit.sigma(), fit.budget.greatest(1.0));
        is_accepted.map_err(|reason| self.for_want_of_misalignment(evidence, &fit, reason))?;
        Ok(Azimuth { angle: fit.azimuth, sigma: fit.sigma() })
    }

    /// The reason for a σ that is not accepted: where most of it is an axis misalignment that is not
    /// known, that and not the encoder is to be mended.
    fn for_want_of_misalignment(
        &self,
        evidence: &Evidence,
        fit: &Fit,
        reason: alignment::Refusal,
    ) -> alignment::Refusal {
        let part = self.problem(evidence).misalignment_sigma(fit) / fit.sigma().0;
        let is_cause = self.misalignments.is_empty() && part * part > 0.5;
        if is_cause { alignment::Refusal::MisalignmentUnknown } else { reason }
    }

    /// Determines the axis misalignments from the rate-modulated turns, or takes the stored ones.
    #[inline(never)]
    fn couple(&mut self, evidence: &Evidence) -> Passed {
        let Evidence { setting, turn_accumulator, .. } = evidence;
        let mut noise = *setting.site.noise.model();
        if !setting.site.noise.is_white_known() {
            noise.angle_random_walk = estimate(&turn_accumulator.stretches, &self.misalignments);
        }
        let stretches = turn_accumulator.modulated.iter();
        let found = stretches.filter_map(|stretch| stretch.misalignment(&noise));
        self.misalignments = found.collect();
        if self.misalignments.is_empty() {
            self.misalignments = setting.misalignments.iter().flatten().copied().collect();
        }
        if !setting.site.noise.is_white_known() {
            noise.angle_random_walk = estimate(&turn_accumulator.stretches, &self.misalignments);
        }
        self.angle_random_walk = noise.angle_random_walk;
        let is_unknown = self.misalignments.is_empty() && !setting.sensor.is_flat;
        refuse_if(is_unknown, alignment::Refusal::MisalignmentUnknown)?;
        self.misalignments.iter().try_for_each(|misalignment| setting.accept(misalignment))
    }

    /// Refuses a failed accelerometer and an encoder that slipped.
    fn judge_followed(turn_accumulator: &TurnAccumulator) -> Passed {
        if let Some(trouble) = turn_accumulator.accelerometer() {
            return Err(alignment::Refusal::Device { device: Device::Accelerometer, trouble });
        }
        let angle = Radians(turn_accumulator.slip).into();
        refuse_if(turn_accumulator.slip != 0.0, Refusal::EncoderSlipped { angle })
    }

    /// Noise model of the gyro, with the N that is known or was estimated.
    fn noise(&self, setting: &Setting) -> GyroNoise {
        GyroNoise { angle_random_walk: self.angle_random_walk, ..*setting.site.noise.model() }
    }

    /// Finds the averages of both senses for every speed.
    #[inline(never)]
    fn pair(&mut self, evidence: &Evidence, marks: &mut Marks) -> Passed {
        let averages = self.averages(evidence, marks);
        let of = |sense: Sense| averages.iter().filter(move |average| average.sense == sense);
        for sense in [Sense::Clockwise, Sense::CounterClockwise] {
            if of(sense).next().is_none() {
                let stretches = &evidence.turn_accumulator.stretches;
                let count = stretches.iter().filter(|stretch| stretch.sense == sense);
                return Err(
                    Refusal::TurnsTooFew { sense, turns: count.map(Stretch::count).sum() }.into()
                );
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
            // Four stretches hold at most two of one sense with a partner, so the push cannot fail.
            let _ = self.pairs.push(Pair { clockwise: *clockwise, counter: *counter });
        }
        let alone = of(Sense::CounterClockwise)
            .find(|average| self.pairs.iter().all(|pair| pair.counter.speed != average.speed));
        match (alone, self.pairs.first()) {
            (Some(counter), Some(pair)) => Err(unequal(&pair.clockwise, counter)),
            _ => Ok(()),
        }
    }

    /// Means of the stretches, without disturbed turns; the phasors of the others are added to
    /// `marks` with the sign of their sense.
    fn averages(&self, evidence: &Evidence, marks: &mut Marks) -> Vec<Average, STRETCHES> {
        let Evidence { setting, turn_accumulator, tilting } = evidence;
        let (stretches, misalignments) = (&turn_accumulator.stretches, &self.misalignments);
        let horizontal = setting.site.latitude.horizontal_rate().0;
        let steady = steady_part(stretches);
        let slow = stretches.first().map_or(0.0, Stretch::speed);
        let mut averages = Vec::new();
        for stretch in stretches {
            let speed = stretch.speed();
            let variance = of_one_turn(&self.noise(setting), speed) / f64::from(stretch.joined);
            // Noise counts at the sensor's input, so the sensor's gain scales it.
            let is_flat = setting.sensor.is_flat;
            let size = || typical_size(stretch, misalignments);
            let gain = if is_flat { 1.0 } else { size() / horizontal };
            let is_second = (speed - slow).abs() > EQUAL_SPEEDS * slow;
            let mark = |turn: &Turn, phasor: Complex| {
                // The vector has room for every turn of every stretch.
                let _ = marks.push(Mark { is_second, ..Mark::of(stretch, turn, phasor) });
            };
            let variance = variance * gain * gain;
            let average = Average::of(stretch, misalignments, steady, variance, tilting, mark);
            if let Some(average) = average {
                // The vector has room for every stretch.
                let _ = averages.push(average);
            }
        }
        averages
    }

    /// Refuses where too many turns were excluded, or those at an end: then they were not
    /// disturbed, but the heading or the encoder changed.
    fn judge_left_out(&self, setting: &Setting) -> Passed {
        let averages = || self.pairs.iter().flat_map(Pair::senses);
        let disturbed: u32 = averages().map(|average| average.left_out).sum();
        let turns: u32 = disturbed + averages().map(|average| average.turns).sum::<u32>();
        refuse_if(4 * disturbed > turns, Refusal::TurnsDisturbed { disturbed, turns })?;
        // A sensor that is not flat may still settle in the first turns of a stretch.
        let from = usize::from(!setting.sensor.is_flat);
        let disagreeing = averages().flat_map(|average| average.ends.into_iter().skip(from));
        let turns = u32::from(disagreeing.max().unwrap_or(0));
        refuse_if(turns > FEW_DISAGREEING, Refusal::TurnsDisagree { turns })
    }

    /// Tests chi-square of the turns about their means, and their drift in σ.
    fn judge_turns(&self, setting: &Setting, drift: f64) -> Passed {
        let degrees = f64::from(self.degrees.max(1));
        let is_known = setting.site.noise.is_white_known();
        let is_no_chance = chi_square_tail(self.chi_square, degrees) < SCATTER_PROBABILITY;
        let is_great = is_known && is_no_chance && self.chi_square > GREATEST_SCATTER * degrees;
        let ratio = self.chi_square / degrees;
        refuse_if(is_great, alignment::Refusal::ResidualsNotWhite { ratio })?;
        let different = if is_known { DIFFERENT } else { different(self.degrees) };
        refuse_if(drift > different, Refusal::DirectionDrifts { sigmas: drift })
    }

    /// Factor of σ by which the turns, including the excluded ones, scatter more than their noise;
    /// one where that may be chance.
    fn excess(&self, setting: &Setting) -> f64 {
        let of = |of_all: bool| {
            let (mut chi_square, mut degrees) = (0.0, 0.0);
            for average in self.pairs.iter().flat_map(Pair::senses) {
                chi_square += if of_all { average.scatter_of_all } else { average.scatter }
                    / self.variance(setting, average);
                let left_out = f64::from(average.left_out) / average.joined();
                degrees += f64::from(average.degrees) + if of_all { 2.0 * left_out } else { 0.0 };
            }
            // A variance estimated from the same turns is itself uncertain, so half of the degrees
            // of freedom count.
            let share = if setting.site.noise.is_white_known() { 1.0 } else { 0.5 };
            let is_chance = degrees == 0.0
                || chi_square_tail(share * chi_square, share * degrees) >= EXCESS_PROBABILITY;
            if is_chance { 1.0 } else { libm::sqrt(chi_square / degrees) }
        };
        // Turns of a sensor that is not flat may be excluded because it settles, and do not count.
        let of_all = if setting.sensor.is_flat { of(true) } else { 1.0 };
        of(false).max(of_all.min(GREATEST_EXCESS))
    }

    /// Variance of either part of a mark's phasor, (rad/s)².
    fn variance(&self, setting: &Setting, average: &Average) -> f64 {
        let horizontal = setting.site.latitude.horizontal_rate();
        let is_it =
            |pair: &&Pair| (pair.speed() - average.speed).abs() <= EQUAL_SPEEDS * average.speed;
        let pair = self.pairs.iter().find(is_it).filter(|_| !setting.sensor.is_flat);
        let gain = pair.map_or(1.0, |pair| pair.gain(horizontal.0));
        of_one_turn(&self.noise(setting), average.speed) * gain * gain / average.joined()
    }

    /// Sums up chi-square; returns the greatest drift of a stretch's phasor, in σ.
    #[inline(never)]
    fn scatter(&mut self, setting: &Setting) -> f64 {
        let (mut chi_square, mut degrees, mut drift) = (0.0, 0, 0.0f64);
        for average in self.pairs.iter().flat_map(Pair::senses) {
            let variance = self.variance(setting, average);
            chi_square += average.scatter / variance;
            degrees += average.degrees;
            drift = drift.max(average.trend / variance);
        }
        (self.chi_square, self.degrees) = (chi_square, degrees);
        libm::sqrt(drift)
    }

    /// Solves, and raises σ by the scatter of the turns and by possible changes from turn to turn.
    #[inline(never)]
    fn solve(&mut self, evidence: &Evidence, marks: Marks) -> Passed {
        let Evidence { setting, tilting, .. } = evidence;
        let problem = self.problem(evidence);
        let mut fit = problem.solve().ok_or(alignment::Refusal::MisalignmentUnknown)?;
        let inflation = Directions { problem: &problem, fit: &fit }.inflation(marks);
        let excess = self.excess(setting);
        fit.budget.noise.0 *= excess;
        let drift = fit.budget.drift.0 * excess;
        let inflation_of = inflation.as_ref().map_or(0.0, |inflation| *inflation);
        fit.budget.drift = Radians(libm::sqrt(drift * drift + inflation_of));
        let slip = tilting.slip(fit.tilt.size());
        let is_small = slip <= SMALL_SLIP * fit.sigma().0;
        fit.budget.encoder = Radians(libm::hypot(fit.budget.encoder.0, OF_SLIP * slip));
        self.fit = Some(fit);
        match tilting.step.filter(|_| !is_small) {
            Some(change) => Err(Refusal::TiltChanged { change: MilliG(change * 1e3) }.into()),
            None => inflation.map(|_| ()),
        }
    }

    /// Equations to be solved.
    fn problem<'a>(&'a self, evidence: &'a Evidence) -> Problem<'a> {
        let Evidence { setting, turn_accumulator, tilting } = evidence;
        let (pairs, misalignments, noise) = (&self.pairs, &self.misalignments, self.noise(setting));
        let ellipse = turn_accumulator.ellipse();
        Problem { setting, pairs, misalignments, noise, tilting, ellipse }
    }

    /// Observability of a slow rotation of the base about the vertical, from the turns of this
    /// conclusion; `None` without a fit.
    #[must_use]
    pub fn slow_turn(
        &self,
        setting: &Setting,
        turn_accumulator: &TurnAccumulator,
    ) -> Option<SlowMotion> {
        let fit = self.fit.as_ref()?;
        let evidence = Evidence::of(setting, turn_accumulator);
        let mut marks = Vec::new();
        self.averages(&evidence, &mut marks);
        Directions { problem: &self.problem(&evidence), fit }.slow_turn(marks)
    }

    /// Checks that the accelerometer lies in the platform's plane and measured one constant tilt.
    fn judge_force(&self, setting: &Setting, fit: &Fit, tilting: &Tilting) -> Passed {
        let gravity = setting.site.latitude.gravity().0;
        let allowed = FORCE_TOLERANCE + DIFFERENT * setting.site.accelerometer_bias_sigma.0;
        let (density, degrees) = force_density(&self.pairs);
        let different = different(degrees);
        for average in self.pairs.iter().flat_map(Pair::senses) {
            let (is_off, ratio) =
                (average.mean_force.abs() > allowed, average.mean_force / gravity);
            refuse_if(is_off, alignment::Refusal::AccelerometerImplausible { ratio })?;
            let sigma = libm::sqrt(density / average.seconds) / gravity;
            // The other axis measures the same force a quarter of a turn later.
            let beside = average.across - Complex::new(0.0, 1.0) * average.force;
            let difference = beside.size() / gravity;
            let allowed = different * 2.0 * sigma + AXES_TOLERANCE * average.force.size() / gravity;
            let is_off =
                average.across != Complex::default() && difference > allowed + TILT_TOLERANCE;
            let scatter = MilliG(difference * 1e3);
            refuse_if(is_off, alignment::Refusal::AccelerometerDisagrees { scatter })?;
            let tilt = fit.tilt + tilting.tilt_at(average.middle);
            let apart = average.force.scaled(1.0 / gravity) - tilt;
            let is_changed = apart.size() > different * sigma + TILT_TOLERANCE;
            refuse_if(is_changed, Refusal::TiltChanged { change: MilliG(apart.size() * 1e3) })?;
        }
        Ok(())
    }
}

impl<'a> Evidence<'a> {
    /// Evidence of these turns under this configuration.
    fn of(setting: &'a Setting, turn_accumulator: &'a TurnAccumulator) -> Self {
        let latitude = setting.site.latitude;
        let [along, across] = setting.site.g_sensitivity;
        let per_tilt = Complex::new(latitude.vertical_rate().0 + along.0, across.0);
        let tilting = Tilting::of(&turn_accumulator.stretches, latitude.gravity().0, per_tilt);
        Self { setting, turn_accumulator, tilting }
    }
}

/// Angle random walk N from the scatter of neighbouring turns.
fn estimate(stretches: &[Stretch], misalignments: &[AxisMisalignment]) -> RadiansPerRootSecond {
    let variance = variance_of_neighbours(stretches, misalignments);
    let speed = stretches.first().map_or(0.0, Stretch::speed);
    RadiansPerRootSecond(libm::sqrt(variance / of_turn(speed, 1.0).max(f64::MIN_POSITIVE)))
}

/// Significance limit for a σ that is itself estimated with so many degrees of freedom: with few it
/// may be far too small.
fn different(degrees: u32) -> f64 {
    DIFFERENT * (1.0 + FEW / f64::from(degrees.max(1)))
}

/// Refusal of unequal speeds.
fn unequal(clockwise: &Average, counter: &Average) -> alignment::Refusal {
    let [clockwise, counter] =
        [clockwise, counter].map(|average| RadiansPerSecond(average.speed).into());
    Refusal::SpeedsUnequal { clockwise, counter }.into()
}

/// Applies every test that a fit must pass by itself.
fn judge(setting: &Setting, fit: &Fit, degrees: u32) -> Passed {
    setting.site.check_tilt(fit.tilt.size())?;
    if setting.sensor.is_flat {
        judge_flat(setting, fit, degrees)
    } else {
        judge_lagging(setting, fit)
    }
}

/// Tests of a flat sensor: the senses agree, and the Earth rate has the expected magnitude.
fn judge_flat(setting: &Setting, fit: &Fit, degrees: u32) -> Passed {
    let sigmas = libm::sqrt(fit.difference);
    let is_molecular = setting.sensor.molecular_sigma.0 > 0.0;
    let different = different(degrees);
    let tolerance = SENSES_TOLERANCE + different * fit.senses_sigma;
    let is_apart = !is_molecular && sigmas > different && fit.molecular.size() > tolerance;
    refuse_if(is_apart, Refusal::SensesDisagree { sigmas })?;
    let (ratio, sigma) = (fit.ratio, fit.ratio_sigma);
    let sigma_and_scale = libm::hypot(sigma, setting.site.amplitude_sigma());
    let tolerance = DIFFERENT * sigma_and_scale + setting.site.ratio_tolerance();
    // A gyro that lags shows a smaller rate; one that is late does not.
    let is_off = ratio > 1.0 + tolerance || ratio < fit.passed * (1.0 - tolerance);
    refuse_if(is_off, alignment::Refusal::EarthRateMismatch { ratio, sigma })
}

/// Tests of a sensor with unknown response: its phase, and the agreement of the speeds.
fn judge_lagging(setting: &Setting, fit: &Fit) -> Passed {
    let phase =
        fit.phases.iter().fold(0.0, |most: f64, x| if x.0.abs() > most.abs() { x.0 } else { most });
    let is_great = phase.abs() > GREATEST_PHASE;
    refuse_if(is_great, Refusal::PhaseAmbiguous { phase: Radians(phase).into() })?;
    if setting.sensor.molecular_sigma.0 == 0.0 {
        return Ok(());
    }
    let sigmas = fit.disagreement.max(fit.lag_disagreement);
    refuse_if(sigmas > DIFFERENT, Refusal::SpeedsDisagree { sigmas })?;
    let ratio = fit.molecular.im.abs();
    refuse_if(ratio > GREATEST_MOLECULAR, Refusal::MolecularTooGreat { ratio })
}
