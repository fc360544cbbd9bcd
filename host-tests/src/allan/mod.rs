//! The Allan variance over a whole record (NIST SP 1065, section 5.2).
//!
//! The board's estimator streams and keeps little; this one has the record in memory, uses every
//! window in it, and is what the other is compared with. A record is rates at one period, in
//! segments where samples are missing between them: no difference is taken across a gap.

pub mod analysis;
pub mod speed;

use orientation::noise::allan::Point;
use orientation::units::Seconds;

/// Rates in segments, ready for any averaging time.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    period: f64,
    /// The running integral of each segment in units of one period, from zero: one more than its
    /// samples.
    phases: Vec<Vec<f64>>,
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

    /// The samples of the longest segment: a window cannot be longer than half of it.
    pub(crate) fn longest(&self) -> usize {
        self.phases.iter().map(|phases| phases.len() - 1).max().unwrap_or(0)
    }

    /// The averaging factors 1, 2, 3, 4, 6, 8, 12, … (two to each octave, as on the board), as far as
    /// two windows fit into a segment.
    #[must_use]
    pub fn factors(&self) -> Vec<usize> {
        let octaves = (1..usize::BITS - 2).flat_map(|k| [2 << k, 3 << k]);
        (1..4).chain(octaves).take_while(|factor| factor <= &(self.longest() / 2)).collect()
    }

    /// The Allan variance for an averaging time of `factor` periods, in the square of the rate's unit, from windows that
    /// begin at every `stride`-th sample of their segment; `None` where no window is long enough.
    #[must_use]
    pub fn strided(&self, factor: usize, stride: usize) -> Option<Point> {
        if !(1..=self.longest() / 2).contains(&factor) {
            return None;
        }
        let of_segments = self.phases.iter().map(|phases| squares(phases, factor, stride.max(1)));
        let (sum, terms) = of_segments.fold((0.0, 0), |all, one| (all.0 + one.0, all.1 + one.1));
        let averaged = 2.0 * (factor as f64) * (factor as f64);
        Some(Point {
            seconds: Seconds(factor as f64 * self.period),
            variance: sum / terms as f64 / averaged,
            stride: Seconds(stride as f64 * self.period),
            terms,
        })
    }
}

/// The sum of the squared second differences over `m` steps of a phase at every `stride`-th place, and how many they are.
fn squares(x: &[f64], m: usize, stride: usize) -> (f64, u64) {
    let starts = (0..x.len().saturating_sub(2 * m)).step_by(stride);
    let differences = starts.map(|i| x[i + 2 * m] - 2.0 * x[i + m] + x[i]);
    differences.fold((0.0, 0), |(sum, terms), step| (sum + step * step, terms + 1))
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
