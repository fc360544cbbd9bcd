//! Decodes a data frame into a conversion or a fault (SBAS661C figures 9-43 to 9-48).
//!
//! The frame is status, four data bytes, sum. Of the two forms of the checksum byte this driver
//! takes the sum rather than the CRC:
//! - it is the form after a reset, so the frame of a chip that has restarted is still understood,
//!   and its reset flag is seen;
//! - its constant `9Bh` makes a line stuck low or high fail; the CRC of four zero bytes is zero;
//! - its definition is certain: for the CRC the data sheet's long division begins with zero, TI's
//!   example code with `FFh`;
//! - it costs four additions, the CRC eight table steps: a good frame is decoded in some 35
//!   instructions of a Cortex-M4.
//!
//! It finds every single wrong bit and every burst within a byte; of two wrong bits it misses those
//! in the same place of two bytes that change in opposite ways (one pair in twenty). No form covers
//! the status byte: a wrong bit there can cost a restart or a sample, not a wrong value.

use crate::fault::Fault;

/// Bytes of a frame.
pub const FRAME: usize = 6;

/// Added to the sum, so that all zeros are wrong (checksum mode, table 9-20).
const SUM_OFFSET: u8 = 0x9B;

/// The status byte (table 9-18).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status(pub u8);

impl Status {
    /// The conversion has not been read before.
    pub const NEW: Self = Self(1 << 6);
    /// The chip runs from a clock or crystal at its pins: the data rate is not what was configured.
    pub const EXTERNAL_CLOCK: Self = Self(1 << 5);
    /// The reference is below 0.4 V.
    pub const REFERENCE_LOW: Self = Self(1 << 4);
    /// An output of the amplifier came within 0.2 V of a supply, or their difference left 105 % of
    /// the range.
    pub const AMPLIFIER: Self = Self(1 << 3 | 1 << 2 | 1 << 1);
    /// The chip was reset since its reset flag was cleared.
    pub const RESET: Self = Self(1);

    /// Whether any of these bits is set.
    #[must_use]
    pub const fn has(self, bits: Self) -> bool {
        self.0 & bits.0 != 0
    }
}

/// One conversion of the input voltage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Conversion {
    /// Input voltage, 1 LSB = reference / (gain · 2³¹) (table 9-19).
    pub code: i32,
    /// Whether the conversion is new; otherwise the converter has nothing newer than the one read
    /// before.
    pub is_new: bool,
    /// Whether the input left the range of the amplifier or of the code; the value is invalid then.
    pub is_clipped: bool,
    /// The status byte of the frame.
    pub status: Status,
}

/// The checksum byte of four data bytes (checksum mode, table 9-20; the data sheet's printed example, `EBh` for
/// 12345678h, is wrong and is `AFh`, as TI has confirmed).
#[must_use]
pub const fn sum(data: [u8; 4]) -> u8 {
    let [a, b, c, d] = data;
    SUM_OFFSET.wrapping_add(a).wrapping_add(b).wrapping_add(c).wrapping_add(d)
}

/// Decodes a frame. The checksum is verified first, since no other byte of a disturbed transfer can
/// be trusted.
///
/// # Errors
/// [`Fault::Checksum`] if the sum is wrong; [`Fault::Reset`] if the chip has restarted;
/// [`Fault::Alarm`] if its reference has failed.
pub const fn decode(frame: [u8; FRAME]) -> Result<Conversion, Fault> {
    let [status, a, b, c, d, received] = frame;
    let data = [a, b, c, d];
    let status = Status(status);
    if sum(data) != received {
        return Err(Fault::Checksum);
    }
    if status.has(Status::RESET) {
        return Err(Fault::Reset);
    }
    if status.has(Status::REFERENCE_LOW) {
        return Err(Fault::Alarm { status: status.0 });
    }
    let code = i32::from_be_bytes(data);
    let is_at_end = code == i32::MAX || code == i32::MIN;
    let is_clipped = is_at_end || status.has(Status::AMPLIFIER);
    Ok(Conversion { code, is_new: status.has(Status::NEW), is_clipped, status })
}
