//! Banks, pages and rows of the flash, and how long its operations take.

use core::time::Duration;

/// Bytes of the flash of the STM32L475VG (DS10969).
pub const SIZE: usize = 1024 * 1024;
/// Bytes of a page, which is erased at once (RM0351, 3.3.1).
pub const PAGE: usize = 2048;
/// Bytes of a row, which is programmed at once, with its check bits: the manual's double word.
pub const ROW: usize = 8;
/// Bytes of a bank: 256 pages.
pub const BANK: usize = SIZE / 2;

/// One of the two halves of the flash. While one is programmed or erased, the other can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bank {
    /// The manual's bank 1, from the first byte on.
    Lower,
    /// The manual's bank 2.
    Upper,
}

impl Bank {
    /// The bank of a byte, by its offset from the start of the flash.
    #[must_use]
    pub const fn of(offset: u32) -> Self {
        if (offset as usize) < BANK { Self::Lower } else { Self::Upper }
    }

    /// Offset of its first byte from the start of the flash.
    #[must_use]
    pub const fn start(self) -> u32 {
        match self {
            Self::Lower => 0,
            Self::Upper => BANK as u32,
        }
    }
}

/// How long operations take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    /// Programming of a row.
    pub row: Duration,
    /// Erasure of a page.
    pub page: Duration,
    /// Erasure of a bank, or of both at once.
    pub bank: Duration,
}

impl Times {
    /// Typical times (DS10969, flash memory characteristics: 81.69 µs, 22.02 ms, 22.13 ms). The table's
    /// 20.91 ms for the 256 rows of a page is the first of them 256 times.
    pub const TYPICAL: Self = Self::nanoseconds(81_690, 22_020_000, 22_130_000);

    /// Longest times of the same table: 90.76 µs, 24.47 ms, 24.59 ms. Zephyr's driver has the second as well
    /// (`flash_stm32.c`: "maximum erase time of 24.47ms for a 2K sector"), but its issue 16934 measured that
    /// 25 ms are not always enough, and 30 ms are.
    pub const LONGEST: Self = Self::nanoseconds(90_760, 24_470_000, 24_590_000);

    /// Times of a row, a page and a bank, ns.
    const fn nanoseconds(row: u64, page: u64, bank: u64) -> Self {
        let [row, page, bank] =
            [Duration::from_nanos(row), Duration::from_nanos(page), Duration::from_nanos(bank)];
        Self { row, page, bank }
    }
}
