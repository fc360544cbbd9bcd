//! The store at work while samples come, which acquisition does not wait for.

use emulated_board::time::Time;
use execution::report::FlashUse;
use firmware::platform::Platform;

use super::support::board::Board;
use super::support::executed::executed;
use super::support::figure::within;
use super::support::worlds::{FULL, short_stage};

/// Rows of the settings, and of a heading.
const ROWS: [u64; 2] = [27, 12];

/// How long a converter waited at most to be read since this was asked for the last time.
fn longest_wait(board: &Board) -> Time {
    let now = board.execution.processor.now();
    board.controller(|controller| controller.wiring.served(now)).longest.0
}

/// The longest time for which a conversion waits when the first heading is saved into a store with so many others, ms;
/// the rows that are programmed then, and the pages that are erased.
fn saved(headings: usize) -> (f64, u64, u64) {
    let mut board = Board::within(Platform::Stage, short_stage(true, headings));
    board.until("handed over", 90.0);
    board.run(0.2);
    longest_wait(&board);
    board.run(5.0);
    let used = board.controller(|controller| controller.flash.used);
    (1e3 * longest_wait(&board).as_seconds(), used.rows, used.pages)
}

#[test]
fn acquisition_waits_for_a_heading_that_is_saved_for_less_than_a_period() {
    let (wait, rows, pages) = saved(0);
    assert_eq!((rows, pages), (ROWS[1], 0));
    within(wait, 0.0..=2.5, "ms acquisition waits for a heading that is saved");
}

#[test]
fn acquisition_waits_for_a_page_that_is_erased_for_less_than_a_period() {
    let (wait, rows, pages) = saved(FULL);
    assert!(
        rows >= ROWS[0] + ROWS[1] && pages == 1,
        "{rows} rows, {pages} pages: no item was moved"
    );
    within(wait, 0.0..=2.5, "ms acquisition waits while the store makes room in another page");
}

/// The core runs from one bank and programs the other: with the data cache on, the controller's erratum may corrupt the cache
/// (`hal_mock::flash::data_cache`).
#[test]
fn no_row_is_programmed_while_the_data_cache_is_on() {
    let FlashUse { rows, rows_with_cache_on: with_cache_on, .. } =
        executed(Platform::Stage, 1).report.flash_use;
    assert_eq!(rows, ROWS[1], "one heading is saved");
    let words = "rows of a heading that is saved are programmed while the data cache is on";
    within(with_cache_on as f64, 0.0..=0.0, words);
}
