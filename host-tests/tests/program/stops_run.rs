//! `run vehicle`: the board in a vehicle from the command line, and its misuse.

use std::process::Output;

use serde_json::Value;

use crate::support::program::{assert_drawn, meridian, object, page};

fn run(arguments: &[&str]) -> Output {
    meridian(&[&["run"], arguments].concat())
}

/// A short day: two stops, four minutes.
const SHORT: [&str; 7] =
    ["vehicle", "--rate=50", "--stops", "2", "--drive-seconds", "240", "--stop-seconds=40"];

/// The object of a short day with more options, and whether there was a result.
fn short(more: &[&str]) -> (Value, bool) {
    let output = run(&[&SHORT, more, &["--json"]].concat());
    (object(&output), output.status.success())
}

#[test]
fn a_vehicle_finds_north_between_two_stops() {
    let (object, found) = short(&["--azimuth", "77"]);
    assert!(found, "{object}");
    let number = |key: &str| object[key].as_f64().unwrap_or(f64::NAN);
    assert_eq!((&object["method"], &object["positions"]), (&"siap".into(), &2.into()));
    assert!(number("error_deg").abs() < 4.5 * number("sigma_deg"), "{object}");
    assert!(number("start_error_deg").abs() < 4.5 * number("start_sigma_deg"), "{object}");
    assert!((number("start_azimuth_deg") - 77.0).abs() < 10.0, "{object}");
    assert_eq!(object["health"]["missing"], 0);
    assert!(object["stops"][1]["displacement_m"].is_array(), "{object}");
}

#[test]
fn a_displacement_that_is_not_given_costs_accuracy() {
    let (known, _) = short(&[]);
    let (unknown, _) = short(&["--no-displacement"]);
    assert!(unknown["stops"][1]["displacement_m"].is_null(), "{unknown}");
    let sigma = |object: &Value| object["sigma_deg"].as_f64();
    if let (Some(known), Some(unknown)) = (sigma(&known), sigma(&unknown)) {
        assert!(unknown > known, "{unknown}° {known}°");
    }
}

#[test]
fn a_vehicle_that_never_drives_is_refused_with_the_reason() {
    let (object, found) = short(&["--fault", "never-drives"]);
    assert!(!found && object["status"] == "refused", "{object}");
    assert!(object["reason"].is_string() && object.get("azimuth_deg").is_none(), "{object}");
}

#[test]
fn the_report_draws_the_stop_criteria_of_the_board() {
    let (_, page) = page(&[&["run"], &SHORT[..]].concat());
    let titles = [
        "Stop criterion of the rates, Ω − |ω|",
        "Inclination U over the azimuth at the start (Szymanowski 2003, Fig. 9)",
        "stop 2",
    ];
    assert_drawn(&page, &titles);
}

#[test]
fn faults_are_those_of_the_method() {
    let vehicle = run(&["vehicle", "--fault", "list"]);
    let names = String::from_utf8_lossy(&vehicle.stdout).into_owned();
    assert!(names.contains("never-drives") && names.contains("right-gyro"), "{names}");
    let stage = run(&["--fault", "list"]);
    let names = String::from_utf8_lossy(&stage.stdout).into_owned();
    assert!(!names.contains("never-drives"), "{names}");
}
