//! The register map: reset values, what may be written, and what the values mean (SBAS661C 9.6).

use crate::violation::Misuse;

/// Registers of an ADS1262 (an ADS1263 has six more).
pub(super) const COUNT: usize = 21;

/// Reference, level shift and reset flag (9.6, POWER).
pub(super) const POWER: u8 = 0x01;
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

/// Values after a reset and bits that must be written as zero, by address (table 9-34).
const MAP: [(u8, u8); COUNT] = [
    (0x00, 0x00), // ID: device 0, revision 0; read only
    (0x11, 0xEC), // POWER
    (0x05, 0xF0), // INTERFACE
    (0x00, 0x00), // MODE0
    (0x80, 0x00), // MODE1
    (0x04, 0x00), // MODE2
    (0x01, 0x00), // INPMUX
    (0x00, 0x00), // OFCAL0
    (0x00, 0x00), // OFCAL1
    (0x00, 0x00), // OFCAL2
    (0x00, 0x00), // FSCAL0
    (0x00, 0x00), // FSCAL1
    (0x40, 0x00), // FSCAL2
    (0xBB, 0x00), // IDACMUX
    (0x00, 0x00), // IDACMAG
    (0x00, 0xC0), // REFMUX
    (0x00, 0x60), // TDACP
    (0x00, 0x60), // TDACN
    (0x00, 0x00), // GPIOCON
    (0x00, 0x00), // GPIODIR
    (0x00, 0x00), // GPIODAT
];

/// The registers of one chip.
#[derive(Clone, Debug)]
pub(super) struct Registers {
    /// Values by address.
    values: [u8; COUNT],
}

impl Registers {
    /// As after a reset, with this identity.
    pub(super) fn reset(identity: u8) -> Self {
        let mut values = MAP.map(|(value, _)| value);
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

    /// Writes a register; what may not be written is not, and is told.
    pub(super) fn set(&mut self, address: u8, value: u8) -> Result<(), Misuse> {
        let index = usize::from(address);
        let (_, reserved) = *MAP.get(index).ok_or(Misuse::UnknownRegister)?;
        if index == 0 {
            return Err(Misuse::ReadOnly);
        }
        if value & reserved != 0 {
            return Err(Misuse::ReservedBits);
        }
        if is_excluded(address, value) {
            return Err(Misuse::ForbiddenValue);
        }
        self.values[index] = value;
        Ok(())
    }

    /// The reset flag, until it is cleared.
    pub(super) fn reset_flag(&self) -> bool {
        self.at(POWER) & 0x10 != 0
    }

    /// Whether the reference inside the chip is on.
    pub(super) fn is_reference_on(&self) -> bool {
        self.at(POWER) & 0x01 != 0
    }

    /// Whether frames carry the status byte.
    pub(super) fn has_status(&self) -> bool {
        self.at(0x02) & 0x04 != 0
    }

    /// Form of the checksum byte: 0 none, 1 sum, 2 CRC.
    pub(super) fn checksum_form(&self) -> u8 {
        self.at(0x02) & 0x03
    }

    /// Whether one start gives one conversion.
    pub(super) fn is_one_shot(&self) -> bool {
        self.at(MODE0) & 0x40 != 0
    }

    /// Code of the delay before a first conversion.
    pub(super) fn delay(&self) -> u8 {
        self.at(MODE0) & 0x0F
    }

    /// Code of the filter: sinc 1 to sinc 4, FIR.
    pub(super) fn filter(&self) -> u8 {
        self.at(MODE1) >> 5
    }

    /// Code of the data rate.
    pub(super) fn rate(&self) -> u8 {
        self.at(MODE2) & 0x0F
    }

    /// Whether inputs go to the modulator without amplifier.
    pub(super) fn is_amplifier_bypassed(&self) -> bool {
        self.at(MODE2) & 0x80 != 0
    }

    /// Gain of the amplifier; one without it.
    pub(super) fn gain(&self) -> f64 {
        if self.is_amplifier_bypassed() {
            return 1.0;
        }
        f64::from(1_u8 << (self.at(MODE2) >> 4 & 0x07))
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
        self.filter() == 4 && !matches!(self.rate(), 0 | 1 | 2 | 4)
    }
}

/// Values that the field tables mark reserved, or that only an ADS1263 has, or chopping, which this
/// model does not do.
fn is_excluded(address: u8, value: u8) -> bool {
    let low = value & 0x0F;
    match address {
        0x02 => value & 0x03 == 3,
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
