//! Values that the data sheet excludes, alone or beside other registers.

use super::map::{ADDRESSES, address};

/// Largest VMAX (6.3.1).
const LARGEST_VELOCITY: u32 = (1 << 23) - 512;

/// Whether the data sheet forbids a value where the registers stand as they do.
pub(super) fn is_forbidden(registers: &[u32; ADDRESSES], address: u8, data: u32) -> bool {
    match address {
        // test_mode: not for the user (6.1).
        address::GCONF => data & (1 << 17) != 0,
        // Burning the memory cannot be undone (6.1.1).
        address::OTP_PROG => data >> 8 == 0xBD,
        address::SHORT_CONF => data & 0xF < 4 || data >> 8 & 0xF < 2,
        address::GLOBALSCALER => matches!(data, 1..=31 | 257..),
        address::VMAX => data > LARGEST_VELOCITY,
        address::XTARGET => cannot_end(registers, registers[usize::from(address::RAMPMODE)]),
        address::RAMPMODE => is_under_way(registers) && cannot_end(registers, data),
        // Soft stop not together with StallGuard2 (6.3.2.1).
        address::SW_MODE => data & 0xC00 == 0xC00,
        address::CHOPCONF => is_bad_chopper(data),
        _ => false,
    }
}

/// Positioning without D1 or VSTOP (6.3.1).
fn cannot_end(registers: &[u32; ADDRESSES], mode: u32) -> bool {
    let is_zero = |address: u8| registers[usize::from(address)] == 0;
    mode == 0 && (is_zero(address::D1) || is_zero(address::VSTOP))
}

/// Whether VMAX lets the motor move.
fn is_under_way(registers: &[u32; ADDRESSES]) -> bool {
    registers[usize::from(address::VMAX)] != 0
}

/// A short off time needs a long blank time, and the hysteresis must not pass 16 (6.5.2).
fn is_bad_chopper(data: u32) -> bool {
    let (off, blank) = (data & 0xF, data >> 15 & 3);
    let (start, end) = ((data >> 4 & 7) + 1, data >> 7 & 0xF);
    let is_spread = data & (1 << 14) == 0;
    (off == 1 && blank < 2) || (is_spread && start + end > 16 + 3)
}
