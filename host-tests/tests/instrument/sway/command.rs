//! `meridian run --sway`.

use std::process::Output;

use serde_json::Value;

use crate::support::campaign::assert_in_accuracy;
use crate::support::program::meridian;

fn run(arguments: &[&str]) -> Output {
    meridian(&[&["run", "-v"], arguments].concat())
}

fn all(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes)).concat()
}

#[test]
fn a_sway_is_subtracted_with_the_base_imu_and_refused_without() {
    let with = run(&["--sway", "0.1", "--sway-hertz", "0.7"]);
    assert_eq!(with.status.code(), Some(0), "{}", all(&with));
    assert!(all(&with).contains("base: sways by 0.07"), "{}", all(&with));
    let without = run(&["--sway", "0.1", "--no-base-imu"]);
    assert_eq!(without.status.code(), Some(1), "{}", all(&without));
    assert!(all(&without).contains("dwells were disturbed"), "{}", all(&without));
}

/// The JSON object of a run on a base that sways by an amplitude, °.
fn swaying(gyro: &str, amplitude: &str, more: &[&str]) -> Value {
    let run = ["run", "stage", "--hold", "0", "--json", "--gyro", gyro, "--sway", amplitude];
    let output = meridian(&[&run, more].concat());
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"))
}

/// σ as the page of accuracies states it, °, or why there is none.
fn stated(json: &Value) -> String {
    let reason = json["reason"].as_str().unwrap_or_default();
    match json["sigma_deg"].as_f64() {
        Some(sigma) => format!("{sigma:.2}°"),
        None if reason.contains("disturbed") => "refused: disturbed".to_owned(),
        None => panic!("{reason}"),
    }
}

#[test]
fn the_cost_of_a_sway_is_as_the_page_of_accuracies_states_it() {
    let gyros = [("fog", ["0", "0.02", "0.05", "0.5"].as_slice()), ("mems", &["0", "0.05"])];
    let cases = gyros.iter().flat_map(|(gyro, all)| all.iter().map(move |deg| (gyro, deg)));
    let row = |(gyro, amplitude): (&&str, &&str)| {
        let sigma = stated(&swaying(gyro, amplitude, &[]));
        format!("| {gyro} | {amplitude}° | {sigma} |")
    };
    let longer = stated(&swaying("fog", "0.05", &["--dwell", "60"]));
    let rows = cases.map(row).chain([format!("(`--dwell 60`: {longer})")]);
    assert_in_accuracy(&rows.collect::<Vec<_>>());
}

#[test]
fn what_the_coarse_imu_brings_into_a_dwell_is_that_of_its_noise() {
    let json = swaying("fog", "0.05", &[]);
    // A Gauss–Markov angle of N²τ/2 (and a²/(2τ) of the tilt), times 1.4, and its change over 10 s; N of 4 m°/s/√Hz over
    // √2, τ 20 s, a of 90 µg/√Hz over √2.
    let (n, a, tau, seconds) =
        (4e-3 / 2.0_f64.sqrt(), 90e-6_f64.to_degrees() / 2.0_f64.sqrt(), 20.0, 10.0);
    let variance = 1.4 * 0.5 * (n * n * tau + a * a / tau);
    let change = 2.0 * variance * (1.0 - f64::exp(-seconds / tau)) / (seconds * seconds);
    let expected = change.sqrt() * 3600.0;
    let found = json["sway_sigma_deg_h"].as_f64().expect("it is subtracted");
    // The board is given a twentieth more noise than the sensors have, and the part that grows with a sway of 3′ is small.
    assert!((1.05..1.1).contains(&(found / expected)), "{found} °/h for {expected} °/h");
    assert_eq!(swaying("fog", "0", &[])["sway_sigma_deg_h"], Value::Null);
}
