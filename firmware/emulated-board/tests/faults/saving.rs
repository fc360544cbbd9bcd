//! What a save of the heading costs the vehicle that does it.
//!
//! No sample is lost while the flash is written, since acquisition does not wait for the store: what the vehicle turned
//! meanwhile would be lost to the alignment that goes on beside it.

use firmware::platform::Platform;

use crate::board::Board;
use crate::figure::within;
use crate::store::{nearly_full, world};

/// Samples that are missing to the alignment of a vehicle when it saves the heading that it has recalled, into a store
/// with so many earlier ones; it ends with that.
fn missing(earlier: usize) -> f64 {
    let mut board = Board::within(Platform::Vehicle, world(earlier));
    let saved = board.until("recalled", 20.0);
    let Some(ended) = board.awaited("no azimuth: samples are missing", 2.0) else {
        return 0.0;
    };
    let lines = board.lines(saved, ended);
    let count = lines.iter().find_map(|line| line.strip_suffix(" sample(s) missing")?.parse().ok());
    count.unwrap_or_else(|| panic!("no sample is said to be missing:\n{board}"))
}

#[test]
fn a_vehicle_that_saves_its_heading_goes_on_with_its_alignment() {
    let words =
        "samples are missing to the alignment of a vehicle that saves the heading it has recalled";
    within(missing(0), 0.0..=0.0, words);
}

#[test]
fn a_vehicle_that_changes_pages_for_its_heading_goes_on_with_its_alignment() {
    let words =
        "samples are missing to the alignment of a vehicle that changes pages for its heading";
    within(missing(nearly_full()), 0.0..=0.0, words);
}
