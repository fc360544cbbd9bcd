//! Flash of the board's kind, two pages of it, which may lose its supply.

use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

use firmware::storage::FlashStore;

/// Bytes of a page and of a word of the board's flash (STM32L475, RM0351, 3.3).
const PAGE: usize = 2048;
/// Bytes of a word: it is programmed at once, with its check bits, and once between two erasures.
const WORD: usize = 8;
/// Bytes of both pages.
pub const BYTES: usize = 2 * PAGE;

/// The flash. A word that was being programmed when the supply was lost is not modelled, which the
/// controller would report as an uncorrectable one.
#[derive(Clone, Debug)]
pub struct Flash {
    bytes: [u8; BYTES],
    is_written: [bool; BYTES / WORD],
    /// Words that may be written or erased before the supply is lost; none for ever so many.
    pub left: Option<usize>,
}

/// The supply is gone, or a rule was broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// The supply is gone.
    Supply,
    /// Bytes that there are not.
    Misuse,
}

impl NorFlashError for Trouble {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl Default for Flash {
    /// All of it erased.
    fn default() -> Self {
        Self::holding([0xFF; BYTES])
    }
}

impl Flash {
    /// One that holds something; a word of ones was never written.
    #[must_use]
    pub fn holding(bytes: [u8; BYTES]) -> Self {
        let mut is_written = [false; BYTES / WORD];
        for (is_written, word) in is_written.iter_mut().zip(bytes.chunks(WORD)) {
            *is_written = word.iter().any(|byte| *byte != 0xFF);
        }
        Self { bytes, is_written, left: None }
    }

    /// Words that the memory holds.
    #[must_use]
    pub fn bytes(&self) -> &[u8; BYTES] {
        &self.bytes
    }

    /// A store of axis misalignments in it.
    #[must_use]
    pub fn store(self) -> FlashStore<Self> {
        FlashStore::new(self, 0)
    }

    /// Takes one unit of what is left before the supply is lost.
    fn spend(&mut self) -> Result<(), Trouble> {
        if let Some(left) = &mut self.left {
            *left = left.checked_sub(1).ok_or(Trouble::Supply)?;
        }
        Ok(())
    }
}

impl ErrorType for Flash {
    type Error = Trouble;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Trouble> {
        let from = offset as usize;
        bytes.copy_from_slice(self.bytes.get(from..from + bytes.len()).ok_or(Trouble::Misuse)?);
        Ok(())
    }

    fn capacity(&self) -> usize {
        BYTES
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = PAGE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Trouble> {
        let (from, to) = (from as usize, to as usize);
        assert!(from.is_multiple_of(PAGE) && to.is_multiple_of(PAGE), "whole pages only");
        for word in from / WORD..to / WORD {
            self.spend()?;
            self.bytes[word * WORD..(word + 1) * WORD].fill(0xFF);
            self.is_written[word] = false;
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Trouble> {
        let offset = offset as usize;
        let are_words = offset.is_multiple_of(WORD) && bytes.len().is_multiple_of(WORD);
        assert!(are_words, "whole words only");
        for (word, written) in (offset / WORD..).zip(bytes.chunks(WORD)) {
            assert!(!self.is_written[word], "a word is written once");
            self.spend()?;
            self.is_written[word] = true;
            self.bytes[word * WORD..(word + 1) * WORD].copy_from_slice(written);
        }
        Ok(())
    }
}
