//! Whatever the two pages hold: rows that cannot be read, rows that hold something else, and pages of anything.

use super::{Board, FIRST, SLOTS, erased, store};
use drivers::fault::Fault;
use firmware::ports::Store as _;
use hal_mock::flash::{PAGE, ROW};
use host::virtual_time::run;
use proptest::collection::vec;
use proptest::prelude::*;

/// Rows of both pages.
const ROWS: u32 = (2 * PAGE / ROW) as u32;

/// A flash in whose store so many items were saved, round the slots; the numbers of the latest ones.
fn used(saves: u64) -> (Board, [Option<u64>; SLOTS.len()]) {
    let (mut flash, mut latest) = (erased(saves), [None; SLOTS.len()]);
    for number in 0..saves {
        let place = number as usize % SLOTS.len();
        SLOTS[place].save(&mut flash, number).expect("there is room");
        latest[place] = Some(number);
    }
    (flash, latest)
}

/// What the slots give, with every item checked that is given.
fn loaded(flash: &mut Board) -> [Result<Option<u64>, Fault>; SLOTS.len()] {
    SLOTS.map(|slot| slot.load(flash))
}

/// Saves an item into every slot, twice as many as fill both pages, and loads it.
fn expect_saves(flash: &mut Board) {
    for number in 0..80 {
        let slot = SLOTS[number as usize % SLOTS.len()];
        slot.save(flash, number).expect("there is room");
        assert_eq!(slot.load(flash), Ok(Some(number)));
    }
}

/// Headers, items, sums, marks, and what is erased: one page, and after two changes of pages.
#[test]
fn any_row_that_cannot_be_read_costs_no_item_and_the_next_saves_neither() {
    for saves in [1, 4, 7, 30, 45] {
        let (flash, latest) = used(saves);
        for row in 0..ROWS {
            let mut flash = flash.clone();
            let offset = FIRST + row * ROW as u32;
            for bit in [3, 40] {
                flash.flash.invert(offset, bit);
            }
            assert_eq!(loaded(&mut flash), latest.map(Ok), "{saves} saves, row {row}");
            assert_eq!(run(store(&mut flash).take_over()), Ok(Ok(false)));
            expect_saves(&mut flash);
        }
    }
}

/// An item that is damaged in two rows does not become an earlier one, nor none, not with a change of pages either.
#[test]
fn an_item_of_which_two_rows_cannot_be_read_stays_damaged_until_it_is_saved_again() {
    let (mut flash, latest) = used(8);
    let [.., record] = SLOTS;
    // The record of settings was saved last: its two marks are before the end, its sum and its item before them.
    let end = flash.flash.bytes().iter().rposition(|byte| *byte != 0xFF).expect("it is used");
    let end = (end + 1).next_multiple_of(ROW) as u32;
    for (row, bit) in [(4, 3), (4, 40), (20, 3), (20, 40)] {
        flash.flash.invert(end - row * ROW as u32, bit);
    }
    assert_eq!(record.load(&mut flash), Err(Fault::Checksum));
    for number in 0..40 {
        SLOTS[0].save(&mut flash, number).expect("there is room");
        assert_eq!(record.load(&mut flash), Err(Fault::Checksum));
        assert_eq!(SLOTS[1].load(&mut flash), Ok(latest[1]));
    }
    record.save(&mut flash, 100).expect("there is room");
    assert_eq!(record.load(&mut flash), Ok(Some(100)));
}

#[test]
fn an_item_of_any_length_is_loaded_as_it_was_saved() {
    fn check<const N: usize>() {
        let mut flash = erased(1);
        let item = core::array::from_fn(|index| (index as u8).wrapping_mul(37));
        assert_eq!(run(store(&mut flash).save::<N>(7, &item)), Ok(Ok(())));
        assert_eq!(run(store(&mut flash).load::<N>(7)), Ok(Ok(Some(item))));
        assert_eq!(run(store(&mut flash).load::<300>(7)), Ok(Err(Fault::Bus)));
    }
    check::<1>();
    check::<7>();
    check::<8>();
    check::<9>();
    check::<255>();
}

#[test]
fn a_store_that_is_full_refuses_the_next_slot_and_keeps_the_others() {
    let mut flash = erased(1);
    let saved = (0..).take_while(|slot| {
        run(store(&mut flash).save(*slot, &[*slot; 192])).expect("it ends").is_ok()
    });
    let saved: Vec<u8> = saved.collect();
    // Of 254 rows, eight are left free, and a record takes 27.
    assert_eq!(saved.len(), 9);
    for slot in saved {
        assert_eq!(run(store(&mut flash).load(slot)), Ok(Ok(Some([slot; 192]))));
    }
}

proptest! {
    /// A row that holds something else, which its code does not show.
    #[test]
    fn a_row_with_other_content_gives_the_item_or_an_error_but_no_other_item(
        saves in 1_u64..60, row in 0..ROWS, content: [u8; ROW],
    ) {
        let (mut flash, latest) = used(saves);
        flash.flash.burn(FIRST + row * ROW as u32, &content);
        for (slot, latest) in SLOTS.iter().zip(latest) {
            let found = slot.load(&mut flash);
            prop_assert!(found == Ok(latest) || found == Err(Fault::Checksum), "{found:?}, not {latest:?}");
        }
        expect_saves(&mut flash);
    }

    #[test]
    fn pages_of_anything_have_no_item_and_are_taken_over(
        bytes in vec(prop_oneof![Just(0xFF), Just(0), any::<u8>()], 2 * PAGE), wrong in vec((0..ROWS, 0_u8..72), 0..20),
    ) {
        let mut flash = erased(1);
        flash.flash.burn(FIRST, &bytes);
        for (row, bit) in wrong {
            flash.flash.invert(FIRST + row * ROW as u32, bit);
        }
        prop_assert_eq!(loaded(&mut flash), [Err(Fault::Bus); SLOTS.len()]);
        prop_assert_eq!(run(store(&mut flash).take_over()), Ok(Ok(true)));
        prop_assert_eq!(loaded(&mut flash), [Ok(None); SLOTS.len()]);
        prop_assert_eq!(run(store(&mut flash).take_over()), Ok(Ok(false)));
        expect_saves(&mut flash);
    }

    /// A save takes pages over by itself.
    #[test]
    fn pages_of_anything_take_a_save(bytes in vec(any::<u8>(), 2 * PAGE)) {
        let mut flash = erased(1);
        flash.flash.burn(FIRST, &bytes);
        expect_saves(&mut flash);
    }

    /// Pages of rows that were torn out of stores and put together anew.
    #[test]
    fn pages_of_a_stores_own_rows_in_any_order_can_be_used(
        rows in vec(prop::option::weighted(0.9, 0..ROWS), ROWS as usize), saves in 1_u64..60,
    ) {
        let (flash, _) = used(saves);
        let mut mixed = erased(1);
        for (place, row) in (0..ROWS).zip(rows) {
            let Some(row) = row else { continue };
            let from = (FIRST + row * ROW as u32) as usize;
            mixed.flash.burn(FIRST + place * ROW as u32, &flash.flash.bytes()[from..from + ROW]);
        }
        for slot in SLOTS {
            let _ = run(store(&mut mixed).load::<64>(slot.key)).expect("it ends");
        }
        prop_assert!(run(store(&mut mixed).take_over()).expect("it ends").is_ok());
        expect_saves(&mut mixed);
    }
}
