//! A store in two pages of a flash, which keeps its items whatever a loss of supply leaves, and whatever single row of it
//! cannot be read any more.
//!
//! A row of the flash is programmed once between two erasures, only zeros over any other, and a row that lost its supply
//! may read as anything, as erased, too, or not at all. One page is in use: records are appended to it, and the latest of
//! a slot holds. When it is full, the latest record of each slot goes to the other page, which is erased before and
//! counts only once that is complete. So an item stays what it was until the mark of its next one is written.
//!
//! | rows | content |
//! |---|---|
//! | 2, the first of a page | its generation, and CRC-32 of layout and generation, twice; written last where records were carried along. The page of the later generation is in use |
//! | as long as the item | a record: the item, filled up with zeros |
//! | 1 | the sum modulo two (exclusive or) of these rows, by which one of them that cannot be read is recovered |
//! | 2 | a mark: slot, length of the item in bytes, which of the two it is, layout, and CRC-32 of these four bytes; a record holds from the first of them on, and as long as one of them can be read |
//!
//! A slot is forgotten by a single mark of length zero. Rows for some of them are always left free, so that forgetting
//! erases nothing. A row that is not taken, since it was torn but reads as erased, is filled with zeros. Of a record whose
//! mark can be read but whose rows cannot, the slot is told to be damaged; it does not fall back to an earlier item.
//!
//! **Why not a general one.** sequential-storage 8.0.2 took a torn erasure for a page in use, a damaged item for none, a
//! torn row that reads as erased for free, and 66 ms of checksums to change pages; a damaged record was lost with any row.
//! Nothing of it can be mended from outside. Here the flash is read backwards, from mark to mark, and nothing is kept in
//! memory between two accesses.

use drivers::fault::Fault;
use embedded_storage_async::nor_flash::NorFlash;
use orientation::checksum::crc32_of_bytes;

use crate::ports::Store;

/// Bytes of a row, which is programmed at once.
const ROW: usize = 8;
/// A row of the flash.
type Row = [u8; ROW];
/// A row that was not programmed since its erasure.
const ERASED: Row = [u8::MAX; ROW];
/// What any row takes.
const ZEROS: Row = [0; ROW];
/// Bytes of the rows of a page before its records.
const HEADER: u32 = 2 * ROW as u32;
/// Version of the layout.
const LAYOUT: u8 = 1;
/// Rows that a save leaves free, in which a slot can be forgotten without an erasure: one is needed, the others serve where
/// a loss of supply has torn it.
const RESERVE: u32 = 8;
/// How often a record is begun: a row may refuse it, and another one once more after a loss of supply.
const ATTEMPTS: u32 = 4;

/// A store in two pages of a flash that are reserved for it.
pub struct FlashStore<F> {
    /// The flash. An error of a read means a row that cannot be read.
    flash: F,
    /// First byte of the two pages.
    start: u32,
}

/// The page in use.
#[derive(Clone, Copy)]
struct Page {
    /// Its generation, one more than that of the page before.
    generation: u32,
    /// Its first byte.
    start: u32,
    /// The byte after its last row that is not erased, or after its header.
    end: u32,
}

/// The end of a record.
#[derive(Clone, Copy, PartialEq)]
struct Mark {
    /// Slot of the item.
    slot: u8,
    /// Length of the item, bytes; zero if the slot is forgotten.
    length: u8,
}

/// A record as it was found.
#[derive(Clone, Copy, PartialEq)]
struct Record {
    mark: Mark,
    /// Its first byte.
    begin: u32,
}

/// The header of a page.
fn header(generation: u32) -> Row {
    let generation = generation.to_le_bytes();
    let [a, b, c, d] = generation;
    sealed(generation, crc32_of_bytes(&[LAYOUT, 0, 0, 0, a, b, c, d]))
}

/// A row of four bytes and their checksum.
fn sealed(content: [u8; 4], checksum: u32) -> Row {
    let mut row = [0; ROW];
    row[..4].copy_from_slice(&content);
    row[4..].copy_from_slice(&checksum.to_le_bytes());
    row
}

/// Adds a row to a sum modulo two.
fn add(sum: &mut Row, row: Row) {
    sum.iter_mut().zip(row).for_each(|(sum, byte)| *sum ^= byte);
}

impl Mark {
    /// The first or the second row of the mark.
    fn row(self, is_second: bool) -> Row {
        let content = [self.slot, self.length, u8::from(is_second), LAYOUT];
        sealed(content, crc32_of_bytes(&content))
    }

    /// The mark in a row, and whether it is the second one.
    fn of(row: Row) -> Option<(Self, bool)> {
        let [slot, length, copy, ..] = row;
        let (mark, is_second) = (Self { slot, length }, copy == 1);
        (mark.row(is_second) == row).then_some((mark, is_second))
    }

    /// Rows of the item.
    fn rows(self) -> u32 {
        u32::from(self.length).div_ceil(ROW as u32)
    }

    /// Rows of the record.
    fn record_rows(self) -> u32 {
        if self.length == 0 { 1 } else { self.rows() + 3 }
    }

    /// Rows of the record before a row of its mark.
    fn rows_before(self, is_second: bool) -> u32 {
        if self.length == 0 { 0 } else { self.rows() + 1 + u32::from(is_second) }
    }
}

impl<F: NorFlash> FlashStore<F> {
    /// Bytes of a page.
    const PAGE: u32 = F::ERASE_SIZE as u32;

    /// Takes a flash with rows of eight bytes, and the offset of the first byte of the two pages, the first byte of a page.
    pub const fn new(flash: F, start: u32) -> Self {
        const { assert!(F::WRITE_SIZE == ROW && F::ERASE_SIZE.is_multiple_of(ROW)) };
        Self { flash, start }
    }

    /// Releases the flash.
    pub fn into_flash(self) -> F {
        self.flash
    }

    /// Erases the pages where they hold something else than a store: what another program left, or a store whose header
    /// cannot be read in either row. Returns whether that was so. Until then nothing is loaded from them.
    ///
    /// # Errors
    /// [`Fault::Bus`]: the flash does not erase them.
    pub async fn take_over(&mut self) -> Result<bool, Fault> {
        if self.page().await.is_some() || self.is_empty().await {
            return Ok(false);
        }
        self.erase(self.start, 2).await?;
        Ok(true)
    }

    /// A row; [`None`] if it cannot be read.
    async fn row(&mut self, at: u32) -> Option<Row> {
        let mut row = ZEROS;
        self.flash.read(at, &mut row).await.ok()?;
        Some(row)
    }

    /// Programs a row, and moves on to the next.
    ///
    /// # Errors
    /// The row is not taken; the place stays.
    async fn program(&mut self, at: &mut u32, row: Row) -> Result<(), Fault> {
        self.flash.write(*at, &row).await.map_err(|_| Fault::Bus)?;
        *at += ROW as u32;
        Ok(())
    }

    /// Erases so many pages.
    async fn erase(&mut self, start: u32, pages: u32) -> Result<(), Fault> {
        self.flash.erase(start, start + pages * Self::PAGE).await.map_err(|_| Fault::Bus)
    }

    /// First bytes of both pages.
    fn pages(&self) -> [u32; 2] {
        [self.start, self.start + Self::PAGE]
    }

    /// Whether both pages are erased but for their headers, which may be torn.
    async fn is_empty(&mut self) -> bool {
        for start in self.pages() {
            if self.end(start).await > start + HEADER {
                return false;
            }
        }
        true
    }

    /// The byte after the last row of a page that is not erased, or after its header.
    async fn end(&mut self, start: u32) -> u32 {
        let mut end = start + Self::PAGE;
        while end > start + HEADER && self.row(end - ROW as u32).await == Some(ERASED) {
            end -= ROW as u32;
        }
        end
    }

    /// The page in use; [`None`] if there is none.
    async fn page(&mut self) -> Option<Page> {
        let mut latest: Option<Page> = None;
        for start in self.pages() {
            if let Some(generation) = self.generation(start).await
                && latest.is_none_or(|latest| latest.generation < generation)
            {
                latest = Some(Page { generation, start, end: 0 });
            }
        }
        let page = latest?;
        let end = self.end(page.start).await;
        Some(Page { end, ..page })
    }

    /// The generation of a page, by either row of its header.
    async fn generation(&mut self, start: u32) -> Option<u32> {
        for at in [start, start + ROW as u32] {
            if let Some(row) = self.row(at).await {
                let [a, b, c, d, ..] = row;
                let generation = u32::from_le_bytes([a, b, c, d]);
                if row == header(generation) {
                    return Some(generation);
                }
            }
        }
        None
    }

    /// The last record of a page that ends before this byte.
    async fn before(&mut self, page: Page, mut end: u32) -> Option<Record> {
        let first = page.start + HEADER;
        while end > first {
            end -= ROW as u32;
            if let Some((mark, is_second)) = self.row(end).await.and_then(Mark::of) {
                let begin = end.saturating_sub(mark.rows_before(is_second) * ROW as u32);
                if begin >= first {
                    return Some(Record { mark, begin });
                }
            }
        }
        None
    }

    /// The latest record of a slot.
    async fn latest(&mut self, page: Page, slot: u8) -> Option<Record> {
        let mut found = self.before(page, page.end).await;
        while let Some(record) = found.filter(|record| record.mark.slot != slot) {
            found = self.before(page, record.begin).await;
        }
        found
    }

    /// The record of the item that a slot holds; [`None`] if it is empty.
    ///
    /// # Errors
    /// [`Fault::Bus`]: the pages hold something else than a store.
    async fn held(&mut self, slot: u8) -> Result<Option<Record>, Fault> {
        match self.page().await {
            Some(page) => {
                let latest = self.latest(page, slot).await;
                Ok(latest.filter(|record| record.mark.length > 0))
            }
            None if self.is_empty().await => Ok(None),
            None => Err(Fault::Bus),
        }
    }

    /// A row of a record's item, or the one of their sum behind them; the sum of all others where it cannot be read.
    ///
    /// # Errors
    /// [`Fault::Checksum`]: another one cannot be read, either.
    async fn item_row(&mut self, record: Record, index: u32) -> Result<Row, Fault> {
        let at = |index: u32| record.begin + index * ROW as u32;
        if let Some(row) = self.row(at(index)).await {
            return Ok(row);
        }
        let mut sum = ZEROS;
        for other in (0..=record.mark.rows()).filter(|other| *other != index) {
            add(&mut sum, self.row(at(other)).await.ok_or(Fault::Checksum)?);
        }
        Ok(sum)
    }

    /// The item of a record of its length.
    async fn item(&mut self, record: Record, item: &mut [u8]) -> Result<(), Fault> {
        let mut sum = self.item_row(record, record.mark.rows()).await?;
        for (index, bytes) in (0..).zip(item.chunks_mut(ROW)) {
            let row = self.item_row(record, index).await?;
            add(&mut sum, row);
            bytes.copy_from_slice(&row[..bytes.len()]);
        }
        if sum == ZEROS { Ok(()) } else { Err(Fault::Checksum) }
    }

    /// Appends a record, on the other page if there is no room for it and for so many rows more.
    async fn append(&mut self, mark: Mark, item: &[u8], reserve: u32) -> Result<(), Fault> {
        let bytes = (mark.record_rows() + reserve) * ROW as u32;
        for _ in 0..ATTEMPTS {
            let room = |page: &Page| page.end + bytes <= page.start + Self::PAGE;
            let page = match self.page().await.filter(room) {
                Some(page) => page,
                None => self.change_pages().await?,
            };
            let mut at = page.end;
            if !room(&page) {
                return Err(Fault::Bus);
            }
            match self.write(&mut at, mark, item).await {
                Ok(()) => return Ok(()),
                // Zeros set the row apart; if it does not take them, either, nothing helps.
                Err(_) => self.program(&mut at, ZEROS).await?,
            }
        }
        Err(Fault::Bus)
    }

    /// Writes a record.
    ///
    /// # Errors
    /// A row is not taken; it is where the place stays.
    async fn write(&mut self, at: &mut u32, mark: Mark, item: &[u8]) -> Result<(), Fault> {
        let mut sum = ZEROS;
        for bytes in item.chunks(ROW) {
            let mut row = ZEROS;
            row[..bytes.len()].copy_from_slice(bytes);
            add(&mut sum, row);
            self.program(at, row).await?;
        }
        if !item.is_empty() {
            self.program(at, sum).await?;
        }
        self.end_record(at, mark).await
    }

    /// Writes the mark of a record.
    async fn end_record(&mut self, at: &mut u32, mark: Mark) -> Result<(), Fault> {
        self.program(at, mark.row(false)).await?;
        if mark.length > 0 {
            self.program(at, mark.row(true)).await?;
        }
        Ok(())
    }

    /// Takes the other page into use, with the latest record of each slot, or the first one if none is in use.
    async fn change_pages(&mut self) -> Result<Page, Fault> {
        let old = self.page().await;
        let is_first = old.is_none_or(|old| old.start != self.start);
        let start = if is_first { self.start } else { self.start + Self::PAGE };
        self.erase(start, 1).await?;
        let mut end = start + HEADER;
        if let Some(old) = old {
            let mut next = self.before(old, old.end).await;
            while let Some(record) = next {
                let is_latest = self.latest(old, record.mark.slot).await == Some(record);
                if is_latest && record.mark.length > 0 {
                    self.carry(record, &mut end).await?;
                }
                next = self.before(old, record.begin).await;
            }
        }
        let generation = old.map_or(1, |old| old.generation.wrapping_add(1));
        let mut at = start;
        self.program(&mut at, header(generation)).await?;
        self.program(&mut at, header(generation)).await?;
        Ok(Page { generation, start, end })
    }

    /// Copies a record. One that is damaged stays so, lest its slot count as empty.
    async fn carry(&mut self, record: Record, to: &mut u32) -> Result<(), Fault> {
        for index in 0..=record.mark.rows() {
            let row = self.item_row(record, index).await.unwrap_or(ZEROS);
            self.program(to, row).await?;
        }
        self.end_record(to, record.mark).await
    }
}

impl<F: NorFlash> Store for FlashStore<F> {
    /// Reads the latest item of a slot.
    ///
    /// # Errors
    /// [`Fault::Checksum`] for an item that is damaged; [`Fault::Bus`] for a longer one, and for pages that hold something
    /// else than a store.
    async fn read(&mut self, slot: u8, item: &mut [u8]) -> Result<Option<usize>, Fault> {
        let Some(record) = self.held(slot).await? else { return Ok(None) };
        let length = usize::from(record.mark.length);
        let item = item.get_mut(..length).ok_or(Fault::Bus)?;
        self.item(record, item).await?;
        Ok(Some(length))
    }

    async fn save<const N: usize>(&mut self, slot: u8, item: &[u8; N]) -> Result<(), Fault> {
        const { assert!(0 < N && N <= u8::MAX as usize) };
        self.append(Mark { slot, length: N as u8 }, item, RESERVE).await
    }

    async fn forget(&mut self, slot: u8) -> Result<(), Fault> {
        match self.held(slot).await? {
            Some(_) => self.append(Mark { slot, length: 0 }, &[], 0).await,
            None => Ok(()),
        }
    }
}
