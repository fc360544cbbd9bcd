//! How a board starts, and how it is flashed.

use std::fs;

use emulated_board::controller::ResetReason;
use emulated_board::controller::rcc::Oscillators;
use emulated_board::run::Order;
use execution::built::root;
use firmware::platform::Platform;

use super::support::board::Board;
use super::support::executed::executed;
use super::support::worlds::usual;

/// A crystal that is dead, and an internal oscillator that is right.
const DEAD: Oscillators = Oscillators { has_crystal: false, msi_error: 0.0 };

/// Nothing waits for the crystal in a critical section.
#[test]
fn interrupts_are_off_for_a_millisecond_at_most() {
    let [at_start, later] = executed(Platform::Stage, 1).report.masked_seconds;
    assert!(later <= 1e-3, "{later} s after the start");
    assert!(at_start <= 1e-3, "{at_start} s at the start");
}

/// The wait for the crystal ends; what is known of it is forgotten with the supply.
#[test]
fn a_board_with_a_dead_crystal_starts_within_three_seconds() {
    let order = Order { oscillators: DEAD, ..Order::usual(Platform::Vehicle, 1) };
    let mut board = Board::ordered(&order, usual(order.carrier));
    let words = "board: started by Supply, clock follows its crystal: false";
    let starts = [0, 1].map(|_| {
        let supplied = board.seconds();
        let started = board.until(words, 20.0);
        board.execution.switch_off();
        started - supplied
    });
    assert!((starts[0] - starts[1]).abs() < 0.1, "{starts:?}");
    assert!(starts[1] <= 3.0, "{starts:?}");
}

/// What is known of the crystal outlasts a reset.
#[test]
fn a_dead_crystal_is_not_waited_for_after_a_reset() {
    let order = Order { oscillators: DEAD, ..Order::usual(Platform::Vehicle, 1) };
    let mut board = Board::ordered(&order, usual(order.carrier));
    board.until("clock follows its crystal: false", 3.0);
    board.execution.processor.reset(ResetReason::Pin);
    let reset = board.seconds();
    let started = board.until("board: started by Pin, clock follows its crystal: false", 1.0);
    assert!(started - reset < 0.1, "{} s", started - reset);
}

/// As delivered, a controller has the lowest brown-out level.
#[test]
fn a_new_board_sets_its_brown_out_level_once() {
    let mut board = Board::new(Platform::Vehicle);
    board.controller(|controller| controller.flash.deliver());
    board.until("board: sets its brown-out level, and starts again", 3.0);
    board.until("board: started by OptionBytes", 1.0);
    board.until("keeping: level", 3.0);
    assert_eq!(
        board.controller(|controller| controller.resets.clone()),
        [ResetReason::OptionBytes]
    );
    board.execution.switch_off();
    board.until("board: started by Supply", 3.0);
    board.until("keeping: level", 3.0);
}

/// The name in `probe-rs/targets/STM32L4_Series.yaml` of probe-rs. It takes the beginning of a name with a warning for
/// as long as no other chip begins so.
const CHIP: &str = "STM32L475VGTx";

#[test]
fn cargo_board_names_the_chip_as_probe_rs_lists_it() {
    let text = fs::read_to_string(root().join(".cargo/config.toml"))
        .expect("cargo's configuration can be read");
    let line =
        text.lines().find(|line| line.starts_with("board = ")).expect("there is an alias `board`");
    let chip = line.split("--chip ").nth(1).and_then(|rest| rest.split(['"', ' ']).next());
    let chip = chip.expect("the runner names a chip");
    assert!(chip == CHIP, "cargo board names the chip {chip}, which probe-rs lists as {CHIP}");
}
