//! The sample period of a recording: one rule for every kind.
//!
//! It is the header's, unless over all the rows it and the times come apart by more than half a sample; then the times are
//! believed. Times may be rounded, so the mean of the steps counts, of those without a missing sample. Two kinds differ: a
//! turning platform holds on to a stated rate, which its session refuses where the times contradict it, and an analysis of
//! noise at rest goes by the times alone.

/// Samples are consecutive while the step between them is no more than so many times the usual one: with one missing it
/// is two, and clocks jitter.
const LONGEST_STEP: f64 = 1.75;

/// The part by which a stated rate may miss that of the times: no crystal is worse, and what turned is wrong by it.
const RATE_TOLERANCE: f64 = 0.01;

/// The steps from sample to sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// The usual one, s: the median, the lower one of two.
    pub median_s: f64,
    all: Total,
    /// Those without a missing sample.
    unbroken: Total,
}

/// What steps amount to, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Total {
    sum_s: f64,
    count: f64,
    /// The shortest and the longest.
    ends_s: [f64; 2],
}

impl Total {
    /// No steps.
    const NONE: Self = Self { sum_s: 0.0, count: 0.0, ends_s: [f64::INFINITY, 0.0] };

    /// Adds a step, s.
    fn add(&mut self, step_s: f64) {
        let [shortest, longest] = self.ends_s;
        self.sum_s += step_s;
        self.count += 1.0;
        self.ends_s = [shortest.min(step_s), longest.max(step_s)];
    }
}

impl Steps {
    /// The steps between rows whose times, s, increase; `None` of fewer than two.
    pub(crate) fn of<R>(rows: &[R], time_s: impl Fn(&R) -> f64) -> Option<Self> {
        let between = || rows.windows(2).map(|pair| time_s(&pair[1]) - time_s(&pair[0]));
        let mut steps = Self::beside(median(between().collect())?);
        for step in between() {
            steps.add(step);
        }
        Some(steps)
    }

    /// No steps yet, of which this one, s, is usual.
    pub(crate) const fn beside(median_s: f64) -> Self {
        Self { median_s, all: Total::NONE, unbroken: Total::NONE }
    }

    /// Adds a step, s; whether no sample is missing in it.
    pub(crate) fn add(&mut self, step_s: f64) -> bool {
        let is_unbroken = self.is_unbroken(step_s);
        self.all.add(step_s);
        if is_unbroken {
            self.unbroken.add(step_s);
        }
        is_unbroken
    }

    /// Whether the same steps were unbroken if another one were the usual: one of `usual_s`, s, from … to. `broken_s` is
    /// the shortest that is not.
    pub(crate) fn stand(&self, usual_s: [f64; 2], broken_s: f64) -> bool {
        let [low, high] = usual_s.map(|usual| LONGEST_STEP * usual);
        self.unbroken.ends_s[1] <= low && broken_s > high
    }

    /// Whether no sample is missing in a step, s.
    pub(crate) fn is_unbroken(&self, step_s: f64) -> bool {
        step_s <= LONGEST_STEP * self.median_s
    }

    /// The mean of the steps without a missing sample, s.
    pub(crate) fn mean_s(&self) -> f64 {
        self.unbroken.sum_s / self.unbroken.count
    }

    /// The rate of the times, Hz, where this one misses it.
    pub(crate) fn contradicted(&self, rate_hz: f64) -> Option<f64> {
        let found_hz = 1.0 / self.mean_s();
        ((rate_hz / found_hz - 1.0).abs() > RATE_TOLERANCE).then_some(found_hz)
    }

    /// The rate of the times, Hz, where this one is none of theirs even if much is missing at either end. Missing samples
    /// slow all steps down, few digits in the times make some seem to miss one: a wrong rate shows both ways.
    pub(super) fn refuted(&self, rate_hz: f64) -> Option<f64> {
        let Total { sum_s, count, ends_s: [shortest, longest] } = self.unbroken;
        // So much may be missing at either end, by few digits or jitter.
        let spread_s = longest - shortest;
        let is_refuted = |steps: Total| {
            let stated_s = steps.count / rate_hz;
            (steps.sum_s - stated_s).abs() > RATE_TOLERANCE * steps.sum_s + spread_s
        };
        [self.all, self.unbroken].into_iter().all(is_refuted).then(|| count / sum_s)
    }

    /// The sample period, s, with the header's rate, Hz, where it has one.
    pub(crate) fn period_s(&self, rate_hz: Option<f64>) -> f64 {
        let Total { sum_s, count, .. } = self.unbroken;
        let is_theirs = |stated: &f64| (sum_s - count * stated).abs() <= 0.5 * stated;
        rate_hz.map(|rate| 1.0 / rate).filter(is_theirs).unwrap_or_else(|| self.mean_s())
    }
}

/// The median of steps, the lower one of two; `None` of none.
pub(crate) fn median(mut steps: Vec<f64>) -> Option<f64> {
    let middle = steps.len().checked_sub(1)? / 2;
    Some(*steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The sample period of rows, s, with the header's rate, Hz, where it has one; of fewer than two rows the header's, or one
/// second.
#[must_use]
pub fn period_s<R>(rate_hz: Option<f64>, rows: &[R], time_s: impl Fn(&R) -> f64) -> f64 {
    let stated = || rate_hz.map_or(1.0, |rate| 1.0 / rate);
    Steps::of(rows, time_s).map_or_else(stated, |steps| steps.period_s(rate_hz))
}
