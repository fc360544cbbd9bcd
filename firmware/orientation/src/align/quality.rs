//! Which dwells were disturbed: judged from inside each, before any azimuth is known.
//!
//! A kick shows in the scatter of a dwell's blocks, a nudge as a step of any length inside it, a
//! slow push as a slope that the other dwells do not share. All are measured against the gyro's
//! noise; where that is unknown, against the median of the dwells.

use super::setting::Setting;
use super::{CAPACITY, level};
use crate::math::rotation::length;
use crate::math::{chi_square_tail, median};
use crate::signal::blocks::BlockStatistics;
use crate::signal::dwell::{Dwell, SampleFault};
use crate::signal::rest::{Criteria, Sensors};
use crate::signal::sway::SwayNoise;
use crate::units::DEGREE_PER_HOUR;
use crate::words;
use crate::words::Rounded;

/// Why a dwell is left out of the fit. Numbers are in units of the expected standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Disturbance {
    /// Its samples were sick.
    Samples(SampleFault),
    /// Its blocks scatter more than the noise: factor of the variance.
    NonStationary(f64),
    /// Its rate stepped or was pushed for a while.
    Step(f64),
    /// Its rate drifted unlike that of the other dwells.
    Drift(f64),
    /// The accelerometer stood out: the platform moved.
    Moved(f64),
    /// The vehicle drove or turned: what Kryt1 of the gyro's axis, °/h, or Kryt2, m/s², lie beyond rest
    /// (Szymanowski's criteria).
    Driving(f64, f64),
    /// Its mean does not fit the others.
    Outlier(f64),
}

words! { Disturbance:
    Self::Samples(SampleFault::Saturated) => "gyro saturated";
    Self::Samples(SampleFault::Stuck) => "gyro stuck: every sample the same";
    Self::Samples(SampleFault::Missing) => "samples missing";
    Self::NonStationary(x) => "not quiet: {} times the noise power", Rounded::<1>(x);
    Self::Step(x) => "stepped by {} σ within the dwell", Rounded::<1>(x);
    Self::Drift(x) => "drifted by {} σ within the dwell", Rounded::<1>(x);
    Self::Moved(x) => "platform moved by {} σ", Rounded::<1>(x);
    Self::Driving(rate, force) =>
        "the vehicle does not stand: {} °/h beyond the Earth rate, {} m/s² from gravity",
        Rounded::<1>(rate), Rounded::<3>(force);
    Self::Outlier(x) => "residual of {} σ", Rounded::<1>(x);
}

/// Probability with which the scatter test rejects a healthy dwell.
const SCATTER_PROBABILITY: f64 = 1e-5;
/// Bound of the step scan, σ: it searches 120 intervals, so a healthy dwell passes it with a
/// probability of about 1 − 5e-5.
const STEP_BOUND: f64 = 5.0;
/// Bound of the slope test, σ (7e-6 two-sided).
const SLOPE_BOUND: f64 = 4.5;
/// Bound of the test of the accelerometer against the tilt, in the usual scatter of the dwells. Wide,
/// for this scatter is itself estimated from few dwells.
const MOVED_BOUND: f64 = 12.0;
/// Scatter that no accelerometer is held below, g: the bound is then 0.03° of tilt.
const LEAST_SCATTER: f64 = 5e-5;

/// What quiet dwells look like for this gyro.
#[derive(Clone, Copy, Debug)]
pub struct ExpectedScatter {
    /// White noise, (rad/s)²·s: N².
    white: f64,
    /// Random walk, (rad/s)²/s: K².
    walk: f64,
    /// Flicker, (rad/s)²: B²/π.
    flicker: f64,
    /// What a subtracted sway leaves.
    sway: SwayNoise,
    /// Slope that the dwells share, rad/s².
    slope: f64,
    /// Variance of that slope, (rad/s²)².
    slope_variance: f64,
    /// The dwells' usual rate, rad/s, and specific force, m/s².
    rate: f64,
    force: f64,
    /// 1σ of what a rate may have drifted from the usual one, rad/s, and a force, m/s².
    sensors: Sensors,
}

impl ExpectedScatter {
    /// From what is known of the gyro and from the dwells so far.
    #[must_use]
    #[inline(never)]
    pub fn of(setting: &Setting, dwells: &[Dwell]) -> Self {
        let noise = &setting.noise;
        let known = noise.angle_random_walk * noise.angle_random_walk;
        let estimated = || white_median(dwells);
        let white = if setting.white_known { known } else { estimated() };
        Self {
            white,
            sway: setting.sway,
            slope_variance: white * slope_density(dwells),
            walk: noise.rate_random_walk * noise.rate_random_walk,
            flicker: noise.bias_instability * noise.bias_instability / core::f64::consts::PI,
            slope: slope_median(dwells),
            rate: median_of(dwells.iter().map(|dwell| dwell.rate)),
            force: median_of(dwells.iter().filter_map(force_of)),
            sensors: sensors(setting, dwells, white),
        }
    }

    /// White noise of the gyro, N², (rad/s)²·s.
    #[must_use]
    pub fn white(&self) -> f64 {
        self.white
    }

    /// What disturbed this dwell, if anything did.
    #[must_use]
    pub fn disturbance(&self, dwell: &Dwell) -> Option<Disturbance> {
        if let Some(fault) = dwell.fault {
            return Some(Disturbance::Samples(fault));
        }
        let quietness = dwell.quietness.as_ref()?;
        if self.white <= 0.0 {
            return None;
        }
        self.unquiet(quietness)
            .or_else(|| self.step(quietness))
            .or_else(|| self.drift(quietness))
            .or_else(|| self.driving(dwell))
    }

    /// Variance of one block about the dwell's line: white noise, and what of the drift a line
    /// does not follow.
    fn block_variance(&self, quietness: &BlockStatistics) -> f64 {
        let seconds = quietness.count() * quietness.block_seconds;
        self.own_variance(quietness) + self.walk * seconds / 15.0 + 2.0 * self.flicker
    }

    /// Variance of one block that no other shares: white noise, and what a subtracted sway leaves.
    fn own_variance(&self, quietness: &BlockStatistics) -> f64 {
        let seconds = quietness.block_seconds;
        self.white / seconds + self.sway.mean_variance(seconds)
    }

    /// White noise as the scatter inside the dwells shows it, N², (rad/s)²·s: that of the gyro where
    /// they scatter as its noise says.
    #[must_use]
    pub fn observed_white(&self, dwells: &[Dwell]) -> f64 {
        let (mut found, mut expected) = (0.0, 0.0);
        for quietness in dwells.iter().filter_map(|dwell| dwell.quietness.as_ref()) {
            found += quietness.scatter;
            expected += (quietness.count() - 2.0) * self.block_variance(quietness);
        }
        if expected > 0.0 { self.white * found / expected } else { self.white }
    }

    /// Szymanowski's criteria, against what the dwells usually show: their biases are no motion.
    fn driving(&self, dwell: &Dwell) -> Option<Disturbance> {
        if dwell.seconds <= 0.0 {
            return None;
        }
        let force = force_of(dwell).unwrap_or(self.force);
        let criteria = Criteria::of_axis(dwell.rate - self.rate, force, self.force);
        let limits = self.sensors.limits(dwell.seconds);
        let [rate, force] = [criteria.rate / DEGREE_PER_HOUR, criteria.force].map(f64::abs);
        (!criteria.is_rest(&limits)).then_some(Disturbance::Driving(rate, force))
    }

    fn unquiet(&self, quietness: &BlockStatistics) -> Option<Disturbance> {
        let degrees = quietness.count() - 2.0;
        let chi_square = quietness.scatter / self.block_variance(quietness);
        (chi_square_tail(chi_square, degrees) < SCATTER_PROBABILITY)
            .then_some(Disturbance::NonStationary(chi_square / degrees))
    }

    fn step(&self, quietness: &BlockStatistics) -> Option<Disturbance> {
        let step = quietness.largest_step / libm::sqrt(self.block_variance(quietness));
        (step > STEP_BOUND).then_some(Disturbance::Step(step))
    }

    /// A random walk over T has a slope of variance 6K²/(5T); flicker one of about 6B²/(πT²).
    fn drift(&self, quietness: &BlockStatistics) -> Option<Disturbance> {
        let slope =
            (quietness.slope - self.slope).abs() / libm::sqrt(self.slope_variance(quietness));
        (slope > SLOPE_BOUND).then_some(Disturbance::Drift(slope))
    }

    /// Variance of a dwell's slope about that which they share, (rad/s²)².
    fn slope_variance(&self, quietness: &BlockStatistics) -> f64 {
        let seconds = quietness.count() * quietness.block_seconds;
        let unit = quietness.slope_unit();
        self.own_variance(quietness) * unit * unit
            + 1.2 * self.walk / seconds
            + 6.0 * self.flicker / (seconds * seconds)
            + self.slope_variance
    }
}

/// What the criteria are held to: the gyro's noise, what it may have drifted, how the forces scatter.
fn sensors(setting: &Setting, dwells: &[Dwell], white: f64) -> Sensors {
    let noise = &setting.noise;
    let seconds = dwells.last().map_or(0.0, Dwell::end) - dwells.first().map_or(0.0, Dwell::start);
    let walk = noise.rate_random_walk * libm::sqrt(seconds);
    let drift = libm::hypot(walk, noise.rate_ramp * seconds);
    let usual = median_of(dwells.iter().filter_map(force_of));
    let deviations = dwells.iter().filter_map(force_of).map(|force| (force - usual).abs());
    Sensors {
        angle_random_walk: libm::sqrt(white),
        bias_sigma: libm::hypot(drift, noise.bias_instability)
            + libm::sqrt(setting.sway.mean_variance(1.0)),
        force_noise: 0.0,
        // A median of deviations is 0.67 of their σ.
        force_bias_sigma: 1.5 * median_of(deviations),
    }
}

/// Size of a dwell's mean specific force, m/s².
fn force_of(dwell: &Dwell) -> Option<f64> {
    dwell.force.map(|force| length(&force))
}

/// The median of one value a dwell.
pub(super) fn median_of(values: impl Iterator<Item = f64>) -> f64 {
    median(&mut values.take(CAPACITY).collect::<heapless::Vec<f64, CAPACITY>>())
}

/// Marks the dwells whose accelerometer reading does not fit the tilt of the others.
///
/// What is usual comes from the differences of successive dwells, which a platform that moves once
/// leaves alone however many dwells stand on either side.
#[inline(never)]
pub fn moved(
    setting: &Setting,
    dwells: &[Dwell],
    tilt: &level::Tilt,
    mark: &mut [Option<Disturbance>],
) {
    let deviations: heapless::Vec<[f64; 2], CAPACITY> = dwells
        .iter()
        .map(|dwell| dwell.force.map_or([0.0; 2], |force| off_level(setting, dwell, force, tilt)))
        .collect();
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

/// How many dwells tell whether the gyro lags.
const LAGGING_DWELLS: i32 = 4;
/// Significance, σ, of a lag that is believed: more than one dwell may show.
const LAG_BOUND: f64 = 5.0;
/// Part of a slope that a lag may leave unexplained.
const LAG_CURVE: f64 = 0.3;

/// By how much the gyro follows the stage late, s, by the dwells whose platform stood; `None` where it
/// may be chance.
///
/// A gyro that lags by τ, or whose column is late by τ, brings into each dwell of T a part of the one before:
/// its mean moves by Δ·τ/T for a difference Δ of both rates, and its slope by −6 Δ τ/T², beside the slope that all
/// share. One that is late by almost a dwell and the way to it brings the one before as a whole, and a part of the
/// dwell's own rate at the end. A blow to one dwell shows no lag, nor may it hide one: what each dwell has is bounded,
/// and both all dwells and the quiet ones are asked; unbounded only where all agree.
#[must_use]
#[inline(never)]
pub fn lag(norm: &ExpectedScatter, dwells: &[Dwell], marks: &[Option<Disturbance>]) -> Option<f64> {
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
        let spacing = dwells.windows(2).map(|pair| pair[1].start() - pair[0].start());
        Some(median_of(spacing) - early)
    };
    of(stood, SLOPE_BOUND, Other::Before)
        .or_else(|| of(|_| false, SLOPE_BOUND, Other::Before))
        .or_else(agreed)
        .or_else(whole)
}

/// Whose rate shows in a dwell beside its own.
#[derive(Clone, Copy)]
enum Other {
    /// That of the dwell before, at its beginning.
    Before,
    /// That of the dwell after, at its end.
    After,
}

/// A straight line through slopes against those that a lag of one second makes: sums about their means.
#[derive(Default)]
struct Lag {
    count: i32,
    expected: f64,
    found: f64,
    power: f64,
    shared: f64,
    total: f64,
}

impl Lag {
    /// Of pairs expected and found, σ, of which what is found is bounded.
    #[inline(never)]
    fn of(slopes: impl Iterator<Item = [f64; 2]>, bound: f64) -> Self {
        let mut lag = Self::default();
        for [expected, found] in slopes {
            let found = found.clamp(-bound, bound);
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

    /// The lag, s.
    fn seconds(&self) -> f64 {
        self.shared / self.power
    }

    /// The lag, s, if it is no chance.
    fn believed(&self) -> Option<f64> {
        if self.count < LAGGING_DWELLS {
            return None;
        }
        // A drift that no key states makes slopes, too: they are weighed by what the lag leaves of them.
        let left = self.total - self.shared * self.seconds();
        let left = (left / f64::from(self.count - 2)).max(1.0);
        (self.shared > LAG_BOUND * libm::sqrt(self.power * left)).then(|| self.seconds())
    }

    /// Whether it explains a slope; of a long one only the greater part, for within the dwell it is a curve.
    fn explains(&self, [expected, found]: [f64; 2]) -> bool {
        let explained = self.seconds() * (expected - self.expected);
        (found - self.found - explained).abs() <= SLOPE_BOUND + LAG_CURVE * explained.abs()
    }
}

/// For each dwell beside another the slope that one second of the other's rate gives it, and that which it has, in σ:
/// of those whose disturbance, if there is one, may show the lag.
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
        let quietness = dwell.quietness.as_ref()?;
        let sigma = libm::sqrt(norm.slope_variance(quietness));
        if sigma <= 0.0 || !marks.iter().flatten().all(is_asked) {
            return None;
        }
        let per_second = 6.0 * (pair[1].rate - pair[0].rate) / (dwell.seconds * dwell.seconds);
        Some([per_second / sigma, (quietness.slope - norm.slope) / sigma])
    })
}

/// Whether a dwell's samples are sick, or its platform moved.
fn is_moved(mark: &Disturbance) -> bool {
    use Disturbance::{Driving, Moved, Samples};
    matches!(mark, Samples(_) | Moved(_) | Driving(..))
}

/// How a dwell's mean force differs from that of the tilt and the biases, g.
fn off_level(setting: &Setting, dwell: &Dwell, force: [f64; 3], tilt: &level::Tilt) -> [f64; 2] {
    let gravity = setting.latitude.gravity();
    let expected = tilt.at(dwell.middle).force(setting.mount.accelerometer_turn(dwell));
    let bias = tilt.bias_at(dwell.middle);
    [0, 1].map(|i| force[i] / gravity - expected[i] - bias[i])
}

/// N² from the median of the dwells' own scatter; from their neighbouring blocks, which a slow
/// disturbance leaves alone, while there are fewer than three dwells.
fn white_median(dwells: &[Dwell]) -> f64 {
    let few = dwells.len() < 3;
    let estimate = |quietness: &BlockStatistics| {
        let blocks = quietness.count();
        let variance = if few {
            quietness.neighbour_squares / (2.0 * (blocks - 1.0))
        } else {
            quietness.scatter / (blocks - 2.0)
        };
        variance * quietness.block_seconds
    };
    median_of(dwells.iter().filter_map(|dwell| dwell.quietness.as_ref().map(estimate)))
}

/// Variance of the shared slope for white noise of density one: a median of n values has π/2 of the
/// variance of their mean.
fn slope_density(dwells: &[Dwell]) -> f64 {
    let density = |quietness: &BlockStatistics| {
        quietness.slope_unit() * quietness.slope_unit() / quietness.block_seconds
    };
    let mut values: heapless::Vec<f64, CAPACITY> =
        dwells.iter().filter_map(|dwell| dwell.quietness.as_ref().map(density)).collect();
    if values.len() < 3 {
        return 0.0;
    }
    core::f64::consts::FRAC_PI_2 / values.len() as f64 * median(&mut values)
}

/// The slope that the dwells share; with fewer than three, none is known to be shared.
fn slope_median(dwells: &[Dwell]) -> f64 {
    let mut slopes: heapless::Vec<f64, CAPACITY> =
        dwells.iter().filter_map(|dwell| dwell.quietness.as_ref().map(|q| q.slope)).collect();
    if slopes.len() < 3 { 0.0 } else { median(&mut slopes) }
}
