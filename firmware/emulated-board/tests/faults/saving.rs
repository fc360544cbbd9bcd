//! What a save of the heading costs the vehicle that does it.
//!
//! No sample is lost while the flash is written, since acquisition does not wait for the store: what the vehicle turned
//! meanwhile would be lost to the alignment that goes on beside it.

use firmware::platform::Platform;

use crate::board::Board;
use crate::store::{nearly_full, world};

/// Rows of a heading in the flash.
const HEADING_ROWS: u64 = 12;

/// Holds that the alignment of a vehicle goes on without a sample missing when it saves the heading that it has recalled,
/// into a store with so many earlier ones.
fn goes_on(earlier: usize) {
    let mut board = Board::within(Platform::Vehicle, world(earlier));
    let saved = board.until("recalled", 20.0);
    let rows = board.controller(|controller| controller.flash.used.rows);
    board.until("stop 1 levelled", 20.0);
    let written = board.controller(|controller| controller.flash.used.rows) - rows;
    assert!(written >= HEADING_ROWS, "{written} rows: {board}");
    let lines = board.lines(saved, f64::INFINITY);
    assert!(!lines.iter().any(|line| line.contains("missing")), "{board}");
}

#[test]
fn a_vehicle_that_saves_its_heading_goes_on_with_its_alignment() {
    goes_on(0);
}

#[test]
fn a_vehicle_that_changes_pages_for_its_heading_goes_on_with_its_alignment() {
    goes_on(nearly_full());
}
