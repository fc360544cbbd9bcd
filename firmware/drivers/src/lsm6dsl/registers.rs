//! LSM6DSL: addresses and bits (ST data sheet `DocID028475`, Register mapping and description; ST's
//! own driver and Zephyr's agree with every address and mask here).

use core::time::Duration;

/// The 7-bit address with pin SA0 low.
pub const ADDRESS_LOW: u8 = 0x6A;
/// The 7-bit address with pin SA0 high.
pub const ADDRESS_HIGH: u8 = 0x6B;

/// Identity.
pub const WHO_AM_I: u8 = 0x0F;
/// Content of the identity register. LSM6DSM, ISM330DLC and LSM6DS3TR-C have the same identity and
/// the same registers.
pub const IDENTITY: u8 = 0x6A;
/// Rate and range of the accelerometer, first of the control registers.
pub const CTRL1_XL: u8 = 0x10;
/// Rate and range of the gyro.
pub const CTRL2_G: u8 = 0x11;
/// Reset, boot, block data update, address increment.
pub const CTRL3_C: u8 = 0x12;
/// Self-test.
pub const CTRL5_C: u8 = 0x14;
/// Status.
pub const STATUS: u8 = 0x1E;
/// First of temperature, gyro and accelerometer.
pub const OUT_TEMP_L: u8 = 0x20;

/// Loads the factory settings again.
pub const BOOT: u8 = 0x80;
/// Holds both bytes of an axis together.
pub const BLOCK_DATA_UPDATE: u8 = 0x40;
/// Counts addresses up in a burst; set after reset.
pub const INCREMENT: u8 = 0x04;
/// Resets the registers; clears itself.
pub const SOFTWARE_RESET: u8 = 0x01;

/// Accelerometer in its self-test: 52 Hz, ±4 g (ST's example `lsm6dsl_self_test`).
pub const TEST_CTRL1_XL: u8 = 0x38;
/// Gyro in its self-test: 208 Hz, ±2000 °/s (same source).
pub const TEST_CTRL2_G: u8 = 0x5C;
/// The self-test forces of gyro and accelerometer in their positive direction: `ST_G` 01, `ST_XL` 01.
pub const TEST_FORCES: u8 = 0x05;

/// The status register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status(pub u8);

impl Status {
    /// New data of accelerometer and gyro since they were last read.
    #[must_use]
    pub const fn is_fresh(self) -> bool {
        self.0 & 0x03 == 0x03
    }
}

/// Output data rate of gyro and accelerometer, which then sample together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum OutputRate {
    /// 12.5 Hz.
    Hz12 = 1,
    /// 26 Hz.
    Hz26 = 2,
    /// 52 Hz.
    Hz52 = 3,
    /// 104 Hz: the sway of a vehicle is sampled often enough to be integrated.
    #[default]
    Hz104 = 4,
    /// 208 Hz.
    Hz208 = 5,
    /// 416 Hz.
    Hz416 = 6,
}

impl OutputRate {
    /// Outputs a second, Hz, nominal: 13 Hz · 2ⁿ, of which the data sheet rounds the first to 12.5 Hz. Chips are off
    /// by some per cent.
    #[must_use]
    pub const fn hertz(self) -> u32 {
        13 << (self as u8 - 1)
    }

    /// Time from one output to the next, rounded down to nanoseconds.
    #[must_use]
    pub const fn period(self) -> Duration {
        Duration::from_nanos(1_000_000_000 / self.hertz() as u64)
    }

    const fn bits(self) -> u8 {
        (self as u8) << 4
    }
}

/// Range of the gyro. Linux' table calls 250 °/s 245 and leaves 125 °/s out, although its text names
/// it; ST's driver and the data sheet have both as here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum RateRange {
    /// ±125 °/s, more than the sway of any base.
    #[default]
    Dps125 = 0b001,
    /// ±250 °/s.
    Dps250 = 0b000,
    /// ±500 °/s.
    Dps500 = 0b010,
    /// ±1000 °/s.
    Dps1000 = 0b100,
    /// ±2000 °/s.
    Dps2000 = 0b110,
}

impl RateRange {
    /// Binary logarithm of the value of a count relative to that at ±125 °/s.
    #[must_use]
    pub const fn shift(self) -> u32 {
        match self {
            Self::Dps125 => 0,
            Self::Dps250 => 1,
            Self::Dps500 => 2,
            Self::Dps1000 => 3,
            Self::Dps2000 => 4,
        }
    }
}

/// Range of the accelerometer; the codes are not in order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum ForceRange {
    /// ±2 g.
    #[default]
    G2 = 0b00,
    /// ±4 g.
    G4 = 0b10,
    /// ±8 g.
    G8 = 0b11,
    /// ±16 g.
    G16 = 0b01,
}

impl ForceRange {
    /// Binary logarithm of the value of a count relative to that at ±2 g.
    #[must_use]
    pub const fn shift(self) -> u32 {
        match self {
            Self::G2 => 0,
            Self::G4 => 1,
            Self::G8 => 2,
            Self::G16 => 3,
        }
    }
}

/// `CTRL1_XL` for a rate and a range; the low-pass at half the rate.
#[must_use]
pub const fn control_force(rate: OutputRate, range: ForceRange) -> u8 {
    rate.bits() | (range as u8) << 2
}

/// `CTRL2_G` for a rate and a range.
#[must_use]
pub const fn control_rate(rate: OutputRate, range: RateRange) -> u8 {
    rate.bits() | (range as u8) << 1
}
