//! `run --method siap`: the board in a vehicle from the command line, and its misuse.

use std::process::{Command, Output};

use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_meridian");
    Command::new(program).arg("run").args(arguments).output().expect("it runs")
}

fn object(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).expect("one JSON object")
}

/// A short day: two stops, four minutes.
const SHORT: [&str; 7] =
    ["--method", "siap", "--stops", "2", "--drive-seconds", "240", "--stop-seconds=40"];

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
fn a_displacement_that_nobody_tells_costs_accuracy() {
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
    let page = std::env::temp_dir().join(format!("siap-{}.html", std::process::id()));
    let path = page.display().to_string();
    assert!(run(&[&SHORT[..], &["--report", path.as_str()]].concat()).status.success());
    let text = std::fs::read_to_string(&page).expect("it was written");
    std::fs::remove_file(&page).expect("the file is ours");
    for title in ["Kryt1 = Ω − |ω| (Fig. 6)", "U over the azimuth at the start (Fig. 9)", "stop 2"]
    {
        assert!(text.contains(title), "{title}");
    }
}

#[test]
fn faults_are_those_of_the_method() {
    let vehicle = run(&["--method", "siap", "--fault", "list"]);
    let names = String::from_utf8_lossy(&vehicle.stdout).into_owned();
    assert!(names.contains("never-drives") && names.contains("right-gyro"), "{names}");
    let stage = run(&["--fault", "list"]);
    let names = String::from_utf8_lossy(&stage.stdout).into_owned();
    assert!(!names.contains("never-drives"), "{names}");
    assert_eq!(run(&["--fault", "never-drives"]).status.code(), Some(2));
    assert_eq!(run(&["--method", "siap", "--fault", "nothing"]).status.code(), Some(2));
}

#[test]
fn what_cannot_go_together_is_misuse_with_the_options_named() {
    let misuses: [(&[&str], &str); 9] = [
        (&["--stops", "3"], "--stops"),
        (&["--drive-seconds", "300"], "--drive-seconds"),
        (&["--method", "rotating", "--no-displacement"], "--no-displacement"),
        (&["--method", "siap", "--stops", "1"], "--stops"),
        (&["--method", "siap", "--dwell", "3"], "--dwell"),
        (&["--method", "siap", "--mount", "two-frame"], "--mount"),
        (&["--method", "siap", "--turns", "3"], "--turns"),
        (&["--method", "siap", "--sway", "0.1"], "--sway"),
        (&["--method", "siap", "--record", "x.csv"], "--record"),
    ];
    for (arguments, option) in misuses {
        let output = run(arguments);
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {words}");
        assert!(words.contains(option), "{arguments:?}: {words}");
    }
}
