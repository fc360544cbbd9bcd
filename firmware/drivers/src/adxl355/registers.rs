//! ADXL355: addresses and bits (data sheet rev. C, Register Map and Register Definitions).

use core::time::Duration;

/// First of four identity registers: maker, family, part, revision.
pub const DEVID_AD: u8 = 0x00;
/// Status; a read clears it.
pub const STATUS: u8 = 0x04;
/// First of the offset trims, and first of the registers that can be written.
pub const OFFSET_X_H: u8 = 0x1E;
/// High-pass corner and output data rate.
pub const FILTER: u8 = 0x28;
/// Interface speed, interrupt polarity and range.
pub const RANGE: u8 = 0x2C;
/// Standby, temperature and data-ready switches.
pub const POWER_CTL: u8 = 0x2D;
/// Self-test switches.
pub const SELF_TEST: u8 = 0x2E;
/// Takes [`RESET_CODE`].
pub const RESET: u8 = 0x2F;
/// First of five copies of the factory settings (Reset Register, note on software resets).
pub const SHADOW: u8 = 0x50;

/// The code that [`RESET`] takes.
pub const RESET_CODE: u8 = 0x52;
/// Maker, family and part of an ADXL355.
pub const IDENTITY: [u8; 3] = [0xAD, 0x1D, 0xED];

/// Range register: ±2 g, everything else as after reset.
pub const RANGE_2_G: u8 = 0x81;
/// Range register: ±8 g, everything else as after reset.
pub const RANGE_8_G: u8 = 0x83;
/// Power control: measuring, with temperature and data-ready.
pub const MEASURING: u8 = 0x00;
/// Power control: standby, which is also how the chip wakes from a reset.
pub const STANDBY: u8 = 0x01;
/// Self-test mode without the force.
pub const SELF_TEST_MODE: u8 = 0b01;
/// Self-test mode with the force.
pub const SELF_TEST_FORCE: u8 = 0b11;
/// No self-test.
pub const SELF_TEST_OFF: u8 = 0b00;

/// The status register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status(pub u8);

impl Status {
    /// New data since the last read of this register.
    #[must_use]
    pub const fn is_ready(self) -> bool {
        self.0 & 0x01 != 0
    }

    /// The factory settings are being loaded. The text under "Interrupts" calls it bit 1, which is
    /// `FIFO_FULL`; the register's own table says bit 4.
    #[must_use]
    pub const fn is_busy(self) -> bool {
        self.0 & 0x10 != 0
    }
}

/// Output data rate, with a low-pass corner at a quarter of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum OutputRate {
    /// 4000 Hz.
    Hz4000 = 0,
    /// 2000 Hz.
    Hz2000 = 1,
    /// 1000 Hz.
    Hz1000 = 2,
    /// 500 Hz.
    Hz500 = 3,
    /// 250 Hz.
    Hz250 = 4,
    /// 125 Hz: the sway of a vehicle passes, the noise of the chip is averaged.
    #[default]
    Hz125 = 5,
    /// 62.5 Hz.
    Hz62 = 6,
    /// 31.25 Hz.
    Hz31 = 7,
    /// 15.625 Hz.
    Hz15 = 8,
    /// 7.8125 Hz.
    Hz7 = 9,
    /// 3.90625 Hz.
    Hz3 = 10,
}

impl OutputRate {
    /// Time from one sample to the next, exact: 250 µs · 2ⁿ.
    #[must_use]
    pub const fn period(self) -> Duration {
        Duration::from_micros(250 << self as u8)
    }
}
