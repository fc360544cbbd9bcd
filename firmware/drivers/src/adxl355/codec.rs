//! Conversion of the ADXL355's bytes to units, and checks of its answers.

use orientation::units::{SpecificForce, Temperature};

use super::registers::{OFFSET_X_H, OutputRate, POWER_CTL, RANGE_2_G, STANDBY, Status};
use crate::fault::{self, Fault};

/// Number of registers in a burst, from the status to the last byte of z.
pub const BURST: usize = 13;

/// Number of writable registers in a row, from the offsets to the self-test.
pub const SETTINGS: usize = 17;

/// Bits of a burst that the register map reserves as zero, the only protection against a disturbed
/// transfer. 19 of 104 bits; a line that is stuck high or slipped by a bit is unlikely to keep them
/// zero.
const RESERVED: [u8; BURST] =
    [0xE0, 0x80, 0xF0, 0x00, 0x00, 0x00, 0x0F, 0x00, 0x00, 0x0F, 0x00, 0x00, 0x0F];

/// One sample in the chip's format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The status register.
    pub status: Status,
    /// Temperature, 12 bits without sign.
    pub temperature: u16,
    /// Specific force on x, y, z; 20 bits, two's complement.
    pub counts: [i32; 3],
}

/// Decodes a burst.
///
/// # Errors
/// [`Fault::Checksum`] if a bit is set that the chip keeps zero.
pub fn frame(bytes: &[u8; BURST]) -> Result<Frame, Fault> {
    if bytes.iter().zip(RESERVED).any(|(byte, reserved)| byte & reserved != 0) {
        return Err(Fault::Checksum);
    }
    let [status, _, t2, t1, x3, x2, x1, y3, y2, y1, z3, z2, z1] = *bytes;
    Ok(Frame {
        status: Status(status),
        temperature: u16::from_be_bytes([t2, t1]),
        counts: [axis([x3, x2, x1]), axis([y3, y2, y1]), axis([z3, z2, z1])],
    })
}

/// An axis: two's complement, left-justified in three bytes.
fn axis([high, middle, low]: [u8; 3]) -> i32 {
    i32::from_be_bytes([high, middle, low, 0]) >> 12
}

/// Fraction bits of [`SCALE`]: the product with 20 bits fits 63.
const SCALE_BITS: u32 = 38;

/// µm/s² per count at ±2 g: 9 806 650 / 256 000 = 196 133 / 5120, rounded down at the last bit.
const SCALE: i64 = (196_133 << SCALE_BITS) / 5120;

/// Specific force of a count at ±2 g (data sheet, Specifications: 256 000 LSB/g, g = 9.80665 m/s²),
/// to the nearest µm/s², ties towards zero (so over all 2²⁰ counts, as a test asserts).
pub fn force(count: i32) -> SpecificForce {
    let product = i64::from(count) * SCALE;
    SpecificForce(((product + (1 << (SCALE_BITS - 1))) >> SCALE_BITS) as i32)
}

/// Whether a count stands at a limit of its 20 bits, ±2.048 g.
#[must_use]
pub fn is_clipped(count: i32) -> bool {
    count == 0x7_FFFF || count == -0x8_0000
}

/// Counts at 25 °C (data sheet, Temperature Data Registers). Uncalibrated: a chip may be some
/// degrees off; its changes are good.
const TEMPERATURE_AT_25: i32 = 1885;

/// Temperature of a count, to the nearest m°C: −9.05 LSB/°C is −20 000/181 m°C per count, and no
/// count is a tie.
pub fn temperature(count: u16) -> Temperature {
    let numerator = (TEMPERATURE_AT_25 - i32::from(count)) * 20_000;
    let half = if numerator < 0 { -90 } else { 90 };
    Temperature(25_000 + (numerator + half) / 181)
}

/// Counts per g at ±8 g, where the self-test runs.
const COUNTS_PER_G_SELF_TEST: i64 = 64_000;

/// Smallest and largest response to the self-test force, thousandths of g (data sheet,
/// Specifications: x and y 0.1 … 0.6 g, z 0.5 … 3.0 g).
const SELF_TEST_LIMITS: [(i64, i64); 3] = [(100, 600), (100, 600), (500, 3000)];

/// Whether the response to the self-test force is within its limits: sums of `samples` counts at ±8
/// g without and with the force. Gravity and tilt are in both sums and cancel.
#[must_use]
pub fn self_test_passes(without: [i32; 3], with: [i32; 3], samples: i32) -> bool {
    let unit = i64::from(samples) * COUNTS_PER_G_SELF_TEST;
    let within = |((without, with), (least, most)): ((i32, i32), (i64, i64))| {
        let answer = 1000 * (i64::from(with) - i64::from(without));
        (least * unit..=most * unit).contains(&answer)
    };
    without.into_iter().zip(with).zip(SELF_TEST_LIMITS).all(within)
}

/// Contents of all writable registers of a measuring chip: reset values except for rate, range and
/// power.
#[must_use]
pub const fn settings(rate: OutputRate) -> [u8; SETTINGS] {
    // Offsets; activity detection with its count of 1; filter; FIFO mark at 96, interrupts and
    // synchronisation off; range; measuring; no self-test.
    [0, 0, 0, 0, 0, 0, 0, 0, 0, 1, rate as u8, 0x60, 0, 0, RANGE_2_G, 0, 0]
}

/// Compares the writable registers with their required contents.
///
/// # Errors
/// [`Fault::Reset`] if the chip is in the standby that follows a reset, or silent (all bits alike,
/// as while it powers up); otherwise [`Fault::NotAsWritten`] with the first register that differs.
pub fn compare(found: &[u8; SETTINGS], expected: &[u8; SETTINGS]) -> Result<(), Fault> {
    let is_silent = *found == [0x00; SETTINGS] || *found == [0xFF; SETTINGS];
    if is_silent || found[usize::from(POWER_CTL - OFFSET_X_H)] == STANDBY {
        return Err(Fault::Reset);
    }
    fault::compare(OFFSET_X_H, found, expected)
}
