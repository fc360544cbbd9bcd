//! The data cache between processor and flash, with its erratum.
//!
//! Eight lines of four rows (ST's `stm32l4xx_hal_flash.c`: "8 cache lines of 4*64 bits on D-Code"), on after a
//! reset (RM0351, `FLASH_ACR`: DCEN). The line that was used least recently gives way (RM0090, 3.5.2, of the
//! same cache), and a row is fetched when it is first read.
//!
//! A hit is not checked anew: an uncorrectable row raises its interrupt once (RM0351, 3.3.2, of a buffer).
//!
//! The cache holds wrong data after
//! - an erasure: lines keep what the page held until they are reset (RM0351, 3.3.7, "programming and
//!   caches": programming changes cache and flash, an erasure the flash alone);
//! - a read beside a write, the erratum "Data cache might be corrupted during Flash memory read-while-write
//!   operation". The sheet of the STM32L475 is ES0302 (Zephyr, pull request 67740), whose text was not at hand; this
//!   is ST's of the `STM32F42x` (2.1.11 of its errata, quoted in trezor-core's pull request 57). Zephyr (pull request
//!   13732: section 2.2.3, and bus faults because of it), `NuttX` (pull request 166) and embassy (pull request 6384:
//!   section 2.2.2 of ES0510) find it in the sheets of the STM32L4, too. When the flash is written, the cache is
//!   updated to reflect it; if the other bank is read during that update, the cache may be corrupted, and later reads
//!   from the same address that hit the cache get wrong data. It needs both banks, reading from one (data or code)
//!   while the other is written, and the cache on. The remedy is to switch the cache off before a write, and to reset
//!   it before it is switched on again.
//!
//! When the update takes place, how often it spoils a row, and what with, ST does not tell. Here any fetch of
//! a row while the other bank is programmed may spoil it, with a probability that the user sets: the read itself
//! gets the right data, later ones get random data, as was seen on an STM32L471 ("STM32 L471 Flash Cache Error",
//! community.st.com, 2016). Erasures spoil nothing.

use core::ops::DerefMut;
use core::time::Duration;

use super::{Bank, Busy, Cells, Ecc, Flash, ROW, Read};
use crate::noise::Generator;

/// Lines of the cache.
const LINES: usize = 8;
/// Rows of a line.
const ROWS: usize = 4;
/// Bytes of a line.
const BYTES: u32 = (ROWS * ROW) as u32;

/// The data cache.
#[derive(Clone, Debug)]
pub(super) struct DataCache {
    /// DCEN.
    is_on: bool,
    /// What it holds; the line that was used last comes first.
    lines: [Line; LINES],
    /// Probability that a fetch beside a write spoils its row.
    risk: f64,
    /// How many rows were spoilt since the start.
    spoilt: u32,
    /// What decides which rows are spoilt, and what they hold then.
    noise: Generator,
}

/// A line: four rows that begin at a multiple of 32 bytes.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    /// Offset of its first byte in the flash.
    start: u32,
    /// What was fetched.
    rows: [Option<[u8; ROW]>; ROWS],
}

impl DataCache {
    /// An empty cache that is on, and is never spoilt.
    pub(super) fn new(noise: Generator) -> Self {
        Self { is_on: true, lines: Default::default(), risk: 0.0, spoilt: 0, noise }
    }

    /// As after a reset: empty and on.
    pub(super) fn restart(&mut self) {
        self.lines = Default::default();
        self.is_on = true;
    }

    /// Follows the programming of a row.
    pub(super) fn update(&mut self, offset: u32, bytes: [u8; ROW]) {
        if let Some(held) = self.row(offset).filter(|held| held.is_some()) {
            *held = Some(bytes);
        }
    }

    /// The place of a row in the line that holds its address.
    fn row(&mut self, offset: u32) -> Option<&mut Option<[u8; ROW]>> {
        let line = self.lines.iter_mut().find(|line| line.start == line_of(offset))?;
        line.rows.get_mut(place(offset))
    }

    /// Makes the line of a row the first, in the place of the least recently used one if it is not held.
    fn use_line(&mut self, offset: u32) -> &mut Line {
        let start = line_of(offset);
        let held = self.lines.iter().position(|line| line.start == start);
        self.lines[..=held.unwrap_or(LINES - 1)].rotate_right(1);
        if held.is_none() {
            self.lines[0] = Line { start, ..Line::default() };
        }
        &mut self.lines[0]
    }
}

impl<M: DerefMut<Target = Cells>> Flash<M> {
    /// Sets the probability, 0 to 1, with which the erratum spoils a row that is fetched while the other bank
    /// is programmed. It is 0 at first.
    pub fn set_cache_risk(&mut self, risk: f64) {
        self.cache.risk = risk;
    }

    /// Switches the data cache on or off (DCEN). What it holds, it keeps.
    pub fn switch_cache(&mut self, is_on: bool) {
        self.cache.is_on = is_on;
    }

    /// Empties the data cache (DCRST). Without effect while it is on (RM0351, `FLASH_ACR`).
    pub fn reset_cache(&mut self) {
        if !self.cache.is_on {
            self.cache.lines = Default::default();
        }
    }

    /// How many rows of the data cache the erratum has spoilt since the start.
    #[must_use]
    pub fn spoilt_rows(&self) -> u32 {
        self.cache.spoilt
    }

    /// Reads the row of a byte as a load of the processor does: from the data cache if it is on and holds the
    /// row, or from the flash.
    ///
    /// # Errors
    /// The row is not in the cache, and its bank is programmed or erased.
    ///
    /// # Panics
    /// Where the flash ends before this offset.
    pub fn load(&mut self, offset: u32, now: Duration) -> Result<Read, Busy> {
        // An operation that has ended is completed first.
        self.busy(now);
        if !self.cache.is_on {
            return self.read(offset, now);
        }
        if let Some(bytes) = self.cache.row(offset).copied().flatten() {
            self.cache.use_line(offset);
            return Ok(Read { bytes, ecc: Ecc::Sound });
        }
        let read = self.read(offset, now)?;
        let held = if self.is_spoilt(offset) { self.spoil() } else { read.bytes };
        self.cache.use_line(offset).rows[place(offset)] = Some(held);
        Ok(read)
    }

    /// Whether the erratum spoils the row that is being fetched.
    fn is_spoilt(&mut self, offset: u32) -> bool {
        let is_beside = self.operation.as_ref().is_some_and(|operation| {
            operation.data.is_some() && Bank::of(operation.bytes.start) != Bank::of(offset)
        });
        is_beside && self.cache.noise.uniform() < self.cache.risk
    }

    /// Random data for a row that is spoilt.
    fn spoil(&mut self) -> [u8; ROW] {
        self.cache.spoilt += 1;
        self.cache.noise.next_u64().to_le_bytes()
    }
}

/// Offset of the first byte of a line.
const fn line_of(offset: u32) -> u32 {
    offset - offset % BYTES
}

/// Place of a row in its line.
const fn place(offset: u32) -> usize {
    (offset % BYTES) as usize / ROW
}
