//! Supervision of the sampling: checks by their time stamps whether samples arrive at the sampling
//! rate.

use drivers::data_ready::Edge;

/// Periods for each of which the count of conversions may be put right by one: a converter's own
/// clock is accurate to some per cent, so that over a long gap the count is better than the time.
const COUNTED: u32 = 32;

/// The arrival of a sample relative to the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// The sample arrived in time.
    InTime,
    /// The sample arrived at the wrong time, by this deviation, µs, early negative, but none is
    /// missing.
    Late(i32),
    /// The number of samples that are missing before it.
    Missing(u32),
}

/// The time stamps of a stream of samples.
#[derive(Clone, Copy, Debug)]
pub struct Timeline {
    /// Nominal sampling period, µs.
    period: u32,
    /// End of the latest sample's conversion.
    last: Option<Edge>,
}

impl Timeline {
    /// A stream with a nominal period in µs, ≥ 1.
    #[must_use]
    pub const fn new(period: u32) -> Self {
        Self { period, last: None }
    }

    /// Judges the next sample by the end of its conversion. A deviation of up to a quarter of the
    /// period is tolerated: a converter that is awaited anew may be in any phase.
    pub fn judge(&mut self, end: Edge) -> Arrival {
        let Some(last) = self.last.replace(end) else { return Arrival::InTime };
        let gap = u32::try_from(end.at.0.saturating_sub(last.at.0)).unwrap_or(u32::MAX);
        let timed = gap.saturating_add(self.period / 2) / self.period;
        let counted = end.count.wrapping_sub(last.count);
        // A converter that was started again has not converted all the time.
        let is_counted = timed.abs_diff(counted) <= timed / COUNTED;
        let missing = if is_counted { counted } else { timed }.saturating_sub(1);
        let beside = gap.wrapping_sub(self.period).cast_signed();
        match missing {
            0 if beside.unsigned_abs() <= self.period / 4 => Arrival::InTime,
            0 => Arrival::Late(beside),
            _ => Arrival::Missing(missing),
        }
    }
}
