//! The wire of a converter's data-ready line breaks: no edge of it comes any more.
//!
//! Converter and line look silent. It is started again and again, and given up by its name, which ends the alignment.

use firmware::platform::Platform;

use crate::board::Board;

/// Breaks the wire of a line once `begun` is in the log, and holds that the device with this name, and no other, is
/// started five times and given up.
fn is_given_up(carrier: Platform, begun: &str, (line, name): (u32, &str)) {
    let mut board = Board::new(carrier);
    board.until(begun, 60.0);
    board.controller(|controller| controller.exti.broken = 1 << line);
    let broken = board.seconds();
    board.until("given up", 10.0);
    board.run(1.0);
    let lines = board.lines(broken, f64::INFINITY);
    let starts = lines.iter().filter(|line| line.contains("starting it again"));
    let words = format!("{name}: no data in time: starting it again");
    assert_eq!(starts.collect::<Vec<_>>(), [&words.as_str(); 5], "line {line}: {board}");
    let end = format!("{name}: given up: it gives no more data");
    assert!(lines.contains(&end.as_str()), "line {line}: {board}");
}

#[test]
fn a_converter_of_a_spinning_body_that_falls_silent_is_given_up_by_its_name() {
    let converters = [
        (14, "forward gyro"),
        (1, "up gyro"),
        (0, "right gyro"),
        (4, "up accelerometer"),
        (3, "right accelerometer"),
    ];
    for converter in converters {
        is_given_up(Platform::Spin, "roll: locked", converter);
    }
}

#[test]
fn a_gyro_of_a_vehicle_that_falls_silent_is_given_up_by_its_name() {
    for gyro in [(14, "forward gyro"), (0, "right gyro"), (1, "down gyro")] {
        is_given_up(Platform::Vehicle, "stop 1: the vehicle stands", gyro);
    }
}

#[test]
fn the_gyro_of_a_stage_that_falls_silent_is_given_up_by_its_name() {
    is_given_up(Platform::Stage, "dwell 1 of", (14, "gyro"));
}
