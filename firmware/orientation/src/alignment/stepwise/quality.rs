//! Detection of disturbed dwells, each checked by itself before any azimuth is known.
//!
//! A shock shows in the scatter of a dwell's blocks, a nudge as a step of any length inside it, a
//! slow push as a slope that the other dwells do not share. All are compared with the gyro's noise;
//! where that is unknown, with the median of the dwells.

use super::CAPACITY;
use super::setting::Setting;
use super::tilt::Tilt;
use crate::math::rotation::length;
use crate::math::{chi_square_tail, median};
use crate::signal::blocks::BlockStatistics;
use crate::signal::rest::{Criteria, Sensors};
use crate::signal::{Dwell, SampleFault, SwayNoise};
use crate::units::{
    DegreesPerHour, ForceNoise, MetresPerSecondSquared, RadiansPerRootSecond, RadiansPerSecond,
    Seconds,
};
use crate::words::Rounded;

/// Reason for which a dwell is excluded from the fit. Numbers are in units of the expected standard
/// deviation unless stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Disturbance {
    /// The samples were faulty.
    Samples(SampleFault),
    /// The block means scatter more than the noise: factor of the variance.
    NonStationary(f64),
    /// The rate stepped, or was offset for a part of the dwell.
    Step(f64),
    /// The rate drifted unlike that of the other dwells.
    Drift(f64),
    /// The accelerometer reading stood out: the platform moved.
    Moved(f64),
    /// The vehicle drove or turned: deviation of the gyro's rate beyond rest, °/h (Kryt1), and of
    /// the force from gravity, m/s² (Kryt2; Szymanowski 2003).
    Driving(DegreesPerHour, MetresPerSecondSquared),
    /// The mean rate does not fit the other dwells: studentised residual.
    Outlier(f64),
}

crate::words! { Disturbance:
    Self::Samples(SampleFault::Saturated) => "gyro saturated";
    Self::Samples(SampleFault::Stuck) => "gyro stuck: every sample the same";
    Self::Samples(SampleFault::Missing) => "samples missing";
    Self::NonStationary(x) => "not quiet: {} times the noise power", Rounded::<1>(x);
    Self::Step(x) => "stepped by {} σ within the dwell", Rounded::<1>(x);
    Self::Drift(x) => "drifted by {} σ within the dwell", Rounded::<1>(x);
    Self::Moved(x) => "platform moved by {} σ", Rounded::<1>(x);
    Self::Driving(rate, force) =>
        "the vehicle does not stand: {} °/h beyond the Earth rate, {} m/s² from gravity",
        Rounded::<1>(rate.0), Rounded::<3>(force.0);
    Self::Outlier(x) => "residual of {} σ", Rounded::<1>(x);
}

/// Probability with which the scatter test rejects a sound dwell.
const SCATTER_PROBABILITY: f64 = 1e-5;
/// Limit of the step scan, σ: it searches 120 intervals, so a sound dwell passes it with a
/// probability of about 1 − 5e-5.
const STEP_BOUND: f64 = 5.0;
/// Limit of the slope test, σ (7e-6 two-sided).
const SLOPE_BOUND: f64 = 4.5;
/// Limit of the accelerometer's deviation from the tilt, in the usual scatter of the dwells. It is
/// wide because this scatter is itself estimated from few dwells.
const MOVED_BOUND: f64 = 12.0;
/// Least scatter that is assumed for an accelerometer, g: the limit is then 0.03° of tilt.
const LEAST_SCATTER: f64 = 5e-5;

/// Expected statistics of undisturbed dwells for this gyro.
#[derive(Clone, Copy, Debug)]
pub struct ExpectedScatter {
    /// White noise N², (rad/s)²·s.
    pub white: f64,
    /// Random walk K², (rad/s)²/s.
    walk: f64,
    /// Flicker B²/π, (rad/s)².
    flicker: f64,
    /// Noise that sway compensation leaves.
    sway: SwayNoise,
    /// Slope that the dwells share, rad/s².
    slope: f64,
    /// Variance of that slope, (rad/s²)².
    slope_variance: f64,
    /// Median rate of the dwells, rad/s, and median specific force, m/s².
    rate: f64,
    force: f64,
    /// Allowed drift of a rate from the median, rad/s, and of a force, m/s², 1σ.
    sensors: Sensors,
}

impl ExpectedScatter {
    /// Expected statistics from the configured noise and from the dwells so far.
    #[must_use]
    #[inline(never)]
    pub fn of(setting: &Setting, dwells: &[Dwell]) -> Self {
        let noise = setting.site.noise.model();
        let known = noise.angle_random_walk.0 * noise.angle_random_walk.0;
        let estimated = || white_median(dwells);
        let white = if setting.site.noise.is_white_known() { known } else { estimated() };
        Self {
            white,
            sway: setting.sway,
            slope_variance: white * slope_density(dwells),
            walk: noise.rate_random_walk.0 * noise.rate_random_walk.0,
            flicker: noise.bias_instability.0 * noise.bias_instability.0 / core::f64::consts::PI,
            slope: slope_median(dwells),
            rate: median_of(dwells.iter().map(|dwell| dwell.rate.0)),
            force: median_of(dwells.iter().filter_map(force_of)),
            sensors: sensors(setting, dwells, white),
        }
    }

    /// Disturbance of this dwell, if there is one. The tests are applied in the order: sample
    /// faults, scatter, step, drift, motion of the vehicle.
    #[must_use]
    pub fn disturbance(&self, dwell: &Dwell) -> Option<Disturbance> {
        if let Some(fault) = dwell.fault {
            return Some(Disturbance::Samples(fault));
        }
        let statistics = dwell.statistics.as_ref()?;
        if self.white <= 0.0 {
            return None;
        }
        self.non_stationary(statistics)
            .or_else(|| self.step(statistics))
            .or_else(|| self.drift(statistics))
            .or_else(|| self.driving(dwell))
    }

    /// Variance of one block mean about the dwell's line, (rad/s)²: white noise, and the part of
    /// the drift that a line does not follow.
    fn block_variance(&self, statistics: &BlockStatistics) -> f64 {
        let seconds = statistics.count() * statistics.block_seconds;
        self.own_variance(statistics) + self.walk * seconds / 15.0 + 2.0 * self.flicker
    }

    /// Variance of one block mean that is independent of others, (rad/s)²: white noise, and the
    /// remainder of sway compensation.
    fn own_variance(&self, statistics: &BlockStatistics) -> f64 {
        let seconds = statistics.block_seconds;
        self.white / seconds + self.sway.mean_variance(seconds)
    }

    /// White noise N² as the scatter inside the dwells shows it, (rad/s)²·s; equal to that of the
    /// gyro where they scatter as expected.
    pub(super) fn observed_white(&self, dwells: &[Dwell]) -> f64 {
        let (mut found, mut expected) = (0.0, 0.0);
        for statistics in statistics(dwells) {
            found += statistics.scatter;
            expected += (statistics.count() - 2.0) * self.block_variance(statistics);
        }
        if expected > 0.0 { self.white * found / expected } else { self.white }
    }

    /// Stop criteria (Szymanowski 2003) relative to the medians of the dwells, so that biases do
    /// not count as motion.
    fn driving(&self, dwell: &Dwell) -> Option<Disturbance> {
        if dwell.seconds.0 <= 0.0 {
            return None;
        }
        let force = force_of(dwell).unwrap_or(self.force);
        let criteria = Criteria::of_axis(dwell.rate.0 - self.rate, force, self.force);
        let limits = self.sensors.limits(dwell.seconds);
        let [rate, force] = [criteria.rate.degrees_per_hour(), criteria.force.0].map(f64::abs);
        let driving = Disturbance::Driving(DegreesPerHour(rate), MetresPerSecondSquared(force));
        (!criteria.is_rest(&limits)).then_some(driving)
    }

    /// Chi-square test of the block means' scatter.
    fn non_stationary(&self, statistics: &BlockStatistics) -> Option<Disturbance> {
        let degrees = statistics.count() - 2.0;
        let chi_square = statistics.scatter / self.block_variance(statistics);
        (chi_square_tail(chi_square, degrees) < SCATTER_PROBABILITY)
            .then_some(Disturbance::NonStationary(chi_square / degrees))
    }

    /// Test of the largest step.
    fn step(&self, statistics: &BlockStatistics) -> Option<Disturbance> {
        let step = statistics.largest_step / libm::sqrt(self.block_variance(statistics));
        (step > STEP_BOUND).then_some(Disturbance::Step(step))
    }

    /// Test of the slope. A random walk over T has a slope of variance 6K²/(5T); flicker one of
    /// about 6B²/(πT²).
    fn drift(&self, statistics: &BlockStatistics) -> Option<Disturbance> {
        let slope =
            (statistics.slope - self.slope).abs() / libm::sqrt(self.slope_variance(statistics));
        (slope > SLOPE_BOUND).then_some(Disturbance::Drift(slope))
    }

    /// Variance of a dwell's slope about the shared one, (rad/s²)².
    fn slope_variance(&self, statistics: &BlockStatistics) -> f64 {
        let seconds = statistics.count() * statistics.block_seconds;
        let unit = statistics.slope_unit();
        self.own_variance(statistics) * unit * unit
            + 1.2 * self.walk / seconds
            + 6.0 * self.flicker / (seconds * seconds)
            + self.slope_variance
    }
}

/// Sensor properties for the stop criteria: the gyro's noise, its possible drift, and the scatter
/// of the forces.
fn sensors(setting: &Setting, dwells: &[Dwell], white: f64) -> Sensors {
    let noise = setting.site.noise.model();
    let time = |time: Option<Seconds>| time.unwrap_or_default().0;
    let seconds = time(dwells.last().map(Dwell::end)) - time(dwells.first().map(Dwell::start));
    let walk = noise.rate_random_walk.0 * libm::sqrt(seconds);
    let drift = libm::hypot(walk, noise.rate_ramp.0 * seconds);
    let usual = median_of(dwells.iter().filter_map(force_of));
    let deviations = dwells.iter().filter_map(force_of).map(|force| (force - usual).abs());
    let bias = libm::hypot(drift, noise.bias_instability.0);
    let sway = libm::sqrt(setting.sway.mean_variance(1.0));
    Sensors {
        angle_random_walk: RadiansPerRootSecond(libm::sqrt(white)),
        bias_sigma: RadiansPerSecond(bias + sway),
        force_noise: ForceNoise(0.0),
        // The median of absolute deviations is 0.67 of their σ.
        force_bias_sigma: MetresPerSecondSquared(1.5 * median_of(deviations)),
    }
}

/// Magnitude of a dwell's mean specific force, m/s².
fn force_of(dwell: &Dwell) -> Option<f64> {
    dwell.force.map(|[x, y, z]| length(&[x.0, y.0, z.0]))
}

/// Median of one value for each dwell.
pub(super) fn median_of(values: impl Iterator<Item = f64>) -> f64 {
    median(&mut values.take(CAPACITY).collect::<heapless::Vec<f64, CAPACITY>>())
}

/// Marks the dwells whose accelerometer reading does not fit the tilt of the others.
///
/// The usual scatter comes from the differences of successive dwells, which a platform that moves
/// once affects at one place only, however many dwells stand on either side.
#[inline(never)]
pub(crate) fn moved(
    setting: &Setting,
    dwells: &[Dwell],
    tilt: &Tilt,
    mark: &mut [Option<Disturbance>],
) {
    let deviations: heapless::Vec<[f64; 2], CAPACITY> =
        dwells.iter().map(|dwell| off_level(setting, dwell, tilt)).collect();
    let mut steps: heapless::Vec<f64, CAPACITY> = deviations
        .windows(2)
        .map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]))
        .collect();
    let usual = (median(&mut steps) * core::f64::consts::FRAC_1_SQRT_2).max(LEAST_SCATTER);
    for (mark, [x, y]) in mark.iter_mut().zip(deviations) {
        let deviation = libm::hypot(x, y) / usual;
        if mark.is_none() && deviation > MOVED_BOUND {
            *mark = Some(Disturbance::Moved(deviation));
        }
    }
}

/// Least number of dwells that determine a lag of the gyro.
const LAGGING_DWELLS: i32 = 4;
/// Significance, σ, at which a lag is accepted: more than one dwell alone may show.
const LAG_BOUND: f64 = 5.0;
/// Part of a slope that a lag may leave unexplained.
const LAG_CURVE: f64 = 0.3;

/// Lag of the gyro behind the stage, s, from the dwells whose platform stood; `None` where it may
/// be chance.
///
/// A gyro that lags by τ, or whose column is late by τ, brings into each dwell of length T a part
/// of the one before: its mean moves by Δ·τ/T for a difference Δ of both rates, and its slope by −6
/// Δ τ/T², in addition to the slope that all dwells share. A gyro that is late by almost a dwell
/// and the rotation to it brings the previous dwell as a whole, and a part of the dwell's own rate
/// at the end. A shock to one dwell must neither show as a lag nor hide one: each dwell's slope is
/// clamped, and both all dwells and the undisturbed ones are tried; without clamping only where all
/// agree.
#[inline(never)]
pub(super) fn lag(
    norm: &ExpectedScatter,
    dwells: &[Dwell],
    marks: &[Option<Disturbance>],
) -> Option<f64> {
    let stood = |mark: &Disturbance| !is_moved(mark);
    let slopes = |is_asked, other| slopes(norm, dwells, marks, is_asked, other);
    let of = |is_asked, bound, other| Lag::of(slopes(is_asked, other), bound).believed();
    let agreed = || {
        let lag = Lag::of(slopes(stood, Other::Before), f64::INFINITY);
        let is_agreed = slopes(stood, Other::Before).all(|slope| lag.explains(slope));
        lag.believed().filter(|_| is_agreed)
    };
    let whole = || {
        let early = of(stood, SLOPE_BOUND, Other::After)?;
        let spacing = dwells.windows(2).map(|pair| pair[1].start().0 - pair[0].start().0);
        Some(median_of(spacing) - early)
    };
    of(stood, SLOPE_BOUND, Other::Before)
        .or_else(|| of(|_| false, SLOPE_BOUND, Other::Before))
        .or_else(agreed)
        .or_else(whole)
}

/// Neighbouring dwell whose rate shows in a dwell beside its own.
#[derive(Clone, Copy)]
enum Other {
    /// The rate of the dwell before shows at the beginning.
    Before,
    /// The rate of the dwell after shows at the end.
    After,
}

/// Regression of measured slopes on those that a lag of one second makes: sums about their means.
#[derive(Default)]
struct Lag {
    /// Number of dwells.
    count: i32,
    /// Mean of the expected slopes.
    expected: f64,
    /// Mean of the measured slopes.
    found: f64,
    /// Sum of squares of the expected slopes.
    power: f64,
    /// Sum of products of expected and measured slopes.
    shared: f64,
    /// Sum of squares of the measured slopes.
    total: f64,
}

impl Lag {
    /// Regression of pairs expected and measured, both in σ, with the measured ones clamped to
    /// `bound`.
    #[inline(never)]
    fn of(slopes: impl Iterator<Item = [f64; 2]>, bound: f64) -> Self {
        let mut lag = Self::default();
        for [expected, found] in slopes {
            // Not by `clamp`, which panics at a bound that is no number, and prints it: 15 KB of flash.
            let found = found.max(-bound).min(bound);
            lag.count += 1;
            let [x, y] = [expected - lag.expected, found - lag.found];
            lag.expected += x / f64::from(lag.count);
            lag.found += y / f64::from(lag.count);
            let later = expected - lag.expected;
            lag.power += x * later;
            lag.shared += y * later;
            lag.total += y * (found - lag.found);
        }
        lag
    }

    /// Estimated lag, s.
    fn seconds(&self) -> f64 {
        self.shared / self.power
    }

    /// Estimated lag, s, if it is significant.
    fn believed(&self) -> Option<f64> {
        if self.count < LAGGING_DWELLS {
            return None;
        }
        // A drift that no configuration states also makes slopes, so the significance is weighted
        // by the residual of the fit.
        let left = self.total - self.shared * self.seconds();
        let left = (left / f64::from(self.count - 2)).max(1.0);
        (self.shared > LAG_BOUND * libm::sqrt(self.power * left)).then(|| self.seconds())
    }

    /// Whether the lag explains a slope; of a long lag only the greater part, because the rate
    /// within the dwell is then a curve.
    fn explains(&self, [expected, found]: [f64; 2]) -> bool {
        let explained = self.seconds() * (expected - self.expected);
        (found - self.found - explained).abs() <= SLOPE_BOUND + LAG_CURVE * explained.abs()
    }
}

/// Pairs of the slope that one second of lag makes and the measured slope, in σ, for each dwell
/// beside another whose disturbance, if any, is admitted by `is_asked`.
fn slopes<'a>(
    norm: &'a ExpectedScatter,
    dwells: &'a [Dwell],
    marks: &'a [Option<Disturbance>],
    is_asked: fn(&Disturbance) -> bool,
    other: Other,
) -> impl Iterator<Item = [f64; 2]> + 'a {
    dwells.windows(2).zip(marks.windows(2)).filter_map(move |(pair, marks)| {
        let dwell = match other {
            Other::Before => &pair[1],
            Other::After => &pair[0],
        };
        let statistics = dwell.statistics.as_ref()?;
        let sigma = libm::sqrt(norm.slope_variance(statistics));
        if sigma <= 0.0 || !marks.iter().flatten().all(is_asked) {
            return None;
        }
        let per_second =
            6.0 * (pair[1].rate.0 - pair[0].rate.0) / (dwell.seconds.0 * dwell.seconds.0);
        Some([per_second / sigma, (statistics.slope - norm.slope) / sigma])
    })
}

/// Whether the samples of a dwell were faulty, or its platform or vehicle moved.
fn is_moved(mark: &Disturbance) -> bool {
    use Disturbance::{Driving, Moved, Samples};
    matches!(mark, Samples(_) | Moved(_) | Driving(..))
}

/// Deviation of a dwell's mean force from that of the tilt and the biases, g.
fn off_level(setting: &Setting, dwell: &Dwell, tilt: &Tilt) -> [f64; 2] {
    let Some(force) = dwell.force else { return [0.0; 2] };
    let gravity = setting.site.latitude.gravity().0;
    let expected = tilt.at(dwell.middle.0).force(setting.mount.accelerometer_turn(dwell));
    let bias = tilt.bias_at(dwell.middle.0);
    [0, 1].map(|i| force[i].0 / gravity - expected[i] - bias[i])
}

/// Statistics of the dwells that have them.
pub(super) fn statistics(dwells: &[Dwell]) -> impl Iterator<Item = &BlockStatistics> {
    dwells.iter().filter_map(|dwell| dwell.statistics.as_ref())
}

/// Noise power N² from the median of the dwells' own scatter, (rad/s)²·s; with fewer than three
/// dwells from their neighbouring blocks, to which a slow disturbance contributes little.
fn white_median(dwells: &[Dwell]) -> f64 {
    let few = dwells.len() < 3;
    let estimate = |statistics: &BlockStatistics| {
        let blocks = statistics.count();
        let variance = if few {
            statistics.neighbour_squares / (2.0 * (blocks - 1.0))
        } else {
            statistics.scatter / (blocks - 2.0)
        };
        variance * statistics.block_seconds
    };
    median_of(statistics(dwells).map(estimate))
}

/// Variance of the shared slope for white noise of density one: the median of n values has π/2
/// times the variance of their mean.
fn slope_density(dwells: &[Dwell]) -> f64 {
    let density = |statistics: &BlockStatistics| {
        statistics.slope_unit() * statistics.slope_unit() / statistics.block_seconds
    };
    let count = statistics(dwells).count();
    if count < 3 {
        return 0.0;
    }
    core::f64::consts::FRAC_PI_2 / count as f64 * median_of(statistics(dwells).map(density))
}

/// Slope that the dwells share, rad/s²; zero with fewer than three dwells.
fn slope_median(dwells: &[Dwell]) -> f64 {
    let is_shared = statistics(dwells).count() >= 3;
    if is_shared { median_of(statistics(dwells).map(|one| one.slope)) } else { 0.0 }
}
