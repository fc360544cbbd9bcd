//! Registers of the flash.

use emulated_board::controller::Refused;
use emulated_board::controller::flash::STORE;
use emulated_board::time::Time;
use hal_mock::flash::Bank;

use super::Bench;

/// Registers of the flash.
const FLASH: u32 = 0x4002_2000;
/// A row of the store.
const ROW: u32 = STORE.start;

/// A flash whose control register is open.
fn open() -> Bench {
    let mut bench = Bench::new();
    bench.write(FLASH + 8, 0x4567_0123);
    bench.write(FLASH + 8, 0xCDEF_89AB);
    bench
}

/// Stores a row.
fn store(bench: &mut Bench, words: [u32; 2]) {
    for (offset, word) in [ROW, ROW + 4].into_iter().zip(words) {
        let waits = bench.controller.flash.store(offset, word, 4, bench.now);
        assert_eq!(waits, None);
    }
}

#[test]
fn without_the_keys_nothing_is_programmed() {
    let mut bench = Bench::new();
    bench.write(FLASH + 0x14, 1);
    assert_eq!(bench.read(FLASH + 0x14), 3 << 30, "the locks hold");
    store(&mut bench, [1, 2]);
    assert_eq!(bench.read(FLASH + 0x10), 1 << 7, "an error of the sequence");
    assert_eq!(bench.controller.flash.load(ROW, 4, bench.now), Ok(0xFFFF_FFFF));
}

#[test]
fn two_words_program_a_row_in_82_microseconds_while_its_bank_cannot_be_read() {
    let mut bench = open();
    bench.write(FLASH + 0x14, 1);
    store(&mut bench, [0x1111_2222, 0x3333_4444]);
    assert_eq!(bench.read(FLASH + 0x10), 1 << 16);
    let until = bench.controller.flash.load(ROW, 4, bench.now).expect_err("the bank is busy");
    assert_eq!(until.as_nanoseconds(), 81_690);
    assert!(bench.controller.flash.load(0, 4, bench.now).is_ok(), "the other bank can be read");
    bench.pass(Time::microseconds(82));
    assert_eq!(bench.read(FLASH + 0x10), 0);
    assert_eq!(bench.controller.flash.load(ROW, 4, bench.now), Ok(0x1111_2222));
    assert_eq!(bench.controller.flash.load(ROW + 4, 4, bench.now), Ok(0x3333_4444));
    assert_eq!(bench.controller.flash.load(ROW + 5, 1, bench.now), Ok(0x44));
    // A second time it is refused.
    store(&mut bench, [0, 1]);
    assert_eq!(bench.read(FLASH + 0x10) & 0xFFFF, 1 << 3);
}

#[test]
fn a_store_of_less_than_a_word_is_an_error_of_its_size_and_the_next_one_of_the_sequence() {
    for size in [1, 2] {
        let mut bench = open();
        bench.write(FLASH + 0x14, 1);
        assert_eq!(bench.controller.flash.store(ROW, 0, size, bench.now), None);
        assert_eq!(bench.read(FLASH + 0x10), 1 << 6, "SIZERR (3.7.5)");
        store(&mut bench, [1, 2]);
        assert_eq!(bench.read(FLASH + 0x10), 1 << 6 | 1 << 7, "PGSERR, too");
        assert_eq!(bench.controller.flash.used.rows, 0);
        bench.write(FLASH + 0x10, 1 << 6 | 1 << 7);
        store(&mut bench, [1, 2]);
        assert_eq!(bench.controller.flash.used.rows, 1);
    }
}

#[test]
fn what_the_flash_does_not_do_here_is_refused() {
    // ACR without power; CR with fast programming, protected areas.
    for (offset, value) in [(0, 1 << 13), (0x14, 1 << 18), (0x14, 1 << 26)] {
        let refused = open().try_write(FLASH + offset, value, 4);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{value:#x}: {refused:?}");
    }
}

#[test]
fn rows_that_are_programmed_beside_the_data_cache_are_counted_apart() {
    let mut bench = open();
    bench.write(FLASH + 0x14, 1);
    let counted = |bench: &Bench| {
        let used = bench.controller.flash.used;
        [used.rows, used.rows_with_cache_on]
    };
    // The cache is on after a reset (RM0351, 3.7.1).
    store(&mut bench, [1, 2]);
    assert_eq!(counted(&bench), [1, 1]);
    bench.pass(Time::microseconds(82));
    let access = bench.read(FLASH);
    bench.write(FLASH, access & !(1 << 10));
    for (offset, word) in [(ROW + 8, 3), (ROW + 12, 4)] {
        bench.controller.flash.store(offset, word, 4, bench.now);
    }
    assert_eq!(counted(&bench), [2, 1]);
}

#[test]
fn a_page_is_erased_in_22_milliseconds_and_the_end_interrupts() {
    let mut bench = open();
    bench.controller.flash.array.burn(ROW, &[0; 16]);
    // Page 254 of bank 2; the end interrupts.
    bench.write(FLASH + 0x14, 2 | 254 << 3 | 1 << 11 | 1 << 16 | 1 << 24);
    bench.pass(Time::microseconds(22_000));
    assert!(!bench.interrupts(4));
    bench.pass(Time::microseconds(100));
    assert!(bench.interrupts(4));
    assert_eq!(bench.controller.flash.load(ROW, 4, bench.now), Ok(0xFFFF_FFFF));
    bench.write(FLASH + 0x10, 1);
    assert!(!bench.interrupts(4));
}

#[test]
fn a_row_that_lost_its_supply_or_charge_is_corrected_or_told() {
    let mut bench = open();
    bench.controller.flash.array.burn(ROW, &[0x55; 8]);
    bench.controller.flash.array.invert(ROW, 3);
    assert_eq!(bench.controller.flash.load(ROW, 4, bench.now), Ok(0x5555_5555));
    assert_eq!(bench.read(FLASH + 0x18) >> 30, 1, "corrected");
    bench.write(FLASH + 0x18, 1 << 30);
    bench.controller.flash.array.invert(ROW, 4);
    bench.controller.flash.array.switch_cache(false);
    let _ = bench.controller.flash.load(ROW, 4, bench.now);
    assert_eq!(bench.read(FLASH + 0x18) >> 31, 1, "beyond correction");
    assert!(bench.controller.exceptions.pending.has(2), "which is not maskable");
}

#[test]
fn an_erasure_in_the_bank_that_the_program_is_executed_from_is_refused_and_one_in_the_other_is_not()
{
    // PER and BKER, MER1, MER2; and STRT.
    for (control, bank) in
        [(1 << 1, false), (1 << 1 | 1 << 11, true), (1 << 2, false), (1 << 15, true)]
    {
        let mut bench = open();
        bench.controller.flash.program = Some(Bank::Lower);
        let erased = bench.controller.flash.write(0x14, control | 1 << 16, bench.now);
        assert_eq!(erased.is_ok(), bank, "{control:#x}: {erased:?}");
        assert_eq!(bench.controller.flash.used.pages, u64::from(bank));
    }
}
