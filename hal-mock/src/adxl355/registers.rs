//! The register map of the ADXL355: what may be read and written where, and what a reset leaves.

use crate::registers::{self, Registers, both, fixed, read, write};
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

/// What may be written, and what power-up and reset leave in it (data sheet, Table "Register Map").
pub const MAP: &[Registers] = &[
    fixed(0x00, 0x00, 0xAD),
    fixed(0x01, 0x01, 0x1D),
    fixed(0x02, 0x02, 0xED),
    fixed(0x03, 0x03, 0x01),
    read(0x04, 0x11),
    both(0x1E, 0xFF, 0).to(0x23),
    both(0x24, 0x07, 0),
    both(0x25, 0xFF, 0).to(0x26),
    both(0x27, 0xFF, 0x01),
    both(0x28, 0x7F, 0),
    both(0x29, 0x7F, 0x60),
    both(0x2A, 0xFF, 0),
    both(0x2B, 0x07, 0),
    both(0x2C, 0xC3, 0x81),
    both(0x2D, 0x07, 0x01),
    both(0x2E, 0x03, 0),
    write(0x2F, 0xFF, 0),
    read(0x50, 0x54),
];

/// Why this write is forbidden, if it is: the register holds `held`, and the chip is measuring or not.
pub fn write_refusal(address: u8, value: u8, held: u8, is_measuring: bool) -> Option<Misuse> {
    registers::write_refusal(MAP, address.into(), value.into()).or_else(|| {
        let is_bad = is_forbidden(address, value)
            || is_measuring && !may_change_measuring(address, value, held);
        is_bad.then_some(Misuse::ForbiddenValue)
    })
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
