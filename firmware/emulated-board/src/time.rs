//! Time of the microcontroller: what it executes takes time, and what happens around it has a time.

use std::ops::{Add, Sub};

use embassy_time::Instant;

/// Fractions of a nanosecond that time is counted in, as a power of two.
const FRACTION_BITS: u32 = 16;

/// Nanoseconds of a second.
const SECOND: u64 = 1_000_000_000;

/// A moment since the supply came up, or a span of time: nanoseconds with a fraction of 2⁻¹⁶; wraps after three days.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Time(u64);

impl Time {
    /// The beginning.
    pub const ZERO: Self = Self(0);
    /// Later than anything.
    pub const NEVER: Self = Self(u64::MAX);

    /// So many nanoseconds.
    pub const fn nanoseconds(nanoseconds: u64) -> Self {
        Self(nanoseconds << FRACTION_BITS)
    }

    /// So many microseconds.
    pub const fn microseconds(microseconds: u64) -> Self {
        Self::nanoseconds(microseconds * 1000)
    }

    /// So many seconds, to the nearest fraction.
    pub fn seconds(seconds: f64) -> Self {
        Self((seconds * 1e9 * f64::from(1 << FRACTION_BITS)).round() as u64)
    }

    /// So many periods of a frequency in hertz (> 0, below 2³³), to the nearest fraction.
    pub const fn periods(count: u64, hertz: u64) -> Self {
        let (seconds, rest) = (count / hertz, count % hertz * SECOND);
        let fraction = (((rest % hertz) << FRACTION_BITS) + hertz / 2) / hertz;
        Self(((seconds * SECOND + rest / hertz) << FRACTION_BITS) + fraction)
    }

    /// How many whole periods of a frequency in hertz (below 2³³) it holds; a period that ends within a fraction counts.
    pub const fn count(self, hertz: u64) -> u64 {
        let end = self.0 + 1;
        let (nanoseconds, fraction) = (end >> FRACTION_BITS, end % (1 << FRACTION_BITS));
        let (seconds, rest) = (nanoseconds / SECOND, nanoseconds % SECOND * hertz);
        let rest_fraction = ((rest % SECOND) << FRACTION_BITS) + fraction * hertz;
        seconds * hertz + rest / SECOND + rest_fraction / (SECOND << FRACTION_BITS)
    }

    /// Whole nanoseconds.
    pub const fn as_nanoseconds(self) -> u64 {
        self.0 >> FRACTION_BITS
    }

    /// Seconds.
    pub fn as_seconds(self) -> f64 {
        self.0 as f64 * 1e-9 / f64::from(1 << FRACTION_BITS)
    }

    /// The moment of the simulated world, whole microseconds.
    pub const fn instant(self) -> Instant {
        Instant::from_micros(self.as_nanoseconds() / 1000)
    }

    /// When the simulated world has reached a moment.
    pub const fn of(instant: Instant) -> Self {
        Self::microseconds(instant.as_micros())
    }

    /// So often this span.
    #[must_use]
    pub const fn times(self, count: u64) -> Self {
        Self(self.0 * count)
    }
}

impl Add for Time {
    type Output = Self;

    fn add(self, span: Self) -> Self {
        Self(self.0.saturating_add(span.0))
    }
}

impl Sub for Time {
    type Output = Self;

    fn sub(self, earlier: Self) -> Self {
        Self(self.0.saturating_sub(earlier.0))
    }
}
