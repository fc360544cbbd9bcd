//! Whether the times of a sampled recording keep its rate.

use super::error::Fault;
use super::period::{RATE_TOLERANCE, Steps};
use super::problem::TimeProblem;

/// A gap is a step longer than this many sample periods.
const GAP_PERIODS: f64 = 3.0;

/// The part of a period by which times written with few digits may miss.
const WRITING: f64 = 1e-3;

/// The line and time, in seconds, of a sample; times increase.
type Stamp<T> = fn(&T) -> (u64, f64);

/// Refuses a header's rate (its line, and Hz) that the times of samples contradict, and gaps.
pub(super) fn check<T>(rows: &[T], stamp: Stamp<T>, rate: Option<(u64, f64)>) -> Result<(), Fault> {
    let Some(usual) = Steps::of(rows, |row| stamp(row).1) else { return Ok(()) };
    let Some((line, rate_hz)) = rate else { return check_gaps(rows, stamp, usual.median_s) };
    let steps = || rows.windows(2).map(|pair| stamp(&pair[1]).1 - stamp(&pair[0]).1);
    let unbroken = Timing::of(steps().filter(|step| usual.is_unbroken(*step)));
    // Missing samples slow all steps down, few digits in the times make some seem to miss one: a wrong rate
    // shows both ways.
    let timings = [Timing::of(steps()), unbroken];
    if timings.iter().all(|timing| timing.contradicts(rate_hz, unbroken.spread())) {
        let found_hz = unbroken.count / unbroken.sum_s;
        return Err(Fault::key(line, "rate_hz", TimeProblem::Rate(rate_hz, found_hz)));
    }
    check_gaps(rows, stamp, 1.0 / rate_hz)
}

/// Refuses a step longer than three periods.
fn check_gaps<T>(rows: &[T], stamp: Stamp<T>, period_s: f64) -> Result<(), Fault> {
    let longest = (GAP_PERIODS + WRITING) * period_s;
    for pair in rows.windows(2) {
        let [(before_line, before), (line, time)] = [0, 1].map(|i| stamp(&pair[i]));
        let gap_s = time - before;
        if gap_s > longest {
            let problem = TimeProblem::Gap { gap_s, before_line, period_s };
            return Err(Fault::column(line, "t_s", problem));
        }
    }
    Ok(())
}

/// What steps amount to, in seconds.
#[derive(Clone, Copy)]
struct Timing {
    sum_s: f64,
    count: f64,
    /// The shortest and the longest.
    ends_s: [f64; 2],
}

impl Timing {
    /// Summarises steps of time.
    fn of(steps: impl Iterator<Item = f64>) -> Self {
        let none = Self { sum_s: 0.0, count: 0.0, ends_s: [f64::INFINITY, 0.0] };
        steps.fold(none, |Self { sum_s, count, ends_s: [shortest, longest] }, step| Self {
            sum_s: sum_s + step,
            count: count + 1.0,
            ends_s: [shortest.min(step), longest.max(step)],
        })
    }

    /// By how much steps differ: so much may be missing at either end, by few digits or jitter.
    fn spread(&self) -> f64 {
        self.ends_s[1] - self.ends_s[0]
    }

    /// Whether the rate, Hz, is not theirs, where the ends are off by no more than this.
    fn contradicts(&self, rate_hz: f64, ends_s: f64) -> bool {
        let stated_s = self.count / rate_hz;
        (self.sum_s - stated_s).abs() > RATE_TOLERANCE * self.sum_s + ends_s
    }
}
