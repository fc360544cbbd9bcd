//! What a sample of a spinning body takes of the bus: five converters on one SPI, against the time there is.
//!
//! Arithmetic is counted apart, in instructions (`firmware/budget.toml`). The paper samples at 10 kHz; an
//! ADS1262 gives 7 200 or 14 400 samples a second, so the next faster one is taken.

use drivers::ads1262::{self, BYTES_PER_SAMPLE, GREATEST_BUS_HERTZ};

use super::configuration::CHANNELS;

/// Samples a second that the paper's method is stated for, Hz.
pub const PAPER_HERTZ: u32 = 10_000;
/// Samples a second of an ADS1262 next to it, Hz (SBAS661C table 9-3).
pub const SAMPLE_HERTZ: u32 = 14_400;
/// The bus clock of the board, Hz: 80 MHz divided by a power of two, not above the converter's 8 MHz.
pub const BOARD_BUS_HERTZ: u32 = 5_000_000;
/// Bytes on the bus for a sample of all converters.
pub const BYTES: usize = CHANNELS * BYTES_PER_SAMPLE;

/// Per cent of the sample period, rounded up, that the bytes of five conversions take at a bus clock and a
/// sample rate, Hz. What a controller adds between bytes and for each select comes on top.
#[must_use]
pub const fn bus_percent(bus_hertz: u32, sample_hertz: u32) -> u32 {
    let nanoseconds = ads1262::bus_time(bus_hertz).as_nanos() as u64 * CHANNELS as u64;
    (nanoseconds * sample_hertz as u64).div_ceil(10_000_000) as u32
}

/// At the converter's own limit half of the time, on this board four fifths of it.
const _: () = assert!(bus_percent(GREATEST_BUS_HERTZ, SAMPLE_HERTZ) <= 51);
const _: () = assert!(bus_percent(BOARD_BUS_HERTZ, SAMPLE_HERTZ) <= 81);
