//! The register map of the ADXL355: what may be read and written where, and what a reset leaves.

use crate::violation::Misuse;

/// Addresses that hold something, up to the last.
pub const SIZE: usize = 0x30;

/// Status: data ready, FIFO full or overrun, settings being loaded; a read clears it.
pub const STATUS: u8 = 0x04;
/// Number of values in the FIFO.
pub const FIFO_ENTRIES: u8 = 0x05;
/// Upper four bits of the temperature.
pub const TEMP2: u8 = 0x06;
/// Lower byte of the temperature.
pub const TEMP1: u8 = 0x07;
/// Upper byte of the acceleration along x; each axis has three bytes, 20 bits from the left.
pub const XDATA3: u8 = 0x08;
/// Lower byte of the acceleration along z, with four bits of data.
pub const ZDATA1: u8 = 0x10;
/// Where the FIFO is read, three bytes a value.
pub const FIFO_DATA: u8 = 0x11;
/// Upper byte of the offset of x; each axis has two bytes, added to the upper 16 of its 20 bits.
pub const OFFSET_X_H: u8 = 0x1E;
/// High-pass corner and output data rate.
pub const FILTER: u8 = 0x28;
/// Number of values, 1 to 96, from which on the FIFO counts as full.
pub const FIFO_SAMPLES: u8 = 0x29;
/// Which events go to the interrupt pins.
pub const INT_MAP: u8 = 0x2A;
/// Synchronisation of the samples with an external clock.
pub const SYNC: u8 = 0x2B;
/// Range in the lowest two bits (1 for 256 000 counts per g, halved by each further code).
pub const RANGE: u8 = 0x2C;
/// Power control: standby, and whether the data-ready pin is off.
pub const POWER_CTL: u8 = 0x2D;
/// Self-test: mode and force, which both bits together switch on.
pub const SELF_TEST: u8 = 0x2E;
/// Software reset, by writing [`RESET_CODE`].
pub const RESET: u8 = 0x2F;
/// First of the shadow registers.
pub const SHADOW: u8 = 0x50;
/// Last of the shadow registers.
pub const SHADOW_LAST: u8 = 0x54;

/// Standby bit of the power control.
pub const STANDBY: u8 = 0x01;
/// Data-ready pin off, in the power control.
pub const DRDY_OFF: u8 = 0x04;
/// What the reset register takes.
pub const RESET_CODE: u8 = 0x52;

/// What power-up and reset leave in the registers (data sheet, Table "Register Map").
pub const DEFAULTS: [u8; SIZE] = {
    let mut values = [0; SIZE];
    values[0x00] = 0xAD;
    values[0x01] = 0x1D;
    values[0x02] = 0xED;
    values[0x03] = 0x01;
    values[0x27] = 0x01;
    values[0x29] = 0x60;
    values[0x2C] = 0x81;
    values[0x2D] = STANDBY;
    values
};

/// Why a read of an address is forbidden, or none where it is allowed.
#[must_use]
pub fn read_refusal(address: u8) -> Option<Misuse> {
    match address {
        0x00..=FIFO_DATA | OFFSET_X_H..=SELF_TEST | SHADOW..=SHADOW_LAST => None,
        RESET => Some(Misuse::WriteOnly),
        _ => Some(Misuse::UnknownRegister),
    }
}

/// Why this write is forbidden, if it is: the register holds `held`, and the chip is measuring or not.
#[must_use]
pub fn write_refusal(address: u8, value: u8, held: u8, is_measuring: bool) -> Option<Misuse> {
    match address {
        0x00..=FIFO_DATA | SHADOW..=SHADOW_LAST => Some(Misuse::ReadOnly),
        OFFSET_X_H..=RESET => {
            if value & reserved(address) != 0 {
                Some(Misuse::ReservedBits)
            } else if is_forbidden(address, value)
                || is_measuring && !may_change_measuring(address, value, held)
            {
                Some(Misuse::ForbiddenValue)
            } else {
                None
            }
        }
        _ => Some(Misuse::UnknownRegister),
    }
}

/// Bits that must be written as zero.
const fn reserved(address: u8) -> u8 {
    match address {
        0x24 | SYNC | POWER_CTL => 0xF8,
        FILTER | FIFO_SAMPLES => 0x80,
        RANGE => 0x3C,
        SELF_TEST => 0xFC,
        _ => 0,
    }
}

/// Values that the tables of the registers do not list.
const fn is_forbidden(address: u8, value: u8) -> bool {
    match address {
        FILTER => value & 0x0F > 10 || value >> 4 > 6,
        FIFO_SAMPLES => value == 0 || value > 96,
        SYNC => value & 0x03 == 3,
        RANGE => matches!(value & 0x03, 0),
        RESET => value != RESET_CODE,
        _ => false,
    }
}

/// What may change while the chip measures (Register Map, note): the high-pass corner, interrupts,
/// self-test, reset and the power control itself.
const fn may_change_measuring(address: u8, value: u8, held: u8) -> bool {
    match address {
        FILTER => value & 0x0F == held & 0x0F,
        INT_MAP | POWER_CTL | SELF_TEST | RESET => true,
        _ => false,
    }
}
