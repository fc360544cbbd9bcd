//! The register map of the MT6835: which bits can be written where, and what its EEPROM holds.

use crate::registers::{Registers, both, read};

/// Addresses of the RAM that mirrors the EEPROM, up to the last correction.
pub const SIZE: usize = 0xD3;

/// First byte of the angle; status and checksum follow within the next three.
pub const ANGLE: u16 = 0x003;
/// The checksum over angle and status.
pub const CRC: u16 = 0x006;
/// Upper eight of the twelve bits of the zero position.
pub const ZERO_HIGH: u16 = 0x009;
/// Lower four of the twelve bits of the zero position, in the upper half of the byte.
pub const ZERO_LOW: u16 = 0x00A;
/// Direction of counting (bit 3) and hysteresis (bits 0 to 2).
pub const DIRECTION: u16 = 0x00D;
/// State of the self-calibration, in the upper two bits.
pub const CALIBRATION: u16 = 0x113;

/// The bits that the user may write, and what the EEPROM of a chip from the factory holds. Fields with a name
/// hold their documented defaults (hysteresis 0.011°, bandwidth × 32, calibration at 400 … 800 1/min, all
/// else zero); the maker's bits are any pattern: a driver must keep them without knowing them.
pub const MAP: &[Registers] = &[
    both(0x001, 0xFF, 0),
    read(0x003, 0x006),
    both(0x007, 0xFF, 0).to(0x00B),
    both(0x00C, 0x3F, 0x80),
    both(0x00D, 0x0F, 0xA7),
    both(0x00E, 0xF0, 0x35),
    both(0x011, 0x07, 0x95),
    both(0x013, 0xFF, 0).to(0x0D2),
    read(0x113, 0x113),
];

/// Hysteresis of each setting, degrees.
const HYSTERESES: [f64; 8] = [0.022, 0.044, 0.088, 0.176, 0.0, 0.003, 0.006, 0.011];

/// Hysteresis of a direction register, turns.
pub fn hysteresis(direction: u8) -> f64 {
    HYSTERESES[usize::from(direction & 0x07)] / 360.0
}
