//! Decision on the azimuth of a multi-position alignment: from the dwells to an azimuth with σ, or
//! to a refusal.
//!
//! The order is: check each dwell by itself, fit all sound dwells, exclude outliers one by one,
//! test what remains (tilt, residuals, Earth-rate ratio, budget), and only then give an azimuth.
//! Every bound below is chosen so that a sound session is refused in about one of a thousand cases.

use heapless::Vec;

use super::criterion::{self, Criterion};
use super::fit::{FEW_DEGREES, Fit, Found, HeadingStep, Prediction, Problem, Residual};
use super::quality::{self, Disturbance, ExpectedScatter};
use super::setting::Setting;
use super::tilt::Tilt;
use super::{CAPACITY, Refusal, cause, different_positions, level};
use crate::alignment::{self, Azimuth, Judged, Passed, SlowMotion, refuse_if};
use crate::math::chi_square_tail;
use crate::signal::Dwell;
use crate::units::{Angle, Degrees, MilliG, Radians, RadiansPerRootSecond, Seconds, TURN, wrapped};

/// Studentised residual beyond which a dwell is excluded (2.7e-5 two-sided: one sound session of 60
/// dwells in 600 loses one).
const OUTLIER_BOUND: f64 = 4.2;
/// Probability of the chi-square below which the residuals are refused: with few degrees of
/// freedom, and with more.
const WHITENESS_PROBABILITY: [f64; 2] = [1e-3, 1e-6];
/// Chi-square by which a trend that the azimuth cannot afford must explain the dwells to be refused
/// (probability 6e-5).
const HIDDEN_TREND: f64 = 16.0;
/// Chi-square by which one outlying dwell must explain more than a heading step; otherwise the step
/// may be what shows in it.
const CLEARLY: f64 = 10.0;
/// Greatest scatter that is left about a heading step which counts as the explanation, over the
/// noise's variance.
const LEFT: f64 = 3.0;
/// Greatest factor by which excluded dwells raise σ: that of a chi-square at the edge of refusal.
const GREATEST_EXCESS: f64 = 2.0;
/// Limit of the correlation of neighbouring residuals, in its standard deviation 1/√n.
const CORRELATION_BOUND: f64 = 5.0;
/// Least chi-square by which the second-best azimuth must be worse than the best (4σ).
const SECOND_MINIMUM: f64 = 16.0;
/// RMS of the dwells' mean forces about any tilt, g, beyond which accelerometer and encoder do not
/// turn alike: ten times the effect of the worst accelerometer's scale error at 5° of tilt.
const FORCE_TOLERANCE: f64 = 3e-3;
/// Greatest σ, rad, over the tangent of the angle between the azimuth and the axis of two
/// positions: the second-order error is then a tenth of the first-order one.
const STEEPNESS: f64 = 0.2;
/// Limit of the Earth-rate ratio's deviation from one, in its σ.
const RATIO_BOUND: f64 = 4.0;
/// Relative tolerance of the measured gravity beyond five σ of the accelerometer's bias: scale and
/// altitude.
const GRAVITY_TOLERANCE: f64 = 0.05;

/// Complete result of a session.
#[must_use]
#[derive(Clone, Debug)]
pub struct Conclusion {
    /// The azimuth, or the reason for refusing it.
    pub verdict: Judged,
    /// Tilt of the platform.
    pub tilt: Tilt,
    /// Fit of the dwells, where the positions determine one; its azimuth is valid only together
    /// with the verdict.
    pub fit: Option<Fit>,
    /// Angle random walk N used: configured, or estimated from the scatter within the
    /// dwells.
    pub angle_random_walk: RadiansPerRootSecond,
    /// Reason for the exclusion of each dwell; none where it was used.
    pub disturbances: Vec<Option<Disturbance>, CAPACITY>,
    /// Residual of each dwell; zero where it was excluded.
    pub residuals: Vec<Residual, CAPACITY>,
}

impl Default for Conclusion {
    /// Result without dwells: a refusal.
    fn default() -> Self {
        Self {
            verdict: Err(Refusal::TooFewPositions { positions: 0 }.into()),
            tilt: Tilt::default(),
            fit: None,
            angle_random_walk: RadiansPerRootSecond(0.0),
            disturbances: Vec::new(),
            residuals: Vec::new(),
        }
    }
}

impl Conclusion {
    /// Checks the dwells, fits the sound ones, and decides.
    pub fn of(setting: &Setting, dwells: &[Dwell], criterion: Criterion) -> Self {
        let mut conclusion = Self::default();
        conclusion.draw(setting, dwells, criterion);
        conclusion
    }

    /// Computes the conclusion in place of a [`Self::default`]: its 3 KB then need not pass through
    /// a small stack.
    pub fn draw(&mut self, setting: &Setting, dwells: &[Dwell], criterion: Criterion) {
        let lag = self.begin(setting, dwells);
        self.verdict = match lag {
            Some(seconds) => Err(Refusal::GyroLags { seconds }.into()),
            None => self.decide(setting, dwells, criterion),
        };
        if let Err(reason) = setting.site.check_latitude() {
            self.verdict = Err(reason);
        }
    }

    /// Fit, tests and choice of the azimuth, in that order; the first failure is the refusal.
    fn decide(&mut self, setting: &Setting, dwells: &[Dwell], criterion: Criterion) -> Judged {
        self.fit_undisturbed(setting, dwells)?;
        let fit = self.fit.as_ref().ok_or(Refusal::AzimuthUnobservable)?;
        self.judge(setting, dwells, fit)?;
        self.azimuth(setting, dwells, fit, criterion)
    }

    /// Checks each dwell by itself and determines the tilt from those that passed; returns the lag
    /// of the gyro, if there is one.
    #[inline(never)]
    fn begin(&mut self, setting: &Setting, dwells: &[Dwell]) -> Option<Seconds> {
        let norm = ExpectedScatter::of(setting, dwells);
        self.angle_random_walk = RadiansPerRootSecond(libm::sqrt(norm.white));
        for dwell in dwells {
            // The vectors hold as many entries as a session has dwells, so the pushes cannot fail.
            let _ = self.disturbances.push(norm.disturbance(dwell));
            let _ = self.residuals.push(Residual::default());
        }
        self.level(setting, dwells);
        quality::moved(setting, dwells, &self.tilt, &mut self.disturbances);
        self.level(setting, dwells);
        quality::lag(&norm, dwells, &self.disturbances).map(Seconds)
    }

    /// Tilt from the dwells that are not excluded.
    fn level(&mut self, setting: &Setting, dwells: &[Dwell]) {
        self.tilt = level::tilt(setting, self.kept(dwells));
    }

    /// Fits, and excludes the dwell with the largest residual, until none stands out.
    ///
    /// This step and the other steps are not inlined, so that their stack frames do not add up.
    #[inline(never)]
    fn fit_undisturbed(&mut self, setting: &Setting, dwells: &[Dwell]) -> Passed {
        let mut scatter: f64 = 1.0;
        loop {
            let kept: Vec<&Dwell, CAPACITY> = self.kept(dwells).collect();
            Self::enough(setting, dwells.len(), &kept)
                .map_err(|why| cause::of(why, setting, dwells))?;
            if !setting.site.noise.is_white_known() {
                self.angle_random_walk = RadiansPerRootSecond(libm::sqrt(white_of(&kept)));
            }
            let white = self.angle_random_walk.0 * self.angle_random_walk.0;
            let tilt = self.tilt;
            let problem = Problem { setting, tilt: &tilt, white, dwells: &kept };
            let nothing = setting.half.map_or(Refusal::AzimuthUnobservable, |_| Refusal::NotInHalf);
            let found = problem.fit().ok_or(nothing)?;
            self.keep_residuals(&problem, &found);
            let fit = self.fit.insert(found.0);
            let (degrees, ratio) = (fit.degrees, excess(fit));
            let hidden = fit.model.rejected_trend > HIDDEN_TREND;
            let step = fit.step;
            // Excluded dwells count in the scatter: they are part of its distribution.
            scatter = scatter.max(fit.excess.min(GREATEST_EXCESS));
            fit.allow_for(scatter);
            // With few degrees of freedom the largest residual need not belong to the disturbed
            // dwell.
            let outliers = self.outliers();
            let removable = outliers < allowed_outliers(dwells.len()) && degrees > FEW_DEGREES;
            let worst = self.worst();
            let is_stepped = |step: &HeadingStep| {
                (step.is_believed || worst.is_some()) && !explains(worst, step)
            };
            if let Some(step) = step.filter(is_stepped) {
                let angle = Degrees(step.angle.0 / TURN * 360.0);
                return Err(alignment::Refusal::HeadingStepped { angle, after: step.after });
            }
            let (worst, residual) = match worst {
                Some(worst) if removable => worst,
                _ if hidden => return Err(Refusal::TrendNotSeparable.into()),
                Some(_) => return Err(alignment::Refusal::ResidualsNotWhite { ratio }),
                None => {
                    if let Some(fit) = &mut self.fit {
                        problem.protect(fit, outliers > 0);
                    }
                    return self.judge_ends(dwells);
                }
            };
            self.disturbances[worst] = Some(Disturbance::Outlier(residual));
            self.level(setting, dwells);
        }
    }

    /// Refuses where the inconsistent dwells begin or end the session: then they were not
    /// disturbed, but the heading or the encoder changed.
    fn judge_ends(&self, dwells: &[Dwell]) -> Passed {
        let first = inconsistent(self.disturbances.iter());
        let last = inconsistent(self.disturbances.iter().rev());
        let at = match (first, last) {
            (0, 0) => return Ok(()),
            (first, 0) => first,
            (_, last) => dwells.len() - last,
        };
        let after = dwells.get(at.max(1) - 1).map(Dwell::end).unwrap_or_default();
        Err(Refusal::EndDisagrees { dwells: first.max(last), after }.into())
    }

    /// The dwells that take part.
    fn kept<'a>(&self, dwells: &'a [Dwell]) -> impl Iterator<Item = &'a Dwell> + Clone {
        let pairs = dwells.iter().zip(&self.disturbances).filter(|(_, why)| why.is_none());
        pairs.map(|(dwell, _)| dwell)
    }

    /// Checks that enough dwells at enough different positions are left.
    fn enough(setting: &Setting, positions: usize, kept: &[&Dwell]) -> Result<(), Refusal> {
        let different = different_positions(kept);
        let disturbed = positions - kept.len();
        if disturbed > allowed(positions) {
            return Err(Refusal::Disturbed { disturbed, positions });
        }
        match (different, setting.half) {
            (3.., _) | (2, Some(_)) => Ok(()),
            (2, None) => Err(Refusal::SignUnknown),
            _ => Err(Refusal::TooFewPositions { positions: different }),
        }
    }

    /// Stores the residuals at the places of the dwells that took part.
    fn keep_residuals(&mut self, problem: &Problem, found: &Found) {
        let Self { residuals, disturbances, .. } = self;
        residuals.fill(Residual::default());
        let mut places = residuals.iter_mut().zip(disturbances).filter(|(_, why)| why.is_none());
        problem.residuals(found, |residual| {
            if let Some((place, _)) = places.next() {
                *place = residual;
            }
        });
    }

    /// Index and magnitude of the largest studentised residual, if it is beyond the bound.
    fn worst(&self) -> Option<(usize, f64)> {
        let sizes = self.residuals.iter().map(|residual| residual.studentised.abs());
        let (index, size) = sizes
            .enumerate()
            .fold((0, 0.0), |most, item| if item.1 > most.1 { item } else { most });
        (size > OUTLIER_BOUND).then_some((index, size))
    }

    /// Number of dwells that were excluded for their residual alone.
    fn outliers(&self) -> usize {
        self.disturbances.iter().filter(|why| matches!(why, Some(Disturbance::Outlier(_)))).count()
    }

    /// Applies every test that an azimuth must pass.
    #[inline(never)]
    fn judge(&self, setting: &Setting, dwells: &[Dwell], fit: &Fit) -> Passed {
        self.judge_accelerometer(setting, dwells)?;
        self.judge_tilt(setting, fit)?;
        refuse_if(fit.direction.margin < SECOND_MINIMUM, Refusal::AzimuthUnobservable)?;
        setting.site.check_sigma(fit.sigma(), fit.budget.greatest(fit.excess))?;
        self.judge_single_axis(dwells, fit)?;
        self.judge_residuals(fit)?;
        let (ratio, sigma) = (fit.ratio, fit.ratio_sigma);
        // Two positions do not measure the Earth rate but assume it.
        let is_seen = !fit.model.is_single_axis;
        let tolerance = RATIO_BOUND * sigma + setting.site.ratio_tolerance();
        let is_off = is_seen && (ratio - 1.0).abs() > tolerance;
        refuse_if(is_off, alignment::Refusal::EarthRateMismatch { ratio, sigma })
    }

    /// Refuses an accelerometer that does not measure gravity: one that is dead, inverted or in
    /// other units shows a false tilt.
    fn judge_accelerometer(&self, setting: &Setting, dwells: &[Dwell]) -> Passed {
        let gravity = setting.site.latitude.gravity().0;
        let ratio = level::gravity_ratio(self.kept(dwells), gravity);
        let Some(ratio) = ratio else { return Ok(()) };
        let bias = setting.site.accelerometer_bias_sigma.0;
        let tolerance = GRAVITY_TOLERANCE + 5.0 * bias / gravity;
        let is_off = (ratio - 1.0).abs() > tolerance;
        refuse_if(is_off, alignment::Refusal::AccelerometerImplausible { ratio })
    }

    /// Refuses a tilt that is too large, too uncertain, stepped, or inconsistent with the encoder.
    fn judge_tilt(&self, setting: &Setting, fit: &Fit) -> Passed {
        setting.site.check_tilt(self.tilt.magnitude())?;
        let (sigma, required) =
            (degrees(fit.budget.accelerometer), degrees(setting.site.required_sigma));
        refuse_if(sigma > required, Refusal::TiltTooUncertain { sigma, required })?;
        // An encoder slip changes F by the same angle times its magnitude, and the azimuth by at
        // most the slip.
        let matters = |change: &(f64, f64)| change.1 > fit.sigma().0 * self.tilt.magnitude();
        if let Some((after, change)) = self.tilt.step.filter(matters) {
            let (change, after) = (MilliG(change * 1e3), Seconds(after));
            return Err(Refusal::TiltStepped { change, after }.into());
        }
        let Tilt { counter, scatter, .. } = self.tilt;
        let is_off = counter > 0.0 || scatter > FORCE_TOLERANCE;
        let scatter = MilliG(if counter > 0.0 { counter } else { scatter } * 1e3);
        refuse_if(is_off, alignment::Refusal::AccelerometerDisagrees { scatter })
    }

    /// Refuses two positions near their own axis, where the error of the azimuth is not normal: the
    /// cosine that they measure is flat there.
    fn judge_single_axis(&self, dwells: &[Dwell], fit: &Fit) -> Passed {
        let mut angles = self.kept(dwells).map(|dwell| dwell.stage);
        let Some(first) = angles.next().filter(|_| fit.model.is_single_axis) else { return Ok(()) };
        let apart = |angle: Angle| (angle - first).signed_rad();
        let other =
            angles.map(apart).fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most });
        // The difference of two unit vectors is perpendicular to their mean.
        let axis = first.rad() + 0.5 * other + 0.25 * TURN;
        let slope = libm::tan(fit.direction.azimuth + axis).abs();
        refuse_if(fit.sigma().0 > STEEPNESS * slope, Refusal::AzimuthUnobservable)
    }

    /// Tests chi-square of the residuals, and the correlation of neighbours.
    fn judge_residuals(&self, fit: &Fit) -> Passed {
        let degrees = fit.degrees as f64;
        let least = WHITENESS_PROBABILITY[usize::from(fit.degrees > FEW_DEGREES)];
        let is_no_noise = fit.degrees > 0 && chi_square_tail(fit.chi_square, degrees) < least;
        let ratio = excess(fit);
        refuse_if(is_no_noise, alignment::Refusal::ResidualsNotWhite { ratio })?;
        let kept: Vec<f64, CAPACITY> = (self.residuals.iter().zip(&self.disturbances))
            .filter(|(_, why)| why.is_none())
            .map(|(residual, _)| residual.normalised)
            .collect();
        let power: f64 = kept.iter().map(|r| r * r).sum();
        let shared: f64 = kept.windows(2).map(|pair| pair[0] * pair[1]).sum();
        let correlation = shared / power.max(1e-300);
        let is_no_chance = correlation * libm::sqrt(kept.len() as f64) > CORRELATION_BOUND;
        refuse_if(is_no_chance, alignment::Refusal::ResidualsCorrelated { correlation })
    }

    /// Fit problem of the dwells that took part.
    fn problem<'a>(&'a self, setting: &'a Setting, kept: &'a [&'a Dwell]) -> Problem<'a> {
        let white = self.angle_random_walk.0 * self.angle_random_walk.0;
        Problem { setting, tilt: &self.tilt, white, dwells: kept }
    }

    /// Slow rotation of the base about the vertical and slow tilting of the base, as the dwells of
    /// this conclusion show them; none where the model already contains it.
    #[must_use]
    pub fn slow_motions(&self, setting: &Setting, dwells: &[Dwell]) -> [Option<SlowMotion>; 2] {
        let Some(fit) = &self.fit else { return [None; 2] };
        let kept: Vec<&Dwell, CAPACITY> = self.kept(dwells).collect();
        let problem = self.problem(setting, &kept);
        [problem.slow_turn(fit), problem.slow_tilting(fit)]
    }

    /// Passes to `each` what the fit predicts of each dwell that took part, in their order; nothing
    /// without a fit.
    pub fn predictions(&self, setting: &Setting, dwells: &[Dwell], each: impl FnMut(Prediction)) {
        let Some(fit) = &self.fit else { return };
        let kept: Vec<&Dwell, CAPACITY> = self.kept(dwells).collect();
        self.problem(setting, &kept).predictions(fit, each);
    }

    /// Azimuth by the chosen criterion, within the required σ.
    #[inline(never)]
    fn azimuth(
        &self,
        setting: &Setting,
        dwells: &[Dwell],
        fit: &Fit,
        criterion: Criterion,
    ) -> Judged {
        let kept: Vec<&Dwell, CAPACITY> = self.kept(dwells).collect();
        let problem = self.problem(setting, &kept);
        let azimuth = match criterion {
            Criterion::MaximumLikelihood => {
                Azimuth { angle: Radians(wrapped(fit.direction.azimuth)), sigma: fit.sigma() }
            }
            paper => criterion::azimuth(&problem, fit, paper)?,
        };
        setting.site.check_sigma(azimuth.sigma, fit.budget.greatest(fit.excess))?;
        Ok(azimuth)
    }
}

/// Number of `positions` dwells that may be excluded in all: a third.
fn allowed(positions: usize) -> usize {
    positions / 3
}

/// Number of dwells that may be excluded for their residual alone: a tenth, and at least one.
fn allowed_outliers(positions: usize) -> usize {
    (positions / 10).max(1)
}

/// Whether one outlying dwell (index and studentised residual) explains more than a heading step.
/// At either end of the session both explanations coincide, and a step must not be overlooked.
fn explains(worst: Option<(usize, f64)>, step: &HeadingStep) -> bool {
    // A step that leaves more scatter than noise does not explain the dwells.
    let is_enough = step.explained < LEFT * step.gain;
    let explained = if is_enough { step.explained } else { step.gain };
    worst.is_some_and(|(_, residual)| residual * residual > explained + CLEARLY)
}

/// Chi-square over its degrees of freedom.
fn excess(fit: &Fit) -> f64 {
    fit.chi_square / fit.degrees.max(1) as f64
}

/// Number of inconsistent dwells at an end. A single dwell that was disturbed within itself may
/// have been hit by a shock and does not count.
fn inconsistent<'a>(from: impl Iterator<Item = &'a Option<Disturbance>>) -> usize {
    use Disturbance::{Drift, NonStationary, Step};
    let run = from.map_while(|why| why.filter(|why| !matches!(why, Disturbance::Samples(_))));
    let (mut count, mut within) = (0, 0);
    for why in run {
        count += 1;
        within += usize::from(matches!(why, NonStationary(_) | Step(_) | Drift(_)));
    }
    if count == 1 && within == 1 { 0 } else { count }
}

/// Noise power N² from the scatter within the dwells, each weighted by its degrees of freedom.
fn white_of(kept: &[&Dwell]) -> f64 {
    let (mut power, mut freedom) = (0.0, 0.0);
    for statistics in kept.iter().filter_map(|dwell| dwell.statistics.as_ref()) {
        power += statistics.scatter * statistics.block_seconds;
        freedom += statistics.count() - 2.0;
    }
    if freedom > 0.0 { power / freedom } else { 0.0 }
}

/// Converts radians to degrees.
fn degrees(angle: Radians) -> Degrees {
    Degrees(angle.0 / TURN * 360.0)
}
