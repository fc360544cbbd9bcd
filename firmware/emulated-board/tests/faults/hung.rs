//! A transfer on a bus never ends.
//!
//! A time limit ends every transfer; the bus is started again, and what is lost is counted, logged and sent with the name
//! of the device whose bus it is.

use firmware::platform::Platform;

use crate::board::Board;
use crate::figure::within;
use crate::sentences::states;
use crate::turning::TurningBoard;

/// How long a transfer may hang until the log says which bus it is, s.
const TOLD: std::ops::RangeInclusive<f64> = 0.0..=0.1;

/// A reading of the gyro or of the accelerometer is lost, and the measurement goes on with the next.
#[test]
fn a_hung_transfer_of_the_sensors_is_ended_and_told_by_its_bus() {
    let mut board = Board::new(Platform::Vehicle);
    board.until("stop 1: the vehicle stands", 20.0);
    board.run(1.0);
    let hung = board.seconds();
    board.controller(|controller| controller.spi[0].hangs = true);
    let silent = board.takes("its bus hangs", 12.0);
    board.run(12.0);
    let lines = board.lines(hung, f64::INFINITY);
    assert!(lines[0].ends_with(": reading lost: its bus hangs"), "{board}");
    assert!(lines[1].ends_with("the vehicle may drive"), "{board}");
    let states = states(board.sent(hung + 1.0, f64::INFINITY));
    assert!(states.len() >= 10 && states.iter().all(|state| state[4] == "1"), "{board}");
    let words = "s after a transfer of the sensors in a vehicle hangs no line names their bus";
    within(silent, TOLD, words);
}

/// The chain of transfers that reads the converters stops, no set of conversions comes, and a converter is started again,
/// with which the chain begins anew.
#[test]
fn a_spinning_body_is_followed_on_where_one_transfer_hangs() {
    let mut board = Board::new(Platform::Spin);
    board.until("roll: locked", 5.0);
    board.run(0.5);
    let hung = board.seconds();
    board.controller(|controller| controller.spi[0].hangs = true);
    let silent = board.takes("no data in time: starting it again", 1.0);
    board.until("roll: locked", 2.0);
    board.run(0.5);
    let lines = board.lines(hung, f64::INFINITY);
    let restarts = lines.iter().filter(|line| line.contains("starting it again")).count();
    assert_eq!(restarts, 1, "{board}");
    let words = "s after a transfer of the sensors on a spinning body hangs no line tells of it";
    within(silent, TOLD, words);
}

/// A start of a converter uses the bus, too, and says what is wrong with it.
#[test]
fn a_spinning_body_is_no_longer_followed_where_each_transfer_hangs() {
    let mut board = Board::new(Platform::Spin);
    board.until("roll: locked", 5.0);
    board.controller(|controller| controller.spi[0].is_stuck = true);
    board.until("given up: ", 5.0);
    assert!(board.log.iter().any(|(_, line)| line.contains("its bus hangs")), "{board}");
}

/// Where each transfer hangs, the sensors are given up, which ends the alignment, and the platform comes to rest.
#[test]
fn a_platform_comes_to_rest_where_a_transfer_of_the_sensors_hangs() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    board.controller(|controller| controller.spi[0].is_stuck = true);
    board.run(12.0);
    assert!(board.log.iter().any(|(_, line)| line.contains("its bus hangs again and again")));
    let words = "°/s a platform turns twelve seconds after a transfer of the sensors hangs";
    within(turning(&board).abs(), 0.0..=1.0, words);
}

/// Where each transfer hangs that goes to a motor's driver, its current is taken away.
#[test]
fn a_platform_comes_to_rest_where_each_transfer_of_the_motors_hangs() {
    for platform in [TurningBoard::new, TurningBoard::stage, TurningBoard::two_frames] {
        let TurningBoard { mut board, turning } = platform();
        assert!(turning(&board).abs() > 1.0, "it turns at {} °/s: {board}", turning(&board));
        board.controller(|controller| controller.spi[1].is_stuck = true);
        board.until("not brought to rest: the motors' current is taken away", 12.0);
        board.run(3.0);
        let words = "°/s a platform turns three seconds after the motors' current is taken away";
        within(turning(&board).abs(), 0.0..=1.0, words);
    }
}

/// What was given up is brought to rest even if its bus works again.
#[test]
fn a_platform_comes_to_rest_where_transfers_of_the_motors_hang_for_three_seconds() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    board.controller(|controller| controller.spi[1].is_stuck = true);
    board.run(3.0);
    board.controller(|controller| controller.spi[1].is_stuck = false);
    board.run(12.0);
    let words = "°/s a platform turns twelve seconds after its bus works again";
    within(turning(&board).abs(), 0.0..=1.0, words);
}

/// A transfer that hangs once costs a reading.
#[test]
fn a_platform_turns_on_and_is_measured_where_one_transfer_of_the_sensors_hangs() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    let hung = board.seconds();
    board.controller(|controller| controller.spi[0].hangs = true);
    board.run(12.0);
    let lines = board.lines(hung, f64::INFINITY);
    assert!(lines[0].ends_with(": reading lost: its bus hangs"), "{board}");
    assert!(!lines.iter().any(|line| line.contains("no motion")), "{board}");
    assert!((turning(&board) - 72.0).abs() < 15.0, "it turns at {} °/s", turning(&board));
}

/// A reading of the encoder, or a request to the motor, is repeated.
#[test]
fn a_hung_transfer_of_the_motors_is_ended_and_told_by_its_bus() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    let hung = board.seconds();
    board.controller(|controller| controller.spi[1].hangs = true);
    let silent = board.takes("", 10.0);
    let first = board.lines(hung, f64::INFINITY)[0];
    assert!(first.ends_with(": reading lost: its bus hangs"), "{board}");
    board.run(2.0);
    assert!(!board.sent(hung, f64::INFINITY).is_empty(), "{board}");
    assert!((turning(&board) - 72.0).abs() < 15.0, "it turns at {} °/s", turning(&board));
    let words = "s a hung transfer of the motors holds the core, which the watchdog resets";
    within(silent, TOLD, words);
}

/// The encoder is started twenty times, given up, and tried again after ten seconds, over and over; the sensors on the
/// base are read and passed on all the time.
#[test]
fn the_keeper_has_motion_all_the_time_where_each_transfer_of_the_motors_hangs() {
    let TurningBoard { mut board, .. } = TurningBoard::new();
    let hung = board.seconds();
    board.controller(|controller| controller.spi[1].is_stuck = true);
    board.run(20.0);
    let lines = board.lines(hung, f64::INFINITY);
    let count = |words: &str| lines.iter().filter(|line| line.contains(words)).count();
    assert_eq!(count("encoder: given up: its bus hangs"), 2, "{board}");
    assert_eq!(count("no motion"), 0, "{board}");
}

/// The base starts first, and nothing waits for the others.
#[test]
fn the_level_is_kept_where_each_transfer_of_the_motors_hangs_from_power_on() {
    for carrier in [Platform::Stage, Platform::TwoFrame, Platform::Turntable] {
        let mut board = Board::new(carrier);
        board.controller(|controller| controller.spi[1].is_stuck = true);
        board.until("keeping: level", 5.0);
        board.run(20.0);
        let lines = board.lines(0.0, f64::INFINITY);
        let count = |words: &str| lines.iter().filter(|line| line.contains(words)).count();
        assert_eq!(count("ncoder: given up"), 2, "{board}");
        assert_eq!(count("no motion"), 0, "{board}");
    }
}

/// A time limit of five milliseconds ends every transfer, and the log names the base. It is tried twenty times more, and
/// given up after 0.83 s; its own readings are the only ones that are lost.
#[test]
fn a_hung_transfer_of_the_base_is_ended_and_told_and_the_base_is_given_up() {
    let TurningBoard { mut board, .. } = TurningBoard::new();
    let hung = board.seconds();
    board.controller(|controller| controller.i2c.hangs = true);
    let given_up = board.until("base: given up: its bus fails", 2.0);
    assert!((0.8..0.9).contains(&(given_up - hung)), "{} s", given_up - hung);
    board.run(1.2);
    let lines = board.lines(hung, f64::INFINITY);
    let count = |words: &str| lines.iter().filter(|line| line.contains(words)).count();
    assert_eq!(count("base: bus error: starting it again"), 20, "{board}");
    assert_eq!(lines.last(), Some(&"keeping: no motion is measured any more"), "{board}");
    let states = states(board.sent(hung, f64::INFINITY));
    let Some(["aligning", _, _, _, faults, _, "0", "8", _]) = states.last() else {
        panic!("{board}")
    };
    assert!(faults.parse().is_ok_and(|faults: u32| (20..30).contains(&faults)), "{board}");
}

/// Nothing tells the motion any more, and a body that rested then has not set off.
#[test]
fn an_alignment_goes_on_where_the_base_is_given_up() {
    let TurningBoard { mut board, .. } = TurningBoard::new();
    board.controller(|controller| controller.i2c.hangs = true);
    let given_up = board.until("base: given up: its bus fails", 2.0);
    let ended = board.until("azimuth", 120.0);
    let is_refused = board.lines(given_up, f64::INFINITY).concat().contains("no azimuth");
    let after = if is_refused { ended - given_up } else { f64::INFINITY };
    let words = "s after the base's bus is given up the alignment ends without an azimuth";
    within(after, f64::INFINITY..=f64::INFINITY, words);
}

/// The base is read beside the others.
#[test]
fn a_hung_transfer_of_the_base_costs_no_sample_of_another_device() {
    let TurningBoard { mut board, .. } = TurningBoard::new();
    let hung = board.seconds();
    board.controller(|controller| controller.i2c.hangs = true);
    board.run(2.0);
    let lines = board.lines(hung, f64::INFINITY);
    let missing = lines
        .iter()
        .filter_map(|line| line.strip_suffix(" sample(s) missing")?.parse::<u32>().ok());
    let words = "samples of all devices are lost until the base's bus is given up";
    within(missing.sum::<u32>().into(), 0.0..=0.0, words);
}
