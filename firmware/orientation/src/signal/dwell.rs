//! The average of one dwell: filter, integrate, and judge what went in.
//!
//! The filter starts at each arrival as if the first sample x₀ had stood for ever, so nothing of
//! the previous position and of the rotation can smear into this one. The mean of its output over
//! n samples is then x₀ + Σ wⱼ(xⱼ − x₀), with wⱼ the step response at the time that is left; as
//! W = Σ wⱼ is known from the design, dividing by W/n gives an unbiased mean in which x₀ cancels.
//! Nothing is discarded: the taper costs the variance factor n Σ wⱼ²/W². For a dwell longer than
//! the filter's settling W = n − D and Σ wⱼ² = n − 2D + E, with D the lag and E the lag power.

use super::Sample;
use super::blocks::{Blocks, Quietness};
use super::butterworth::{Coefficients, Filter};
use crate::units::{Angle, AngularRate, Instant};

/// What one dwell leaves behind, whoever averaged it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dwell {
    /// Encoder angle.
    pub stage: Angle,
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
    pub stated_variance: Option<f64>,
    /// Standard deviation of one sample about the mean, rad/s.
    pub spread: f64,
    /// Block statistics, where there were samples enough.
    pub quietness: Option<Quietness>,
    /// Mean specific force on the platform's axes, m/s², where it was measured.
    pub force: Option<[f64; 3]>,
    /// Mean temperature, °C, where it was measured.
    pub temperature: Option<f64>,
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

/// Mean of a quantity that every sample brings, as a plain sum; its first value is taken away at
/// the end, so that the mean keeps its last bits.
#[derive(Clone, Copy, Debug, Default)]
struct Total {
    origin: i32,
    sum: i64,
}

impl Total {
    #[inline]
    fn push(&mut self, value: i32) {
        self.sum += i64::from(value);
    }

    /// The sum of the deviations of `count` values from the first.
    fn deviation(&self, count: u32) -> i64 {
        self.sum - i64::from(self.origin) * i64::from(count)
    }

    /// The mean of `count` values in units of `lsb`.
    fn mean(&self, count: u32, lsb: f64) -> f64 {
        (f64::from(self.origin) + self.deviation(count) as f64 / f64::from(count)) * lsb
    }
}

/// Mean of a quantity that samples may lack, as a sum of deviations from its first value.
#[derive(Clone, Copy, Debug, Default)]
struct Deviations {
    origin: i32,
    sum: i64,
}

impl Deviations {
    fn push(&mut self, value: i32) {
        self.sum += i64::from(value) - i64::from(self.origin);
    }

    /// The mean in units of `lsb`.
    fn mean(&self, count: f64, lsb: f64) -> f64 {
        (f64::from(self.origin) + self.sum as f64 / count) * lsb
    }
}

/// Sample periods without a sample that a dwell bears: two samples in a row may be lost.
const LONGEST_GAP: f64 = 3.5;

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
    /// The raw rate of the first sample, and the sum of the filtered ones.
    filtered: Total,
    filter: Filter<SECTIONS>,
    squares: u64,
    blocks: Blocks,
    stage: i64,
    force: [Total; 3],
    temperature: Option<Deviations>,
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
            filtered: Total { origin: sample.rate.0, sum: 0 },
            filter: Filter::at_rest(sample.rate),
            squares: 0,
            blocks: Blocks::default(),
            stage: 0,
            force: sample.force.map(|force| Total { origin: force.0, sum: 0 }),
            temperature: sample.temperature.map(|t| Deviations { origin: t.0, sum: 0 }),
            saturated: false,
            longest_gap: 0,
        };
        average.push(coefficients, sample);
        average
    }

    /// Adds a sample of the same standstill.
    pub fn push(&mut self, coefficients: &Coefficients<SECTIONS>, sample: &Sample) {
        self.push_rate(coefficients, sample.rate);
        self.stage += i64::from((sample.stage - self.anchor).0.cast_signed());
        self.push_time(sample.time);
        for (sum, force) in self.force.iter_mut().zip(sample.force) {
            sum.push(force.0);
        }
        if let (Some(sum), Some(temperature)) = (&mut self.temperature, sample.temperature) {
            sum.push(temperature.0);
        }
    }

    #[inline]
    fn push_rate(&mut self, coefficients: &Coefficients<SECTIONS>, rate: AngularRate) {
        let filtered = self.filter.update(coefficients, rate);
        self.filtered.push(filtered.0);
        let deviation = rate.0.saturating_sub(self.filtered.origin);
        let square = (i64::from(deviation) * i64::from(deviation)).cast_unsigned();
        // A square is at most 2⁶²: it fits above any sum below 2⁶³.
        if self.squares.cast_signed() < 0 {
            self.add_to_great(square);
        } else {
            self.squares += square;
        }
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

    /// Adds to a sum of squares that may be near its limit.
    #[cold]
    #[inline(never)]
    fn add_to_great(&mut self, square: u64) {
        self.squares = self.squares.saturating_add(square);
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

    /// Mean specific force so far, m/s².
    #[must_use]
    pub fn force(&self) -> [f64; 3] {
        self.force.map(|sum| sum.mean(self.count(), 1e-6))
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
            middle: 0.5 * (self.first.seconds() + self.last.seconds()),
            seconds: count * sample_seconds,
            samples: self.count(),
            rate: (f64::from(self.filtered.origin) + self.deviation() / weight) * 1e-9,
            taper: power * count / (weight * weight),
            stated_variance: None,
            spread: self.spread(),
            quietness: self.blocks.quietness(sample_seconds),
            force: Some(self.force()),
            temperature: self.temperature.map(|sum| sum.mean(count, 1e-3)),
            fault: self.fault(sample_seconds),
        })
    }

    /// Sum of the filtered rates' deviations from the first raw one, nrad/s.
    fn deviation(&self) -> f64 {
        self.filtered.deviation(self.count()) as f64
    }

    /// Standard deviation of one sample about the mean of the filtered ones, rad/s.
    fn spread(&self) -> f64 {
        let count = f64::from(self.count());
        let mean = self.deviation() / count;
        libm::sqrt((self.squares as f64 / count - mean * mean).max(0.0)) * 1e-9
    }

    fn fault(&self, sample_seconds: f64) -> Option<SampleFault> {
        if self.saturated {
            Some(SampleFault::Saturated)
        } else if self.squares == 0 {
            Some(SampleFault::Stuck)
        } else if self.longest_gap as f64 * 1e-6 > LONGEST_GAP * sample_seconds {
            Some(SampleFault::Missing)
        } else {
            None
        }
    }
}
