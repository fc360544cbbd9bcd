//! Random sequences of saves, loads, restarts and losses of supply, against the items that may be there.

use super::{Board, SLOTS, erased};
use hal_mock::flash::nor::{Interrupt, Loss, Trouble};
use hal_mock::flash::sequence::{Step, steps};

/// Sequences of each kind.
const SEQUENCES: u64 = 1000;
/// Steps of a sequence.
const STEPS: usize = 60;

/// What goes wrong in a sequence, which ends with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    /// A load gave an item that may not be there, or none.
    Wrong,
    /// A load failed while the board was supplied.
    Unreadable,
    /// A save failed while the board was supplied.
    Unwritable,
}

/// A board under test, and which items each slot may hold.
struct Sequence {
    flash: Board,
    permitted: [Vec<Option<u64>>; SLOTS.len()],
    cuts: u32,
    /// Whether every third save forgets the slot instead.
    forgets: bool,
}

impl Sequence {
    fn new(seed: u64, forgets: bool) -> Self {
        let permitted = core::array::from_fn(|_| vec![None]);
        Self { flash: erased(seed), permitted, cuts: 0, forgets }
    }

    /// What a slot holds after the save of this number.
    fn saved(&self, number: u64) -> Option<u64> {
        Some(number).filter(|number| !self.forgets || number % 3 > 0)
    }

    /// The step of this number, by which the item is known that it saves.
    fn step(&mut self, step: Step, number: u64) -> Result<(), Defect> {
        match step {
            Step::Save(slot) => self.save(slot, number),
            Step::Cut(slot, loss) => self.cut(slot, number, loss),
            Step::Load(slot) => self.load(slot),
            Step::Restart => {
                self.flash.restart();
                Ok(())
            }
        }
    }

    /// A save in which the supply is lost, unless it is over before.
    fn cut(&mut self, slot: usize, number: u64, loss: Loss) -> Result<(), Defect> {
        self.flash.restart();
        self.flash.loss = Some(loss);
        let saved = self.save(slot, number);
        self.flash.loss = None;
        if self.flash.stopped() != Some(Trouble::Supply) {
            return saved;
        }
        self.flash.restart();
        let saved = self.saved(number);
        self.permitted[slot].push(saved);
        self.cuts += 1;
        Ok(())
    }

    fn save(&mut self, slot: usize, number: u64) -> Result<(), Defect> {
        let saved = self.saved(number);
        let done = match saved {
            Some(number) => SLOTS[slot].save(&mut self.flash, number),
            None => SLOTS[slot].forget(&mut self.flash),
        };
        done.map_err(|_| Defect::Unwritable)?;
        self.permitted[slot] = vec![saved];
        Ok(())
    }

    fn load(&mut self, slot: usize) -> Result<(), Defect> {
        let found = SLOTS[slot].load(&mut self.flash).map_err(|_| Defect::Unreadable)?;
        if !self.permitted[slot].contains(&found) {
            return Err(Defect::Wrong);
        }
        self.permitted[slot] = vec![found];
        Ok(())
    }
}

/// How many sequences end with each defect, and how often the supply was lost.
fn played(is_within: bool, prepare: impl Fn(&mut Board)) -> ([u32; 3], u32) {
    played_with(false, is_within, prepare)
}

/// The same where every third save forgets the slot instead.
fn played_with(forgets: bool, is_within: bool, prepare: impl Fn(&mut Board)) -> ([u32; 3], u32) {
    let (mut defects, mut cuts) = ([0; 3], 0);
    for seed in 0..SEQUENCES {
        let mut sequence = Sequence::new(seed, forgets);
        prepare(&mut sequence.flash);
        let mut steps = (1..).zip(steps(seed, SLOTS.len() as u32, is_within)).take(STEPS);
        if let Err(defect) = steps.try_for_each(|(number, step)| sequence.step(step, number)) {
            defects[defect as usize] += 1;
        }
        cuts += sequence.cuts;
    }
    (defects, cuts)
}

fn expect_none(defects: [u32; 3]) {
    assert!(defects == [0; 3], "{defects:?} of 1000 load a wrong item, cannot load, cannot save");
}

#[test]
fn a_thousand_sequences_with_losses_of_supply_between_rows_have_no_defect() {
    let (defects, cuts) = played(false, |_| ());
    expect_none(defects);
    assert!(cuts > 5 * SEQUENCES as u32, "only {cuts} losses of supply");
}

#[test]
fn a_thousand_sequences_with_losses_of_supply_within_rows_and_pages_have_no_defect() {
    let (defects, _) = played(true, |_| ());
    expect_none(defects);
}

/// What a row reads as that cannot be corrected is taken for its data.
#[test]
fn where_the_interrupt_returns_a_thousand_sequences_have_no_defect() {
    let (defects, _) = played(true, |flash| flash.interrupt = Interrupt::Returns);
    expect_none(defects);
}

/// The data cache keeps what an erased page held until the driver resets it.
#[test]
fn through_the_data_cache_a_thousand_sequences_have_no_defect() {
    let (defects, _) = played(false, |flash| flash.is_cached = true);
    expect_none(defects);
}

#[test]
fn where_slots_are_forgotten_a_thousand_sequences_have_no_defect() {
    let (defects, _) = played_with(true, true, |flash| flash.is_cached = true);
    expect_none(defects);
}

#[test]
fn through_the_data_cache_a_store_that_is_not_interrupted_is_right() {
    let mut flash = erased(1);
    flash.is_cached = true;
    let mut latest = [None; SLOTS.len()];
    for number in 0..1000 {
        let place = number as usize % SLOTS.len();
        SLOTS[place].save(&mut flash, number).expect("there is room");
        latest[place] = Some(number);
        assert_eq!(SLOTS.map(|slot| slot.load(&mut flash)), latest.map(Ok));
    }
}
