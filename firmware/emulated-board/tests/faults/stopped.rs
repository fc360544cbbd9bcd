//! The core does not go on: a stuck task, a panic, faults of the core.
//!
//! All of them end the same way. The watchdog, which was last fed up to a second before, resets after 8.2 s at the
//! latest; until then log and link are silent, and a platform turns on. The log of the next start says "started by
//! Watchdog" and nothing of the cause. The alignment begins anew.
//!
//! As it should be: the reason, and where it was, outlast the reset in RAM; the next start logs it and sends it, and a
//! reset follows a fault at once, with the motors off.

use emulated_board::exceptions::HARD_FAULT;
use firmware::platform::Platform;

use crate::board::{Board, TurningBoard};
use crate::images::image;

/// Where there is nothing.
const NOWHERE: u32 = 0x6000_0000;
/// The shortest and longest time from a fault to the first line of the next log, s.
const RESET_SECONDS: std::ops::Range<f64> = 7.1..8.3;

/// A vehicle that is at work, and the time, s.
fn at_work() -> (Board, f64) {
    let mut board = Board::new(Platform::Vehicle);
    board.until("keeping: level", 5.0);
    board.run(2.0);
    let now = board.seconds();
    (board, now)
}

/// The address of a function in the vehicle's image.
fn function(name: &str) -> u32 {
    image(Platform::Vehicle).address_of(name).expect("the image has it")
}

/// Whether the core handles a hard fault.
fn handles_fault(board: &Board) -> bool {
    board.controller(|controller| controller.exceptions.active.has(HARD_FAULT))
}

/// `CFSR` and `HFSR`.
fn causes(board: &Board) -> [u32; 2] {
    board.controller(|controller| [0, 1].map(|register| controller.system.faults[register]))
}

/// Expects a mute board until the watchdog's reset, then a start like any other.
fn expect_reset(board: &mut Board, fault: f64) {
    let start = board.until("board: started by Watchdog", 10.0);
    assert!(RESET_SECONDS.contains(&(start - fault)), "{} s\n{board}", start - fault);
    assert_eq!((board.lines(fault, start), board.sent(fault, start)), (vec![], vec![]), "{board}");
    board.until("keeping: level", 2.0);
    let lines = board.lines(start, f64::INFINITY);
    assert_eq!(lines[0], "board: started by Watchdog, clock follows its crystal: true");
    assert!(
        lines[1].starts_with("board: carrier vehicle"),
        "nothing of the cause follows: {board}"
    );
    assert_eq!(board.sent(start, f64::INFINITY), ["starting, faults 0"], "{board}");
}

/// Interrupts are still served, those of the clock among them, and wake tasks that are never polled.
#[test]
fn a_stuck_task_is_mute_until_the_watchdog_resets() {
    let (mut board, now) = at_work();
    // The image has no endless loop but those of its handlers.
    board.execution.processor.jump(function("HardFault_"));
    let before = board.execution.processor.counts().exceptions;
    board.run(1.0);
    assert!(!handles_fault(&board));
    let taken = board.execution.processor.counts().exceptions - before;
    assert!((30..60).contains(&taken), "{taken} interrupts are served in a second");
    expect_reset(&mut board, now);
}

/// `panic-probe` is built without a way to print, and executes an undefined instruction with interrupts off.
#[test]
fn a_panic_is_mute_and_ends_with_the_watchdogs_reset() {
    let (mut board, now) = at_work();
    board.execution.processor.jump(function("core::panicking::panic_fmt"));
    board.run(0.001);
    assert!(handles_fault(&board), "{}", board.execution.processor.place());
    // An undefined instruction (CFSR, UNDEFINSTR), whose fault is not enabled either.
    assert_eq!(causes(&board), [1 << 16, 1 << 30]);
    expect_reset(&mut board, now);
}

#[test]
fn a_jump_to_where_nothing_is_is_mute_and_ends_with_the_watchdogs_reset() {
    let (mut board, now) = at_work();
    board.execution.processor.jump(NOWHERE);
    board.run(0.001);
    assert!(handles_fault(&board), "{}", board.execution.processor.place());
    // An instruction could not be fetched (CFSR, IBUSERR). The fault of the bus is not enabled, and becomes a hard fault
    // (HFSR, FORCED).
    assert_eq!(causes(&board), [1 << 8, 1 << 30]);
    expect_reset(&mut board, now);
}

#[test]
fn a_fault_in_the_handler_of_faults_locks_the_core_up_until_the_watchdog_resets_it() {
    let (mut board, now) = at_work();
    board.execution.processor.jump(NOWHERE);
    board.run(0.001);
    board.execution.processor.jump(NOWHERE);
    expect_reset(&mut board, now);
}

/// After the reset the motor driver still turns, and is first not ready. As it should be: a panic switches the
/// motors off, as a reset does.
#[test]
fn after_a_panic_a_turntable_turns_on_until_the_reset() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    let panic = image(Platform::Turntable)
        .address_of("core::panicking::panic_fmt")
        .expect("the image has it");
    let now = board.seconds();
    board.execution.processor.jump(panic);
    board.run(7.0);
    assert!((turning(&board) - 72.0).abs() < 15.0, "it turns at {} °/s", turning(&board));
    let start = board.until("board: started by Watchdog", 2.0);
    assert!(RESET_SECONDS.contains(&(start - now)), "{} s", start - now);
    board.until("stage: not ready in time: starting it again", 3.0);
    board.until("stage: identity and self-test passed", 1.0);
}
