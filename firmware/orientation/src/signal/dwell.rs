//! The average of one dwell: filter, integrate, and judge what went in.
//!
//! The filter starts at each arrival as if the first sample x₀ had stood for ever, so nothing of
//! the previous position and of the rotation can smear into this one. The mean of its output over
//! n samples is then x₀ + Σ wⱼ(xⱼ − x₀), with wⱼ the step response at the time that is left; as
//! W = Σ wⱼ is known from the design, dividing by W/n gives an unbiased mean in which x₀ cancels.
//! Nothing is discarded: the taper costs the variance factor n Σ wⱼ²/W². For a dwell longer than
//! the filter's settling W = n − D and Σ wⱼ² = n − 2D + E, with D the lag and E the lag power.

use super::Sample;
use super::blocks::{BlockStatistics, Blocks};
use super::butterworth::{Coefficients, Filter};
use crate::units::{Angle, AngularRate, Instant, Optional};

/// What one dwell leaves behind, whoever averaged it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dwell {
    /// Encoder angle: the heading of the sensitive axis in the base plane.
    pub stage: Angle,
    /// Mean elevation of the sensitive axis above the base plane, rad, up positive; zero where it lies
    /// in that plane. In single precision, which takes no room: 0.3° is kept to 10⁻⁴″.
    pub elevation: f32,
    /// Middle of the averaged time, s. (The taper's own middle lies half its lag earlier, in every
    /// dwell alike, so it is of no consequence.)
    pub middle: f64,
    /// Length of the averaged time, s.
    pub seconds: f64,
    /// Samples averaged; zero where that is not known.
    pub samples: u32,
    /// Mean rate about the sensitive axis, rad/s.
    pub rate: f64,
    /// White-noise variance of the mean over that of an average of all samples, ≥ 1.
    pub taper: f64,
    /// Variance of the mean as its source states it, (rad/s)².
    pub stated_variance: Optional,
    /// Block statistics, where there were samples enough.
    pub quietness: Option<BlockStatistics>,
    /// Mean specific force on the accelerometer's axes, m/s², where it was measured.
    pub force: Option<[f64; 3]>,
    /// Mean temperature, °C, where it was measured.
    pub temperature: Optional,
    /// What was wrong with samples.
    pub fault: Option<SampleFault>,
}

impl Dwell {
    /// When the averaged time began, s.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.middle - 0.5 * self.seconds
    }

    /// When the averaged time ended, s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.middle + 0.5 * self.seconds
    }
}

/// A sickness of the samples of a dwell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleFault {
    /// A rate stood at the limit of its range.
    Saturated,
    /// Every rate was the same: the gyro or its bus is stuck.
    Stuck,
    /// Samples were missing: the times have a gap.
    Missing,
}

/// Means of quantities that come together and with some samples only, as plain sums; the first
/// values are taken away at the end, so that the means keep their last bits.
#[derive(Clone, Copy, Debug)]
struct Means<const N: usize> {
    origins: [i32; N],
    sums: [i64; N],
    count: u32,
}

impl<const N: usize> Means<N> {
    /// Of nothing.
    const EMPTY: Self = Self { origins: [0; N], sums: [0; N], count: 0 };

    fn push(&mut self, values: [i32; N]) {
        if self.count == 0 {
            self.origins = values;
        }
        self.count += 1;
        for (sum, value) in self.sums.iter_mut().zip(&values) {
            *sum += i64::from(*value);
        }
    }

    /// The means in units of `lsb`; `None` of nothing.
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

/// Sample periods without a sample that a dwell bears: two samples in a row may be lost.
const LONGEST_GAP: f64 = 3.5;

/// Longest step over the mean one of samples none of which is missing.
const REGULAR: f64 = 1.5;

/// The fewest samples that make a dwell: four times the filter's lag, and eight.
#[must_use]
pub fn shortest<const SECTIONS: usize>(coefficients: &Coefficients<SECTIONS>) -> u32 {
    (libm::ceil(4.0 * coefficients.lag()) as u32).max(8)
}

/// The running average of a dwell in progress.
#[derive(Clone, Debug)]
pub struct DwellAverage<const SECTIONS: usize> {
    first: Instant,
    last: Instant,
    anchor: Angle,
    /// The raw rate of the first sample.
    origin: AngularRate,
    /// Sum of the filtered rates; the origin is taken away at the end.
    filtered: i64,
    filter: Filter<SECTIONS>,
    /// Every bit that was set in the raw rate's deviation from the first.
    changes: i32,
    blocks: Blocks,
    stage: i64,
    /// Specific force and, with it, the elevation.
    force: Means<4>,
    temperature: Means<1>,
    saturated: bool,
    longest_gap: u64,
}

impl<const SECTIONS: usize> DwellAverage<SECTIONS> {
    /// Begins at the first sample of a standstill, which counts.
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
    /// The filter comes last: it needs all registers, and what is needed before it is then done.
    pub fn push(&mut self, coefficients: &Coefficients<SECTIONS>, sample: &Sample) {
        if sample.force.is_some() | sample.temperature.is_some() {
            self.push_slow(sample);
        }
        self.push_time(sample.time);
        self.stage += i64::from((sample.stage - self.anchor).0.cast_signed());
        self.push_raw(sample.rate);
        self.filtered += i64::from(self.filter.update(coefficients, sample.rate).0);
    }

    /// Takes what only some samples bring. An elevation comes with a force: asking for it alone would
    /// cost every sample a test.
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

    /// Takes the rate as it came.
    #[inline]
    fn push_raw(&mut self, rate: AngularRate) {
        let deviation = rate.0.saturating_sub(self.origin.0);
        self.changes |= deviation;
        self.blocks.push(deviation);
        if rate.is_saturated() {
            self.saturate();
        }
    }

    #[inline]
    fn push_time(&mut self, time: Instant) {
        // Wraps where time ran backwards, to more than any gap.
        let gap = time.0.wrapping_sub(self.last.0);
        if gap > self.longest_gap {
            self.widen_gap(time);
        }
        self.last = time;
    }

    #[cold]
    #[inline(never)]
    fn widen_gap(&mut self, time: Instant) {
        if time > self.last {
            self.longest_gap = time.0 - self.last.0;
        }
    }

    #[cold]
    #[inline(never)]
    fn saturate(&mut self) {
        self.saturated = true;
    }

    /// Whether a stage angle is that of the first sample, within `tolerance`.
    #[must_use]
    pub fn stands_at(&self, stage: Angle, tolerance: Angle) -> bool {
        (stage - self.anchor).0.cast_signed().unsigned_abs() <= tolerance.0
    }

    /// Samples so far.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.blocks.count()
    }

    /// Mean step of the samples' times, s, where none is missing; `None` of fewer than two.
    #[must_use]
    pub fn step(&self) -> Option<f64> {
        let steps = f64::from(self.count().checked_sub(1).filter(|steps| *steps > 0)?);
        let step = (self.last.seconds() - self.first.seconds()) / steps;
        (self.longest_gap as f64 * 1e-6 <= REGULAR * step).then_some(step)
    }

    /// Mean specific force so far, m/s²; `None` while no sample brought one.
    #[must_use]
    pub fn force(&self) -> Option<[f64; 3]> {
        self.force.get(FORCE_STEP).map(|[x, y, z, _]| [x, y, z])
    }

    /// Mean elevation so far, rad; zero while no sample brought one.
    fn elevation(&self) -> f32 {
        self.force.get(Angle::STEP).map_or(0.0, |[.., elevation]| elevation as f32)
    }

    /// The dwell, for a sample period in seconds; `None` while it is shorter than [`shortest`].
    #[must_use]
    pub fn finish(
        &self,
        coefficients: &Coefficients<SECTIONS>,
        sample_seconds: f64,
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
            middle: 0.5 * (self.first.seconds() + self.last.seconds()),
            seconds: count * sample_seconds,
            samples: self.count(),
            rate: (f64::from(self.origin.0) + self.deviation() / weight) * 1e-9,
            taper: power * count / (weight * weight),
            stated_variance: Optional::NONE,
            quietness: self.blocks.quietness(sample_seconds),
            force: self.force(),
            temperature: self.temperature.get(1e-3).map(|[temperature]| temperature).into(),
            fault: self.fault(sample_seconds),
        })
    }

    /// Sum of the filtered rates' deviations from the first raw one, nrad/s.
    fn deviation(&self) -> f64 {
        (self.filtered - i64::from(self.origin.0) * i64::from(self.count())) as f64
    }

    fn fault(&self, sample_seconds: f64) -> Option<SampleFault> {
        if self.saturated {
            Some(SampleFault::Saturated)
        } else if self.changes == 0 {
            Some(SampleFault::Stuck)
        } else if self.longest_gap as f64 * 1e-6 > LONGEST_GAP * sample_seconds {
            Some(SampleFault::Missing)
        } else {
            None
        }
    }
}
