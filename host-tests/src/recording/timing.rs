//! Whether the times of a sampled recording keep its rate.

use super::error::Fault;
use super::period::Steps;
use super::problem::Problem;

/// A gap is a step longer than this many sample periods.
const GAP_PERIODS: f64 = 3.0;

/// The part of a period by which times written with few digits may miss.
const WRITING: f64 = 1e-3;

/// The line and time, in seconds, of a sample; times increase.
type Stamp<T> = fn(&T) -> (u64, f64);

/// Refuses a header's rate (its line, and Hz) that the times of samples contradict, and gaps.
pub(super) fn check<T>(rows: &[T], stamp: Stamp<T>, rate: Option<(u64, f64)>) -> Result<(), Fault> {
    let Some(steps) = Steps::of(rows, |row| stamp(row).1) else { return Ok(()) };
    let Some((line, rate_hz)) = rate else { return check_gaps(rows, stamp, steps.median_s) };
    if let Some(found_hz) = steps.refuted(rate_hz) {
        return Err(Fault::key(line, "rate_hz", Problem::Rate(rate_hz, found_hz)));
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
            let problem = Problem::Gap { gap_s, before_line, period_s };
            return Err(Fault::column(line, "t_s", problem));
        }
    }
    Ok(())
}
