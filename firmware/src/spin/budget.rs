//! Load of the bus on a spinning body: five converters share one SPI, whose transfers must fit in
//! the sampling period.
//!
//! The load of the processor is checked separately, in instructions (`firmware/budget.toml`).
//! The method of Nekrasova 2017 is stated for 10 kHz; an ADS1262 gives 7 200 or 14 400 samples per second, so the
//! next higher rate is taken.

use drivers::ads1262::{self, BYTES_PER_SAMPLE, GREATEST_BUS_HERTZ};

use super::configuration::CHANNELS;

/// Sampling rate for which the method is stated (Nekrasova 2017), Hz.
pub const PAPER_HERTZ: u32 = 10_000;
/// The next higher data rate of an ADS1262, Hz (SBAS661C, table 9-3).
pub const SAMPLE_HERTZ: u32 = 14_400;
/// Bytes on the bus for one sample of all converters.
pub const BYTES: usize = CHANNELS * BYTES_PER_SAMPLE;

/// Share of the sampling period, %, rounded up, that the transfers of five conversions take at a
/// bus clock and a sampling rate, Hz. Gaps between bytes and the selection of each converter come
/// on top.
#[must_use]
pub const fn bus_percent(bus_hertz: u32, sample_hertz: u32) -> u32 {
    let nanoseconds = ads1262::bus_time(bus_hertz).as_nanos() as u64 * CHANNELS as u64;
    (nanoseconds * sample_hertz as u64).div_ceil(10_000_000) as u32
}

/// At the converters' limit, to which a board's clock of 64 MHz is divided, the transfers take half of the period.
const _: () = assert!(bus_percent(GREATEST_BUS_HERTZ, SAMPLE_HERTZ) <= 51);
