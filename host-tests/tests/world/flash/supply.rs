//! The supply is lost while a row is programmed or pages are erased.

use super::{DATA, ERASED, LATER, START, UPPER, erased, sound};
use core::time::Duration;
use hal_mock::flash::{Bank, Cells, Ecc, Flash, PAGE, ROW, Read, Refused, Times};

/// A flash whose supply was lost after this share of a row's programming time.
fn torn(seed: u64, share: f64) -> Flash<Box<Cells>> {
    let mut flash = erased(seed);
    flash.program(UPPER, DATA, START).expect("it is erased");
    flash.lose_supply(Times::TYPICAL.row.mul_f64(share));
    flash
}

fn row(flash: &mut Flash<Box<Cells>>) -> Read {
    flash.read(UPPER, START).expect("nothing is under way")
}

#[test]
fn a_torn_row_holds_only_bits_of_the_old_and_of_the_new_data() {
    let new = u64::from_le_bytes(DATA);
    let cleared = [0.05, 0.5, 0.95].map(|share| {
        let mut cleared = 0;
        for seed in 0..200 {
            let flash = torn(seed, share);
            let (rows, _) = flash.bytes()[UPPER as usize..].as_chunks::<ROW>();
            let held = u64::from_le_bytes(rows[0]);
            assert_eq!(held & new, new, "no bit is cleared that should stay");
            cleared += held.count_zeros();
        }
        f64::from(cleared) / 200.0 / f64::from(new.count_zeros())
    });
    for (found, share) in cleared.into_iter().zip([0.05, 0.5, 0.95]) {
        // Four deviations of a mean of 200 × 33 bits.
        assert!((found - share).abs() < 4.0 * (share * (1.0 - share) / 6600.0).sqrt(), "{found}");
    }
}

#[test]
fn a_row_is_torn_neither_before_its_programming_nor_after_it() {
    assert_eq!(row(&mut torn(1, 0.0)).bytes, ERASED);
    assert_eq!(torn(1, 0.0).program(UPPER, DATA, START), Ok(()));
    let mut after = torn(1, 1.0);
    assert_eq!(after.read(UPPER, START), sound(DATA));
}

/// Half way, half of the torn rows have an odd number of wrong bits, of whose 128 syndromes 72 are those of
/// single bits; the other half an even number, of whose 128 one is that of none.
#[test]
fn most_torn_rows_are_detected_and_some_pass_for_sound_ones() {
    let mut counts = [0; 3];
    for seed in 0..4000 {
        counts[row(&mut torn(seed, 0.5)).ecc as usize] += 1;
    }
    let expected = [1.0 / 128.0, 72.0 / 128.0, (56.0 + 127.0) / 128.0].map(|share| share * 2000.0);
    for (found, expected) in counts.into_iter().zip(expected) {
        assert!((f64::from(found) - expected).abs() < 4.0 * expected.sqrt(), "{counts:?} of 4000");
    }
}

#[test]
fn a_torn_row_may_read_as_erased_and_yet_not_be_programmable() {
    let mut seeds = 0..1000;
    let mut flash = seeds
        .find_map(|seed| {
            let mut flash = torn(seed, 0.03);
            let is_like = row(&mut flash) == Read { bytes: ERASED, ecc: Ecc::Corrected };
            is_like.then_some(flash)
        })
        .expect("there is one with a single bit cleared");
    assert_eq!(flash.program(UPPER, DATA, START), Err(Refused::Programmed));
    assert_eq!(flash.program(UPPER, [0; ROW], START), Ok(()));
    assert_eq!(flash.read(UPPER, LATER), sound([0; ROW]));
}

#[test]
fn a_torn_erasure_tears_its_whole_page_and_another_one_restores_it() {
    let end = UPPER + PAGE as u32;
    let mut flash = erased(3);
    flash.burn(UPPER, &[0x5A; PAGE + ROW]);
    flash.erase_page(Bank::Upper, 0, START).expect("nothing is under way");
    flash.lose_supply(Times::TYPICAL.page / 2);
    let unsound = flash.unsound(UPPER..end).count();
    assert!(unsound > PAGE / ROW - 20, "{unsound} rows of 256");
    assert_eq!(flash.read(end, START), sound([0x5A; ROW]), "the next page is as it was");
    flash.erase_page(Bank::Upper, 0, START).expect("nothing is under way");
    assert_eq!(flash.busy(LATER), None);
    assert_eq!(flash.unsound(UPPER..end).count(), 0);
    assert_eq!(flash.program(UPPER, DATA, LATER), Ok(()));
}

#[test]
fn one_seed_tears_a_row_in_one_way() {
    let half = Duration::from_micros(40);
    let rows = [7, 7, 8].map(|seed| {
        let mut flash = erased(seed);
        flash.program(UPPER, DATA, START).expect("it is erased");
        flash.lose_supply(half);
        row(&mut flash)
    });
    assert_eq!(rows[0], rows[1]);
    assert_ne!(rows[0], rows[2]);
}
