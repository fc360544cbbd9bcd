//! Average of one dwell: the rate is filtered, integrated, and checked for disturbances.
//!
//! The filter starts at each arrival as if the first sample x₀ had stood for ever, so nothing of
//! the previous position and of the rotation can smear into this one. The mean of its output over
//! n samples is then x₀ + Σ wⱼ(xⱼ − x₀), with wⱼ the step response at the time that is left; as
//! W = Σ wⱼ is known from the design, dividing by W/n gives an unbiased mean in which x₀ cancels.
//! Nothing is discarded: the taper costs the variance factor n Σ wⱼ²/W². For a dwell longer than
//! the filter's settling W = n − D and Σ wⱼ² = n − 2D + E, with D the lag and E the lag power.

use super::Sample;
use super::blocks::{BlockStatistics, Blocks};
use crate::filter::{Coefficients, Filter};
use crate::units::{
    Angle, AngularRate, Instant, MetresPerSecondSquared, Optional, RadiansPerSecond, Seconds,
};

/// Result of one dwell (a standstill of the stage), whether averaged here or read from a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dwell {
    /// Encoder angle: heading of the sensitive axis in the base plane.
    pub stage: Angle,
    /// Mean elevation of the sensitive axis above the base plane, rad, up positive; zero where it lies
    /// in that plane. In single precision, which takes no room: 0.3° is kept to 10⁻⁴″.
    pub elevation: f32,
    /// Middle of the averaged time. (The taper's own middle lies half its lag earlier, in every
    /// dwell alike, so this offset does not affect the azimuth.)
    pub middle: Seconds,
    /// Length of the averaged time.
    pub seconds: Seconds,
    /// Number of samples averaged; zero where it is unknown.
    pub samples: u32,
    /// Mean rate about the sensitive axis.
    pub rate: RadiansPerSecond,
    /// Variance of the mean for white noise over that of a plain average of all samples, ≥ 1.
    pub taper: f64,
    /// Variance of the mean as configured by its source, (rad/s)²; none where it follows from the
    /// noise model.
    pub stated_variance: Optional,
    /// Block statistics; none with too few samples for four blocks.
    pub statistics: Option<BlockStatistics>,
    /// Mean specific force on the accelerometer's axes; none where it was not measured.
    pub force: Option<[MetresPerSecondSquared; 3]>,
    /// Mean temperature, °C; none where it was not measured.
    pub temperature: Optional,
    /// Fault found in the samples; none where they are sound.
    pub fault: Option<SampleFault>,
}

impl Dwell {
    /// Beginning of the averaged time.
    pub fn start(&self) -> Seconds {
        Seconds(self.middle.0 - 0.5 * self.seconds.0)
    }

    /// End of the averaged time.
    pub fn end(&self) -> Seconds {
        Seconds(self.middle.0 + 0.5 * self.seconds.0)
    }
}

/// Fault found in the samples of a dwell, in the order in which it is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleFault {
    /// A rate stood at the limit of its range.
    Saturated,
    /// Every rate was identical: the gyro or its bus is stuck.
    Stuck,
    /// Samples were missing: the time stamps have a gap of more than 3.5 sample periods.
    Missing,
}

/// Means of quantities that arrive together and only with some samples, kept as integer sums. The
/// first values are subtracted at the end, so that the means keep their last bits.
#[derive(Clone, Copy, Debug)]
struct Means<const N: usize> {
    /// First values, subtracted before the division.
    origins: [i32; N],
    /// Sums of all values.
    sums: [i64; N],
    /// Number of values.
    count: u32,
}

impl<const N: usize> Means<N> {
    /// Means of no values yet.
    const EMPTY: Self = Self { origins: [0; N], sums: [0; N], count: 0 };

    /// Adds one set of values.
    fn push(&mut self, values: [i32; N]) {
        if self.count == 0 {
            self.origins = values;
        }
        self.count += 1;
        for (sum, value) in self.sums.iter_mut().zip(&values) {
            *sum += i64::from(*value);
        }
    }

    /// The means in units of `lsb`; `None` before the first value.
    fn get(&self, lsb: f64) -> Option<[f64; N]> {
        let count = i64::from(self.count);
        let mean = |index: usize| {
            let origin = self.origins[index];
            let deviations = self.sums[index] - i64::from(origin) * count;
            (f64::from(origin) + deviations as f64 / count as f64) * lsb
        };
        (count > 0).then(|| core::array::from_fn(mean))
    }
}

/// One step of a [`SpecificForce`](crate::units::SpecificForce), m/s².
const FORCE_STEP: f64 = 1e-6;

/// Longest time without a sample that a dwell tolerates, in sample periods: two samples in a row
/// may be lost.
const LONGEST_GAP: f64 = 3.5;

/// Longest step of the time stamps over the mean step up to which no sample counts as missing.
const REGULAR: f64 = 1.5;

/// Fewest samples of a dwell: four times the filter's lag, and at least eight.
pub(crate) fn shortest<const SECTIONS: usize>(coefficients: &Coefficients<SECTIONS>) -> u32 {
    (libm::ceil(4.0 * coefficients.lag) as u32).max(8)
}

/// Running average of a dwell in progress. The work per sample is one integer filter update and a
/// few additions; everything in floating point waits for [`DwellAverage::finish`].
#[derive(Clone, Debug)]
pub struct DwellAverage<const SECTIONS: usize> {
    /// Time of the first sample.
    first: Instant,
    /// Time of the latest sample.
    last: Instant,
    /// Stage angle of the first sample, from which the mean angle is counted.
    anchor: Angle,
    /// Raw rate of the first sample.
    origin: AngularRate,
    /// Sum of the filtered rates, nrad/s; the origin is subtracted at the end.
    filtered: i64,
    /// Low-pass filter, started at rest at the first sample.
    filter: Filter<SECTIONS>,
    /// Union of all bits ever set in the raw rate's deviation from the first sample: zero while
    /// every rate is identical.
    changes: i32,
    /// Block sums of the raw rate, for the stationarity statistics.
    blocks: Blocks,
    /// Sum of the deviations of the stage angle from the anchor, in steps of an [`Angle`].
    stage: i64,
    /// Means of the specific force and, together with it, of the elevation.
    force: Means<4>,
    /// Mean of the temperature, m°C.
    temperature: Means<1>,
    /// Whether a rate stood at a limit of its range.
    saturated: bool,
    /// Longest step of the time stamps, µs.
    longest_gap: u64,
}

impl<const SECTIONS: usize> DwellAverage<SECTIONS> {
    /// Begins with the first sample of a standstill, which is included in the average.
    #[must_use]
    pub fn begin(coefficients: &Coefficients<SECTIONS>, sample: &Sample) -> Self {
        let mut average = Self {
            first: sample.time,
            last: sample.time,
            anchor: sample.stage,
            origin: sample.rate,
            filtered: 0,
            filter: Filter::at_rest(sample.rate),
            changes: 0,
            blocks: Blocks::default(),
            stage: 0,
            force: Means::EMPTY,
            temperature: Means::EMPTY,
            saturated: false,
            longest_gap: 0,
        };
        average.push(coefficients, sample);
        average
    }

    /// Adds a sample of the same standstill.
    ///
    /// The filter comes last: it needs all registers, and by then the other values of the sample
    /// are no longer live.
    pub fn push(&mut self, coefficients: &Coefficients<SECTIONS>, sample: &Sample) {
        if sample.force.is_some() | sample.temperature.is_some() {
            self.push_slow(sample);
        }
        self.push_time(sample.time);
        self.stage += i64::from((sample.stage - self.anchor).0.cast_signed());
        self.push_raw(sample.rate);
        self.filtered += i64::from(self.filter.update(coefficients, sample.rate).0);
    }

    /// Takes the quantities that only some samples carry. An elevation is taken together with a
    /// force: a test of its own would cost every sample.
    #[cold]
    #[inline(never)]
    fn push_slow(&mut self, sample: &Sample) {
        if let Some([x, y, z]) = sample.force {
            let elevation = sample.elevation.unwrap_or_default();
            self.force.push([x.0, y.0, z.0, elevation.0.cast_signed()]);
        }
        if let Some(temperature) = sample.temperature {
            self.temperature.push([temperature.0]);
        }
    }

    /// Takes the raw rate for the checks, before the filter smooths it.
    #[inline]
    fn push_raw(&mut self, rate: AngularRate) {
        let deviation = rate.0.saturating_sub(self.origin.0);
        self.changes |= deviation;
        self.blocks.push(deviation);
        if rate.is_saturated() {
            self.saturate();
        }
    }

    /// Follows the longest step of the time stamps.
    #[inline]
    fn push_time(&mut self, time: Instant) {
        // The difference wraps where time ran backwards and then exceeds any gap.
        let gap = time.0.wrapping_sub(self.last.0);
        if gap > self.longest_gap {
            self.widen_gap(time);
        }
        self.last = time;
    }

    /// Stores a longer step; a step backwards in time is ignored.
    #[cold]
    #[inline(never)]
    fn widen_gap(&mut self, time: Instant) {
        if time > self.last {
            self.longest_gap = time.0 - self.last.0;
        }
    }

    /// Notes a saturated rate, out of the per-sample path.
    #[cold]
    #[inline(never)]
    fn saturate(&mut self) {
        self.saturated = true;
    }

    /// Whether a stage angle agrees with that of the first sample within `tolerance`.
    pub(crate) fn stands_at(&self, stage: Angle, tolerance: Angle) -> bool {
        (stage - self.anchor).0.cast_signed().unsigned_abs() <= tolerance.0
    }

    /// Number of samples so far.
    pub(crate) fn count(&self) -> u32 {
        self.blocks.count()
    }

    /// Mean step of the time stamps; `None` with fewer than two samples or with samples missing.
    pub(crate) fn step(&self) -> Option<Seconds> {
        let steps = f64::from(self.count().checked_sub(1).filter(|steps| *steps > 0)?);
        let step = (self.last.seconds() - self.first.seconds()) / steps;
        (self.longest_gap as f64 * 1e-6 <= REGULAR * step).then_some(Seconds(step))
    }

    /// Mean specific force so far; `None` while no sample brought one.
    pub(crate) fn force(&self) -> Option<[MetresPerSecondSquared; 3]> {
        let part = MetresPerSecondSquared;
        self.force.get(FORCE_STEP).map(|[x, y, z, _]| [part(x), part(y), part(z)])
    }

    /// Mean elevation so far, rad; zero while no sample brought one.
    fn elevation(&self) -> f32 {
        self.force.get(Angle::STEP).map_or(0.0, |[.., elevation]| elevation as f32)
    }

    /// The finished dwell, for a sample period in seconds; `None` while it is shorter than
    /// four times the filter's lag.
    #[must_use]
    pub fn finish(
        &self,
        coefficients: &Coefficients<SECTIONS>,
        sample_seconds: Seconds,
    ) -> Option<Dwell> {
        let samples = self.count();
        if samples < shortest(coefficients) {
            return None;
        }
        let count = f64::from(samples);
        let [weight, power] = coefficients.step_sums(samples);
        let offset = self.stage as f64 / count;
        Some(Dwell {
            stage: Angle(self.anchor.0.wrapping_add(libm::round(offset) as i32 as u32)),
            elevation: self.elevation(),
            middle: Seconds(0.5 * (self.first.seconds() + self.last.seconds())),
            seconds: Seconds(count * sample_seconds.0),
            samples: self.count(),
            rate: RadiansPerSecond((f64::from(self.origin.0) + self.deviation() / weight) * 1e-9),
            taper: power * count / (weight * weight),
            stated_variance: Optional::NONE,
            statistics: self.blocks.statistics(sample_seconds.0),
            force: self.force(),
            temperature: self.temperature.get(1e-3).map(|[temperature]| temperature).into(),
            fault: self.fault(sample_seconds),
        })
    }

    /// Sum of the filtered rates less the first raw rate times their number, nrad/s.
    fn deviation(&self) -> f64 {
        (self.filtered - i64::from(self.origin.0) * i64::from(self.count())) as f64
    }

    /// First fault found: saturation, then a stuck reading, then missing samples.
    fn fault(&self, sample_seconds: Seconds) -> Option<SampleFault> {
        if self.saturated {
            Some(SampleFault::Saturated)
        } else if self.changes == 0 {
            Some(SampleFault::Stuck)
        } else if self.longest_gap as f64 * 1e-6 > LONGEST_GAP * sample_seconds.0 {
            Some(SampleFault::Missing)
        } else {
            None
        }
    }
}
