//! `run turntable`: the board on a turning platform from the command line, and its misuse.

use std::process::Output;

use serde_json::Value;

use crate::support::files::Scratch;
use crate::support::program::{assert_drawn, meridian, object, page};

fn run(arguments: &[&str]) -> Output {
    meridian(&[&["run"], arguments].concat())
}

#[test]
fn a_gyro_finds_north_on_a_turning_platform() {
    let output = run(&["turntable", "--rate=50", "--turns", "4", "--json", "--azimuth", "77"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let object = object(&output);
    let number = |key: &str| object[key].as_f64().unwrap_or(f64::NAN);
    assert_eq!((&object["method"], &object["sensor"]), (&"rotating".into(), &"gyro".into()));
    assert!(number("error_deg").abs() < 4.5 * number("sigma_deg"), "{object}");
    assert!((number("coupling_deg") - 0.8).abs() < 1e-3, "{object}");
    assert_eq!((number("positions"), &object["health"]["missing"]), (8.0, &0.into()));
}

#[test]
fn speeds_and_turns_are_those_that_were_asked_for() {
    let output = run(&["turntable", "--rate=50", "--speeds", "0.2", "--turns", "3", "--json"]);
    let object = object(&output);
    let stretches = object["stretches"].as_array().map(Vec::as_slice).unwrap_or_default();
    assert_eq!(stretches.len(), 2, "{object}");
    for stretch in stretches {
        let speed = stretch["speed_hz"].as_f64().unwrap_or(0.0);
        // The motor's clock is off by up to 4 %.
        assert!((speed / 0.2 - 1.0).abs() < 0.04, "{stretch}");
        assert_eq!(stretch["turns"], 3, "{stretch}");
    }
}

#[test]
fn a_flash_file_spares_the_modulated_turns_of_the_next_run() {
    let scratch = Scratch::new("kept");
    let file = scratch.path("flash");
    let turns = ["turntable", "--rate=50", "--turns", "4", "--json", "--flash", file.as_str()];
    let first = run(&[&turns[..], &["--date", "2026-03-14"]].concat());
    let second = run(&[&turns[..], &["--date", "2026-03-20", "--modulated-turns", "0"]].concat());
    let [first, second] = [first, second].map(|output| object(&output));
    assert_eq!(first["recalled"], Value::Array(Vec::new()));
    let number = |object: &Value, key: &str| object[key].as_f64().unwrap_or(f64::NAN);
    let apart = number(&first, "azimuth_deg") - number(&second, "azimuth_deg");
    let sigma = number(&first, "sigma_deg").hypot(number(&second, "sigma_deg"));
    assert!(apart.abs() < 3.0 * sigma, "{apart}° apart: {second}");
    for object in [&first, &second] {
        let [error, sigma] = ["error_deg", "sigma_deg"].map(|key| number(object, key));
        assert!(error.abs() < 3.0 * sigma, "{object}");
    }
    let recalled = &second["recalled"][0];
    assert_eq!(recalled["date"], "2026-03-14", "{second}");
    assert!((15.0..35.0).contains(&number(recalled, "temperature_c")), "{second}");
    assert!((number(recalled, "coupling_deg") - 0.8).abs() < 1e-3, "{second}");
}

#[test]
fn a_molecular_electronic_sensor_without_a_stored_misalignment_is_refused() {
    let scratch = Scratch::new("empty");
    let file = scratch.path("flash");
    let output = run(&[
        "turntable",
        "--sensor",
        "met",
        "--modulated-turns",
        "0",
        "--flash",
        &file,
        "--json",
    ]);
    let object = object(&output);
    assert_eq!((output.status.code(), &object["status"]), (Some(1), &"refused".into()));
    let reason = object["reason"].as_str().unwrap_or_default();
    assert!(reason.contains("modulate the platform's rate first"), "{reason}");
}

#[test]
fn a_damaged_flash_file_is_named_and_left_alone() {
    let scratch = Scratch::new("damaged");
    let file = scratch.path("flash");
    let arguments = ["turntable", "--rate=50", "--turns", "2", "--flash", file.as_str()];
    assert!(run(&arguments).status.success());
    let mut bytes = std::fs::read(&file).expect("it was written");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    for damaged in [&bytes[..], &bytes[..middle], &[]] {
        std::fs::write(&file, damaged).expect("the file is ours");
        let output = run(&arguments);
        let words = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && words.contains(&file), "{words}");
        assert_eq!(std::fs::read(&file).expect("it is there"), damaged);
    }
}

#[test]
fn the_report_of_a_run_draws_its_turns() {
    let (_, page) = page(&["run", "turntable", "--rate=50", "--turns", "3"]);
    assert_drawn(&page, &["rate-modulated", "Phasor of each turn"]);
    assert!(!page.contains("no points to draw"));
}
