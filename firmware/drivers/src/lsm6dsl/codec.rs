//! Conversion of the LSM6DSL's bytes to units, and the required register contents.

use orientation::units::{AngularRate, DEGREE, SpecificForce, Temperature};

use super::Configuration;
use super::registers::{
    BLOCK_DATA_UPDATE, CTRL1_XL, ForceRange, INCREMENT, RateRange, control_force, control_rate,
};
use crate::fault::{self, Fault};

/// Bytes of a burst: temperature, three axes of the gyro, three of the accelerometer.
pub const BURST: usize = 14;

/// Number of control registers that determine the meaning of a reading, `CTRL1_XL` … `CTRL8_XL`.
pub const SETTINGS: usize = 8;

/// One sample in the chip's format, in counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Temperature.
    pub temperature: i16,
    /// Angular rate about x, y, z.
    pub rate: [i16; 3],
    /// Specific force on x, y, z.
    pub force: [i16; 3],
}

/// Decodes a burst: little-endian, lower byte first.
#[must_use]
pub fn frame(bytes: &[u8; BURST]) -> Frame {
    let word = |index: usize| i16::from_le_bytes([bytes[2 * index], bytes[2 * index + 1]]);
    Frame {
        temperature: word(0),
        rate: [word(1), word(2), word(3)],
        force: [word(4), word(5), word(6)],
    }
}

/// Fraction bits of [`RATE_SCALE`] and [`FORCE_SCALE`]: products with 19 bits fit 63.
const SCALE_BITS: u32 = 20;

/// nrad/s per count at ±125 °/s: 4.375 m°/s (data sheet, Mechanical characteristics, `G_So`).
const RATE_SCALE: i64 = (4.375e6 * DEGREE * (1 << SCALE_BITS) as f64) as i64;

/// µm/s² per count at ±2 g: 0.061 mg (same table, `LA_So`), g = 9.80665 m/s².
const FORCE_SCALE: i64 = (0.061e-3 * 9_806_650.0 * (1 << SCALE_BITS) as f64) as i64;

/// A count in units of a scale factor, rounded to nearest.
fn scaled(count: i16, scale: i64, shift: u32) -> i64 {
    (((i64::from(count) * scale) << shift) + (1 << (SCALE_BITS - 1))) >> SCALE_BITS
}

/// Rate of a count, to nearest within 0.6 nrad/s + 2⁻⁵ ppm. It saturates at ±123 °/s, the range of
/// its type, whatever the chip's.
pub fn rate(count: i16, range: RateRange) -> AngularRate {
    let rate = scaled(count, RATE_SCALE, range.shift());
    AngularRate(rate.max(i64::from(i32::MIN)).min(i64::from(i32::MAX)) as i32)
}

/// Specific force of a count, to nearest within 0.6 µm/s².
pub fn force(count: i16, range: ForceRange) -> SpecificForce {
    SpecificForce(scaled(count, FORCE_SCALE, range.shift()) as i32)
}

/// Temperature of a count, rounded down to m°C: 256 LSB/°C, zero at 25 °C (data sheet, Temperature
/// sensor characteristics; offset ±15 °C). An LSM6DS3 of the same family has 16 LSB/°C.
pub fn temperature(count: i16) -> Temperature {
    Temperature(25_000 + ((i32::from(count) * 125) >> 5))
}

/// Limit of the gyro's nominal range, counts, the same for all ranges: 125 °/s over 4.375 m°/s.
/// Between it and the limit of 16 bits the data sheet specifies nothing.
const RATE_LIMIT: u16 = 28_571;

/// Whether a rate is beyond the gyro's nominal range.
#[must_use]
pub fn is_rate_clipped(count: i16) -> bool {
    count.unsigned_abs() >= RATE_LIMIT
}

/// Whether a specific force is at the limit of its 16 bits, the nominal range.
#[must_use]
pub fn is_force_clipped(count: i16) -> bool {
    count.unsigned_abs() >= i16::MAX.unsigned_abs()
}

/// Smallest and largest response to the self-test force of the accelerometer at ±4 g, counts of
/// 0.122 mg: 90 … 1700 mg (data sheet, Mechanical characteristics, Vst; ST's example tests the
/// same).
const FORCE_ANSWER: [i32; 2] = [738, 13_934];
/// Smallest and largest response to the self-test force of the gyro at ±2000 °/s, counts of 70
/// m°/s: 150 … 700 °/s.
const RATE_ANSWER: [i32; 2] = [2143, 10_000];

/// Sums of counts of gyro and accelerometer.
pub type Sums = [[i32; 3]; 2];

/// Whether the responses to the self-test forces are within their limits, by sums of the same
/// number of samples without and with the forces. Earth rate, tilt and sway are in both sums, or
/// small against the limits.
#[must_use]
pub fn self_test_passes(without: &Sums, with: &Sums, samples: i32) -> bool {
    let within = |sensor: usize, [least, most]: [i32; 2]| {
        let limits = least * samples..=most * samples;
        let mut pairs = without[sensor].iter().zip(&with[sensor]);
        pairs.all(|(off, on)| limits.contains(&(on - off).saturating_abs()))
    };
    within(0, RATE_ANSWER) && within(1, FORCE_ANSWER)
}

/// The control registers of a measuring chip: reset values but for rates, ranges and block data
/// update; both sensors at high performance.
#[must_use]
pub const fn settings(configuration: &Configuration) -> [u8; SETTINGS] {
    let Configuration { output, rate, force } = *configuration;
    let [first, second] = [control_force(output, force), control_rate(output, rate)];
    [first, second, BLOCK_DATA_UPDATE | INCREMENT, 0, 0, 0, 0, 0]
}

/// Compares the control registers with their required contents.
///
/// # Errors
/// [`Fault::Reset`] if both sensors are off, as after a reset, or the line is dead; otherwise
/// [`Fault::NotAsWritten`] with the first register that differs.
pub fn compare(found: &[u8; SETTINGS], expected: &[u8; SETTINGS]) -> Result<(), Fault> {
    if found[..2] == [0; 2] || *found == [0xFF; SETTINGS] {
        return Err(Fault::Reset);
    }
    fault::compare(CTRL1_XL, found, expected)
}
