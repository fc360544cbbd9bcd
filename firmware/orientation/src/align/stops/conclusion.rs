//! From what a vehicle's path left to a verdict: an azimuth with σ, or the reason why there is none.

use super::Setting;
use super::filter::{BIAS, FORCE, LATITUDE, PLACE, Row, SCALE, START};
use super::path::Path;
use super::place::Place;
use super::plain::Plain;
use super::solution::{Belief, Solution, now_row};
use super::stop::Stop;
use super::stop_detector::{Loss, Rests, StopDetector, WINDOW};
use crate::align::budget::Budget;
use crate::align::conclusion::Azimuth;
use crate::earth::EARTH_RATE;
use crate::error::{Refusal, Source};
use crate::math::chi_square_tail;
use crate::math::rotation::{
    IDENTITY, Matrix, Vector, cross, difference, length, product, transposed,
};
use crate::signal::rest::Criteria;
use crate::signal::strapdown::Carried;
use crate::units::{DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES, wrapped};

/// Least time at rest that makes a stop, s: as long as the criteria look.
const LEAST_REST: f64 = WINDOW as f64;
/// Least time between the middles of the first stop and the last, and least time of a rest that is all
/// there is, s: the Earth turns by a quarter of a degree.
const LEAST_SECONDS: f64 = 60.0;
/// Least length of a drive, s: a shorter one is none.
const LEAST_DRIVE: f64 = 1.0;
/// What the ratio of the Earth's turn may be off beyond five of its σ.
const RATIO_TOLERANCE: f64 = 0.01;
/// What is a difference and no chance, in σ.
const DIFFERENT: f64 = 5.0;
/// Least part of gravity along the body's down axis: no vehicle stands on its side.
const UPRIGHT: f64 = 0.5;
/// How far a body that sways may turn between both ends of a stop, rad: a degree and a bit.
const SWAY: f64 = 0.02;
/// Probability of healthy blocks' scatter below which they are refused.
const SCATTER_PROBABILITY: f64 = 1e-6;
/// How far the scatter that blocks are held to may be too small: it is taken from the same few blocks, and
/// sway is not white.
const UNSURE: f64 = 1.5;
/// How much more than on the body's axes the forces may change from second to second when they are turned
/// by what the gyros show, in power: where both have their axes and signs right, sway is taken off.
const DISAGREEMENT: f64 = 1.5;
/// How fast a vehicle that only stands may have turned from its beginning to its end beside the Earth, rad/s:
/// a fifth of the Earth rate.
const CARRIED: f64 = 0.2 * EARTH_RATE;
/// Correlation of neighbouring blocks that no noise has: something drifts that is not in the model.
const CORRELATED: f64 = 0.75;
/// Correlation of neighbouring blocks that sway makes which is quicker than they are long: longer ones feel it
/// less.
const SWAYS: f64 = -0.3;
/// Fewest blocks that may be joined in pairs.
const MANY: usize = 16;
/// Part of the blocks that may be left out.
const LEFT_OUT: u32 = 4;
/// Part of what was known of a bias beforehand below which it counts as observed.
const OBSERVED: f64 = 0.5;

/// All that stops told.
#[derive(Clone, Debug)]
pub struct Conclusion {
    /// The azimuth of body x at the end, or why there is none.
    pub verdict: Result<Azimuth, Refusal>,
    /// The rest, where there was something to solve; it counts only with the verdict.
    pub found: Option<Found>,
}

/// What was found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// Azimuth of body x at the end.
    pub azimuth: Azimuth,
    /// Azimuth of body x at the start.
    pub start: Azimuth,
    /// Least 1σ of the azimuth at the end that any estimator reaches with these columns, rad.
    pub limit: f64,
    /// Azimuth of body x at the end when nothing is checked or left out, rad: for campaigns.
    pub unchecked: f64,
    /// Where σ comes from.
    pub budget: Budget,
    /// Pitch and roll at the end, rad.
    pub level: [f64; 2],
    /// Biases of the gyros, rad/s.
    pub biases: Vector,
    /// Their 1σ, rad/s.
    pub bias_sigmas: Vector,
    /// Whether the stops tell all of them: their 1σ is half of what was known before, or less.
    pub are_biases_observed: bool,
    /// How many times greater than was known the biases are, and are taken to be; one where they are not.
    pub widening: f64,
    /// Szymanowski's own method.
    pub plain: Plain,
    /// Chi-square of the blocks, and its degrees of freedom.
    pub chi_square: [f64; 2],
    /// Correlation of neighbouring blocks.
    pub correlation: f64,
    /// Blocks left out, and of how many.
    pub left_out: [u32; 2],
    /// Stops at which the vehicle turned, whose rest rates are left out.
    pub turning: u32,
    /// Greatest rate at which it turned there beside the Earth, rad/s.
    pub turning_rate: f64,
    /// Drives that did not come to rest at their end, whose velocity is left out.
    pub unsteady: u32,
}

impl Conclusion {
    /// Judges what a stop detector has, solves, and decides.
    #[must_use]
    #[inline(never)]
    pub fn of(setting: &Setting, stop_detector: &mut StopDetector) -> Self {
        let now = stop_detector.now();
        if let Err(reason) = inspect(setting, stop_detector) {
            return Self { verdict: Err(reason), found: None };
        }
        let mut found = Found::of(setting, &path(setting, stop_detector, &now));
        while found.correlation < SWAYS && stop_detector.blocks().all().len() >= MANY {
            stop_detector.coarsen();
            found = Found::of(setting, &path(setting, stop_detector, &now));
        }
        Self {
            verdict: judge(setting, &found, stop_detector.stops().len() as u32)
                .map(|()| found.azimuth),
            found: Some(found),
        }
    }

    /// Of nothing but a reason.
    #[must_use]
    pub const fn refused(reason: Refusal) -> Self {
        Self { verdict: Err(reason), found: None }
    }
}

/// The path until now, when so much is carried.
fn path<'a>(setting: &Setting, stop_detector: &'a StopDetector, now: &(f64, Carried)) -> Path<'a> {
    Path {
        place: Place::new(setting.common.latitude),
        gravity: setting.common.latitude.gravity(),
        start: stop_detector.start(),
        stops: stop_detector.stops(),
        blocks: stop_detector.blocks(),
        drives: stop_detector.drives(),
        now: now.0,
        carried: now.1,
        stated_density: 0.5 * setting.force_noise * setting.force_noise,
    }
}

/// Whether there is something to solve.
fn inspect(setting: &Setting, stop_detector: &StopDetector) -> Result<(), Refusal> {
    match stop_detector.loss() {
        Some(Loss::Gap(at, seconds)) => return Err(Refusal::RotationMissing { at, seconds }),
        Some(Loss::Saturated(at)) => return Err(Refusal::RotationClipped { at }),
        None => {}
    }
    let stops = stop_detector.stops();
    let is_whole = *stop_detector.rests() == Rests::Whole;
    let seconds = stop_detector.fleeting();
    if seconds > 0.0 && stops.len() < 2 {
        return Err(Refusal::StopTooShort { stop: stops.len() + 1, seconds, least: LEAST_REST });
    }
    let [Some(first), Some(last)] = [stops.first(), stops.last()] else {
        return Err(Refusal::NoStop);
    };
    if !is_whole && stops.len() == 1 {
        return Err(Refusal::OneStop { from: first.from, to: first.to });
    }
    for (index, stop) in stops.iter().enumerate() {
        inspect_stop(setting, stop_detector, index, stop)?;
    }
    let driven = stops.windows(2).map(|pair| pair[1].from - pair[0].to);
    if let Some(seconds) = driven.into_iter().find(|seconds| *seconds < LEAST_DRIVE) {
        return Err(Refusal::DriveTooShort { seconds, least: LEAST_DRIVE });
    }
    let seconds = if is_whole { last.seconds() } else { last.middle() - first.middle() };
    if seconds < LEAST_SECONDS {
        return Err(Refusal::DriveTooShort { seconds, least: LEAST_SECONDS });
    }
    Ok(())
}

/// Whether a stop is long enough, and the vehicle stands there.
fn inspect_stop(
    setting: &Setting,
    stop_detector: &StopDetector,
    index: usize,
    stop: &Stop,
) -> Result<(), Refusal> {
    let rest: f64 = stop_detector.blocks().of(index).map(|block| f64::from(block.seconds)).sum();
    if rest < LEAST_REST {
        return Err(Refusal::StopTooShort { stop: index + 1, seconds: rest, least: LEAST_REST });
    }
    let gravity = setting.common.latitude.gravity();
    let ratio = -stop.force.mean()[2] / gravity;
    if ratio < UPRIGHT {
        return Err(Refusal::AccelerometerImplausible { ratio });
    }
    let mut limits = setting.sensors().limits(stop.seconds());
    limits.rate += SWAY / stop.seconds();
    let [rate, force] = [stop.turned.mean(), stop.force.mean()].map(|mean| length(&mean));
    let criteria = Criteria::of(rate, force, gravity);
    let ratio = stop.disagreement();
    if criteria.is_rest(&limits) {
        return if ratio <= DISAGREEMENT { Ok(()) } else { Err(Refusal::AxesDisagree { ratio }) };
    }
    let rate = criteria.rate.abs() / DEGREE_PER_HOUR;
    Err(Refusal::VehicleMoves { stop: index + 1, rate, force: criteria.force.abs() })
}

/// Whether what was left out contradicts what is left. A vehicle may be turned at a stop, and a drive may
/// end by rolling; but where most of them tell something else, it is the rest that is wrong.
fn agree(found: &Found, stops: u32) -> Result<(), Refusal> {
    let drives = stops.saturating_sub(1);
    // All there is of a vehicle that only stands: it may be trodden on, but not carried round.
    let is_carried = drives == 0 && found.turning_rate > CARRIED;
    if is_carried || drives > 0 && 2 * found.turning > stops {
        return Err(Refusal::EarthNotFelt { stops: found.turning, of: stops });
    }
    if drives > 0 && 2 * found.unsteady >= drives {
        return Err(Refusal::DrivesDisagree { drives: found.unsteady, of: drives });
    }
    Ok(())
}

/// Whether what was found can be believed.
fn judge(setting: &Setting, found: &Found, stops: u32) -> Result<(), Refusal> {
    agree(found, stops)?;
    let [left_out, blocks] = found.left_out;
    if left_out * LEFT_OUT > blocks {
        return Err(Refusal::RestDisturbed { disturbed: left_out, of: blocks });
    }
    let [chi_square, degrees] = found.chi_square;
    if chi_square_tail(chi_square / UNSURE, degrees) < SCATTER_PROBABILITY {
        return Err(Refusal::ResidualsNotWhite { ratio: chi_square / degrees });
    }
    let correlation = found.correlation;
    if correlation > CORRELATED {
        return Err(Refusal::ResidualsCorrelated { correlation });
    }
    let Plain { ratio, ratio_sigma: sigma, .. } = found.plain;
    if (ratio - 1.0).abs() > DIFFERENT * found.widening * sigma + RATIO_TOLERANCE {
        return Err(Refusal::EarthRateMismatch { ratio, sigma });
    }
    let required = setting.common.required_sigma;
    let sigma = found.azimuth.sigma;
    // A σ that is not a number is not met either.
    if sigma <= required {
        return Ok(());
    }
    let is_unknown = setting.bias_sigma.is_none() && !found.are_biases_observed;
    let source = if is_unknown { Source::Drift } else { found.budget.greatest().0 };
    Err(Refusal::BudgetNotMet { sigma: sigma * DEGREES, required: required * DEGREES, source })
}

impl Found {
    #[inline(never)]
    fn of(setting: &Setting, path: &Path) -> Self {
        let plain = Plain::of(setting, path);
        let mut solution = Solution::new(plain.frame);
        solution.run(setting, path, Belief::Ideal);
        // How sure the azimuth is hardly depends on where it points.
        let end = End::of(path, &solution);
        let limit = libm::sqrt(solution.filter.variance(&end.row(path)));
        let unchecked = azimuth_of(&end.attitude);
        solution.settle(setting, path);
        Self { limit, unchecked, ..Self::shown(setting, path, &plain, &solution) }
    }

    /// All but the limit.
    #[inline(never)]
    fn shown(setting: &Setting, path: &Path, plain: &Plain, solution: &Solution) -> Self {
        let filter = &solution.filter;
        let end = End::of(path, solution);
        let row = end.row(path);
        let start = Azimuth {
            angle: azimuth_of(&start_attitude(solution)),
            sigma: libm::sqrt(filter.variance(&start_row(solution))),
        };
        let sigma = libm::sqrt(filter.variance(&row));
        let bias_sigmas: Vector =
            core::array::from_fn(|axis| libm::sqrt(filter.covariance[BIAS + axis][BIAS + axis]));
        let known = setting.bias_sigma();
        Self {
            azimuth: Azimuth { angle: azimuth_of(&end.attitude), sigma },
            start,
            limit: 0.0,
            unchecked: 0.0,
            budget: budget(setting, path, &filter.covariances(&row), sigma, solution.widening),
            level: level_of(&end.attitude),
            biases: filter.three(BIAS),
            bias_sigmas,
            are_biases_observed: bias_sigmas.iter().all(|sigma| *sigma <= OBSERVED * known),
            widening: solution.widening,
            plain: *plain,
            chi_square: [solution.chi_square, solution.degrees],
            correlation: solution.correlation(),
            left_out: [solution.left_out, path.blocks.all().len() as u32],
            turning: solution.turning,
            turning_rate: solution.turning_rate,
            unsteady: solution.unsteady,
        }
    }
}

/// Attitude and place at the end.
struct End {
    /// From body axes to north, east, down.
    attitude: Matrix,
    /// From the start frame to north, east, down.
    navigation: Matrix,
    /// Body x on the start frame.
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
        let error = solution.filter.three(super::filter::NOW);
        let body = product(&without(&error), &path.carried.attitude.matrix());
        let forward = transposed(&body)[0];
        Self { attitude: product(&navigation, &body), navigation, forward }
    }

    /// How the azimuth at the end depends on the states: on φ now, and on how far east the vehicle is.
    fn row(&self, path: &Path) -> Row {
        let mut row = now_row(&gradient(&self.navigation, &self.forward));
        row[PLACE + 1] = path.place.convergence();
        row
    }
}

/// The rotation that takes a small error off.
fn without(error: &Vector) -> Matrix {
    let columns = IDENTITY.map(|axis| difference(&axis, &cross(error, &axis)));
    transposed(&columns)
}

/// From body axes to north, east, down at the start.
fn start_attitude(solution: &Solution) -> Matrix {
    product(&transposed(&solution.frame), &without(&solution.filter.three(START)))
}

fn start_row(solution: &Solution) -> Row {
    let mut row = [0.0; super::filter::STATES];
    let gradient = gradient(&transposed(&solution.frame), &IDENTITY[0]);
    row[START..START + 3].copy_from_slice(&gradient);
    row
}

/// How the azimuth of an axis, given on the start frame, falls with a rotation φ of that frame.
fn gradient(navigation: &Matrix, axis: &Vector) -> Vector {
    let forward = crate::math::rotation::turned(navigation, axis);
    let square = forward[0] * forward[0] + forward[1] * forward[1];
    IDENTITY.map(|about| {
        let moved = crate::math::rotation::turned(navigation, &cross(axis, &about));
        (forward[0] * moved[1] - forward[1] * moved[0]) / square
    })
}

fn azimuth_of(attitude: &Matrix) -> f64 {
    wrapped(libm::atan2(attitude[1][0], attitude[0][0]))
}

/// Pitch and roll, rad.
fn level_of(attitude: &Matrix) -> [f64; 2] {
    let [x, y, z] = attitude[2];
    [libm::atan2(-x, libm::hypot(y, z)), libm::atan2(y, z)]
}

/// The parts of σ: of what was known beforehand each keeps (covariance with the azimuth)² over its own
/// variance before; the rest is noise. Their squares add up.
fn budget(setting: &Setting, path: &Path, covariances: &Row, sigma: f64, widening: f64) -> Budget {
    let part = |states: core::ops::Range<usize>, sigma: f64| {
        let together = length(&core::array::from_fn(|axis| {
            states.clone().nth(axis).map_or(0.0, |state| covariances[state])
        }));
        if sigma > 0.0 { together / sigma } else { 0.0 }
    };
    let common = &setting.common;
    let mut budget = Budget {
        drift: part(BIAS..BIAS + 3, widening * setting.bias_sigma()),
        scale: part(SCALE..SCALE + 3, common.scale_sigma),
        accelerometer: part(FORCE..FORCE + 3, common.accelerometer_bias_sigma),
        latitude: part(LATITUDE..LATITUDE + 1, common.latitude_sigma),
        displacement: part(PLACE..PLACE + 2, path.displacement_sigma(setting)),
        ..Budget::default()
    };
    let beside = budget.beside_noise();
    budget.noise = libm::sqrt((sigma * sigma - beside * beside).max(0.0));
    budget
}
