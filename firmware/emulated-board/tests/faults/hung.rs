//! A transfer on a bus never ends.

use firmware::platform::Platform;

use crate::board::{Board, TurningBoard};

/// As it should be: a time limit ends the transfer, as on the bus of the base; the bus is started again, and the loss is
/// counted, logged and sent.
#[test]
fn a_hung_transfer_of_the_sensors_in_a_vehicle_ends_the_measurement_and_the_link_goes_on_as_if_nothing_were()
 {
    let mut board = Board::new(Platform::Vehicle);
    board.until("stop 1: the vehicle stands", 20.0);
    board.run(1.0);
    let hung = board.seconds();
    board.controller(|controller| controller.spi[0].hangs = true);
    board.run(12.0);
    // One line tells of it, which does not name the bus; the watchdog is fed.
    assert_eq!(
        board.lines(hung, f64::INFINITY),
        ["keeping: no motion is measured any more"],
        "{board}"
    );
    let sent = board.sent(hung, f64::INFINITY);
    assert!(
        sent.len() >= 11 && sent.iter().all(|line| *line == "levelling at stop 1, faults 0"),
        "{board}"
    );
}

/// The IMU on the base is on a bus of its own, but one task reads all devices, and waits for this one. The platform turns
/// on for ever.
#[test]
fn a_hung_transfer_of_the_sensors_on_a_turntable_ends_the_measurement_and_the_platform_turns_on() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    let hung = board.seconds();
    board.controller(|controller| controller.spi[0].hangs = true);
    board.run(12.0);
    assert_eq!(
        board.lines(hung, f64::INFINITY),
        ["keeping: no motion is measured any more"],
        "{board}"
    );
    let sent = board.sent(hung, f64::INFINITY);
    assert!(
        sent.len() >= 11 && sent.iter().all(|line| *line == "measuring 0/8, faults 0"),
        "{board}"
    );
    assert!((turning(&board) - 72.0).abs() < 15.0, "it turns at {} °/s", turning(&board));
}

/// Its bytes are polled, so that one task holds the core for ever, and no other is polled: the link is silent, the
/// platform turns on, and the watchdog resets. The alignment begins anew, and nothing says which bus hung.
///
/// As it should be: a time limit as on the bus of the base, and a line of the log after it.
#[test]
fn a_hung_transfer_of_the_motors_holds_the_core_until_the_watchdog_resets_it() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    let hung = board.seconds();
    board.controller(|controller| controller.spi[1].hangs = true);
    board.run(7.0);
    assert!((turning(&board) - 72.0).abs() < 15.0, "it turns at {} °/s", turning(&board));
    let start = board.until("board: started by Watchdog", 2.0);
    assert!((7.1..8.3).contains(&(start - hung)), "{} s", start - hung);
    assert_eq!((board.lines(hung, start), board.sent(hung, start)), (vec![], vec![]), "{board}");
    board.until("begin: 8 turns", 1.0);
}

/// A time limit of five milliseconds ends every transfer. The base is tried twenty times more and given up after 0.83 s,
/// in which 324 samples of all devices are lost, since one task reads them all. The alignment goes on without it.
///
/// As it should be: no sample of another device is lost, since a platform that turns meanwhile has to begin anew.
#[test]
fn a_hung_transfer_of_the_base_costs_the_samples_of_all_devices_until_the_base_is_given_up() {
    let TurningBoard { mut board, .. } = TurningBoard::new();
    let hung = board.seconds();
    board.controller(|controller| controller.i2c.hangs = true);
    let given_up = board.until("base: given up: its bus fails", 2.0);
    assert!((0.8..0.9).contains(&(given_up - hung)), "{} s", given_up - hung);
    board.run(1.2);
    let lines = board.lines(hung, f64::INFINITY);
    let count = |words: &str| lines.iter().filter(|line| line.contains(words)).count();
    assert_eq!(count("base: bus error: starting it again"), 20, "{board}");
    let missing = lines
        .iter()
        .filter_map(|line| line.strip_suffix(" sample(s) missing")?.parse::<u32>().ok());
    assert!((320..330).contains(&missing.sum::<u32>()), "{board}");
    assert_eq!(lines.last(), Some(&"keeping: no motion is measured any more"), "{board}");
    let faults = board
        .link
        .last()
        .and_then(|(_, line)| line.strip_prefix("measuring 0/8, faults ")?.parse::<u32>().ok());
    assert!(faults.is_some_and(|faults| (340..360).contains(&faults)), "{board}");
}
