//! Lines of the log that are kept over a loss of supply: what waits to be written into a [ring](crate::storage::Ring) of
//! the flash, and how many may be.
//!
//! They wait in memory that outlasts a reset, so that those are written, too, after which nothing was: the lines before
//! a task was stuck, or before a panic.
//!
//! **Endurance of the flash.** A record costs a minute of a credit that grows with time, to that of half an hour at most,
//! and outlasts a reset as the lines do. The latter half of it is for outcomes alone, lest symptoms that come again and
//! again leave none. So 16 pages with 28 records each, of 10 000 erase cycles (STM32L475 data sheet, table 59), take one
//! every minute for eight years, and 32 more at each power-on. What the credit does not allow, or what finds too many
//! waiting, is counted, and the count is kept as a line.

use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use crate::storage::CONTENT;

/// Bytes of the image's identity, with which a record begins.
pub const IMAGE: usize = 4;
/// Records that may wait: those of a device that is given up within a conclusion.
const CAPACITY: u32 = 16;
/// What a record costs, s.
const COST: u32 = 60;
/// The greatest credit, s.
const FULL: u32 = 32 * COST;

/// How much a line tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// What may come again and again.
    Symptom,
    /// What has come of something, or why nothing has.
    Outcome,
}

impl Weight {
    /// The least credit for a record of such a line, s.
    const fn least(self) -> u32 {
        match self {
            Self::Symptom => FULL / 2 + COST,
            Self::Outcome => COST,
        }
    }
}

/// Records that wait: the identity of the image, then what the log sends of a line up to the zero at its end, or a part of
/// that, which the next record goes on with. Any bits that memory may hold are valid.
#[derive(Debug)]
pub struct KeptLines {
    records: [[AtomicU8; CONTENT]; CAPACITY as usize],
    /// How many were given, modulo 2³².
    given: AtomicU32,
    /// How many of them were taken.
    taken: AtomicU32,
    /// What may be spent, s.
    credit: AtomicU32,
    /// Lines that were neither kept nor told of.
    omitted: AtomicU32,
}

impl KeptLines {
    /// No record, and no credit.
    pub(crate) const fn new() -> Self {
        Self {
            records: [const { [const { AtomicU8::new(0) }; CONTENT] }; CAPACITY as usize],
            given: AtomicU32::new(0),
            taken: AtomicU32::new(0),
            credit: AtomicU32::new(0),
            omitted: AtomicU32::new(0),
        }
    }

    /// Forgets everything, and gives full credit.
    pub(crate) fn clear(&self) {
        self.given.store(0, Ordering::Relaxed);
        self.taken.store(0, Ordering::Relaxed);
        self.credit.store(FULL, Ordering::Relaxed);
        self.omitted.store(0, Ordering::Relaxed);
    }

    /// Adds to the credit what a second brings.
    pub(crate) fn pass_second(&self) {
        if self.credit.load(Ordering::Relaxed) < FULL {
            self.credit.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Has a record be written, where the credit allows it, and whether that is so. No other part may be doing so at the same
    /// time.
    pub fn give(&self, weight: Weight, record: &[u8; CONTENT]) -> bool {
        let [given, taken, credit] =
            [&self.given, &self.taken, &self.credit].map(|number| number.load(Ordering::Relaxed));
        let is_taken = given.wrapping_sub(taken) < CAPACITY && credit >= weight.least();
        if is_taken {
            for (place, byte) in self.place(given).iter().zip(record) {
                place.store(*byte, Ordering::Relaxed);
            }
            self.credit.store(credit - COST, Ordering::Relaxed);
            self.given.store(given.wrapping_add(1), Ordering::Release);
        } else {
            let omitted = self.omitted.load(Ordering::Relaxed);
            self.omitted.store(omitted.saturating_add(1), Ordering::Relaxed);
        }
        is_taken
    }

    /// The record that has waited longest.
    #[must_use]
    pub fn first(&self) -> Option<[u8; CONTENT]> {
        let taken = self.taken.load(Ordering::Relaxed);
        let waiting = self.given.load(Ordering::Acquire).wrapping_sub(taken);
        (1..=CAPACITY)
            .contains(&waiting)
            .then(|| self.place(taken).each_ref().map(|place| place.load(Ordering::Relaxed)))
    }

    /// Drops it.
    pub fn drop_first(&self) {
        self.taken.store(self.taken.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
    }

    /// How many lines were not kept, once a line may say it.
    #[must_use]
    pub fn take_omitted(&self) -> Option<u32> {
        let may_say = self.credit.load(Ordering::Relaxed) >= Weight::Symptom.least();
        let omitted = if may_say { self.omitted.swap(0, Ordering::Relaxed) } else { 0 };
        (omitted > 0).then_some(omitted)
    }

    /// The place of the record of a number.
    fn place(&self, number: u32) -> &[AtomicU8; CONTENT] {
        &self.records[(number % CAPACITY) as usize]
    }
}
