//! A ring of records in pages of a flash: when all are full, the page with the oldest ones is erased for the next.
//!
//! Any loss of supply costs at most the record that is being written, or, where the erasure of a page had begun, the
//! oldest ones, which were to go. No page has a header, and nothing is carried along: a record says by its number where in
//! the order it belongs. A place whose first row was programmed, or torn, refuses another record, and is passed over.
//!
//! | bytes | content of a record, which takes 9 rows; a page holds 28 |
//! |---|---|
//! | 4 | its number, from 1 on, little-endian |
//! | 4 | CRC-32 of that, by which the latest record is found |
//! | 60 | the content |
//! | 4 | CRC-32 of all before |

use core::ops::Range;

use embassy_futures::yield_now;
use embassy_time::{Duration, Timer};
use orientation::checksum::crc32_of_bytes;

/// Bytes of the content of a record.
pub const CONTENT: usize = 60;
/// Bytes of a page.
pub const PAGE: usize = 2048;
/// Bytes of a row, which is programmed at once.
const ROW: usize = 8;
/// A row.
pub type Row = [u8; ROW];
/// Bytes of the checksum at the end of a record.
const CHECKSUM: usize = 4;
/// Bytes of a record.
const RECORD: usize = ROW + CONTENT + CHECKSUM;
/// Records of a page.
const RECORDS: u32 = (PAGE / RECORD) as u32;

/// Time between two looks whether an erasure is over.
const POLLED: Duration = Duration::from_millis(2);

/// A flash of such pages and rows. Nothing of it waits for what is under way.
pub trait Pages {
    /// A row; [`None`] if it cannot be read.
    fn row(&self, offset: u32) -> Option<Row>;

    /// Whether nothing is under way.
    fn is_idle(&self) -> bool;

    /// Programs a row; whether the flash takes it.
    fn program(&mut self, offset: u32, row: Row) -> bool;

    /// Begins to erase the page at this offset.
    fn begin_erasure(&mut self, offset: u32);

    /// Leaves an erasure, where it is over; whether that is so. What is not erased refuses to be programmed.
    fn end_erasure(&mut self) -> bool;
}

/// The ring.
pub struct Ring<F> {
    /// The flash.
    flash: F,
    /// Bytes of its pages.
    pages: Range<u32>,
    /// The place of the latest record, counted from the first page's first one.
    place: u32,
    /// The number of the latest record; zero where there is none.
    latest: u32,
    /// The latest record.
    record: [u8; RECORD],
    /// How many of its bytes are to be written.
    left: usize,
    /// How many places may still be tried.
    attempts: u32,
    /// How far the erasure of the page is that begins with its place.
    erasure: Erasure,
    /// How many records were found at first, the last one before a loss of supply included.
    pub found: u32,
}

/// How far an erasure is.
#[derive(Clone, Copy, PartialEq)]
enum Erasure {
    /// It is needed.
    Due,
    /// It is under way.
    Begun,
    /// It is over, or not needed.
    Over,
}

impl<F: Pages> Ring<F> {
    /// Finds the records in these pages of a flash. Nothing may be under way there.
    pub fn open(flash: F, pages: Range<u32>) -> Self {
        let places = (pages.end - pages.start) / PAGE as u32 * RECORDS;
        let mut ring = Self {
            flash,
            pages,
            place: places - 1,
            latest: 0,
            record: [0; RECORD],
            left: 0,
            attempts: 0,
            erasure: Erasure::Over,
            found: 0,
        };
        for place in 0..places {
            if let Some(number) = ring.flash.row(ring.offset(place)).and_then(number) {
                ring.found += 1;
                if number > ring.latest {
                    (ring.latest, ring.place) = (number, place);
                }
            }
        }
        ring
    }

    /// First byte of a place.
    const fn offset(&self, place: u32) -> u32 {
        self.pages.start + place / RECORDS * PAGE as u32 + place % RECORDS * RECORD as u32
    }

    /// Begins to append a record, which is written by [`Self::step`]. The one before must be.
    pub fn begin(&mut self, content: &[u8; CONTENT]) {
        self.latest += 1;
        self.record = record(self.latest, content);
        // The first place of the next page is erased before.
        self.attempts = RECORDS;
        self.advance();
    }

    /// Goes on to the next place. One at the beginning of a page has that erased.
    fn advance(&mut self) {
        self.left = RECORD;
        self.place += 1;
        if self.offset(self.place) >= self.pages.end {
            self.place = 0;
        }
        let begins = self.place.is_multiple_of(RECORDS);
        self.erasure = if begins { Erasure::Due } else { Erasure::Over };
    }

    /// Writes another row, or erases a page, where nothing else is under way; whether the record is written. One that no
    /// place of a page's length takes is given up.
    pub fn step(&mut self) -> bool {
        match self.erasure {
            Erasure::Begun if self.flash.end_erasure() => self.erasure = Erasure::Over,
            Erasure::Due if self.flash.is_idle() => {
                self.flash.begin_erasure(self.offset(self.place));
                self.erasure = Erasure::Begun;
            }
            Erasure::Over if self.left > 0 && self.flash.is_idle() => self.write(),
            _ => {}
        }
        self.left == 0
    }

    /// Writes another row.
    fn write(&mut self) {
        let written = RECORD - self.left;
        let mut row = [0; ROW];
        row.copy_from_slice(&self.record[written..written + ROW]);
        if self.flash.program(self.offset(self.place) + written as u32, row) {
            self.left -= ROW;
        } else if self.attempts > 0 {
            self.attempts -= 1;
            self.advance();
        } else {
            self.left = 0;
        }
    }
}

/// The first row of the record of a number.
fn head(number: u32) -> Row {
    let number = number.to_le_bytes();
    let [[a, b, c, d], [e, f, g, h]] = [number, crc32_of_bytes(&number).to_le_bytes()];
    [a, b, c, d, e, f, g, h]
}

/// A record of the log with its number.
pub type LogRecord = (u32, [u8; CONTENT]);

/// The whole record with the least number above this one in these pages of a flash. Others go on after each page; while one
/// is erased, it waits, as the core would.
pub async fn record_after(flash: &impl Pages, pages: Range<u32>, number: u32) -> Option<LogRecord> {
    let mut above = number;
    loop {
        let mut least = None;
        for page in pages.clone().step_by(PAGE) {
            yield_now().await;
            while !flash.is_idle() {
                Timer::after(POLLED).await;
            }
            least = least_above(flash, page, above, least);
        }
        let (number, offset) = least?;
        // One that is torn is passed over.
        if let Some(content) = content(flash, offset, number) {
            return Some((number, content));
        }
        above = number;
    }
}

/// The least number above this one that is stated in a page, or before it, with the offset of its record.
fn least_above(
    flash: &impl Pages,
    page: u32,
    above: u32,
    mut least: Option<(u32, u32)>,
) -> Option<(u32, u32)> {
    for offset in (0..RECORDS).map(|place| page + place * RECORD as u32) {
        let is_less = |it: u32| it > above && least.is_none_or(|(least, _)| it < least);
        // A checksum takes longer than all else, and is looked at only of a number that counts.
        let row = flash.row(offset).filter(|row| is_less(unchecked(*row)));
        least = row.and_then(number).map(|number| (number, offset)).or(least);
    }
    least
}

/// The content of the record of this number at this offset; [`None`] where it is not whole.
fn content(flash: &impl Pages, offset: u32, number: u32) -> Option<[u8; CONTENT]> {
    let mut found = [0; RECORD];
    for (place, row) in found.as_chunks_mut::<ROW>().0.iter_mut().enumerate() {
        *row = flash.row(offset + (place * ROW) as u32)?;
    }
    let content = found[ROW..].first_chunk()?;
    (record(number, content) == found).then_some(*content)
}

/// The number in a row, if it is the first of a record.
const fn unchecked([a, b, c, d, ..]: Row) -> u32 {
    u32::from_le_bytes([a, b, c, d])
}

/// The number in the first row of a record; [`None`] in any other row.
fn number(row: Row) -> Option<u32> {
    let number = unchecked(row);
    // An erased row is what the head of that number would be.
    (number != u32::MAX && head(number) == row).then_some(number)
}

/// A record.
fn record(number: u32, content: &[u8; CONTENT]) -> [u8; RECORD] {
    let mut record = [0; RECORD];
    record[..ROW].copy_from_slice(&head(number));
    record[ROW..ROW + CONTENT].copy_from_slice(content);
    let checksum = crc32_of_bytes(&record[..ROW + CONTENT]);
    record[ROW + CONTENT..].copy_from_slice(&checksum.to_le_bytes());
    record
}

/// The whole records in pages that were read from a flash, with their numbers, in the order of their places.
pub fn records(pages: &[u8]) -> impl Iterator<Item = (u32, &[u8; CONTENT])> {
    let (pages, _) = pages.as_chunks::<PAGE>();
    let records = pages.iter().flat_map(|page| page.as_chunks::<RECORD>().0);
    records.filter_map(|found| {
        let (head, rest) = found.split_first_chunk()?;
        let (number, content) = (number(*head)?, rest.first_chunk()?);
        (record(number, content) == *found).then_some((number, content))
    })
}
