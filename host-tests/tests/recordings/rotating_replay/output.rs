//! What the command line says of a turning platform.

use std::process::Output;

use serde_json::Value;

use crate::support::files::stored;
use crate::support::program::{assert_drawn, meridian, object, page};

use super::{GYRO, MET};

fn replayed(name: &str, more: &[&str]) -> Output {
    meridian(&[&["replay", &stored(name)], more].concat())
}

#[test]
fn the_object_has_every_key_of_an_azimuth_and_its_own() {
    for (name, sensor) in [(GYRO, "gyro"), (MET, "met")] {
        let output = replayed(name, &["--json", "--method", "rotating"]);
        assert!(output.status.success());
        let object = object(&output);
        for key in [
            "method",
            "status",
            "azimuth_deg",
            "sigma_deg",
            "limit_deg",
            "budget",
            "positions",
            "seconds",
            "pitch_deg",
            "roll_deg",
            "earth_rate_ratio",
            "earth_rate_ratio_sigma",
            "model",
            "excluded",
            "coupling_deg",
            "tilt_deg",
            "met_ratio",
            "stages",
            "stretches",
            "sensor",
        ] {
            assert!(object.get(key).is_some(), "{name}: {key} is missing");
        }
        assert_eq!((&object["method"], &object["status"]), (&"rotating".into(), &"ok".into()));
        assert_eq!(object["sensor"], sensor);
        assert_eq!(object["budget"].as_object().map(serde_json::Map::len), Some(8));
    }
}

#[test]
fn numbers_are_reported_where_they_mean_something() {
    let gyro = object(&replayed(GYRO, &["--json"]));
    let number = |key: &str| gyro[key].as_f64().unwrap_or(f64::NAN);
    assert!((number("coupling_deg") - 0.8).abs() < 1e-4);
    assert!((number("tilt_deg") - 0.3).abs() < 0.01);
    assert!((number("earth_rate_ratio") - 1.0).abs() < 5.0 * number("earth_rate_ratio_sigma"));
    assert!(gyro["met_ratio"].is_null() && gyro["one_speed_bias_deg"].is_null());
    let stretches = gyro["stretches"].as_array().map(Vec::as_slice).unwrap_or_default();
    let senses: Vec<&Value> = stretches.iter().map(|stretch| &stretch["sense"]).collect();
    assert_eq!(senses, ["clockwise", "counter-clockwise"]);
    assert!(stretches.iter().all(|s| (s["speed_hz"].as_f64().unwrap_or(0.0) - 0.137).abs() < 1e-4));
    let met = object(&replayed(MET, &["--json"]));
    assert!(met["earth_rate_ratio"].is_null() && met["met_ratio"].is_f64());
    assert_eq!(met["stretches"].as_array().map(Vec::len), Some(4));
}

#[test]
fn the_block_prints_the_limit_the_misalignment_and_every_stage() {
    let output = replayed(GYRO, &["-v"]);
    let text = String::from_utf8_lossy(&output.stdout);
    for words in [
        "azimuth of body x",
        "limit",
        "axis misalignment",
        "raw, clockwise",
        "without the unevenness",
        "both senses",
        "everything",
        "Error budget",
        "uneven by, %",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let met = replayed(MET, &["-v"]);
    let text = String::from_utf8_lossy(&met.stdout);
    assert!(
        text.contains("one speed alone") && text.contains("g-sensitivity and")
            || text.contains("gain, lag and g-sensitivity"),
        "{text}"
    );
}

#[test]
fn the_report_draws_profile_spectra_phasors_and_residuals() {
    let (_, page) = page(&["replay", &stored(MET)]);
    let titles = [
        "Azimuth after each stage of compensation",
        "Rate of the platform, clockwise at 0.100 Hz, rate-modulated",
        "Amplitude spectra, clockwise at 0.100 Hz, rate-modulated",
        "Amplitude spectra, counter-clockwise at 0.200 Hz",
        "Phasor of the sensor's signal in each turn",
        "Phasor of each turn less the median of its stretch",
    ];
    assert_drawn(&page, &titles);
    assert!(!page.contains("no points to draw"));
}

#[test]
fn options_that_a_turning_platform_cannot_take_are_misuse_and_other_kinds_are_refused() {
    let half = replayed(GYRO, &["--method", "rotating", "--half", "east"]);
    assert_eq!(half.status.code(), Some(2));
    let criterion = replayed(GYRO, &["--criterion", "least-squares"]);
    assert_eq!(criterion.status.code(), Some(2));
    let other = replayed(GYRO, &["--method", "stepwise"]);
    let words = String::from_utf8_lossy(&other.stderr);
    assert!(words.contains("kind `rotating` has no positions to align from"), "{words}");
    let kind = replayed("stepwise-paper-1", &["--method", "rotating", "--json"]);
    assert_eq!(kind.status.code(), Some(1));
    assert_eq!(object(&kind)["status"], "failed");
}
