//! The wires between a model of a microcontroller and the chips: select lines that move on their own, single
//! bytes at their own times, conditions of an I²C bus.
//!
//! ```text
//!  pins, SPI controller ─▶ SpiWires ─select, exchange, deselect─▶ Rig
//!  I²C controller ──────▶ I2cWires ─start, write, read, stop───▶ Single
//! ```
//!
//! Times are nanoseconds since the start of the clock and do not fall from call to call; the chips see whole
//! microseconds. Whatever the wires carry reaches the chips, as far as they would hear it; what no
//! controller may do with them is recorded beside the chips' own violations ([`SpiWires::faults`],
//! [`I2cWires::faults`]).

mod i2c;
mod spi;

use embassy_time::Instant;

pub use i2c::{I2cFault, I2cRule, I2cWires};
pub use spi::{Clock, SpiFault, SpiRule, SpiWires, Wait};

/// The microsecond in which a time in nanoseconds lies.
const fn instant(nanoseconds: u64) -> Instant {
    Instant::from_micros(nanoseconds / 1000)
}

/// The first microsecond that is not before a time in nanoseconds.
const fn instant_after(nanoseconds: u64) -> Instant {
    Instant::from_micros(nanoseconds.div_ceil(1000))
}

/// Time of `half_bits` half bits at a bus clock in hertz (> 0), ns, rounded up.
const fn half_bits(half_bits: u64, hertz: u32) -> u64 {
    (half_bits * 500_000_000).div_ceil(hertz as u64)
}
