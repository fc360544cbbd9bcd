//! The flash of the STM32L475 against its manual's rules.

mod cache;
mod driver;
mod supply;

use core::time::Duration;

use hal_mock::flash::{BANK, Bank, Busy, Cells, Ecc, Flash, PAGE, ROW, Read, Refused, SIZE, Times};
use hal_mock::noise::Generator;

/// Some data that are neither ones nor zeros.
const DATA: [u8; ROW] = *b"Meridian";
/// Nothing was programmed.
const ERASED: [u8; ROW] = [0xFF; ROW];
/// The start.
const START: Duration = Duration::ZERO;
/// Later than any operation that began at the start.
const LATER: Duration = Duration::from_secs(1);
/// The first row of the upper bank.
const UPPER: u32 = BANK as u32;

fn erased(seed: u64) -> Flash<Box<Cells>> {
    let cells: Box<Cells> = vec![0; size_of::<Cells>()].try_into().expect("as long as the cells");
    Flash::erased(cells, Times::TYPICAL, seed)
}

/// An erased flash in which this row was programmed.
fn programmed(offset: u32, bytes: [u8; ROW]) -> Flash<Box<Cells>> {
    let mut flash = erased(1);
    assert_eq!(flash.program(offset, bytes, START), Ok(()));
    assert_eq!(flash.busy(LATER), None);
    flash
}

#[expect(clippy::unnecessary_wraps, reason = "it is compared with what reads return")]
fn sound(bytes: [u8; ROW]) -> Result<Read, Busy> {
    Ok(Read { bytes, ecc: Ecc::Sound })
}

#[test]
fn an_erased_flash_reads_ones_and_every_row_of_it_is_sound() {
    let mut flash = erased(1);
    assert!(flash.bytes().iter().all(|byte| *byte == 0xFF) && flash.bytes().len() == SIZE);
    assert_eq!(flash.unsound(0..SIZE as u32).count(), 0);
    assert_eq!(flash.read(SIZE as u32 - 1, START), sound(ERASED));
}

#[test]
fn a_row_is_programmed_once_between_two_erasures() {
    for first in [DATA, ERASED, [0; ROW]] {
        let mut flash = programmed(UPPER, first);
        for second in [DATA, ERASED, first] {
            let expected = if second == [0; ROW] { Ok(()) } else { Err(Refused::Programmed) };
            assert_eq!(flash.program(UPPER, second, LATER), expected);
        }
        assert_eq!(flash.erase_page(Bank::Upper, 0, LATER * 2), Ok(()));
        assert_eq!(flash.program(UPPER, DATA, LATER * 3), Ok(()));
        assert_eq!(flash.read(UPPER, LATER * 4), sound(DATA));
    }
}

#[test]
fn zeros_may_be_programmed_over_any_row_and_are_sound() {
    let mut noise = Generator::new(1);
    for _ in 0..100 {
        let mut flash = programmed(0, noise.next_u64().to_le_bytes());
        assert_eq!(flash.program(0, [0; ROW], LATER), Ok(()));
        assert_eq!(flash.read(0, LATER * 2), sound([0; ROW]));
    }
}

#[test]
fn a_row_must_be_aligned_and_within_the_flash() {
    let mut flash = erased(1);
    for offset in 1..ROW as u32 {
        assert_eq!(flash.program(offset, DATA, START), Err(Refused::Unaligned));
    }
    assert_eq!(flash.program(SIZE as u32, DATA, START), Err(Refused::OutOfBounds));
    assert_eq!(flash.busy(START), None);
    assert!(flash.bytes().iter().all(|byte| *byte == 0xFF));
}

/// The figures of the data sheet, and that 256 rows take what the same table says of a page: 20.91 ms
/// typically, 23.24 ms at the longest.
#[test]
fn operations_take_the_times_of_the_data_sheet() {
    let micros = |hundredths: u64| Duration::from_nanos(hundredths * 10);
    let tables = [
        (Times::TYPICAL, [8_169, 2_202_000, 2_213_000], 20.91),
        (Times::LONGEST, [9_076, 2_447_000, 2_459_000], 23.24),
    ];
    for (times, expected, page_ms) in tables {
        assert_eq!([times.row, times.page, times.bank], expected.map(micros));
        assert!(((times.row * 256).as_secs_f64() * 1e3 - page_ms).abs() < 0.01);
    }
    let typical = Times::TYPICAL;
    let mut flash = erased(1);
    let busy = |until| Some(Busy { until });
    flash.program(0, DATA, START).expect("it is erased");
    assert_eq!(flash.busy(START), busy(typical.row));
    let start = LATER;
    flash.erase_page(Bank::Lower, 7, start).expect("nothing is under way");
    assert_eq!(flash.busy(start), busy(start + typical.page));
    let start = LATER * 2;
    flash.erase_bank(Bank::Upper, start).expect("nothing is under way");
    assert_eq!(flash.busy(start), busy(start + typical.bank));
    assert_eq!(flash.busy(start + typical.bank), None);
}

#[test]
fn the_other_bank_is_readable_while_one_is_busy() {
    let row = Times::TYPICAL.row;
    for (written, other) in [(0, UPPER), (UPPER, 0)] {
        let mut flash = programmed(other, DATA);
        flash.program(written + 8, DATA, LATER).expect("it is erased");
        let last = LATER + row.saturating_sub(Duration::from_nanos(1));
        assert_eq!(flash.read(other, last), sound(DATA));
        // Any row of the same bank waits, and the program's writes to either bank do.
        let busy = Busy { until: LATER + row };
        assert_eq!(flash.read(written + 64, last), Err(busy));
        assert_eq!(flash.program(written + 16, DATA, last), Err(Refused::Busy(busy)));
        assert_eq!(flash.program(other + 8, DATA, last), Err(Refused::Busy(busy)));
        assert_eq!(flash.erase_page(Bank::of(other), 3, last), Err(busy));
        assert_eq!(flash.read(written + 8, LATER + row), sound(DATA));
    }
}

#[test]
fn erasing_both_banks_at_once_lets_neither_be_read() {
    let mut flash = programmed(UPPER, DATA);
    flash.erase_all(LATER).expect("nothing is under way");
    let busy = Err(Busy { until: LATER + Times::TYPICAL.bank });
    assert_eq!([0, UPPER].map(|offset| flash.read(offset, LATER)), [busy; 2]);
    assert_eq!(flash.read(UPPER, LATER * 2), sound(ERASED));
}

#[test]
fn an_erasure_restores_its_page_or_bank_and_nothing_else() {
    let page = UPPER + 9 * PAGE as u32;
    let edges = [page - 8, page, page + PAGE as u32 - 8, page + PAGE as u32];
    let mut flash = erased(1);
    for row in edges {
        flash.burn(row, &DATA);
    }
    flash.erase_page(Bank::Upper, 9, START).expect("nothing is under way");
    let found = edges.map(|row| flash.read(row, LATER));
    assert_eq!(found, [DATA, ERASED, ERASED, DATA].map(sound));
    flash.burn(UPPER - 8, &DATA);
    flash.erase_bank(Bank::Upper, LATER).expect("nothing is under way");
    let found = [UPPER - 8, page - 8, SIZE as u32 - 8].map(|row| flash.read(row, LATER * 2));
    assert_eq!(found, [DATA, ERASED, ERASED].map(sound));
}

#[test]
fn what_a_debugger_programs_is_there_at_once_with_its_check_bits() {
    let mut flash = erased(1);
    flash.burn(0x1003, b"image");
    assert_eq!(flash.read(0x1000, START), sound(*b"\xFF\xFF\xFFimage"));
    assert_eq!(flash.read(0x1008, START), sound(ERASED));
    assert_eq!(flash.program(0x1000, DATA, START), Err(Refused::Programmed));
}

#[test]
fn one_wrong_bit_of_the_72_is_corrected_and_two_are_detected() {
    let mut noise = Generator::new(2);
    let drawn = [(); 4].map(|()| noise.next_u64().to_le_bytes());
    for data in drawn.into_iter().chain([DATA, [0; ROW], ERASED]) {
        let mut flash = programmed(0, data);
        for bit in 0..72 {
            flash.invert(0, bit);
            let read = flash.read(0, LATER);
            assert_eq!(read, Ok(Read { bytes: data, ecc: Ecc::Corrected }), "bit {bit}");
            for other in 0..bit {
                flash.invert(0, other);
                let ecc = flash.read(0, LATER).map(|read| read.ecc);
                assert_eq!(ecc, Ok(Ecc::Uncorrectable), "bits {other} and {bit}");
                flash.invert(0, other);
            }
            flash.invert(0, bit);
        }
        assert_eq!(flash.read(0, LATER), sound(data));
    }
}

/// RM0351, 3.3.2: of virgin data, one error is detected and corrected.
#[test]
fn one_wrong_bit_of_an_erased_row_is_corrected_but_the_row_is_no_longer_erased() {
    for bit in 0..72 {
        let mut flash = erased(1);
        flash.invert(UPPER, bit);
        assert_eq!(flash.read(UPPER, START), Ok(Read { bytes: ERASED, ecc: Ecc::Corrected }));
        assert_eq!(flash.program(UPPER, DATA, START), Err(Refused::Programmed));
        assert_eq!(flash.unsound(0..SIZE as u32).collect::<Vec<_>>(), [(UPPER, Ecc::Corrected)]);
    }
}
