//! Decision on the azimuth of a vehicle: from the averages of its stops and drives to an azimuth
//! with σ, or to a refusal.
//!
//! The sequence is: check that the rotation was recorded without loss and that there is something
//! to solve, run the filter until the start frame is consistent, then test outliers, residuals, the
//! Earth-rate ratio and the budget.

use super::filter::{BIAS, FORCE, LATITUDE, NOW, PLACE, Row, SCALE, START, placed};
use super::path::Path;
use super::place::Place;
use super::plain::Plain;
use super::residual::Residual;
use super::solution::{Belief, Solution, Tally};
use super::stop_detector::{Rests, StopDetector, WINDOW};
use super::{Refusal, Setting};
use crate::alignment::budget::{Budget, Source};
use crate::alignment::{self, Azimuth, Judged, Passed, refuse_if};
use crate::earth::EARTH_RATE;
use crate::math::chi_square_tail;
use crate::math::rotation::{
    IDENTITY, Matrix, Vector, cross, difference, length, product, transposed,
};
use crate::signal::rest::Criteria;
use crate::units::{
    DEGREE_PER_HOUR, DegreesPerHour, MetresPerSecondSquared, Radians, RadiansPerSecond, Seconds,
    wrapped,
};

/// Least time at rest of a stop, s: the length of the stop criteria's average.
const LEAST_REST: Seconds = Seconds(WINDOW as f64);
/// Least time between the middles of the first and the last stop, and least length of a single
/// rest: the Earth turns by a quarter of a degree.
const LEAST_SECONDS: Seconds = Seconds(60.0);
/// Least length of a drive between two stops.
const LEAST_DRIVE: Seconds = Seconds(1.0);
/// Tolerance of the ratio of the Earth's rotation beyond five of its σ.
const RATIO_TOLERANCE: f64 = 0.01;
/// Difference that is not chance, in σ.
const DIFFERENT: f64 = 5.0;
/// Least part of gravity along the body's down axis: no vehicle stands on its side.
const UPRIGHT: f64 = 0.5;
/// Greatest rotation of a swaying body between both ends of a stop, rad: about one degree.
const SWAY: f64 = 0.02;
/// Probability of the scatter of sound blocks below which they are refused.
const SCATTER_PROBABILITY: f64 = 1e-6;
/// Factor by which the assumed scatter of the blocks may be too small: it is estimated from the
/// same few blocks, and sway is not white.
const UNSURE: f64 = 1.5;
/// Greatest power of the force changes after rotation to a frozen frame over that on the body's
/// axes. Where axes and signs of gyros and accelerometers are right, this rotation removes the
/// sway.
const DISAGREEMENT: f64 = 1.5;
/// Greatest rate of a vehicle that only stands, from its beginning to its end and relative to the
/// Earth, rad/s: a fifth of the Earth rate.
const CARRIED: f64 = 0.2 * EARTH_RATE;
/// Correlation of neighbouring blocks beyond that of any noise: an unmodelled drift.
const CORRELATED: f64 = 0.75;
/// Correlation of neighbouring blocks that a sway with a period shorter than two blocks makes;
/// longer blocks respond less to it.
const SWAYS: f64 = -0.3;
/// Fewest blocks that may be joined in pairs.
const MANY: usize = 16;
/// Reciprocal of the greatest part of the blocks that may be excluded.
const LEFT_OUT: u32 = 4;
/// Correction of the first estimates from which the limit is that about the last ones, rad: below it both differ by
/// some thousandths, and a further run costs half a conclusion.
const FAR: f64 = 0.05;
/// Part of a bias's prior 1σ below which the bias counts as observed.
const OBSERVED: f64 = 0.5;

/// Complete result of the stops.
#[must_use]
#[derive(Clone, Debug)]
pub struct Conclusion {
    /// Azimuth of body x at the end, or the reason for refusing it.
    pub verdict: Judged,
    /// Details, where there was something to solve; they are valid only together with the verdict.
    pub found: Option<Found>,
}

/// Details of the solution.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// Azimuth of body x at the end, with σ.
    pub azimuth: Azimuth,
    /// Azimuth of body x at the start, with σ.
    pub start: Azimuth,
    /// Attitude at the start: rotation from body axes to north, east, down.
    pub start_attitude: Matrix,
    /// Cramér–Rao bound of the azimuth at the end for the same unknowns, 1σ.
    pub limit: Radians,
    /// Azimuth of body x at the end from the first run, before outliers are excluded; for
    /// simulation campaigns.
    pub unchecked: Radians,
    /// Error budget of the azimuth at the end.
    pub budget: Budget,
    /// Pitch and roll at the end.
    pub level: [Radians; 2],
    /// Estimated biases of the gyros.
    pub biases: [RadiansPerSecond; 3],
    /// Standard deviations of the biases, 1σ.
    pub bias_sigmas: [RadiansPerSecond; 3],
    /// Whether the stops determine all biases: the 1σ of each is at most half of the prior one.
    pub are_biases_observed: bool,
    /// Factor by which the prior 1σ of the biases had to be inflated; one where it was sufficient.
    pub widening: f64,
    /// Result of the original method (Szymanowski 2003).
    pub plain: Plain,
    /// Statistics of the last run along the path.
    pub tally: Tally,
    /// Number of all blocks at rest.
    pub blocks: u32,
}

impl Conclusion {
    /// Checks the contents of a stop detector, solves, and decides.
    #[inline(never)]
    pub fn of(setting: &Setting, stop_detector: &mut StopDetector) -> Self {
        stop_detector.update();
        if let Err(reason) = inspect(setting, stop_detector) {
            return Self { verdict: Err(reason), found: None };
        }
        let mut found = Found::of(setting, &path(setting, stop_detector));
        while found.tally.correlation() < SWAYS && stop_detector.blocks.list.len() >= MANY {
            // The blocks are joined in pairs, for a sway with a period shorter than two of them.
            stop_detector.blocks.halve();
            found = Found::of(setting, &path(setting, stop_detector));
        }
        Self {
            verdict: judge(setting, &found, stop_detector).map(|()| found.azimuth),
            found: Some(found),
        }
    }

    /// What the solution leaves of a stop of this session; none without a solution, or where it is
    /// not known how far from the first one the vehicle stood.
    pub(crate) fn residual(
        &self,
        setting: &Setting,
        stop_detector: &StopDetector,
        stop: usize,
    ) -> Option<Residual> {
        let found = self.found.as_ref()?;
        let path = path(setting, stop_detector);
        path.stops.get(stop).filter(|at| stop == 0 || at.displacement.is_some())?;
        let walk = setting.site.noise.model().angle_random_walk;
        Some(Residual::of(&path, stop, (&found.start_attitude, &found.biases), walk))
    }

    /// Refusal without any details.
    pub const fn refused(reason: alignment::Refusal) -> Self {
        Self { verdict: Err(reason), found: None }
    }
}

/// Path of the vehicle until now.
fn path<'a>(setting: &Setting, stop_detector: &'a StopDetector) -> Path<'a> {
    let (now, carried) = stop_detector.now();
    Path {
        place: Place::new(setting.site.latitude),
        gravity: setting.site.latitude.gravity().0,
        start: stop_detector.start(),
        stops: &stop_detector.stops,
        blocks: &stop_detector.blocks,
        drives: &stop_detector.drives,
        now,
        carried,
        stated_density: 0.5 * setting.force_noise.0 * setting.force_noise.0,
    }
}

/// Refuses a latitude without north, lost rotation, missing or short stops, and drives that are too
/// short.
fn inspect(setting: &Setting, stop_detector: &StopDetector) -> Passed {
    setting.site.check_latitude()?;
    stop_detector.loss(setting.site.required_sigma.0).map_or(Ok(()), Err)?;
    let (stops, is_whole) = (&stop_detector.stops, stop_detector.rests == Rests::Whole);
    let is_fleeting = stop_detector.state.fleeting > 0.0 && stops.len() < 2;
    refuse_if(is_fleeting, too_short(stops.len(), Seconds(stop_detector.state.fleeting)))?;
    let [Some(first), Some(last)] = [stops.first(), stops.last()] else {
        return Err(Refusal::NoStop.into());
    };
    let is_alone = !is_whole && stops.len() == 1;
    refuse_if(is_alone, Refusal::OneStop { from: first.from, to: first.to })?;
    for index in 0..stops.len() {
        inspect_stop(setting, stop_detector, index)?;
    }
    for pair in stops.windows(2) {
        let (seconds, least) = (Seconds(pair[1].from.0 - pair[0].to.0), LEAST_DRIVE);
        refuse_if(seconds < least, Refusal::DriveTooShort { seconds, least })?;
    }
    let seconds = if is_whole { last.seconds() } else { Seconds(last.middle() - first.middle()) };
    let least = LEAST_SECONDS;
    refuse_if(seconds < least, Refusal::DriveTooShort { seconds, least })
}

/// Refusal of the stop with this index, which has so much rest.
fn too_short(index: usize, seconds: Seconds) -> Refusal {
    Refusal::StopTooShort { stop: index + 1, seconds, least: LEAST_REST }
}

/// Checks that a stop is long enough, and that the vehicle stood.
fn inspect_stop(setting: &Setting, stop_detector: &StopDetector, index: usize) -> Passed {
    let stop = &stop_detector.stops[index];
    let lengths = stop_detector.blocks.of(index).map(|block| f64::from(block.seconds));
    let rest = Seconds(lengths.sum());
    refuse_if(rest < LEAST_REST, too_short(index, rest))?;
    let gravity = setting.site.latitude.gravity().0;
    let ratio = -stop.force.mean()[2] / gravity;
    refuse_if(ratio < UPRIGHT, alignment::Refusal::AccelerometerImplausible { ratio })?;
    let mut limits = setting.sensors().limits(stop.seconds());
    limits.rate.0 += SWAY / stop.seconds().0;
    let [rate, force] = [stop.turned.mean(), stop.force.mean()].map(|mean| length(&mean));
    let criteria = Criteria::of(rate, force, gravity);
    let rate = DegreesPerHour(criteria.rate.0.abs() / DEGREE_PER_HOUR);
    let force = MetresPerSecondSquared(criteria.force.0.abs());
    let is_moving = !criteria.is_rest(&limits);
    refuse_if(is_moving, Refusal::VehicleMoves { stop: index + 1, rate, force })?;
    let ratio = stop.disagreement();
    let is_agreed = ratio <= DISAGREEMENT;
    refuse_if(!is_agreed, Refusal::AxesDisagree { ratio })
}

/// Refuses where the excluded data contradict the rest. A vehicle may be turned at a stop, and a
/// drive may end rolling; but where most of them deviate, the model is wrong.
fn agree(found: &Tally, stops: u32) -> Passed {
    let drives = stops.saturating_sub(1);
    // A single rest has no other data: the vehicle may be rocked, but not carried round.
    let is_carried = drives == 0 && found.turning_rate.0 > CARRIED;
    let is_turning = is_carried || drives > 0 && 2 * found.turning > stops;
    refuse_if(is_turning, Refusal::EarthNotFelt { stops: found.turning, of: stops })?;
    let is_unsteady = drives > 0 && 2 * found.unsteady >= drives;
    refuse_if(is_unsteady, Refusal::DrivesDisagree { drives: found.unsteady, of: drives })
}

/// Tests the plausibility of the result.
fn judge(setting: &Setting, found: &Found, stop_detector: &StopDetector) -> Passed {
    agree(&found.tally, stop_detector.stops.len() as u32)?;
    let (Tally { left_out, chi_square, degrees, .. }, of) = (found.tally, found.blocks);
    refuse_if(left_out * LEFT_OUT > of, Refusal::RestDisturbed { disturbed: left_out, of })?;
    let is_no_noise = chi_square_tail(chi_square / UNSURE, degrees) < SCATTER_PROBABILITY;
    let ratio = chi_square / degrees;
    refuse_if(is_no_noise, alignment::Refusal::ResidualsNotWhite { ratio })?;
    let correlation = found.tally.correlation();
    let is_correlated = correlation > CORRELATED;
    refuse_if(is_correlated, alignment::Refusal::ResidualsCorrelated { correlation })?;
    let Plain { ratio, ratio_sigma: sigma, .. } = found.plain;
    let is_off = (ratio - 1.0).abs() > DIFFERENT * found.widening * sigma + RATIO_TOLERANCE;
    refuse_if(is_off, alignment::Refusal::EarthRateMismatch { ratio, sigma })?;
    let is_unknown = setting.bias_sigma.is_none() && !found.are_biases_observed;
    let source = if is_unknown { Source::Drift } else { found.budget.greatest(1.0) };
    let sigma = found.azimuth.sigma;
    let is_met = setting.site.check_sigma(sigma, source);
    is_met.map_err(|reason| stop_detector.cause(sigma.0).map_or(reason, Into::into))
}

impl Found {
    /// Solves the path and reports the result.
    #[inline(never)]
    fn of(setting: &Setting, path: &Path) -> Self {
        let (plain, frame) = Plain::of(setting, path);
        let mut solution = Solution::new(frame);
        solution.run(setting, path, Belief::Ideal);
        let unchecked = azimuth_of(&End::of(path, &solution).attitude);
        let limit = limit(path, &solution);
        let is_far = solution.correction(path) > FAR;
        solution.settle(setting, path);
        let shown = Self::shown(setting, path, &plain, &solution);
        let limit = if is_far { limit_anew(setting, path, solution) } else { limit };
        // σ allows for more than the limit does.
        Self { limit: Radians(limit.0.min(shown.azimuth.sigma.0)), unchecked, ..shown }
    }

    /// Result without its limit.
    #[inline(never)]
    fn shown(setting: &Setting, path: &Path, plain: &Plain, solution: &Solution) -> Self {
        let filter = &solution.filter;
        let end = End::of(path, solution);
        let row = end.row(path);
        let start_attitude = start_attitude(solution);
        let start = Azimuth {
            angle: azimuth_of(&start_attitude),
            sigma: Radians(libm::sqrt(filter.variance(&start_row(solution)))),
        };
        let sigma = libm::sqrt(filter.variance(&row));
        let variance = |axis: usize| filter.covariance[BIAS + axis][BIAS + axis];
        let bias_sigmas: [RadiansPerSecond; 3] =
            core::array::from_fn(|axis| RadiansPerSecond(libm::sqrt(variance(axis))));
        let known = setting.bias_sigma();
        Self {
            azimuth: Azimuth { angle: azimuth_of(&end.attitude), sigma: Radians(sigma) },
            start,
            start_attitude,
            limit: Radians(0.0),
            unchecked: Radians(0.0),
            budget: budget(setting, path, &filter.covariances(&row), sigma, solution.widening),
            level: level_of(&end.attitude),
            biases: core::array::from_fn(|axis| RadiansPerSecond(filter.state[BIAS + axis])),
            bias_sigmas,
            are_biases_observed: bias_sigmas.iter().all(|sigma| sigma.0 <= OBSERVED * known.0),
            widening: solution.widening,
            plain: *plain,
            tally: solution.tally,
            blocks: path.blocks.list.len() as u32,
        }
    }
}

/// Cramér–Rao bound of the azimuth at the end, after a run with nothing but the stated noise.
fn limit(path: &Path, solution: &Solution) -> Radians {
    Radians(libm::sqrt(solution.filter.variance(&End::of(path, solution).row(path))))
}

/// That bound about the estimates of a solution, with the prior 1σ of the biases as stated: about estimates that are
/// far from them σ could be below it.
#[inline(never)]
fn limit_anew(setting: &Setting, path: &Path, mut solution: Solution) -> Radians {
    solution.widening = 1.0;
    solution.run(setting, path, Belief::Ideal);
    limit(path, &solution)
}

/// Attitude and place at the end of the path.
struct End {
    /// Rotation from body axes to north, east, down.
    attitude: Matrix,
    /// Rotation from the start frame to north, east, down.
    navigation: Matrix,
    /// Direction of body x on the start frame.
    forward: Vector,
}

impl End {
    fn of(path: &Path, solution: &Solution) -> Self {
        let last = path.stops.len().saturating_sub(1);
        let [north, east] = path.displaced(last);
        let [farther_north, farther_east, ..] = solution.filter.three(PLACE);
        let displaced = [north + farther_north, east + farther_east];
        let there = path.place.navigation(path.now - path.start, displaced);
        let navigation = product(&transposed(&there), &transposed(&solution.frame));
        let error = solution.filter.three(NOW);
        let carried = product(&solution.drift.back, &path.carried.attitude.matrix());
        let body = product(&without(&error), &carried);
        let forward = transposed(&body)[0];
        Self { attitude: product(&navigation, &body), navigation, forward }
    }

    /// Derivatives of the azimuth at the end with respect to the states: the rotation φ now, and
    /// the displacement east.
    fn row(&self, path: &Path) -> Row {
        let mut row = placed(NOW, &gradient(&self.navigation, &self.forward));
        row[PLACE + 1] = path.place.convergence();
        row
    }
}

/// Rotation that removes a small error φ.
fn without(error: &Vector) -> Matrix {
    let columns = IDENTITY.map(|axis| difference(&axis, &cross(error, &axis)));
    transposed(&columns)
}

/// Attitude at the start: rotation from body axes to north, east, down.
fn start_attitude(solution: &Solution) -> Matrix {
    product(&transposed(&solution.frame), &without(&solution.filter.three(START)))
}

/// Derivatives of the azimuth at the start with respect to the states.
fn start_row(solution: &Solution) -> Row {
    placed(START, &gradient(&transposed(&solution.frame), &IDENTITY[0]))
}

/// Derivative of the azimuth of an axis, given on the start frame, with respect to an error φ of
/// that frame.
fn gradient(navigation: &Matrix, axis: &Vector) -> Vector {
    let forward = crate::math::rotation::turned(navigation, axis);
    let square = forward[0] * forward[0] + forward[1] * forward[1];
    IDENTITY.map(|about| {
        let moved = crate::math::rotation::turned(navigation, &cross(axis, &about));
        (forward[0] * moved[1] - forward[1] * moved[0]) / square
    })
}

/// Azimuth of body x for an attitude, [0, 2π).
fn azimuth_of(attitude: &Matrix) -> Radians {
    Radians(wrapped(libm::atan2(attitude[1][0], attitude[0][0])))
}

/// Pitch and roll for an attitude.
fn level_of(attitude: &Matrix) -> [Radians; 2] {
    let [x, y, z] = attitude[2];
    [Radians(libm::atan2(-x, libm::hypot(y, z))), Radians(libm::atan2(y, z))]
}

/// Contributions to σ: each group of states with prior knowledge contributes (covariance with the
/// azimuth)² over its prior variance; the rest is noise. The squares add up to σ².
fn budget(setting: &Setting, path: &Path, covariances: &Row, sigma: f64, widening: f64) -> Budget {
    let part = |states: core::ops::Range<usize>, sigma: f64| {
        let together = length(&core::array::from_fn(|axis| {
            states.clone().nth(axis).map_or(0.0, |state| covariances[state])
        }));
        Radians(if sigma > 0.0 { together / sigma } else { 0.0 })
    };
    let site = &setting.site;
    let displacement = libm::hypot(path.displacement_sigma(setting), path.left_sigma(setting));
    let mut budget = Budget {
        drift: part(BIAS..BIAS + 3, widening * setting.bias_sigma().0),
        scale: part(SCALE..SCALE + 3, site.scale_sigma),
        accelerometer: part(FORCE..FORCE + 3, site.accelerometer_bias_sigma.0),
        latitude: part(LATITUDE..LATITUDE + 1, site.latitude_sigma.0),
        displacement: part(PLACE..PLACE + 2, displacement),
        ..Budget::default()
    };
    let beside = budget.beside_noise().0;
    budget.noise = Radians(libm::sqrt((sigma * sigma - beside * beside).max(0.0)));
    budget
}
