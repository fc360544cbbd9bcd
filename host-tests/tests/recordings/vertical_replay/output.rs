//! What the command line says of an attitude that was kept.

use std::process::Output;

use serde_json::Value;

use crate::support::files::{Scratch, recording, stored};
use crate::support::program::{assert_drawn, meridian, object, page, reason, text, words};

use super::TRIALS;

fn replayed(name: &str, more: &[&str]) -> Output {
    meridian(&[&["replay", &stored(name), "--method", "vertical"], more].concat())
}

fn number(object: &Value, key: &str) -> f64 {
    object[key].as_f64().unwrap_or_else(|| panic!("{key} is no number: {object}"))
}

#[test]
fn the_object_has_its_keys_and_the_errors_where_there_is_a_truth() {
    let broad = object(&replayed("imu-broad-24", &["--json"]));
    assert_eq!((&broad["method"], &broad["status"]), (&"vertical".into(), &"ok".into()));
    for key in ["pitch_deg", "roll_deg", "sigma_deg", "turned_deg", "seconds"] {
        assert!(number(&broad, key).is_finite());
    }
    for key in ["bias_dph", "bias_sigma_dph", "coverage_percent"] {
        assert_eq!(broad[key].as_array().map(Vec::len), Some(3), "{key}");
    }
    assert_eq!(broad["compared"], 7198);
    let states = broad["states"].as_array().expect("states were met");
    let met: f64 = states.iter().map(|met| number(met, "seconds")).sum();
    assert!((met - number(&broad, "seconds")).abs() < 1e-6 && (met - 70.0).abs() < 0.1, "{met}");
    let parked = object(&replayed("parked-swaying", &["--json"]));
    assert!(parked.get("inclination_rmse_deg").is_none() && parked.get("compared").is_none());
    // The body stands but for its sway of half a degree.
    assert!(number(&parked, "turned_deg").abs() < 1.0, "{parked}");
}

#[test]
fn the_attitude_is_written_for_every_sample_and_has_the_errors_that_are_reported() {
    for (name, _) in TRIALS {
        let scratch = Scratch::new("attitude");
        let path = scratch.path("attitude.csv");
        let reported = object(&replayed(name, &["--json", "--attitude-out", &path]));
        let written = scratch.read("attitude.csv");
        let mut lines = written.lines();
        assert_eq!(lines.next(), Some("t_s,qw,qx,qy,qz,sigma_tilt_rad"));
        let truth = recording(name).truth.attitude;
        let mut squares = Vec::new();
        for (line, truth) in lines.by_ref().zip(&truth) {
            let fields: Vec<f64> = line.split(',').filter_map(|field| field.parse().ok()).collect();
            let [time, w, x, y, z, sigma] = fields[..] else { panic!("{line}") };
            let length: f64 = [w, x, y, z].iter().map(|part| part * part).sum();
            assert!((length - 1.0).abs() < 1e-6, "{line}");
            // Nothing is known until the first forces are taken for gravity.
            assert!(sigma > 0.0 && sigma < if time < 0.5 { 6.4 } else { 1.0 }, "{line}");
            squares.extend(
                truth.map(|truth| inclination_deg(down([w, x, y, z]), down(truth)).powi(2)),
            );
        }
        assert_eq!((lines.next(), truth.len()), (None, written.lines().count() - 1));
        let rmse = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        let said = number(&reported, "inclination_rmse_deg");
        assert!((rmse - said).abs() < 2e-3, "{name}: {rmse}° {said}°");
    }
}

/// Where the vertical points on the body's axes, which the heading does not move.
fn down([w, x, y, z]: [f64; 4]) -> [f64; 3] {
    let square = w * w + x * x + y * y + z * z;
    [
        2.0 * (x * z - w * y) / square,
        2.0 * (y * z + w * x) / square,
        (w * w - x * x - y * y + z * z) / square,
    ]
}

fn inclination_deg(a: [f64; 3], b: [f64; 3]) -> f64 {
    let away: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    2.0 * (0.5 * away.sqrt()).asin().to_degrees()
}

#[test]
fn the_block_tells_level_turn_biases_states_and_what_was_assumed() {
    let block = words(&text(&replayed("imu-broad-06", &["-v"]).stdout));
    for told in [
        "Pitch and roll kept in",
        "° (1σ)",
        "about the vertical since the beginning",
        "°/h forward, right, down",
        "state at the end",
        "Against the truth, in 9230 samples",
        "latitude 45°: none is stated",
        "gyro noise of a coarse unit",
        "gyro scale and axes of a coarse unit: 0.5 %",
    ] {
        assert!(block.contains(told), "{told}: {block}");
    }
    let known = text(&replayed("imu-broad-06", &["--latitude", "52.5", "-v"]).stdout);
    assert!(!known.contains("latitude 45°"), "{known}");
    // A header that knows its gyros is believed.
    let fog = text(&replayed("drive-fog-1dph", &["-v"]).stdout);
    assert!(!fog.contains("gyro noise of") && !fog.contains("gyro biases of"), "{fog}");
    assert!(fog.contains("accelerometer biases of a coarse unit"), "{fog}");
}

#[test]
fn a_recording_is_not_written_over_and_no_output_over_another() {
    let scratch = Scratch::new("kept");
    let before = std::fs::read(stored("imu-broad-24")).expect("it is there");
    let path = scratch.with("kept.csv.gz", &before);
    for (options, words) in [
        (["--attitude-out", &path, "--report", "x.html"], "--attitude-out"),
        (["--attitude-out", "x.csv", "--report", &path], "--report"),
        (["--attitude-out", "x.csv", "--report", "x.csv"], "takes the attitude already"),
    ] {
        let output = meridian(&[&["replay", &path, "--method", "vertical"], &options[..]].concat());
        let reported = reason(&output);
        assert!(!output.status.success() && reported.contains(words), "{reported}");
    }
    assert_eq!(std::fs::read(&path).expect("it is there"), before);
}

#[test]
fn the_report_draws_errors_beside_their_sigma() {
    let [with, without] = ["imu-broad-24", "parked-swaying"]
        .map(|name| page(&["replay", &stored(name), "--method", "vertical"]).1);
    let titles = ["Error of the vertical", "Error of the heading", "Biases of the gyros", "±1σ"];
    assert_drawn(&with, &titles);
    assert!(!without.contains("Error of the vertical") && without.contains("Pitch and roll"));
}

#[test]
fn options_that_keep_no_attitude_or_no_azimuth_are_misuse() {
    let path = stored("imu-broad-06");
    for (method, more) in [
        ("vertical", ["--half", "east"]),
        ("vertical", ["--criterion", "least-squares"]),
        ("vertical", ["--displacements", "0,0;1,1"]),
        ("static", ["--attitude-out", "never.csv"]),
    ] {
        let output =
            meridian(&[&["replay", path.as_str(), "--method", method][..], &more].concat());
        assert_eq!(output.status.code(), Some(2), "{method} {more:?}");
    }
}

#[test]
fn a_sigma_that_was_not_reached_is_refused_with_exit_one() {
    let output = replayed("imu-broad-06", &["--json", "--require-sigma", "0.01"]);
    assert_eq!(output.status.code(), Some(1));
    let object = object(&output);
    assert_eq!(object["status"], "refused");
    assert!(object["pitch_deg"].is_null());
    let reason = object["reason"].as_str().expect("a reason");
    assert!(reason.contains("0.01° is wanted"), "{reason}");
    let stage = stored("stepwise-paper-1");
    let output = meridian(&["replay", &stage, "--method", "vertical"]);
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(error.contains("kind `stage` is no vehicle"), "{error}");
}
