//! The flash as a program sees it through its driver.

use super::{DATA, ERASED, UPPER, erased};
use core::time::Duration;
use embedded_storage_async::nor_flash::{NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use hal_mock::flash::nor::{Interrupt, Loss, PoweredFlash, Trouble};
use hal_mock::flash::{Cells, PAGE, ROW, SIZE, Times};
use host::virtual_time::run;

fn powered() -> PoweredFlash<Box<Cells>> {
    PoweredFlash::new(erased(1), 1)
}

fn read<const N: usize>(
    flash: &mut PoweredFlash<Box<Cells>>,
    offset: u32,
) -> Result<[u8; N], Trouble> {
    let mut bytes = [0; N];
    run(flash.read(offset, &mut bytes)).expect("it ends").map(|()| bytes)
}

fn write(flash: &mut PoweredFlash<Box<Cells>>, offset: u32, bytes: &[u8]) -> Result<(), Trouble> {
    run(flash.write(offset, bytes)).expect("it ends")
}

fn erase(flash: &mut PoweredFlash<Box<Cells>>, from: u32, to: u32) -> Result<(), Trouble> {
    run(flash.erase(from, to)).expect("it ends")
}

#[test]
fn it_reads_bytes_writes_rows_and_erases_pages() {
    let mut flash = powered();
    assert_eq!(flash.capacity(), SIZE);
    assert_eq!(write(&mut flash, UPPER, b"MeridianMeridian"), Ok(()));
    assert_eq!(read(&mut flash, UPPER + 6), Ok(*b"anMeri"));
    assert_eq!(erase(&mut flash, UPPER, UPPER + 2 * PAGE as u32), Ok(()));
    assert_eq!(read(&mut flash, UPPER), Ok(ERASED));
    assert_eq!(flash.operations, 4);
    assert_eq!(flash.now(), Times::TYPICAL.row * 2 + Times::TYPICAL.page * 2);
}

#[test]
fn it_refuses_what_is_not_in_whole_rows_or_pages_or_not_in_the_flash() {
    let mut flash = powered();
    let (size, page) = (SIZE as u32, PAGE as u32);
    assert_eq!(write(&mut flash, 4, &DATA), Err(Trouble::Unaligned));
    assert_eq!(write(&mut flash, 0, &DATA[..4]), Err(Trouble::Unaligned));
    assert_eq!(write(&mut flash, size, &DATA), Err(Trouble::Size));
    assert_eq!(read::<2>(&mut flash, size - 1), Err(Trouble::Size));
    assert_eq!(erase(&mut flash, 0, 8), Err(Trouble::Unaligned));
    assert_eq!(erase(&mut flash, 8, page), Err(Trouble::Unaligned));
    assert_eq!(erase(&mut flash, page, 0), Err(Trouble::Unaligned));
    assert_eq!(erase(&mut flash, size, size + page), Err(Trouble::Size));
    assert_eq!(flash.operations, 0);
    let kinds = [Trouble::Size, Trouble::Unaligned, Trouble::Programmed].map(|error| error.kind());
    let expected =
        [NorFlashErrorKind::OutOfBounds, NorFlashErrorKind::NotAligned, NorFlashErrorKind::Other];
    assert_eq!(kinds, expected);
}

#[test]
fn rows_before_a_refused_one_stay_written() {
    let mut flash = powered();
    assert_eq!(write(&mut flash, 8, &DATA), Ok(()));
    assert_eq!(write(&mut flash, 0, &[1; 2 * ROW]), Err(Trouble::Programmed));
    assert_eq!(read(&mut flash, 0), Ok([1; ROW]));
    assert_eq!(read(&mut flash, 8), Ok(DATA));
}

#[test]
fn after_a_loss_of_supply_everything_fails_until_it_comes_back() {
    for (loss, written) in [(0, 0), (1, 1), (2, 2)].map(|(rows, left)| (Loss::After(rows), left)) {
        let mut flash = powered();
        flash.loss = Some(loss);
        assert_eq!(write(&mut flash, 0, &[1; 3 * ROW]), Err(Trouble::Supply));
        assert_eq!(write(&mut flash, 64, &DATA), Err(Trouble::Supply));
        assert_eq!(read::<1>(&mut flash, 0), Err(Trouble::Supply));
        assert_eq!(erase(&mut flash, 0, PAGE as u32), Err(Trouble::Supply));
        flash.restart();
        let mut expected = [0xFF; 3 * ROW];
        expected[..written * ROW].fill(1);
        assert_eq!(read(&mut flash, 0), Ok(expected));
        assert_eq!(write(&mut flash, 64, &DATA), Ok(()));
    }
}

#[test]
fn a_loss_within_an_operation_is_at_some_moment_of_it() {
    let row = Times::TYPICAL.row;
    let mut moments = Vec::new();
    for seed in 0..20 {
        let mut flash = PoweredFlash::new(erased(seed), seed);
        flash.loss = Some(Loss::Within(1));
        assert_eq!(write(&mut flash, 0, &[1; 3 * ROW]), Err(Trouble::Supply));
        moments.push(flash.now().saturating_sub(row));
        flash.restart();
        flash.interrupt = Interrupt::Returns;
        assert_eq!(read(&mut flash, 0), Ok([1; ROW]));
        assert_eq!(read(&mut flash, 16), Ok(ERASED));
    }
    moments.sort();
    assert!(moments[0] < row / 4 && moments[19] > row * 3 / 4 && moments[19] < row);
    assert_ne!(moments[0], Duration::ZERO);
}

#[test]
fn an_uncorrectable_row_is_an_error_of_its_read_or_is_read_as_the_cells_hold_it() {
    for is_cached in [false, true] {
        let mut flash = powered();
        flash.is_cached = is_cached;
        assert_eq!(write(&mut flash, 0, &[1; 3 * ROW]), Ok(()));
        for bit in [3, 40] {
            flash.flash.invert(8, bit);
        }
        for _ in 0..2 {
            assert_eq!(read(&mut flash, 0), Ok([1; ROW]));
            assert_eq!(read::<1>(&mut flash, 8), Err(Trouble::Uncorrectable), "each time");
            assert_eq!(read(&mut flash, 16), Ok([1; ROW]));
        }
        assert_eq!(flash.stopped(), None);
        flash.interrupt = Interrupt::Returns;
        assert_eq!(read(&mut flash, 8), Ok([9, 1, 1, 1, 1, 0, 1, 1]));
    }
}

#[test]
fn what_an_erased_page_held_is_not_read_out_of_the_cache_nor_are_rows_spoilt_there() {
    let mut flash = powered();
    flash.is_cached = true;
    flash.flash.set_cache_risk(1.0);
    assert_eq!(write(&mut flash, UPPER, &DATA), Ok(()));
    assert_eq!(read(&mut flash, UPPER), Ok(DATA));
    assert_eq!(erase(&mut flash, UPPER, UPPER + PAGE as u32), Ok(()));
    assert_eq!(read(&mut flash, UPPER), Ok(ERASED));
    assert_eq!(flash.flash.spoilt_rows(), 0);
}
