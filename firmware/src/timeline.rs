//! Supervision of the sampling: checks by their time stamps whether samples arrive at the sampling
//! rate.

use embassy_time::Instant;

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
    /// Time of the latest sample.
    last: Option<Instant>,
}

impl Timeline {
    /// A stream with a nominal period in µs, ≥ 1.
    #[must_use]
    pub const fn new(period: u32) -> Self {
        Self { period, last: None }
    }

    /// Judges the next sample. A deviation of up to a quarter of the period is tolerated: the bus
    /// may delay a reading, and the converter's own clock is accurate to some per cent.
    pub fn judge(&mut self, now: Instant) -> Arrival {
        let Some(last) = self.last.replace(now) else { return Arrival::InTime };
        let gap = u32::try_from((now - last).as_micros()).unwrap_or(u32::MAX);
        let missing = (gap.saturating_add(self.period / 2) / self.period).saturating_sub(1);
        let beside = gap.wrapping_sub(self.period).cast_signed();
        match missing {
            0 if beside.unsigned_abs() <= self.period / 4 => Arrival::InTime,
            0 => Arrival::Late(beside),
            _ => Arrival::Missing(missing),
        }
    }
}
