//! The supply of the controller breaks down for a moment, while the chips keep theirs; rows of the flash that cannot be
//! read.
//!
//! RAM keeps its content, since the brown-out level is set above the least supply at which it does. The chips are in the midst of what they did when the board starts again, as after a brown-out above
//! their own limit.

use core::ops::Range;

use emulated_board::controller::flash::STORE;
use firmware::platform::Platform;
use hal_mock::flash::PAGE;

use crate::board::Board;
use crate::sentences::{sentences, states, words};
use crate::store::{Item, RECALLED, RECALLED_AGAIN, item, recalled_sigma, world};
use crate::turning::TurningBoard;

/// What has been measured is lost, as it is on purpose: the alignment begins anew. The motor driver, which the board left
/// turning, is brought to rest before it is started.
#[test]
fn a_brown_out_amid_measuring_begins_the_alignment_anew() {
    let TurningBoard { mut board, .. } = TurningBoard::new();
    let lost = board.seconds();
    board.execution.lose_supply();
    let start = board.until("board: started by Supply", 3.0);
    // The crystal starts again.
    assert!((2.0..2.1).contains(&(start - lost)), "{} s", start - lost);
    board.until("begin: 8 turns", 1.0);
    board.until("stage: turns at 72.0 °/s", 8.0);
    let lines = board.lines(start, f64::INFINITY);
    let is_trouble = |line: &str| line.contains("starting it again") || line.contains("given up");
    assert!(!lines.into_iter().any(is_trouble), "{board}");
}

/// The core sets the same flag for both; what outlasts a short loss in RAM, or does not, tells them apart.
#[test]
fn a_brown_out_is_told_from_a_power_on() {
    let mut board = Board::new(Platform::Vehicle);
    let powered = board.until("board: started by", 3.0);
    board.until("keeping: level", 5.0);
    board.run(2.0);
    board.execution.lose_supply();
    let lost = board.seconds();
    let start = board.until("board: started by", 3.0);
    board.until("keeping: level", 5.0);
    assert!(board.sent(lost, start).is_empty(), "{board}");
    let first = |from: f64| board.lines(from, f64::INFINITY)[0];
    let words = words(board.sent(start, f64::INFINITY));
    let is_told = words.iter().any(|words| words.starts_with("last reset: brown-out"));
    assert!(first(start) != first(powered) || is_told, "{board}");
    let starts = board.log.len();
    board.execution.switch_off();
    board.until("keeping: level", 5.0);
    assert!(!board.log[starts..].iter().any(|(_, line)| line.contains("last reset")), "{board}");
}

/// Goes on until an azimuth is recalled with a 1σ, °, in this range; the time at which that came, s.
fn recalled(board: &mut Board, expected: Range<f64>) -> f64 {
    let time = board.until("recalled", 20.0);
    let sigma = board.log.iter().rev().find_map(|(_, line)| recalled_sigma(line));
    assert!(sigma.is_some_and(|sigma| expected.contains(&sigma)), "{sigma:?}: {board}");
    time
}

/// Twelve seconds after the start the vehicle knows its azimuth again.
#[test]
fn a_brown_out_amid_keeping_costs_a_vehicle_at_rest_its_heading_for_fifteen_seconds() {
    let mut board = Board::within(Platform::Vehicle, world(0));
    recalled(&mut board, RECALLED);
    board.run(0.5);
    let lost = board.seconds();
    board.execution.lose_supply();
    let start = board.until("board: started by Supply", 3.0);
    assert_eq!(board.controller(|controller| item(&controller.flash.array)), Item::New);
    let known = recalled(&mut board, RECALLED_AGAIN);
    assert!((14.0..16.0).contains(&(known - lost)), "{} s", known - lost);
    // Until then no azimuth is told, by any sentence, and nothing has failed.
    let sent = board.sent(start, known);
    let told = sentences(sent.iter().copied(), "HEHDT");
    assert!(told.len() > 5 && told.iter().all(|heading| heading[0].is_empty()), "{board}");
    let is_right =
        |state: &[&str; 9]| state[0] == "aligning" && state[1].is_empty() && state[4] == "0";
    assert!(states(sent).iter().all(is_right), "{board}");
}

/// Inverts bits of a row in the flash of a board.
fn invert(board: &Board, offset: u32, bits: &[u8]) {
    board.controller(|controller| {
        for bit in bits {
            controller.flash.array.invert(offset, *bit);
        }
    });
}

#[test]
fn a_wrong_bit_in_the_store_is_corrected_and_nothing_is_said() {
    let mut board = Board::new(Platform::Vehicle);
    invert(&board, STORE.start + 16, &[3]);
    board.until("settings of a record in flash", 3.0);
    board.until("keeping: level", 1.0);
}

#[test]
fn two_wrong_bits_in_a_row_that_is_not_read_do_no_harm() {
    let mut board = Board::new(Platform::Vehicle);
    invert(&board, STORE.start + PAGE as u32 * 3 / 2, &[3, 40]);
    board.until("keeping: level", 5.0);
}

/// The row raises the non-maskable interrupt. Its handler clears the flag, and the store recovers the row, which is one of
/// the record of settings.
#[test]
fn two_wrong_bits_in_a_row_of_the_store_end_in_a_recovery() {
    let mut board = Board::new(Platform::Vehicle);
    invert(&board, STORE.start + 16, &[3, 40]);
    board.until("keeping: level", 20.0);
    let starts = board.log.iter().filter(|(_, line)| line.contains("board: started by")).count();
    assert_eq!(starts, 1, "{board}");
}
