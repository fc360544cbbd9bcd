//! The bytes of a conversion on the bus (SBAS661C figures 9-43 to 9-48).

use heapless::Vec;

use super::registers::{CHECKSUM, Registers, STATUS};
use crate::checksum::remainder;

/// Bytes of one conversion as far as they are sent.
pub(super) type Frame = Vec<u8, 6>;

/// A frame in the form that INTERFACE asks for: status, four bytes of data, checksum.
pub(super) fn frame(registers: &Registers, status: u8, code: i32) -> Frame {
    let data = code.to_be_bytes();
    let status = registers.is_set(STATUS).then_some(status);
    let check = match registers.value(CHECKSUM) {
        1 => Some(sum(data)),
        2 => Some(remainder(u32::from_be_bytes(data))),
        _ => None,
    };
    status.into_iter().chain(data).chain(check).collect()
}

/// The four bytes and 9Bh, of which the low byte is kept (checksum mode).
fn sum(data: [u8; 4]) -> u8 {
    let whole: u32 = data.iter().map(|&byte| u32::from(byte)).sum();
    ((whole + 0x9B) & 0xFF) as u8
}
