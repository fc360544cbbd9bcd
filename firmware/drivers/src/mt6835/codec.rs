//! Conversion of the MT6835's bytes to units, and its checksum.

use orientation::units::Angle;

use super::registers::{
    BANDWIDTH_MASK, Bandwidth, CALIBRATION_FAILED, CALIBRATION_RUNS, DIRECTION_MASK, Hysteresis,
    READ, REVERSED, WRITE,
};
use crate::fault::Fault;

/// An angle with the warnings of the chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The angle, exact: 21 bits are the upper ones of 32.
    pub angle: Angle,
    /// The three warning bits.
    pub status: u8,
}

/// Decodes a burst: 21 bits of angle, 3 of status, 8 of checksum.
///
/// # Errors
/// [`Fault::Checksum`] if the checksum is wrong.
pub fn frame(bytes: [u8; 4]) -> Result<Frame, Fault> {
    let [high, middle, low, found] = bytes;
    if checksum(&[high, middle, low]) != found {
        return Err(Fault::Checksum);
    }
    let angle = Angle(u32::from_be_bytes([high, middle, low & 0xF8, 0]));
    Ok(Frame { angle, status: low & 0x07 })
}

/// CRC-8, x⁸ + x² + x + 1, most significant bit first, beginning at zero (data sheet, Angle Data
/// Register). It finds up to three wrong bits in a burst, but a line stuck low passes: zeros check
/// as zero.
#[must_use]
pub fn checksum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| (0..8).fold(sum ^ byte, |sum, _| shifted(sum)))
}

fn shifted(sum: u8) -> u8 {
    let feedback = if sum & 0x80 == 0 { 0 } else { 0x07 };
    sum << 1 ^ feedback
}

/// The three bytes that read a register of 12-bit address; the value comes with the third.
#[must_use]
pub const fn read(register: u16) -> [u8; 3] {
    [READ | (register >> 8) as u8, register as u8, 0]
}

/// The three bytes that write a register of 12-bit address.
#[must_use]
pub const fn write(register: u16, value: u8) -> [u8; 3] {
    [WRITE | (register >> 8) as u8, register as u8, value]
}

/// The direction register with new direction and hysteresis; the manufacturer's bits are kept.
#[must_use]
pub const fn direction(kept: u8, is_reversed: bool, hysteresis: Hysteresis) -> u8 {
    let direction = if is_reversed { REVERSED } else { 0 };
    kept & !DIRECTION_MASK | direction | hysteresis as u8
}

/// The bandwidth register with a new bandwidth; the manufacturer's bits are kept.
#[must_use]
pub const fn bandwidth(kept: u8, bandwidth: Bandwidth) -> u8 {
    kept & !BANDWIDTH_MASK | bandwidth as u8
}

/// Checks the state of the self-calibration: valid if none was made or if it succeeded.
///
/// # Errors
/// [`Fault::NotReady`] while it runs, [`Fault::SelfTest`] if it has failed.
pub const fn calibration(register: u8) -> Result<(), Fault> {
    match register >> 6 {
        CALIBRATION_RUNS => Err(Fault::NotReady),
        CALIBRATION_FAILED => Err(Fault::SelfTest),
        _ => Ok(()),
    }
}
