//! The register map: reset values, what may be written, and what the values mean (SBAS661C 9.6).

use crate::registers::{Registers as Row, both, read, reset_bytes, write_refusal};
use crate::violation::Misuse;

/// Registers of an ADS1262 (an ADS1263 has six more).
const COUNT: usize = 21;

/// Reference, level shift and reset flag (9.6, POWER).
const POWER: u8 = 0x01;
/// Status byte and checksum of frames (9.6, INTERFACE).
const INTERFACE: u8 = 0x02;
/// Reference polarity, run mode, chopping and delay (9.6, MODE0).
pub(super) const MODE0: u8 = 0x03;
/// Filter and sensor bias (9.6, MODE1).
pub(super) const MODE1: u8 = 0x04;
/// Amplifier's bypass and gain, and the data rate (9.6, MODE2).
pub(super) const MODE2: u8 = 0x05;
/// Positive and negative input (9.6, INPMUX).
pub(super) const INPMUX: u8 = 0x06;
/// Positive and negative reference (9.6, REFMUX).
pub(super) const REFMUX: u8 = 0x0F;

/// Which bits may be written, and the values after a reset (table 9-34): the identity, of device 0 and
/// revision 0, is read only.
const MAP: &[Row] = &[
    read(0x00, 0x00),
    both(0x01, 0x13, 0x11),
    both(0x02, 0x0F, 0x05),
    both(0x03, 0xFF, 0x00),
    both(0x04, 0xFF, 0x80),
    both(0x05, 0xFF, 0x04),
    both(0x06, 0xFF, 0x01),
    both(0x07, 0xFF, 0x00).to(0x0B),
    both(0x0C, 0xFF, 0x40),
    both(0x0D, 0xFF, 0xBB),
    both(0x0E, 0xFF, 0x00),
    both(0x0F, 0x3F, 0x00),
    both(0x10, 0x9F, 0x00).to(0x11),
    both(0x12, 0xFF, 0x00).to(0x14),
];

/// Bits of the register at an address that mean something together.
#[derive(Clone, Copy)]
pub(super) struct Field(u8, u8);

/// The reset flag, until it is cleared.
pub(super) const RESET_FLAG: Field = Field(POWER, 0x10);
/// Whether the reference inside the chip is on.
pub(super) const REFERENCE_ON: Field = Field(POWER, 0x01);
/// Whether frames carry the status byte.
pub(super) const STATUS: Field = Field(INTERFACE, 0x04);
/// Form of the checksum byte: 0 none, 1 sum, 2 CRC.
pub(super) const CHECKSUM: Field = Field(INTERFACE, 0x03);
/// Whether one start gives one conversion.
pub(super) const ONE_SHOT: Field = Field(MODE0, 0x40);
/// Code of the delay before a first conversion.
pub(super) const DELAY: Field = Field(MODE0, 0x0F);
/// Code of the filter: sinc 1 to sinc 4, FIR.
pub(super) const FILTER: Field = Field(MODE1, 0xE0);
/// Whether inputs go to the modulator without amplifier.
pub(super) const BYPASS: Field = Field(MODE2, 0x80);
/// The amplifier's gain, as a power of two.
const GAIN: Field = Field(MODE2, 0x70);
/// Code of the data rate.
pub(super) const RATE: Field = Field(MODE2, 0x0F);

/// The registers of one chip.
#[derive(Clone, Debug)]
pub(super) struct Registers {
    /// Values by address.
    values: [u8; COUNT],
}

impl Registers {
    /// As after a reset, with this identity.
    pub(super) fn reset(identity: u8) -> Self {
        let mut values = reset_bytes(MAP);
        values[0] = identity;
        Self { values }
    }

    /// The value at an address; there is nothing beyond the last.
    pub(super) fn get(&self, address: u8) -> Option<u8> {
        self.values.get(usize::from(address)).copied()
    }

    /// The value at an address, zero beyond the last.
    fn at(&self, address: u8) -> u8 {
        self.get(address).unwrap_or(0)
    }

    /// Writes a register; what may not be written is not, and is noted.
    pub(super) fn set(&mut self, address: u8, value: u8) -> Result<(), Misuse> {
        if let Some(misuse) = write_refusal(MAP, address.into(), value.into()) {
            return Err(misuse);
        }
        if is_excluded(address, value) {
            return Err(Misuse::ForbiddenValue);
        }
        self.values[usize::from(address)] = value;
        Ok(())
    }

    /// What a field holds.
    pub(super) fn value(&self, field: Field) -> u8 {
        let Field(address, mask) = field;
        (self.at(address) & mask) >> mask.trailing_zeros()
    }

    /// Whether a field of one bit is set.
    pub(super) fn is_set(&self, flag: Field) -> bool {
        self.value(flag) != 0
    }

    /// Gain of the amplifier; one without it.
    pub(super) fn gain(&self) -> f64 {
        if self.is_set(BYPASS) { 1.0 } else { f64::from(1_u8 << self.value(GAIN)) }
    }

    /// Positive and negative input.
    pub(super) fn inputs(&self) -> (u8, u8) {
        (self.at(INPMUX) >> 4, self.at(INPMUX) & 0x0F)
    }

    /// Positive and negative reference.
    pub(super) fn references(&self) -> (u8, u8) {
        (self.at(REFMUX) >> 3, self.at(REFMUX) & 0x07)
    }

    /// Magnitude codes of the two test voltages.
    pub(super) fn test_codes(&self) -> (u8, u8) {
        (self.at(0x10) & 0x1F, self.at(0x11) & 0x1F)
    }

    /// Offset calibration: 24 bits, two's complement (section 9.6).
    pub(super) fn offset(&self) -> i32 {
        i32::from_be_bytes([self.at(0x09), self.at(0x08), self.at(0x07), 0]) >> 8
    }

    /// Full-scale calibration: 24 bits, 400000h is one (table 9-26).
    pub(super) fn full_scale(&self) -> u32 {
        u32::from_be_bytes([0, self.at(0x0C), self.at(0x0B), self.at(0x0A)])
    }

    /// Whether the FIR filter does not have this data rate (section 9.6, MODE2).
    pub(super) fn is_rate_excluded(&self) -> bool {
        self.value(FILTER) == 4 && !matches!(self.value(RATE), 0 | 1 | 2 | 4)
    }
}

/// Values that the field tables mark reserved, or that only an ADS1263 has, or chopping, which this
/// model does not do.
fn is_excluded(address: u8, value: u8) -> bool {
    let low = value & 0x0F;
    match address {
        INTERFACE => value & 0x03 == 3,
        MODE0 => low > 11 || value & 0x30 != 0,
        MODE1 => value >> 5 > 4 || value & 0x10 != 0 || value & 0x07 == 7,
        MODE2 => value >> 4 & 0x07 > 5,
        0x0D => low > 11 || value >> 4 > 11,
        0x0E => low > 10 || value >> 4 > 10,
        REFMUX => value >> 3 > 4 || value & 0x07 > 4,
        0x10 | 0x11 => value & 0x0F > 9 || value & 0x1F == 0x10,
        _ => false,
    }
}

/// Whether writing a register begins the conversion in progress anew (table 9-34).
pub(super) fn restarts(address: u8) -> bool {
    matches!(address, MODE0 | MODE1 | MODE2 | INPMUX | REFMUX)
}
