//! Couplings are kept over a loss of supply: whenever it comes, the old one or the new one is there.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

use bench::virtual_time::run;
use drivers::fault::Fault;
use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use firmware::ports::CalibrationStore;
use firmware::storage::{FlashStore, Today, keep, recall};
use orientation::align::rotating::coupling::{BYTES, Coupling};
use proptest::prelude::*;
use sequential_storage::map::MapConfig;

/// Bytes of a page and of a word of the board's flash (STM32L475, RM0351, 3.3).
const PAGE: usize = 2048;
const WORD: usize = 8;
const PAGES: usize = 2;

/// Flash of the board's kind: a word is programmed at once, with its check bits, and once between two
/// erasures. The supply may be lost after so many words written or erased; a word that was being programmed
/// in that very moment is not modelled, which the controller would report as an uncorrectable one.
#[derive(Clone, Debug)]
struct Flash {
    bytes: Vec<u8>,
    is_written: Vec<bool>,
    left: Option<usize>,
}

/// The supply is gone, or a rule was broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trouble {
    Supply,
    Misuse,
}

impl NorFlashError for Trouble {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl Flash {
    fn new() -> Self {
        let (bytes, is_written) = (vec![0xFF; PAGE * PAGES], vec![false; PAGE * PAGES / WORD]);
        Self { bytes, is_written, left: None }
    }

    /// Takes one unit of what is left before the supply is lost.
    fn spend(&mut self) -> Result<(), Trouble> {
        match &mut self.left {
            None => Ok(()),
            Some(0) => Err(Trouble::Supply),
            Some(left) => {
                *left -= 1;
                Ok(())
            }
        }
    }
}

impl ErrorType for Flash {
    type Error = Trouble;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Trouble> {
        let from = offset as usize;
        bytes.copy_from_slice(self.bytes.get(from..from + bytes.len()).ok_or(Trouble::Misuse)?);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = PAGE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Trouble> {
        let (from, to) = (from as usize, to as usize);
        assert!(from.is_multiple_of(PAGE) && to.is_multiple_of(PAGE), "whole pages only");
        for word in from / WORD..to / WORD {
            self.spend()?;
            self.bytes[word * WORD..(word + 1) * WORD].fill(0xFF);
            self.is_written[word] = false;
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Trouble> {
        let offset = offset as usize;
        assert!(
            offset.is_multiple_of(WORD) && bytes.len().is_multiple_of(WORD),
            "whole words only"
        );
        for (word, written) in (offset / WORD..).zip(bytes.chunks(WORD)) {
            assert!(!self.is_written[word], "a word is written once");
            self.spend()?;
            self.is_written[word] = true;
            self.bytes[word * WORD..(word + 1) * WORD].copy_from_slice(written);
        }
        Ok(())
    }
}

fn open(flash: Flash) -> FlashStore<Flash> {
    FlashStore::new(flash, const { MapConfig::new(0..(PAGE * PAGES) as u32) })
}

fn save(store: &mut FlashStore<Flash>, bytes: &[u8; BYTES]) -> Result<(), Fault> {
    run(store.save(0, bytes)).expect("it ends")
}

fn load(store: &mut FlashStore<Flash>) -> Option<[u8; BYTES]> {
    run(store.load(0)).expect("it ends").expect("the flash is sound")
}

fn coupling(sine: f64, date: u64) -> Coupling {
    Coupling {
        sine,
        quadrature: 1e-6,
        sine_sigma: 1e-6,
        quadrature_sigma: 1e-6,
        frequency: 0.9,
        date,
        temperature: 21.5,
    }
}

fn stored(number: u8) -> [u8; BYTES] {
    coupling(f64::from(number) * 1e-4, 1_700_000_000).to_bytes()
}

/// A store with so many couplings written one after the other, the last of number 1.
fn used(times: usize) -> FlashStore<Flash> {
    let mut store = open(Flash::new());
    for _ in 0..times {
        save(&mut store, &stored(0)).expect("there is room");
    }
    save(&mut store, &stored(1)).expect("there is room");
    store
}

/// Words until a save is over.
fn effort(times: usize) -> usize {
    let mut flash = used(times).into_flash();
    flash.left = Some(usize::MAX);
    let mut store = open(flash);
    save(&mut store, &stored(2)).expect("there is room");
    usize::MAX - store.into_flash().left.expect("it was set")
}

#[test]
fn what_is_saved_last_is_loaded_from_then_on() {
    let mut store = open(Flash::new());
    assert_eq!(load(&mut store), None);
    for number in 0..200 {
        save(&mut store, &stored(number)).expect("there is room");
        store = open(store.into_flash());
        assert_eq!(load(&mut store), Some(stored(number)));
    }
}

/// At every word of a save, on an empty page, in the middle of one, and where pages are changed and
/// erased.
#[test]
fn a_loss_of_supply_at_any_moment_leaves_the_old_coupling_or_the_new_one() {
    let mut cuts = 0;
    for times in [0, 5, 20, 21, 22, 23, 24, 25, 26, 27, 28] {
        for cut in 0..effort(times) {
            let mut flash = used(times).into_flash();
            flash.left = Some(cut);
            let mut store = open(flash);
            assert!(save(&mut store, &stored(2)).is_err(), "the supply was lost");
            let mut flash = store.into_flash();
            flash.left = None;
            let mut store = open(flash);
            let found = load(&mut store).expect("nothing is lost");
            cuts += 1;
            assert!(found == stored(1) || found == stored(2), "after {times}, cut at {cut}");
            save(&mut store, &stored(3)).expect("it goes on");
            assert_eq!(load(&mut store), Some(stored(3)));
        }
    }
    // Eleven saves of ten words or more each, with 256 words of an erased page in some of them.
    assert!(cuts > 300, "only {cuts} moments");
}

#[test]
fn every_speed_has_its_own_coupling_and_all_are_needed() {
    let mut store = open(Flash::new());
    let today = Today { date: Some(1_700_000_100), longest: Some(3600) };
    let recalled = |store: &mut FlashStore<Flash>, speeds| {
        run(recall(store, speeds, today)).expect("it ends").expect("the flash is sound")
    };
    assert_eq!(recalled(&mut store, 1), None);
    let found = [coupling(0.01, 1_700_000_000), coupling(0.02, 1_700_000_050)];
    run(keep(&mut store, found.into_iter().take(1))).expect("it ends").expect("there is room");
    assert_eq!(recalled(&mut store, 1), Some([Some(found[0]), None]));
    assert_eq!(recalled(&mut store, 2), None);
    run(keep(&mut store, found.into_iter())).expect("it ends").expect("there is room");
    assert_eq!(recalled(&mut store, 2), Some(found.map(Some)));
}

#[test]
fn what_is_no_coupling_is_not_recalled() {
    let mut store = open(Flash::new());
    let mut bytes = stored(1);
    bytes[12] ^= 1;
    save(&mut store, &bytes).expect("there is room");
    let today = Today { date: None, longest: None };
    assert_eq!(run(recall(&mut store, 1, today)), Ok(Ok(None)));
}

proptest! {
    #[test]
    fn a_coupling_is_fresh_between_its_date_and_the_longest_age(
        found in 1_u64..4_000_000_000, age in 0_u64..4_000_000_000, longest in 0_u64..4_000_000_000,
    ) {
        let fresh = |date, longest| Today { date, longest }.is_fresh(&coupling(0.01, found));
        prop_assert_eq!(fresh(Some(found + age), Some(longest)), age <= longest);
        prop_assert!(fresh(Some(found + age), None));
        prop_assert!(!fresh(Some(found - 1), Some(longest)), "it is from the future");
        prop_assert!(!fresh(Some(found - 1), None), "it is from the future");
        prop_assert!(!fresh(None, Some(longest)), "nobody knows its age");
        prop_assert!(fresh(None, None), "its age does not matter");
    }

    #[test]
    fn a_coupling_without_a_date_is_fresh_where_its_age_does_not_matter(
        date in prop::option::of(1_u64..4_000_000_000), longest in 0_u64..4_000_000_000,
    ) {
        let undated = coupling(0.01, 0);
        let of_an_age = Today { date, longest: Some(longest) };
        prop_assert!(!of_an_age.is_fresh(&undated));
        let any_age = Today { date, longest: None };
        prop_assert!(any_age.is_fresh(&undated));
    }
}
