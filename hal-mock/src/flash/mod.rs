//! The flash of the STM32L475VG, without its registers: cells, error correction, operations in time, and a
//! supply that may be lost at any moment.
//!
//! - Two banks of 256 pages of 2 KiB; all bits of an erased page are ones.
//! - A row of 8 bytes is programmed at once, and once between two erasures. A second time is refused
//!   (PROGERR), whatever the row holds, but for zeros, which may be programmed over any row. RM0351, 3.3.7:
//!   programming in a previously programmed address is not allowed except if the data to write is full zero.
//!   The register's description names the data alone (not erased to ones); here a row counts as programmed if
//!   any of its 72 bits, data or check, is a zero.
//! - Programming and erasing take the data sheet's times ([`Times`]). Meanwhile no other operation can start
//!   in either bank, and a read of the same bank waits until the operation is over; the other bank can be read.
//! - Every row has 8 check bits (the `ecc` module); what they find is part of every read ([`Read::ecc`]).
//! - What is read through the data cache may be out of date or spoilt ([`data_cache`]).
//!
//! Where the manual promises nothing, the model does the worst that is still allowed:
//! - A row whose programming lost its supply is torn: each of its 72 bits that was to change has changed or
//!   not, and the more probably so the later the supply was lost. So it may read as erased although it cannot
//!   be programmed, as sound with neither the old nor the new data (the check misses some of three wrong bits
//!   and more), as corrected, or as uncorrectable.
//! - A page or bank whose erasure lost its supply is torn so in all of its rows.
//!
//! Not modelled: cells between zero and one that read differently from one time to the next (each settles when
//! the supply is lost), wear, fast programming, protection of areas, option bytes, system memory.
//!
//! Sources: RM0351 (reference manual of `STM32L4x5`), chapter 3; DS10969 (data sheet of the STM32L475); what a
//! lost supply does, and the interrupt that follows: "Handling ECCD error during flash read on STM32L4",
//! community.st.com, 2016–2017.

pub mod data_cache;
mod ecc;
mod geometry;
pub mod nor;
pub mod sequence;

use core::ops::{DerefMut, Range};
use core::time::Duration;

use crate::noise::Generator;

use data_cache::DataCache;
pub use ecc::Ecc;
use ecc::Word;
pub use geometry::{BANK, Bank, PAGE, ROW, SIZE, Times};

/// The memory of the cells: the data of all rows, then a byte of check bits for each. Who creates a
/// flash provides it, boxed or borrowed.
pub type Cells = [u8; SIZE + SIZE / ROW];

/// The flash. Bytes are addressed by their offset from its start, which the processor sees at 0x0800 0000.
/// Times are counted from any start, and must not run backwards.
#[derive(Clone, Debug)]
pub struct Flash<M> {
    /// The data of all rows, then their check bits.
    cells: M,
    /// How long operations take.
    times: Times,
    /// What is being programmed or erased.
    operation: Option<Operation>,
    /// What decides how a row is torn.
    noise: Generator,
    /// The data cache in front of it, on from the start as after a reset.
    cache: DataCache,
}

/// A row is programmed, or pages are erased.
#[derive(Clone, Debug)]
struct Operation {
    /// Bytes whose rows change.
    bytes: Range<u32>,
    /// What is programmed; [`None`] for an erasure.
    data: Option<u64>,
    /// When it started, and when it ends.
    time: Range<Duration>,
}

/// An operation is under way until this time; the processor's bus waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Busy {
    /// When the operation ends: the access can be repeated then.
    pub until: Duration,
}

/// Why a row is not programmed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// Another operation is under way.
    Busy(Busy),
    /// The row was programmed, or torn, since the last erasure, and the data are not zeros (PROGERR).
    Programmed,
    /// The offset is not that of a row (PGAERR).
    Unaligned,
    /// The flash ends before this offset.
    OutOfBounds,
}

/// A row as it was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Read {
    /// Its data, corrected where one bit was wrong.
    pub bytes: [u8; ROW],
    /// What the check found. The address and the flags are the register's to keep.
    pub ecc: Ecc,
}

impl<M: DerefMut<Target = Cells>> Flash<M> {
    /// An erased flash in this memory. The seed decides how rows are torn and what the data cache spoils.
    pub fn erased(mut cells: M, times: Times, seed: u64) -> Self {
        cells.fill(u8::MAX);
        let [torn, spoilt] = [Generator::stream(seed, 0), Generator::stream(seed, 1)];
        Self { cells, times, operation: None, noise: torn, cache: DataCache::new(spoilt) }
    }

    /// Programs bytes from this offset on as a debugger does before the start: at once, with their
    /// check bits, whatever was there; rows of ones stay erased. The rest of the first and of the last row is kept.
    ///
    /// # Panics
    /// Where the flash ends before the bytes.
    pub fn burn(&mut self, offset: u32, bytes: &[u8]) {
        let from = offset as usize;
        self.cells[..SIZE][from..from + bytes.len()].copy_from_slice(bytes);
        for row in rows(offset & !(ROW as u32 - 1)..offset + bytes.len() as u32) {
            let data = self.word(row).data;
            self.set_word(row, if data == u64::MAX { Word::ERASED } else { Word::of(data) });
        }
    }

    /// Inverts a bit of the row of a byte, as a cell that lost its charge: 0 to 63 are its data, the least
    /// significant bit of the first byte first, 64 to 71 its check bits.
    ///
    /// # Panics
    /// Where the flash ends before this offset.
    pub fn invert(&mut self, offset: u32, bit: u8) {
        let Word { data, check } = self.word(offset);
        let mask = 1_u128 << bit;
        self.set_word(offset, Word { data: data ^ mask as u64, check: check ^ (mask >> 64) as u8 });
    }

    /// The data of all rows as the cells hold them, uncorrected.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.cells[..SIZE]
    }

    /// The rows of this range of offsets whose check finds something, with the finding.
    pub fn unsound(&self, range: Range<u32>) -> impl Iterator<Item = (u32, Ecc)> {
        let found = rows(range).map(|row| (row, self.word(row).read().1));
        found.filter(|(_, ecc)| *ecc != Ecc::Sound)
    }

    /// Until when an operation is under way at this time (BSY); [`None`] if there is none.
    pub fn busy(&mut self, now: Duration) -> Option<Busy> {
        if let Some(ended) = self.operation.take_if(|operation| operation.time.end <= now) {
            self.complete(&ended);
        }
        self.operation.as_ref().map(|operation| Busy { until: operation.time.end })
    }

    /// Starts to program a row.
    ///
    /// # Errors
    /// What forbids it; nothing has changed then.
    pub fn program(&mut self, offset: u32, bytes: [u8; ROW], now: Duration) -> Result<(), Refused> {
        if let Some(busy) = self.busy(now) {
            return Err(Refused::Busy(busy));
        }
        let data = u64::from_le_bytes(bytes);
        if !offset.is_multiple_of(ROW as u32) {
            Err(Refused::Unaligned)
        } else if offset as usize >= SIZE {
            Err(Refused::OutOfBounds)
        } else if data != 0 && self.word(offset) != Word::ERASED {
            Err(Refused::Programmed)
        } else {
            self.start(offset..offset + ROW as u32, Some(data), now, self.times.row);
            Ok(())
        }
    }

    /// Starts to erase a page of a bank (PER, PNB, BKER).
    ///
    /// # Errors
    /// Another operation is under way.
    pub fn erase_page(&mut self, bank: Bank, page: u8, now: Duration) -> Result<(), Busy> {
        let from = bank.start() + u32::from(page) * PAGE as u32;
        self.erase(from..from + PAGE as u32, now, self.times.page)
    }

    /// Starts to erase a bank (MER1 or MER2).
    ///
    /// # Errors
    /// Another operation is under way.
    pub fn erase_bank(&mut self, bank: Bank, now: Duration) -> Result<(), Busy> {
        let from = bank.start();
        self.erase(from..from + BANK as u32, now, self.times.bank)
    }

    /// Starts to erase both banks at once (MER1 and MER2).
    ///
    /// # Errors
    /// Another operation is under way.
    pub fn erase_all(&mut self, now: Duration) -> Result<(), Busy> {
        self.erase(0..SIZE as u32, now, self.times.bank)
    }

    /// Reads the row of a byte, past the data cache.
    ///
    /// # Errors
    /// Its bank is programmed or erased; the read has to be repeated when that is over.
    ///
    /// # Panics
    /// Where the flash ends before this offset.
    pub fn read(&mut self, offset: u32, now: Duration) -> Result<Read, Busy> {
        if let Some(busy) = self.busy(now)
            && self.writes_to(Bank::of(offset))
        {
            return Err(busy);
        }
        let (data, ecc) = self.word(offset).read();
        Ok(Read { bytes: data.to_le_bytes(), ecc })
    }

    /// The supply is lost, or the processor reset: what is being programmed or erased is torn. The data cache
    /// is empty and on afterwards.
    pub fn lose_supply(&mut self, now: Duration) {
        if self.busy(now).is_some()
            && let Some(Operation { bytes, data, time }) = self.operation.take()
        {
            let reached = now
                .saturating_sub(time.start)
                .div_duration_f64(time.end.saturating_sub(time.start));
            for row in rows(bytes) {
                let old = self.word(row);
                let torn = self.torn(old, changed(old, data), reached);
                self.set_word(row, torn);
            }
        }
        self.cache.restart();
    }

    /// Starts an erasure.
    fn erase(&mut self, bytes: Range<u32>, now: Duration, lasts: Duration) -> Result<(), Busy> {
        if let Some(busy) = self.busy(now) {
            return Err(busy);
        }
        self.start(bytes, None, now, lasts);
        Ok(())
    }

    /// Starts an operation.
    fn start(&mut self, bytes: Range<u32>, data: Option<u64>, now: Duration, lasts: Duration) {
        self.operation = Some(Operation { bytes, data, time: now..now + lasts });
    }

    /// Whether the operation under way changes rows of this bank.
    fn writes_to(&self, bank: Bank) -> bool {
        let is_in = |operation: &Operation| {
            bank == Bank::of(operation.bytes.start) || bank == Bank::of(operation.bytes.end - 1)
        };
        self.operation.as_ref().is_some_and(is_in)
    }

    /// Changes the rows of an operation that has ended.
    fn complete(&mut self, operation: &Operation) {
        for row in rows(operation.bytes.clone()) {
            let word = changed(self.word(row), operation.data);
            self.set_word(row, word);
            if operation.data.is_some() {
                self.cache.update(row, word.data.to_le_bytes());
            }
        }
    }

    /// A row on the way from one content to another: each bit that differs has changed with this probability.
    fn torn(&mut self, old: Word, new: Word, reached: f64) -> Word {
        let mut change = |differs: u64| {
            let bits = (0..64).filter(|bit| differs >> bit & 1 == 1);
            bits.fold(0_u64, |mask, bit| mask | u64::from(self.noise.uniform() < reached) << bit)
        };
        let data = old.data ^ change(old.data ^ new.data);
        Word { data, check: old.check ^ change(u64::from(old.check ^ new.check)) as u8 }
    }

    /// What the cells of the row of a byte hold.
    fn word(&self, offset: u32) -> Word {
        let row = offset as usize / ROW;
        let (data, checks) = self.cells.split_at(SIZE);
        let mut bytes = [0; ROW];
        bytes.copy_from_slice(&data[row * ROW..(row + 1) * ROW]);
        Word { data: u64::from_le_bytes(bytes), check: checks[row] }
    }

    /// Sets the cells of the row of a byte.
    fn set_word(&mut self, offset: u32, word: Word) {
        let row = offset as usize / ROW;
        let (data, checks) = self.cells.split_at_mut(SIZE);
        data[row * ROW..(row + 1) * ROW].copy_from_slice(&word.data.to_le_bytes());
        checks[row] = word.check;
    }
}

/// The offsets of the rows in a range of bytes that starts with one.
fn rows(bytes: Range<u32>) -> impl Iterator<Item = u32> {
    bytes.step_by(ROW)
}

/// What becomes of a row: programming clears bits, erasure sets them.
fn changed(old: Word, data: Option<u64>) -> Word {
    data.map_or(Word::ERASED, |data| {
        let new = Word::of(data);
        Word { data: old.data & new.data, check: old.check & new.check }
    })
}
