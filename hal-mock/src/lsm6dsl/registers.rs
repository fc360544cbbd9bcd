//! The register map of the LSM6DSL: what may be read and written where, and what a reset leaves
//! (ST data sheet, tables "Registers address map" and those of each register).

use crate::violation::Misuse;

/// Addresses up to the last.
pub const SIZE: usize = 0x76;

/// Identity of the chip, 0x6A.
pub const WHO_AM_I: u8 = 0x0F;
/// Output rate and range of the accelerometers.
pub const CTRL1_XL: u8 = 0x10;
/// Output rate and range of the gyros.
pub const CTRL2_G: u8 = 0x11;
/// Common control: boot, block data update, address increment, software reset.
pub const CTRL3_C: u8 = 0x12;
/// Sleep mode of the gyros, and masks of interrupts.
pub const CTRL4_C: u8 = 0x13;
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

/// What power-up and software reset leave in the registers.
pub const DEFAULTS: [u8; SIZE] = {
    let mut values = [0; SIZE];
    values[WHO_AM_I as usize] = 0x6A;
    values[CTRL3_C as usize] = IF_INC;
    values[0x18] = 0xE0;
    values
};

/// Why a read of an address is forbidden, or none where it is allowed.
#[must_use]
pub fn read_refusal(address: u8) -> Option<Misuse> {
    let is_known = matches!(address,
        0x01 | 0x04..=0x0B | 0x0D..=0x1E | 0x20..=0x42 | 0x49..=0x54 | 0x58..=0x5F | 0x66..=0x6A | 0x73..=0x75);
    (!is_known).then_some(Misuse::UnknownRegister)
}

/// Why a write of a value to an address is forbidden, or none where it is allowed.
#[must_use]
pub fn write_refusal(address: u8, value: u8) -> Option<Misuse> {
    match address {
        WHO_AM_I | 0x1B..=0x1E | 0x20..=0x42 | 0x49..=0x54 | 0x66..=0x6A => Some(Misuse::ReadOnly),
        0x01 | 0x04..=0x0B | 0x0D..=0x1A | 0x58..=0x5F | 0x73..=0x75 => {
            if value & reserved(address) != 0 {
                Some(Misuse::ReservedBits)
            } else {
                is_forbidden(address, value).then_some(Misuse::ForbiddenValue)
            }
        }
        _ => Some(Misuse::UnknownRegister),
    }
}

/// Bits that must be written as zero.
const fn reserved(address: u8) -> u8 {
    match address {
        CTRL2_G | CTRL4_C => 0x01,
        0x15 => 0x04,
        0x16 | 0x18 => 0x0B,
        0x17 => 0x02,
        0x19 => 0x40,
        _ => 0,
    }
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
#[must_use]
pub fn hertz(control: u8) -> Option<f64> {
    match control >> 4 {
        0 => None,
        11 => Some(1.6),
        code => Some(6.5 * f64::from(1_u32 << code)),
    }
}

/// Unit of the gyro, m°/s per count, for its control register.
#[must_use]
pub fn rate_unit_mdps(control: u8) -> f64 {
    if control & 0x02 != 0 {
        return 4.375;
    }
    [8.75, 17.5, 35.0, 70.0][usize::from(control >> 2 & 3)]
}

/// Unit of the accelerometer, mg per count, for its control register.
#[must_use]
pub fn force_unit_mg(control: u8) -> f64 {
    [0.061, 0.488, 0.122, 0.244][usize::from(control >> 2 & 3)]
}
