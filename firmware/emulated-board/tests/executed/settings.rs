//! What a board does with settings and stores that it cannot use, and after its result.

use emulated_board::run::Order;
use emulated_board::world::stored;
use firmware::platform::Platform;
use firmware::ports::Store as _;
use firmware::settings::{BYTES, SLOT};

use super::support::board::Board;
use super::support::executed::execute_in;
use super::support::figure::within;
use super::support::sentences::{states, words};
use super::support::worlds::{short_stage, usual};

/// A turntable with this store for twenty seconds: how long its link is silent while its watchdog is fed, s. The log
/// must say why.
#[track_caller]
fn silence(store: Vec<u8>, reason: &str) -> f64 {
    let mut board =
        Board::within(Platform::Turntable, usual(Platform::Turntable).with_store(store));
    let begin = board.until(&format!("no settings: {reason}"), 5.0);
    let is_told = |board: &Board| {
        let words = words(board.sent(begin, f64::INFINITY));
        words.iter().any(|words| words.starts_with("no settings: "))
    };
    while !is_told(&board) && board.seconds() < begin + 20.0 {
        board.run(0.01);
    }
    let silent = board.seconds() - begin;
    let feedings = board.controller(|controller| controller.watchdog.feedings);
    assert!(feedings as f64 > silent - 2.0, "the watchdog is fed {feedings} times");
    silent
}

#[test]
fn a_board_with_another_carriers_record_says_so_over_the_link() {
    let reason = "the record is for the carrier stage, and this image for turntable";
    let silent = silence(usual(Platform::Stage).store, reason);
    assert!(silent <= 2.0, "{silent} s");
}

#[test]
fn a_board_with_a_damaged_record_says_so_over_the_link() {
    let store = stored(async |store| {
        store.save(SLOT, &[1; BYTES]).await.map_err(|fault| format!("{fault:?}"))
    });
    let silent = silence(store.expect("a store takes a record"), "the record fails its checksum");
    assert!(silent <= 2.0, "{silent} s");
}

/// The last row of the store is the second one of the record's mark.
#[test]
fn a_board_whose_record_is_lost_in_its_store_does_not_begin_with_other_settings() {
    let mut store = usual(Platform::Turntable).store;
    let at =
        store.iter().rposition(|byte| *byte != 0xFF && *byte != 0).expect("the store has a record");
    store[at] ^= 1;
    let mut board =
        Board::within(Platform::Turntable, usual(Platform::Turntable).with_store(store));
    board.run(4.0);
    let begun = board.log.iter().filter(|(_, line)| line.contains("settings of the image")).count();
    let words = "board with a record that its store has lost begins with the image's settings";
    within(begun as f64, 0.0..=0.0, words);
}

#[test]
fn a_store_with_another_programs_remains_is_erased() {
    // A table of small numbers.
    let remains = (0..1024_u32).flat_map(u32::to_le_bytes).collect();
    let world = usual(Platform::Turntable).with_store(remains);
    let mut board = Board::within(Platform::Turntable, world);
    for _ in 0..3 {
        board.run(4.0);
        board.execution.lose_supply();
    }
    let refused = "no settings: the store that may have a record cannot be read: bus error";
    let ended = board.log.iter().filter(|(_, line)| line.contains(refused)).count();
    let words = "of three starts end with a bus error in a store with another program's remains";
    within(ended as f64, 0.0..=0.0, words);
}

/// The samples go on to be taken.
#[test]
fn a_board_that_does_not_hold_its_result_counts_no_faults_after_it() {
    let order = Order { afterwards: 5.0, ..Order::usual(Platform::Stage, 1) };
    let shown = execute_in(&order, short_stage(false, 0));
    let states = states(shown.link.iter().map(String::as_str));
    let counts = states.iter().rev().take(4);
    let counts: Vec<f64> = counts.map(|state| state[4].parse().expect("a number")).collect();
    let each = (counts[0] - counts[3]) / 3.0;
    let words = "faults a second are counted after the result of a stage that does not hold it";
    within(each, 0.0..=0.0, words);
}
