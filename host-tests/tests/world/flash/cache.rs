//! The data cache, and its erratum.

use super::{DATA, ERASED, LATER, START, UPPER, erased, sound};
use core::time::Duration;
use hal_mock::flash::{Bank, Cells, Flash, ROW, Times};

/// A row of the lower bank holds data; the cache is spoilt wherever it can be.
fn risky(seed: u64) -> Flash<Box<Cells>> {
    let mut flash = erased(seed);
    flash.burn(0, &DATA);
    flash.set_cache_risk(1.0);
    flash
}

/// Reads the row of the lower bank while one of the upper bank is programmed, and again afterwards.
fn read_beside_a_write(flash: &mut Flash<Box<Cells>>) -> [[u8; ROW]; 2] {
    flash.program(UPPER, DATA, START).expect("it is erased");
    let times = [Times::TYPICAL.row / 2, LATER];
    times.map(|now| flash.load(0, now).expect("the other bank is readable").bytes)
}

#[test]
fn a_read_beside_a_write_to_the_other_bank_is_right_and_later_ones_may_be_wrong() {
    let mut flash = risky(1);
    let [first, second] = read_beside_a_write(&mut flash);
    assert_eq!(first, DATA);
    assert_ne!(second, DATA);
    assert_eq!(flash.load(0, LATER * 2).map(|read| read.bytes), Ok(second), "every hit is");
    assert_eq!(flash.read(0, LATER * 2), sound(DATA), "the flash itself is not");
    assert_eq!(flash.spoilt_rows(), 1);
    assert_eq!(read_beside_a_write(&mut risky(1))[1], second, "one seed, one run");
    assert_ne!(read_beside_a_write(&mut risky(2))[1], second);
}

#[test]
fn the_remedy_is_to_switch_the_cache_off_before_a_write_and_to_reset_it() {
    let mut flash = risky(1);
    flash.switch_cache(false);
    assert_eq!(read_beside_a_write(&mut flash), [DATA; 2]);
    flash.reset_cache();
    flash.switch_cache(true);
    assert_eq!(flash.load(0, LATER), sound(DATA));
    assert_eq!(flash.spoilt_rows(), 0);
}

#[test]
fn nothing_is_spoilt_by_an_erasure_or_without_a_write() {
    let mut flash = risky(1);
    flash.erase_page(Bank::Upper, 0, START).expect("nothing is under way");
    let times = [Duration::from_millis(1), Duration::from_millis(2), LATER, LATER * 2];
    assert_eq!(times.map(|now| flash.load(0, now)), [sound(DATA); 4]);
    assert_eq!(flash.spoilt_rows(), 0);
}

#[test]
fn the_cache_follows_a_write_but_not_an_erasure() {
    let mut flash = erased(1);
    assert_eq!(flash.load(UPPER, START), sound(ERASED));
    flash.program(UPPER, DATA, START).expect("it is erased");
    assert_eq!(flash.load(UPPER, LATER), sound(DATA));
    flash.erase_page(Bank::Upper, 0, LATER).expect("nothing is under way");
    let later = LATER * 2;
    assert_eq!(flash.load(UPPER, later), sound(DATA), "it holds what was erased");
    assert_eq!(flash.read(UPPER, later), sound(ERASED));
    flash.reset_cache();
    assert_eq!(flash.load(UPPER, later), sound(DATA), "a reset needs the cache switched off");
    flash.switch_cache(false);
    flash.reset_cache();
    flash.switch_cache(true);
    assert_eq!(flash.load(UPPER, later), sound(ERASED));
}

/// Eight lines of 32 bytes: the ninth line takes the place of the one that was used least recently.
#[test]
fn the_line_that_was_used_least_recently_gives_way() {
    let mut flash = erased(1);
    let lines = |from: u32, to: u32| (from..to).map(|line| UPPER + 32 * line);
    lines(0, 9).for_each(|offset| flash.burn(offset, &DATA));
    for offset in lines(0, 8).chain(lines(0, 1)).chain(lines(8, 9)) {
        assert_eq!(flash.load(offset, START), sound(DATA));
    }
    flash.erase_page(Bank::Upper, 0, START).expect("nothing is under way");
    let held = lines(0, 9).filter(|offset| flash.load(*offset, LATER) == sound(DATA));
    // Line 1 gave way to line 8; fetching it anew takes the place of line 2, and so on.
    assert_eq!(held.collect::<Vec<_>>(), [UPPER]);
}

#[test]
fn a_hit_does_not_wait_for_its_bank() {
    let mut flash = erased(1);
    assert_eq!(flash.load(UPPER, START), sound(ERASED));
    flash.program(UPPER + 64, DATA, START).expect("it is erased");
    assert_eq!(flash.load(UPPER, START), sound(ERASED));
    assert!(flash.load(UPPER + 8, START).is_err(), "a row of the line that was not fetched");
}

#[test]
fn a_restart_empties_the_cache_and_switches_it_on() {
    let mut flash = risky(1);
    let [_, spoilt] = read_beside_a_write(&mut flash);
    assert_ne!(spoilt, DATA);
    flash.switch_cache(false);
    flash.lose_supply(LATER);
    assert_eq!(flash.load(0, LATER), sound(DATA));
}
