//! Whether the times of a sampled recording keep its rate.

use super::error::Fault;
use super::problem::TimeProblem;

/// A gap is a step longer than this many sample periods.
const GAP_PERIODS: f64 = 3.0;

/// The part of a period by which times written with few digits may miss.
const WRITING: f64 = 1e-3;

/// The part by which the header's rate may miss that of the times.
const RATE_TOLERANCE: f64 = 0.1;

/// The line and time, in seconds, of each sample; times increase.
pub(super) struct Times<'a, T> {
    /// The samples.
    pub rows: &'a [T],
    /// The line and time of one.
    pub stamp: fn(&T) -> (u64, f64),
    /// The column of the time.
    pub column: &'static str,
}

impl<T> Times<'_, T> {
    /// Refuses a header's rate (its line, and Hz) that the times contradict, and gaps.
    pub fn check(&self, rate: Option<(u64, f64)>) -> Result<(), Fault> {
        let Some(median) = self.median_step() else { return Ok(()) };
        let Some((line, rate_hz)) = rate else { return self.check_gaps(median) };
        let misses = |step: f64| (step * rate_hz - 1.0).abs() > RATE_TOLERANCE;
        // Missing samples shift the mean, few digits in the times the median: a wrong rate, both.
        if misses(median) && misses(self.mean_step()) {
            return Err(Fault::key(line, "rate_hz", TimeProblem::Rate(rate_hz, 1.0 / median)));
        }
        self.check_gaps(1.0 / rate_hz)
    }

    /// Refuses a step longer than three periods.
    fn check_gaps(&self, period_s: f64) -> Result<(), Fault> {
        let longest = (GAP_PERIODS + WRITING) * period_s;
        for pair in self.rows.windows(2) {
            let [(before_line, before), (line, time)] = [0, 1].map(|i| (self.stamp)(&pair[i]));
            let gap_s = time - before;
            if gap_s > longest {
                let problem = TimeProblem::Gap { gap_s, before_line, period_s };
                return Err(Fault::column(line, self.column, problem));
            }
        }
        Ok(())
    }

    /// The median of the steps (the lower one of two), in seconds; `None` with fewer than two rows.
    pub fn median_step(&self) -> Option<f64> {
        let time = |row| (self.stamp)(row).1;
        let mut steps: Vec<f64> =
            self.rows.windows(2).map(|pair| time(&pair[1]) - time(&pair[0])).collect();
        let middle = steps.len().checked_sub(1)? / 2;
        Some(*steps.select_nth_unstable_by(middle, f64::total_cmp).1)
    }

    /// The mean of the steps, in seconds.
    fn mean_step(&self) -> f64 {
        let time = |row: Option<&T>| row.map_or(0.0, |row| (self.stamp)(row).1);
        (time(self.rows.last()) - time(self.rows.first())) / (self.rows.len() - 1) as f64
    }
}
