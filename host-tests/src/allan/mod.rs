//! The Allan variance and its relatives over a whole record (NIST SP 1065, section 5.2).
//!
//! The board's estimator streams and keeps little; this one has the record in memory, uses every
//! window in it, and is what the other is compared with. A record is rates at one period, in
//! segments where samples are missing between them: no difference is taken across a gap.

pub mod analysis;
mod differences;
pub mod speed;

use differences::{Sum, modified, second, third, total};

/// Rates in segments, ready for any averaging time.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    period: f64,
    /// The running integral of each segment in units of one period, from zero: one more than its
    /// samples.
    phases: Vec<Vec<f64>>,
}

/// The variances that are estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimator {
    /// The Allan variance from adjacent windows.
    Allan,
    /// The Allan variance from windows that begin at every sample.
    Overlapping,
    /// The modified Allan variance: the windows are averaged before they are squared.
    Modified,
    /// The Hadamard variance, blind to a linear drift, from adjacent windows.
    Hadamard,
    /// The Hadamard variance from windows that begin at every sample.
    OverlappingHadamard,
    /// The total variance: every segment is continued by its reflection at both ends.
    Total,
}

/// A variance at one averaging time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variance {
    /// Averaging time, s.
    pub seconds: f64,
    /// The variance in the square of the rate's unit.
    pub variance: f64,
    /// How many squares were averaged, at least 1.
    pub terms: u64,
}

impl Variance {
    /// Allan deviation, the root of the variance, in the rate's unit.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        self.variance.sqrt()
    }
}

impl Record {
    /// A record of segments of rates, one each `period` s, in any unit. The mean is taken off, which
    /// no variance sees, so that long sums stay exact.
    #[must_use]
    pub fn new<'a>(period: f64, segments: impl IntoIterator<Item = &'a [f64]>) -> Self {
        let segments: Vec<&[f64]> = segments.into_iter().collect();
        let samples = || segments.iter().copied().flatten();
        let mean = samples().sum::<f64>() / samples().count().max(1) as f64;
        let phases = segments.iter().map(|rates| integral(rates, mean)).collect();
        Self { period, phases }
    }

    /// Time between two samples, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.period
    }

    /// How many samples there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.phases.iter().map(|phases| phases.len() - 1).sum()
    }

    /// Whether there is no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The samples of the longest segment: a window cannot be longer than half of it.
    #[must_use]
    pub fn longest(&self) -> usize {
        self.phases.iter().map(|phases| phases.len() - 1).max().unwrap_or(0)
    }

    /// The averaging factors 1, 2, 3, 4, 6, 8, 12, … (two to each octave, as on the board), as far as
    /// two windows fit into a segment.
    #[must_use]
    pub fn factors(&self) -> Vec<usize> {
        let octaves = (1..usize::BITS - 2).flat_map(|k| [2 << k, 3 << k]);
        (1..4).chain(octaves).take_while(|factor| factor <= &(self.longest() / 2)).collect()
    }

    /// The variance for an averaging time of `factor` periods; `None` where no window is long
    /// enough.
    #[must_use]
    pub fn variance(&self, estimator: Estimator, factor: usize) -> Option<Variance> {
        let m = self.fitting(factor)?;
        match estimator {
            Estimator::Allan => self.strided(m, m),
            Estimator::Overlapping => self.strided(m, 1),
            Estimator::Modified => self.pooled(m, 2.0, |x| modified(x, m)),
            Estimator::Hadamard => self.pooled(m, 6.0, |x| third(x, m, m)),
            Estimator::OverlappingHadamard => self.pooled(m, 6.0, |x| third(x, m, 1)),
            Estimator::Total => self.pooled(m, 2.0, |x| total(x, m)),
        }
    }

    /// The Allan variance from windows that begin at every `stride`-th sample of their segment.
    #[must_use]
    pub fn strided(&self, factor: usize, stride: usize) -> Option<Variance> {
        let factor = self.fitting(factor)?;
        self.pooled(factor, 2.0, |x| second(x, factor, stride.max(1)))
    }

    /// The factor, where two windows of that many samples fit into a segment.
    fn fitting(&self, factor: usize) -> Option<usize> {
        (1..=self.longest() / 2).contains(&factor).then_some(factor)
    }

    /// The mean square over all segments, over `scale` and the square of the averaging time.
    fn pooled(&self, factor: usize, scale: f64, sum: impl Fn(&[f64]) -> Sum) -> Option<Variance> {
        let sum = self.phases.iter().map(|phases| sum(phases)).fold(Sum::default(), Sum::with);
        let averaged = scale * (factor as f64) * (factor as f64);
        let variance = sum.squares / sum.terms as f64 / averaged;
        let seconds = factor as f64 * self.period;
        (sum.terms > 0).then_some(Variance { seconds, variance, terms: sum.terms })
    }
}

/// The running sum of the rates less the mean, from zero.
fn integral(rates: &[f64], mean: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let sums = rates.iter().map(|rate| {
        sum += rate - mean;
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}
