//! What a driver did that its chip's data sheet forbids: recorded, so that a test can fail on it.

use core::fmt;

use embassy_time::Instant;
use heapless::Vec;

/// Violations that are kept; later ones are only counted.
const KEPT: usize = 16;

/// A forbidden access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misuse {
    /// No register has this address.
    UnknownRegister,
    /// The register can only be read.
    ReadOnly,
    /// The register can only be written.
    WriteOnly,
    /// A reserved bit was not written with its reserved value.
    ReservedBits,
    /// A value that the data sheet excludes, or excludes in this state.
    ForbiddenValue,
    /// The command byte means nothing.
    UnknownCommand,
    /// The transaction has the wrong number of bytes.
    Length,
    /// The bus clock is faster than the chip allows.
    ClockTooFast,
    /// The chip was still starting, resetting or busy.
    TooEarly,
}

/// A forbidden access: what, where, when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The rule of the data sheet that was broken.
    pub misuse: Misuse,
    /// The register's address, or the command byte.
    pub address: u8,
    /// Time of the access, µs since the clock began; it stops at its limit after an hour.
    pub microseconds: u32,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { misuse, address, microseconds } = self;
        write!(f, "{misuse:?} at {address:#04x} after {microseconds} µs")
    }
}

/// What broke rules, of any kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record<T> {
    /// The first sixteen of them, in order of time.
    pub first: Vec<T, KEPT>,
    /// How many there were, kept or not.
    pub count: usize,
}

/// The forbidden accesses of one chip. They survive a loss of supply: the record is the test's, not the
/// chip's.
pub type Violations = Record<Violation>;

impl<T> Default for Record<T> {
    /// Nothing was broken.
    fn default() -> Self {
        Self { first: Vec::new(), count: 0 }
    }
}

impl<T> Record<T> {
    /// Counts one more, and keeps it while there is room.
    pub fn keep(&mut self, broken: T) {
        self.count += 1;
        // Where there is no more room the count still shows it.
        let _ = self.first.push(broken);
    }
}

impl Violations {
    /// Records a forbidden access to a register, or of a command byte, at a moment.
    pub fn record(&mut self, misuse: Misuse, address: u8, at: Instant) {
        let microseconds = u32::try_from(at.as_micros()).unwrap_or(u32::MAX);
        self.keep(Violation { misuse, address, microseconds });
    }
}
