//! A board that receives over its link without a pause, while no task reads what comes.

use emulated_board::run::Order;
use execution::report::{Report, Service};
use firmware::platform::Platform;

use super::sound::azimuth;
use super::support::angles::distance;
use super::support::board::Board;
use super::support::executed::{Executed, execute_in, execute_spoken_to};
use super::support::sentences::states;
use super::support::worlds::{short_stage, usual};

/// Bytes for a millisecond, of which 115 200 baud carry 11.52, ten bits each: the line is never at rest.
const BYTES: &[u8; 12] = b"$GPGGA,\xFF\0\x55\r\n";

/// Lines of the log without their numbers.
fn words(shown: &Executed) -> Vec<String> {
    let words = shown.log.iter().map(|entry| entry.words.as_str());
    words.map(|words| words.replace(|letter: char| letter.is_ascii_digit(), "")).collect()
}

/// What is to be the same, whatever the board is sent: resets, false notices, violations and faults, of which there are
/// none, conversions that were lost while they were wanted, and items that the flash took.
fn outcome(Report { resets, false_notices, violations, faults, service, flash_use, .. }: &Report) {
    assert!(resets.is_empty() && false_notices.is_empty(), "{resets:?}, {false_notices:?}");
    assert!(violations.is_empty() && *faults == 0, "{violations:?}, {faults} faults");
    assert_eq!(service.map(|Service { lost, .. }| lost), [0; 3]);
    assert_eq!(flash_use.rows, 12, "a heading is saved");
}

#[test]
fn bytes_that_a_board_is_sent_during_an_alignment_change_nothing_else() {
    let order = Order::usual(Platform::Stage, 1);
    let silent = execute_in(&order, short_stage(true, 0));
    let spoken_to = execute_spoken_to(&order, short_stage(true, 0), BYTES);
    outcome(&silent.report);
    outcome(&spoken_to.report);
    assert_eq!(words(&spoken_to), words(&silent));
    // The interrupts of the ring have a dwell begin a sample earlier or later, with other noise.
    let ((found, sigma), (expected, _)) = (azimuth(&spoken_to.report), azimuth(&silent.report));
    let change = distance(found, expected);
    assert!(change <= 0.5 * sigma, "{change}° at a σ of {sigma}°");
    let states = states(spoken_to.link.iter().map(String::as_str));
    assert!(states.iter().all(|state| state[4] == "0"), "{states:?}");
}

/// Whether the board has so many of the bytes, one after the other, in its first RAM (SRAM1, 96 KiB).
fn has(board: &Board, bytes: &[u8]) -> bool {
    let mut ram = vec![0; 96 << 10];
    board.execution.processor.peek(0x2000_0000, &mut ram);
    ram.windows(bytes.len()).any(|window| window == bytes)
}

/// It has the least time to spare. The ring, which has 256 bytes, begins anew 90 times.
#[test]
fn a_spinning_body_takes_all_bytes_that_it_is_sent_and_loses_no_conversion() {
    let mut board = Board::within(Platform::Spin, usual(Platform::Spin));
    board.until("right accelerometer: identity and self-test passed", 4.0);
    let lost = |board: &Board| board.execution.world.carrier.borrow().lost();
    let before = lost(&board);
    assert!(!has(&board, BYTES));
    board.execution.send(&BYTES.repeat(1920));
    board.run(2.1);
    assert_eq!(lost(&board), before);
    assert_eq!(board.controller(|controller| controller.usart.overruns), 0);
    // The place of the last byte divides what the ring has: one part holds ten of them at least.
    assert!(has(&board, &BYTES.repeat(9)), "the ring has what was sent last");
}
