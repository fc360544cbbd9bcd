//! The supply is lost at every row and page of a save, between them and within them.

use super::{BY_FIRST, BY_TODAY, Board, SLOTS, Slot, erased};
use hal_mock::flash::nor::{Interrupt, Loss};

/// The item that a slot holds before the supply is lost.
const OLD: u64 = 1000;
/// The item that is being saved when it is lost.
const NEW: u64 = 2000;
/// An item that is saved afterwards.
const LATER: u64 = 3000;

/// What was found after losses of supply.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Losses of supply.
    cuts: u32,
    /// The slot holds the old item.
    old: u32,
    /// The slot holds the new item.
    new: u32,
    /// The slot holds none, or another one.
    lost: u32,
    /// The slot cannot be read.
    unreadable: u32,
    /// The slot cannot be written, not after three restarts either.
    unwritable: u32,
}

/// A flash in whose store so many items were saved, and then this slot's old one. About 15 fill a page.
fn used(saves: usize, slot: Slot, seed: u64) -> Board {
    let mut flash = erased(seed);
    for (number, slot) in (0..).zip(SLOTS.iter().cycle().take(saves)) {
        slot.save(&mut flash, number).expect("there is room");
    }
    slot.save(&mut flash, OLD).expect("there is room");
    flash.restart();
    flash
}

/// Rows and pages that a save writes and erases.
fn effort(mut flash: Board, slot: Slot) -> u32 {
    slot.save(&mut flash, NEW).expect("there is room");
    flash.operations
}

/// Loses the supply in a save, and looks at the store after a restart.
fn cut(mut flash: Board, slot: Slot, loss: Loss, tally: &mut Tally) {
    flash.loss = Some(loss);
    slot.save(&mut flash, NEW).expect_err("the supply was lost");
    flash.restart();
    tally.cuts += 1;
    match slot.load(&mut flash) {
        Ok(Some(OLD)) => tally.old += 1,
        Ok(Some(NEW)) => tally.new += 1,
        Ok(_) => tally.lost += 1,
        Err(_) => tally.unreadable += 1,
    }
    let is_saved = (0..3).any(|_| {
        flash.restart();
        slot.save(&mut flash, LATER).is_ok() && slot.load(&mut flash) == Ok(Some(LATER))
    });
    tally.unwritable += u32::from(!is_saved);
}

/// Loses the supply in a save of each slot into stores with 0 to 39 items before, so that pages are filled, changed
/// and erased. The losses depend on how much the save writes and erases.
fn cuts(interrupt: Interrupt, losses: impl Fn(u32) -> Vec<Loss>) -> Tally {
    let mut tally = Tally::default();
    for slot in SLOTS {
        cuts_over((slot, slot), interrupt, &losses, &mut tally);
    }
    tally
}

/// The same for one slot, whose old item was saved otherwise than the new one is.
fn cuts_over(
    (old, new): (Slot, Slot),
    interrupt: Interrupt,
    losses: &dyn Fn(u32) -> Vec<Loss>,
    tally: &mut Tally,
) {
    for saves in 0..40 {
        let mut flash = used(saves, old, saves as u64);
        flash.interrupt = interrupt;
        for loss in losses(effort(flash.clone(), new)) {
            cut(flash.clone(), new, loss, tally);
        }
    }
}

/// Before the first row or page, and after each.
fn between(effort: u32) -> Vec<Loss> {
    (0..=effort).map(Loss::After).collect()
}

/// Within each row and page.
fn within(effort: u32) -> Vec<Loss> {
    (0..effort).map(Loss::Within).collect()
}

#[test]
fn a_loss_of_supply_between_rows_leaves_the_old_item_or_the_new_one() {
    let tally = cuts(Interrupt::Notes, between);
    let Tally { cuts, old, new, unwritable, .. } = tally;
    assert!(old + new == cuts && unwritable == 0, "{tally:?}");
    // 40 saves of 12, 11, 11 and 34 rows in their slots. Eleven of them change pages: one item of each slot is carried
    // along, the header is written twice, and a page is erased.
    assert_eq!(cuts, 40 * (13 + 12 + 12 + 35) + 11 * (12 + 11 + 11 + 34 + 3));
}

/// Settings of either version under a record of today: between any two rows, and within each.
#[test]
fn a_loss_of_supply_while_settings_are_saved_leaves_the_old_ones_of_either_version_or_the_new_ones()
{
    for before in [BY_FIRST, BY_TODAY] {
        let mut tally = Tally::default();
        cuts_over((before, BY_TODAY), Interrupt::Notes, &between, &mut tally);
        let Tally { cuts, old, new, unwritable, .. } = tally;
        assert!(old + new == cuts && old > 0 && new > 0 && unwritable == 0, "{tally:?}");
        assert!(cuts > 40 * 34, "{cuts} moments: a record of 248 bytes has 34 rows");
        let mut tally = Tally::default();
        cuts_over((before, BY_TODAY), Interrupt::Notes, &within, &mut tally);
        let Tally { cuts, old, new, unreadable, unwritable, .. } = tally;
        assert!(old + new == cuts && unreadable + unwritable == 0, "{tally:?}");
    }
}

#[test]
fn a_loss_of_supply_within_a_row_or_page_leaves_a_slot_that_can_be_used() {
    let Tally { cuts, unreadable, unwritable, .. } = cuts(Interrupt::Notes, within);
    assert!(
        unreadable + unwritable == 0,
        "{unreadable} of {cuts} leave a slot that cannot be read, {unwritable} one that cannot be written"
    );
}

/// A first row in which a single bit has changed reads as erased, and is where the next item is to go, which it refuses.
#[test]
fn where_the_interrupt_returns_a_slot_can_be_written_after_a_loss_of_supply_within_a_row_or_page() {
    let tally = cuts(Interrupt::Returns, within);
    let Tally { cuts, unreadable, unwritable, .. } = tally;
    assert_eq!(unreadable, 0, "nothing that is read through stops it");
    assert!(unwritable == 0, "{unwritable} of {cuts} leave a slot that cannot be written");
}

/// Saves that erase a page, the lower one and the upper one for each slot: the slot, and items that are saved before.
/// The erasure is the first of their operations.
fn erasures() -> Vec<(Slot, usize)> {
    let mut found = Vec::new();
    for slot in SLOTS {
        let rows = effort(used(0, slot, 0), slot);
        let changes = (0..40).filter(|saves| effort(used(*saves, slot, 0), slot) > rows).take(2);
        found.extend(changes.map(|saves| (slot, saves)));
    }
    found
}

#[test]
fn where_the_interrupt_returns_a_loss_of_supply_within_an_erasure_leaves_the_old_item() {
    let (mut lost, mut refused) = (0, 0);
    for ((slot, saves), seed) in erasures().into_iter().cycle().zip(0..400) {
        let mut flash = used(saves, slot, seed);
        flash.interrupt = Interrupt::Returns;
        flash.loss = Some(Loss::Within(0));
        slot.save(&mut flash, NEW).expect_err("the supply was lost");
        flash.restart();
        let other = SLOTS[usize::from(slot.key == SLOTS[0].key)];
        let is_saved = other.save(&mut flash, LATER).is_ok();
        refused += u32::from(!is_saved);
        lost += u32::from(is_saved && slot.load(&mut flash) != Ok(Some(OLD)));
    }
    assert!(
        lost + refused == 0,
        "in {lost} of 400 the next save loses the item, in {refused} nothing can be saved"
    );
}
