//! MT6835: commands, addresses and bits (data sheet rev. 1.3, SPI Interface and Register Map).
//!
//! Registers from 0x007 on are copies in RAM, loaded from the EEPROM at power-up. Bits without a
//! name belong to the maker and must be written back as they were read.

/// Command nibble: read one register.
pub const READ: u8 = 0x30;
/// Command nibble: write one register.
pub const WRITE: u8 = 0x60;
/// Burst read of the angle, its status and checksum.
pub const BURST: [u8; 2] = [0xA0, 0x03];

/// The byte that is free for the user.
pub const USER_ID: u16 = 0x001;
/// Zero position, upper 8 of 12 bits.
pub const ZERO_HIGH: u16 = 0x009;
/// Zero position, lower 4 bits, and the shape of the Z pulse.
pub const ZERO_LOW: u16 = 0x00A;
/// PWM output, and bit 5: table of corrections in use.
pub const CORRECTION: u16 = 0x00C;
/// Bit 3: direction of rotation; bits 2…0: hysteresis. (One public driver has the direction at bit 7;
/// four others have it at bit 3.)
pub const DIRECTION: u16 = 0x00D;
/// Bits 2…0: bandwidth.
pub const BANDWIDTH: u16 = 0x011;
/// Bits 7…6: state of the self-calibration.
pub const CALIBRATION: u16 = 0x113;

/// Bits of [`DIRECTION`] that are the user's.
pub const DIRECTION_MASK: u8 = 0x0F;
/// Bits of [`BANDWIDTH`] that are the user's.
pub const BANDWIDTH_MASK: u8 = 0x07;
/// The other direction of rotation.
pub const REVERSED: u8 = 0x08;

/// [`CALIBRATION`], upper two bits: it is running.
pub const CALIBRATION_RUNS: u8 = 0b01;
/// [`CALIBRATION`], upper two bits: it has failed.
pub const CALIBRATION_FAILED: u8 = 0b10;

/// Status bits of a burst: faster than the chip can follow (120 000 1/min).
pub const OVERSPEED: u8 = 0b001;
/// Status bits of a burst: the magnet is too weak or too far.
pub const WEAK_MAGNET: u8 = 0b010;
/// Status bits of a burst: the supply is too low.
pub const UNDERVOLTAGE: u8 = 0b100;

/// Hysteresis: the angle by which the shaft must turn back before the reading follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Hysteresis {
    /// 0.022°.
    Degrees0022 = 0,
    /// 0.044°.
    Degrees0044 = 1,
    /// 0.088°.
    Degrees0088 = 2,
    /// 0.176°.
    Degrees0176 = 3,
    /// No hysteresis: the reading of a stage at rest must not depend on the direction of the
    /// approach.
    #[default]
    Off = 4,
    /// 0.003°.
    Degrees0003 = 5,
    /// 0.006°.
    Degrees0006 = 6,
    /// 0.011°, the factory setting.
    Degrees0011 = 7,
}

/// Bandwidth of the angle filter, as a multiple of the narrowest. The data sheet gives no hertz.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Bandwidth {
    /// The narrowest bandwidth, with the least noise: the stage is read at rest.
    #[default]
    X1 = 0,
    /// Twice the narrowest bandwidth.
    X2 = 1,
    /// 4 times the narrowest bandwidth.
    X4 = 2,
    /// 8 times the narrowest bandwidth.
    X8 = 3,
    /// 16 times the narrowest bandwidth.
    X16 = 4,
    /// 32 times the narrowest bandwidth, the factory setting.
    X32 = 5,
    /// 64 times the narrowest bandwidth.
    X64 = 6,
    /// 128 times the narrowest bandwidth.
    X128 = 7,
}
