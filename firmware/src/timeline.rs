//! Whether samples come when they should, judged by their time stamps alone.

use embassy_time::Instant;

/// How one sample came after the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// At its time.
    InTime,
    /// Beside its time by so many µs, early negative, but none is missing.
    Late(i32),
    /// So many are missing before it.
    Missing(u32),
}

/// The times of a stream of samples.
#[derive(Clone, Copy, Debug)]
pub struct Timeline {
    period: u32,
    last: Option<Instant>,
}

impl Timeline {
    /// A stream with a period in µs.
    #[must_use]
    pub const fn new(period: u32) -> Self {
        Self { period, last: None }
    }

    /// Judges the next sample. A quarter of a period is forgiven: the bus may be late, but a
    /// converter's own clock is good to per cents.
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
