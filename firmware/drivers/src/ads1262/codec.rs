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
    const NEW: u8 = 1 << 6;
    const EXTERNAL_CLOCK: u8 = 1 << 5;
    const REFERENCE_LOW: u8 = 1 << 4;
    const AMPLIFIER_LOW: u8 = 1 << 3;
    const AMPLIFIER_HIGH: u8 = 1 << 2;
    const AMPLIFIER_DIFFERENCE: u8 = 1 << 1;
    const RESET: u8 = 1;
    const AMPLIFIER: u8 = Self::AMPLIFIER_LOW | Self::AMPLIFIER_HIGH | Self::AMPLIFIER_DIFFERENCE;

    const fn has(self, bits: u8) -> bool {
        self.0 & bits != 0
    }

    /// The conversion has not been read before.
    #[must_use]
    pub const fn is_new(self) -> bool {
        self.has(Self::NEW)
    }

    /// The chip runs from a clock or crystal at its pins: the data rate is not what was configured.
    #[must_use]
    pub const fn is_clock_external(self) -> bool {
        self.has(Self::EXTERNAL_CLOCK)
    }

    /// The reference is below 0.4 V.
    #[must_use]
    pub const fn is_reference_low(self) -> bool {
        self.has(Self::REFERENCE_LOW)
    }

    /// An output of the amplifier came within 0.2 V of a supply, or their difference left 105 % of
    /// the range.
    #[must_use]
    pub const fn is_amplifier_overdriven(self) -> bool {
        self.has(Self::AMPLIFIER)
    }

    /// The chip was reset since its reset flag was cleared.
    #[must_use]
    pub const fn is_reset(self) -> bool {
        self.has(Self::RESET)
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
    if status.is_reset() {
        return Err(Fault::Reset);
    }
    if status.is_reference_low() {
        return Err(Fault::Alarm { status: status.0 });
    }
    let code = i32::from_be_bytes(data);
    let is_at_end = code == i32::MAX || code == i32::MIN;
    let is_clipped = is_at_end || status.is_amplifier_overdriven();
    Ok(Conversion { code, is_new: status.is_new(), is_clipped, status })
}
