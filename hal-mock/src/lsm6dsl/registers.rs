//! The register map of the LSM6DSL: what may be read and written where, and what a reset leaves
//! (ST data sheet, tables "Registers address map" and those of each register).

use crate::registers::{self, Registers, both, fixed, read};
use crate::violation::Misuse;

/// Addresses up to the last.
pub const SIZE: usize = 0x76;

/// Output rate and range of the accelerometers.
pub const CTRL1_XL: u8 = 0x10;
/// Output rate and range of the gyros.
pub const CTRL2_G: u8 = 0x11;
/// Common control: boot, block data update, address increment, software reset.
pub const CTRL3_C: u8 = 0x12;
/// Rounding of burst reads, and self-test of both sensors.
pub const CTRL5_C: u8 = 0x14;
/// Status: which sensors have outputs that were not read.
pub const STATUS: u8 = 0x1E;
/// First of the outputs: temperature, gyro, accelerometer.
pub const OUT_TEMP_L: u8 = 0x20;
/// First byte of the gyro.
pub const OUTX_L_G: u8 = 0x22;
/// First byte of the accelerometer.
pub const OUTX_L_XL: u8 = 0x28;
/// Last of the outputs.
pub const OUTZ_H_XL: u8 = 0x2D;

/// Boot bit of [`CTRL3_C`].
pub const BOOT: u8 = 0x80;
/// Block data update in [`CTRL3_C`]: an axis does not change between its two bytes.
pub const BDU: u8 = 0x40;
/// Address increment in [`CTRL3_C`]: each byte of a transfer has the next address.
pub const IF_INC: u8 = 0x04;
/// Software reset in [`CTRL3_C`]; the chip clears the bit when it has reset.
pub const SW_RESET: u8 = 0x01;

/// What may be written, and what power-up and software reset leave in it.
pub const MAP: &[Registers] = &[
    both(0x01, 0xFF, 0),
    both(0x04, 0xFF, 0).to(0x0B),
    both(0x0D, 0xFF, 0).to(0x0E),
    fixed(0x0F, 0x0F, 0x6A),
    both(0x10, 0xFF, 0),
    both(0x11, 0xFE, 0),
    both(0x12, 0xFF, 0x04),
    both(0x13, 0xFE, 0),
    both(0x14, 0xFF, 0),
    both(0x15, 0xFB, 0),
    both(0x16, 0xF4, 0),
    both(0x17, 0xFD, 0),
    both(0x18, 0xF4, 0xE0),
    both(0x19, 0xBF, 0),
    both(0x1A, 0xFF, 0),
    read(0x1B, 0x1E),
    read(0x20, 0x42),
    read(0x49, 0x54),
    both(0x58, 0xFF, 0).to(0x5F),
    read(0x66, 0x6A),
    both(0x73, 0xFF, 0).to(0x75),
];

/// Why a write of a value to an address is forbidden, or none where it is allowed.
pub fn write_refusal(address: u8, value: u8) -> Option<Misuse> {
    registers::write_refusal(MAP, address.into(), value.into())
        .or_else(|| is_forbidden(address, value).then_some(Misuse::ForbiddenValue))
}

/// Values that the tables of the registers do not list, and what is not modelled here and would
/// change what is read: big-endian outputs.
const fn is_forbidden(address: u8, value: u8) -> bool {
    match address {
        CTRL1_XL => value >> 4 > 11,
        CTRL2_G => value >> 4 > 10,
        CTRL3_C => value & 0x02 != 0,
        CTRL5_C => value & 0x03 == 3 || value & 0x0C == 0x08,
        _ => false,
    }
}

/// Outputs a second of a sensor whose control register holds this; none where it is off.
pub fn hertz(control: u8) -> Option<f64> {
    match control >> 4 {
        0 => None,
        11 => Some(1.6),
        code => Some(6.5 * f64::from(1_u32 << code)),
    }
}

/// Unit of the gyro, m°/s per count, for its control register.
pub fn rate_unit_mdps(control: u8) -> f64 {
    if control & 0x02 != 0 {
        return 4.375;
    }
    [8.75, 17.5, 35.0, 70.0][usize::from(control >> 2 & 3)]
}

/// Unit of the accelerometer, mg per count, for its control register.
pub fn force_unit_mg(control: u8) -> f64 {
    [0.061, 0.488, 0.122, 0.244][usize::from(control >> 2 & 3)]
}
