//! Checksum of the data kept in flash: CRC-32 of IEEE 802.3 (reflected polynomial 0xEDB8 8320,
//! initial value and final XOR all ones). The saved calibration, the reference table (etalon) and
//! the stored heading are all guarded by it, so one routine serves every block.

/// Remainders of the reflected IEEE 802.3 polynomial for four bits: a table of 64 bytes, where one
/// for whole bytes would take 1 KB of flash.
const NIBBLE: [u32; 16] = nibble_remainders();

/// Computes [`NIBBLE`] at compile time, bit by bit, from the definition of the polynomial.
const fn nibble_remainders() -> [u32; 16] {
    let mut remainders = [0; 16];
    let mut nibble = 0;
    while nibble < 16 {
        let mut crc = nibble as u32;
        let mut bit = 0;
        while bit < 4 {
            crc = (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg());
            bit += 1;
        }
        remainders[nibble] = crc;
        nibble += 1;
    }
    remainders
}

/// The CRC-32 of words as little-endian bytes, 60 instructions a word.
#[inline]
pub(crate) fn crc32(words: impl Iterator<Item = u32>) -> u32 {
    let mut crc = u32::MAX;
    for word in words {
        // The remainder is linear: a little-endian word enters whole.
        crc ^= word;
        for _ in 0..8 {
            crc = (crc >> 4) ^ NIBBLE[(crc & 15) as usize];
        }
    }
    !crc
}
