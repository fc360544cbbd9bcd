//! Checksum of the data kept in flash: CRC-32 of IEEE 802.3 (reflected polynomial 0xEDB8 8320,
//! initial value and final XOR all ones). The saved calibration, the reference table (etalon) and
//! the stored heading are all guarded by it, so one routine serves every block, the settings of an
//! instrument too. A record of numbers in flash is a version, numbers of eight bytes and the
//! checksum of both, all little-endian.

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
pub fn crc32(words: impl Iterator<Item = u32>) -> u32 {
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

/// Size of a record of so many numbers, bytes.
pub(crate) const fn record_bytes(numbers: usize) -> usize {
    4 + 8 * numbers + 4
}

/// Record of numbers; `BYTES` is their [`record_bytes`].
pub(crate) fn record<const BYTES: usize>(version: u32, numbers: &[u64]) -> [u8; BYTES] {
    let mut bytes = [0; BYTES];
    bytes[..4].copy_from_slice(&version.to_le_bytes());
    for (place, number) in bytes[4..].chunks_exact_mut(8).zip(numbers) {
        place.copy_from_slice(&number.to_le_bytes());
    }
    let checksum = crc32_of_bytes(&bytes[..BYTES - 4]);
    bytes[BYTES - 4..].copy_from_slice(&checksum.to_le_bytes());
    bytes
}

/// Numbers of a record; `None` where it is damaged, of another version, or of another length.
pub(crate) fn numbers<const NUMBERS: usize>(version: u32, bytes: &[u8]) -> Option<[u64; NUMBERS]> {
    let (kept, checksum) = bytes.split_last_chunk()?;
    let (found, numbers) = kept.split_first_chunk()?;
    let is_sound = u32::from_le_bytes(*checksum) == crc32_of_bytes(kept);
    let (numbers, rest) = numbers.as_chunks();
    let is_whole = is_sound && rest.is_empty() && u32::from_le_bytes(*found) == version;
    let numbers: &[[u8; 8]; NUMBERS] = numbers.try_into().ok().filter(|_| is_whole)?;
    Some(numbers.map(u64::from_le_bytes))
}

/// The CRC-32 of bytes, whose number is a multiple of four.
#[must_use]
pub fn crc32_of_bytes(bytes: &[u8]) -> u32 {
    let (words, _) = bytes.as_chunks();
    crc32(words.iter().map(|word| u32::from_le_bytes(*word)))
}
