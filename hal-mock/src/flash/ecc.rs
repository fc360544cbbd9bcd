//! The error correcting code of the flash: 8 check bits for the 64 data bits of a row, which correct one
//! wrong bit and detect two.
//!
//! Which code the chip has is not published. This one is an odd-weight-column code (M.-Y. Hsiao, "A class
//! of optimal minimum odd-weight-column SEC-DED codes", IBM Journal of Research and Development 14, 1970),
//! chosen for what is known of the chip: a row of zeros has check bits of zeros, since it may be programmed
//! over any other (RM0351, 3.3.7); a row that was programmed with ones is no longer an erased one (J. Wagner,
//! efton.sk/STM32/gotcha/g99.html), here because its check bits are zeros. Three wrong bits or more may pass
//! for one or for none, as with any code of this kind.

/// Data and check bits of a row, as the cells hold them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Word {
    /// The data; the byte of the lowest address is the least significant one.
    pub(super) data: u64,
    /// The check bits.
    pub(super) check: u8,
}

/// What the check of a row found when it was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ecc {
    /// Nothing wrong: the row is erased, or its check bits fit its data.
    Sound,
    /// One wrong bit, which is corrected in what was read (ECCC); the cells stay as they are.
    Corrected,
    /// Two wrong bits (ECCD): the non-maskable interrupt is raised, and the data are not to be trusted.
    Uncorrectable,
}

impl Word {
    /// An erased row: all 72 bits are ones.
    pub(super) const ERASED: Self = Self { data: u64::MAX, check: u8::MAX };

    /// A row of these data with the check bits that belong to them.
    pub(super) fn of(data: u64) -> Self {
        Self { data, check: check(data) }
    }

    /// What reading the row gives: its data, with a single wrong bit corrected, and the finding. A wrong bit
    /// in an erased row is corrected, too (RM0351, 3.3.2). The manual promises nothing about two wrong bits in
    /// an erased row: here they are detected as in any other.
    pub(super) fn read(self) -> (u64, Ecc) {
        let syndrome = check(self.data) ^ self.check;
        let cleared = self.data.count_zeros() + self.check.count_zeros();
        if syndrome == 0 || cleared == 0 {
            return (self.data, Ecc::Sound);
        }
        match COLUMNS.iter().position(|column| *column == syndrome) {
            _ if cleared == 1 => (Self::ERASED.data, Ecc::Corrected),
            Some(bit) => (self.data ^ (1 << bit), Ecc::Corrected),
            None if syndrome.is_power_of_two() => (self.data, Ecc::Corrected),
            None => (self.data, Ecc::Uncorrectable),
        }
    }
}

/// The check bits that each data bit, the least significant one first, contributes to.
const COLUMNS: [u8; 64] = columns();

/// All 56 columns of weight 3, and eight of weight 5 in which each check bit occurs equally often.
const fn columns() -> [u8; 64] {
    let mut columns = [0; 64];
    let (mut count, mut candidate) = (0, 0_u8);
    while count < 56 {
        if candidate.count_ones() == 3 {
            columns[count] = candidate;
            count += 1;
        }
        candidate += 1;
    }
    while count < 64 {
        columns[count] = 0b1_1111_u8.rotate_left(count as u32 - 56);
        count += 1;
    }
    columns
}

/// The check bits of these data: the sum modulo two of the columns of all bits that are ones.
fn check(data: u64) -> u8 {
    let ones = (0..64).filter(|bit| data >> bit & 1 == 1);
    ones.fold(0, |sum, bit: usize| sum ^ COLUMNS[bit])
}
