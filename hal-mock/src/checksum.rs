//! The checksum of the ADS1262 (CRC mode) and of the MT6835: both divide by x⁸ + x² + x + 1.
//!
//! Own reading, by long division: a driver's table or shift register is checked against it.

/// The divisor x⁸ + x² + x + 1.
const DIVISOR: u32 = 0x107;

/// The remainder of a message of up to 32 bits with eight zeros behind it, by long division as on paper.
/// Zeros before a shorter message change nothing.
pub(crate) fn remainder(message: u32) -> u8 {
    let mut rest = u64::from(message) << 8;
    for bit in (8..40).rev() {
        if rest >> bit & 1 == 1 {
            rest ^= u64::from(DIVISOR) << (bit - 8);
        }
    }
    rest as u8
}
