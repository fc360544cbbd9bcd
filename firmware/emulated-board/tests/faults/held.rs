//! The IMU on the base holds the data line of its bus, since the clock of a byte that it sends has stopped.
//!
//! Pulses by hand free the line before the interface starts; nothing is lost but what the byte belonged to.

use emulated_board::controller::ResetReason;
use emulated_board::time::Time;
use emulated_board::wiring::Pin;
use firmware::platform::Platform;

use crate::board::Board;
use crate::sentences::states;
use crate::turning::TurningBoard;

/// What the log says once the line is free.
const FREED: &str = "base: its data line was held, and let go after ";

/// Whether the data line of the base's bus is held low.
fn is_held(board: &Board) -> bool {
    let now = board.execution.processor.now();
    board.controller(|controller| !controller.wiring.level(Pin::named(b"PB11"), now))
}

/// Stops the clock at the first bit of a byte that is zero, while the bus is at rest, as a spike on its wires may.
fn hold(board: &mut Board) {
    while board.controller(|controller| controller.i2c.uses_wires()) {
        board.run(0.001);
    }
    let now = board.execution.processor.now();
    board.controller(|controller| controller.wiring.stop_clock(0, now));
}

/// Lines about the base from a moment on, s; nothing has broken a rule of the wires.
fn of_base(board: &Board, from: f64) -> Vec<&str> {
    assert_eq!(board.controller(|controller| controller.wiring.faults()), [""; 0], "{board}");
    let lines = board.lines(from, f64::INFINITY);
    lines.into_iter().filter(|line| line.starts_with("base: ")).collect()
}

#[test]
fn a_base_that_holds_its_data_line_at_power_on_is_started_and_the_log_says_so() {
    let mut board = Board::new(Platform::Turntable);
    hold(&mut board);
    assert!(is_held(&board));
    board.until("keeping: level", 10.0);
    board.run(2.0);
    let lines = of_base(&board, 0.0);
    assert_eq!(lines[0], format!("{FREED}8 pulse(s)"), "{board}");
    assert_eq!(lines[1..], ["base: identity and self-test passed, configured"], "{board}");
}

/// The next reading frees the line before it begins, so that none is lost.
#[test]
fn a_base_that_holds_its_data_line_amid_keeping_costs_nothing() {
    let TurningBoard { mut board, .. } = TurningBoard::new();
    let held = board.seconds();
    hold(&mut board);
    board.until(FREED, 0.1);
    board.run(2.0);
    assert!(!is_held(&board));
    assert!(of_base(&board, held)[0].starts_with(FREED), "{board}");
    assert_eq!(board.lines(held, f64::INFINITY).len(), 1, "{board}");
    let states = states(board.sent(held, f64::INFINITY));
    assert!(states.iter().all(|state| state[4] == "0"), "{board}");
}

/// Lets some microseconds pass.
fn pass(board: &mut Board, microseconds: u64) {
    let until = board.execution.processor.now() + Time::microseconds(microseconds);
    board.execution.processor.run(until).expect("the model knows what the image does");
}

/// A reset amid a byte of a reading, as by the watchdog: the chip waits for the rest of its clocks.
#[test]
fn a_base_whose_reading_a_reset_has_broken_off_is_started_again() {
    let mut board = Board::new(Platform::Turntable);
    let mut reset = 0.0;
    for attempt in 0..20 {
        board.until("keeping: level", 10.0);
        pass(&mut board, 5);
        while !board.controller(|controller| controller.i2c.uses_wires()) {
            pass(&mut board, 5);
        }
        pass(&mut board, 20 * attempt);
        reset = board.seconds();
        board.execution.processor.reset(ResetReason::Watchdog);
        if is_held(&board) {
            break;
        }
    }
    // A reset within an address, or while the bit is a one, leaves the line free.
    assert!(is_held(&board), "{board}");
    board.until("keeping: level", 10.0);
    board.run(2.0);
    let lines = of_base(&board, reset);
    assert!(lines[0].starts_with(FREED), "{board}");
    assert_eq!(lines[1..], ["base: identity and self-test passed, configured"], "{board}");
}
