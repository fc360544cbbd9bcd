//! A slot is forgotten by one row, wherever the supply is lost.

use super::{Board, SLOTS, Slot, erased};
use hal_mock::flash::nor::Loss;

/// A flash in whose store so many items were saved, the last of them in this slot.
fn used(saves: u64, slot: Slot, seed: u64) -> Board {
    let mut flash = erased(seed);
    for (number, slot) in (0..saves).zip(SLOTS.iter().cycle()) {
        slot.save(&mut flash, number).expect("there is room");
    }
    slot.save(&mut flash, saves).expect("there is room");
    flash.restart();
    flash
}

/// Over more than three changes of pages. No page is erased for it: that would be an operation more.
#[test]
fn forgetting_is_one_row_however_full_the_page_is() {
    for (slot, saves) in SLOTS.iter().flat_map(|slot| (0..60).map(move |saves| (slot, saves))) {
        let mut flash = used(saves, *slot, saves);
        assert_eq!(slot.forget(&mut flash), Ok(()));
        assert_eq!(flash.operations, 1, "after {saves} saves");
        flash.restart();
        assert_eq!(slot.load(&mut flash), Ok(None));
        assert_eq!(slot.forget(&mut flash), Ok(()));
        assert_eq!(flash.operations, 0, "nothing is left to be forgotten");
    }
}

#[test]
fn a_slot_that_is_forgotten_stays_so_while_the_others_are_saved_and_can_be_saved_again() {
    let [heading, others @ ..] = SLOTS;
    let mut flash = used(5, heading, 1);
    heading.forget(&mut flash).expect("a row is free");
    for number in 0..60 {
        let other = others[number as usize % others.len()];
        other.save(&mut flash, number).expect("there is room");
        assert_eq!(heading.load(&mut flash), Ok(None));
        assert_eq!(other.load(&mut flash), Ok(Some(number)));
    }
    heading.save(&mut flash, 100).expect("there is room");
    assert_eq!(heading.load(&mut flash), Ok(Some(100)));
}

/// Up to four losses one after the other, each within the row that the one before has torn or spared: there is a row for each.
#[test]
fn a_loss_of_supply_amid_forgetting_leaves_the_item_or_none_and_the_next_one_needs_no_erasure() {
    let [slot, ..] = SLOTS;
    let mut kept = 0;
    for seed in 0..1000 {
        let mut flash = used(seed % 60, slot, seed);
        for _ in 0..4 {
            flash.loss = Some(Loss::Within(0));
            // Where nothing is left, nothing is lost.
            let _ = slot.forget(&mut flash);
            flash.restart();
        }
        let left = slot.load(&mut flash).expect("it can be read");
        assert!(left.is_none() || left == Some(seed % 60), "seed {seed}: {left:?}");
        kept += u32::from(left.is_some());
        flash.restart();
        slot.forget(&mut flash).expect("a row is free");
        // A row that is torn but reads as erased is filled with zeros.
        assert!(flash.operations <= 2, "seed {seed}: {} operations", flash.operations);
        assert_eq!(slot.load(&mut flash), Ok(None));
    }
    assert!((100..1000).contains(&kept), "{kept} of 1000 items were kept");
}

#[test]
fn a_store_that_was_never_written_forgets_without_writing() {
    let mut flash = erased(1);
    assert_eq!(SLOTS[0].forget(&mut flash), Ok(()));
    assert_eq!(flash.operations, 0);
}
