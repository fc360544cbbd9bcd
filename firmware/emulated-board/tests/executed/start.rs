//! How a board starts, and how it is flashed.

use std::fs;

use emulated_board::run::Order;
use execution::built::root;
use firmware::platform::Platform;

use super::support::board::Board;
use super::support::defect::hold;
use super::support::executed::executed;
use super::support::worlds::usual;

/// The start waits for the crystal in a critical section.
#[test]
#[should_panic(expected = "between 1.9 and 2.1 s interrupts are off at the start")]
fn interrupts_are_off_for_a_millisecond_at_most() {
    let [at_start, later] = executed(Platform::Stage, 1).report.masked_seconds;
    assert!(later <= 1e-3, "{later} s after the start");
    hold(at_start, 0.0..=1e-3, 1.9..=2.1, "s interrupts are off at the start");
}

/// The watchdog ends the wait for the crystal, and what it found is forgotten with the supply.
#[test]
#[should_panic(
    expected = "between 8 and 9 s a board with a dead crystal takes to the first line of its log, at each start"
)]
fn a_board_with_a_dead_crystal_starts_within_three_seconds() {
    let order = Order { has_crystal: false, ..Order::usual(Platform::Vehicle, 1) };
    let mut board = Board::ordered(&order, usual(order.carrier));
    let words = "board: started by Watchdog, clock follows its crystal: false";
    let starts = [0, 1].map(|_| {
        let supplied = board.seconds();
        let started = board.until(words, 20.0);
        board.execution.lose_supply();
        started - supplied
    });
    let words = "s a board with a dead crystal takes to the first line of its log, at each start";
    assert!((starts[0] - starts[1]).abs() < 0.1, "{starts:?}");
    hold(starts[1], 0.0..=3.0, 8.0..=9.0, words);
}

/// The name in `probe-rs/targets/STM32L4_Series.yaml` of probe-rs. It takes the beginning of a name with a warning for
/// as long as no other chip begins so.
const CHIP: &str = "STM32L475VGTx";

#[test]
#[should_panic(
    expected = "cargo board names the chip STM32L475VG, which probe-rs lists as STM32L475VGTx"
)]
fn cargo_board_names_the_chip_as_probe_rs_lists_it() {
    let text = fs::read_to_string(root().join(".cargo/config.toml"))
        .expect("cargo's configuration can be read");
    let line =
        text.lines().find(|line| line.starts_with("board = ")).expect("there is an alias `board`");
    let chip = line.split("--chip ").nth(1).and_then(|rest| rest.split(['"', ' ']).next());
    let chip = chip.expect("the runner names a chip");
    assert!(chip == CHIP, "cargo board names the chip {chip}, which probe-rs lists as {CHIP}");
}
