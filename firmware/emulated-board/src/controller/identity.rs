//! The unique number of the device: 96 bits in the system memory, which can be read alone (RM0351, 49.1).

use super::Refused;

/// Where its words begin, in the last kilobyte of the system memory.
const OFFSET: u32 = 0x190;
/// The number of this device: place on the wafer, wafer and lot.
pub const NUMBER: [u8; 12] = *b"\x2A\0\x15\0\x0725PMHP ";

/// Reads a word of it.
pub fn read(offset: u32) -> Result<u32, Refused> {
    let (words, _) = NUMBER.as_chunks();
    let place = offset.checked_sub(OFFSET).ok_or(Refused::Unknown)? / 4;
    words.get(place as usize).map(|word| u32::from_le_bytes(*word)).ok_or(Refused::Unknown)
}
