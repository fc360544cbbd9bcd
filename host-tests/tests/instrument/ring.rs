//! The ring of records in the flash of the STM32L475: the supply is lost at any moment, and other programs have used the
//! pages before.

use std::cell::RefCell;

use embedded_storage_async::nor_flash::{NorFlash as _, ReadNorFlash as _};
use firmware::storage::{CONTENT, LogRecord, Pages, Ring, Row, record_after, records};
use hal_mock::flash::nor::{Interrupt, Loss, PoweredFlash};
use hal_mock::flash::{Cells, Flash, PAGE, ROW, SIZE, Times};
use host::virtual_time::run;
use proptest::collection::vec;
use proptest::prelude::*;

/// The flash of a board, behind its driver.
type Board = PoweredFlash<Box<Cells>>;
/// First byte of the ring, which has three pages here.
const FIRST: u32 = (SIZE - 3 * PAGE) as u32;
/// Records of a page.
const OF_PAGE: u32 = 28;
/// Places of the ring.
const PLACES: u32 = 3 * OF_PAGE;
/// Rows of a record.
const ROWS: u32 = 9;

/// The flash as the ring uses it.
struct Rows<'f>(RefCell<&'f mut Board>);

impl Pages for Rows<'_> {
    fn row(&self, offset: u32) -> Option<Row> {
        let mut row = [0; ROW];
        let read = run(self.0.borrow_mut().read(offset, &mut row)).expect("it ends");
        read.ok().map(|()| row)
    }

    fn is_idle(&self) -> bool {
        true
    }

    fn program(&mut self, offset: u32, row: Row) -> bool {
        run(self.0.get_mut().write(offset, &row)).expect("it ends").is_ok()
    }

    fn begin_erasure(&mut self, offset: u32) {
        // An erasure that fails shows in the rows.
        let _ = run(self.0.get_mut().erase(offset, offset + PAGE as u32)).expect("it ends");
    }

    fn end_erasure(&mut self) -> bool {
        true
    }
}

/// An erased flash. The seed decides what a loss of supply does to it.
fn erased(seed: u64) -> Board {
    let cells: Box<Cells> = vec![0; size_of::<Cells>()].try_into().expect("as long as the cells");
    PoweredFlash::new(Flash::erased(cells, Times::TYPICAL, seed), seed)
}

/// The ring in a flash.
fn ring(flash: &mut Board) -> Ring<Rows<'_>> {
    Ring::open(Rows(RefCell::new(flash)), FIRST..SIZE as u32)
}

/// The content that is known by a number.
fn content(number: u32) -> [u8; CONTENT] {
    core::array::from_fn(|place| (number >> (8 * (place % 4))) as u8)
}

/// Appends records of these numbers, after one start.
fn append(flash: &mut Board, numbers: impl IntoIterator<Item = u32>) {
    let mut ring = ring(flash);
    for number in numbers {
        ring.begin(&content(number));
        while !ring.step() {}
    }
}

/// All records as they are asked for over the link, each after the one before.
fn one_by_one(rows: &Rows<'_>) -> Vec<LogRecord> {
    let after =
        |number| run(record_after(rows, FIRST..SIZE as u32, number)).expect("it waits for nothing");
    core::iter::successors(after(0), |(number, _)| after(*number)).collect()
}

/// The numbers of all records that can be read, in their order.
fn kept(flash: &mut Board) -> Vec<u32> {
    let rows = Rows(RefCell::new(flash));
    let row = |row| rows.row(FIRST + row * ROW as u32).unwrap_or_default();
    let bytes: Vec<u8> = (0..(3 * PAGE / ROW) as u32).flat_map(row).collect();
    let mut found: Vec<_> = records(&bytes).collect();
    found.sort_by_key(|(place, _)| *place);
    assert!(one_by_one(&rows).iter().map(|(place, it)| (*place, it)).eq(found.iter().copied()));
    let number = |content: &[u8; CONTENT]| {
        let number = u32::from_le_bytes([content[0], content[1], content[2], content[3]]);
        assert_eq!(*content, self::content(number), "no record is mixed of others");
        number
    };
    found.iter().map(|(_, content)| number(content)).collect()
}

#[test]
fn the_latest_records_are_read_in_their_order_however_many_were_written() {
    let mut flash = erased(1);
    for number in 0..3 * PLACES {
        assert_eq!(ring(&mut flash).found, kept(&mut flash).len() as u32);
        append(&mut flash, [number]);
        let kept = kept(&mut flash);
        let pages = (number / OF_PAGE).min(2);
        let first = (number / OF_PAGE - pages) * OF_PAGE;
        assert_eq!(kept, (first..=number).collect::<Vec<_>>());
    }
}

/// Nine rows, and the erasure of a page before each 28th record.
#[test]
fn a_page_is_erased_once_for_its_28_records() {
    let mut flash = erased(1);
    append(&mut flash, 0..10 * OF_PAGE);
    assert_eq!(flash.operations, 10 * (OF_PAGE * ROWS + 1));
}

/// Loses the supply while the record after so many is written, and looks at the ring after a restart.
fn cut(before: u32, loss: Loss, interrupt: Interrupt, seed: u64) {
    let mut flash = erased(seed);
    append(&mut flash, 0..before);
    let old = kept(&mut flash);
    flash.restart();
    (flash.loss, flash.interrupt) = (Some(loss), interrupt);
    append(&mut flash, [before]);
    flash.restart();
    let left = kept(&mut flash);
    // The oldest page may be gone, or a part of it, for the new one.
    let oldest =
        if before.is_multiple_of(OF_PAGE) && old.len() as u32 == PLACES { OF_PAGE } else { 0 };
    let (gone, stay) = old.split_at(oldest as usize);
    let context = format!("{loss:?} after {before} records: {left:?}");
    let (found, rest) =
        left.split_at(left.iter().take_while(|number| gone.contains(number)).count());
    assert!(found.is_sorted() && rest.starts_with(stay), "{context}");
    assert!(matches!(rest[stay.len()..], [] | [_]), "{context}");
    assert!(rest[stay.len()..].iter().all(|number| *number == before), "{context}");
    append(&mut flash, [before + 1, before + 2]);
    let after = kept(&mut flash);
    assert!(
        after.is_sorted() && after.ends_with(&[before + 1, before + 2]),
        "{context}, {after:?}"
    );
    assert!(after.len() as u32 >= (before + 2).min(PLACES - OF_PAGE - 2), "{context}, {after:?}");
}

#[test]
fn a_loss_of_supply_at_any_row_or_page_leaves_all_records_but_the_one_that_is_written() {
    for before in [0, 1, 26, 27, 28, 29, 55, 56, 83, 84, 85, 111, 112, 140, 168] {
        for (operation, seed) in
            (0..=ROWS + 1).flat_map(|operation| (0..4).map(move |seed| (operation, seed)))
        {
            for interrupt in [Interrupt::Notes, Interrupt::Returns] {
                cut(before, Loss::After(operation), interrupt, seed);
                cut(before, Loss::Within(operation), interrupt, seed);
            }
        }
    }
}

proptest! {
    /// Starts that each write some records and lose their supply in the last of them.
    #[test]
    fn after_any_losses_of_supply_whatever_was_written_is_read_in_its_order(
        starts in vec((0_u32..12, prop::option::of((any::<bool>(), 0_u32..11))), 1..40), seed in any::<u64>(),
    ) {
        let (mut flash, mut number, mut written) = (erased(seed), 0, Vec::new());
        for (count, loss) in starts {
            append(&mut flash, number..number + count);
            written.extend(number..number + count);
            number += count;
            flash.restart();
            if let Some((is_within, operation)) = loss {
                flash.loss = Some(if is_within { Loss::Within(operation) } else { Loss::After(operation) });
                append(&mut flash, [number]);
                let is_written = flash.stopped().is_none();
                flash.restart();
                written.extend(is_written.then_some(number));
                number += 1;
            }
            let kept = kept(&mut flash);
            prop_assert!(kept.is_sorted(), "{:?}", kept);
            // One page was erased, and places of another are torn.
            let latest = &written[written.len().saturating_sub(OF_PAGE as usize)..];
            prop_assert!(latest.iter().all(|number| kept.contains(number)), "{:?} of {:?}", kept, latest);
        }
    }

    #[test]
    fn pages_of_anything_hold_no_record_and_take_one(
        bytes in vec(prop_oneof![Just(0xFF), Just(0), any::<u8>()], 3 * PAGE),
    ) {
        let mut flash = erased(1);
        flash.flash.burn(FIRST, &bytes);
        prop_assert_eq!(ring(&mut flash).found, 0);
        append(&mut flash, 0..2 * PLACES);
        let kept = kept(&mut flash);
        prop_assert_eq!(kept.last(), Some(&(2 * PLACES - 1)));
        prop_assert!(kept.is_sorted() && kept.len() as u32 == PLACES);
    }
}
