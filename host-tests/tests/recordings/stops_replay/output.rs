//! What the command line says of a vehicle.

use std::process::Output;

use serde_json::Value;

use crate::support::files::{Scratch, stored, unpacked};
use crate::support::program::{assert_drawn, meridian, object, page};

use super::{FOG, IDEAL, PARKED, THREE};

fn replayed(name: &str, more: &[&str]) -> Output {
    meridian(&[&["replay", &stored(name)], more].concat())
}

#[test]
fn the_object_has_every_key_of_an_azimuth_and_its_own() {
    for (name, method, stops) in [(FOG, "siap", 2), (THREE, "siap", 3), (PARKED, "static", 1)] {
        let output = replayed(name, &["--json", "--method", method]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let object = object(&output);
        for key in [
            "method",
            "status",
            "azimuth_deg",
            "sigma_deg",
            "error_deg",
            "start_azimuth_deg",
            "start_sigma_deg",
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
            "assumed",
            "plain",
            "stops",
        ] {
            assert!(object.get(key).is_some(), "{name}: {key} is missing");
        }
        assert_eq!((&object["method"], &object["status"]), (&method.into(), &"ok".into()));
        assert_eq!(object["positions"], stops);
        assert_eq!(object["stops"].as_array().map(Vec::len), Some(stops));
        // The displacement beside the eight parts of every method.
        let parts = object["budget"].as_object().map(serde_json::Map::len);
        assert_eq!(parts, Some(if stops > 1 { 9 } else { 8 }), "{object}");
    }
}

#[test]
fn numbers_are_reported_where_they_mean_something() {
    let three = object(&replayed(THREE, &["--json"]));
    for key in ["bias_dph", "bias_sigma_dph"] {
        assert_eq!(three[key].as_array().map(Vec::len), Some(3), "{key}: {three}");
    }
    let number = |object: &Value, key: &str| object[key].as_f64().unwrap_or(f64::NAN);
    let azimuth = number(&three, "azimuth_deg");
    assert!((0.0..360.0).contains(&azimuth));
    let off = host::output::azimuth_error(azimuth, 12.5621) - number(&three, "error_deg");
    assert!(off.abs() < 1e-9, "{off}");
    assert!((number(&three, "seconds") - 180.0).abs() < 3.0, "{three}");
    let [first, last] = [0, 2].map(|index| &three["stops"][index]);
    assert!((number(first, "from_s")).abs() < 0.05 && (number(last, "to_s") - 1020.0).abs() < 1.1);
    assert_eq!(last["displacement_m"], serde_json::json!([4.3, 2703.7]));
    let ratio =
        (number(&three, "earth_rate_ratio") - 1.0) / number(&three, "earth_rate_ratio_sigma");
    assert!(ratio.abs() < 5.0, "{three}");
    // No limit where the noise is only estimated.
    assert!(object(&replayed(IDEAL, &["--json"]))["limit_deg"].is_null());
}

#[test]
fn the_block_prints_both_ends_the_paper_and_the_stops() {
    let output = replayed(THREE, &["-v"]);
    let text = String::from_utf8_lossy(&output.stdout);
    for words in [
        "azimuth of body x",
        "at the start",
        "limit",
        "gyro biases",
        "The method of Szymanowski 2003",
        "Brent's search",
        "Error budget",
        "assumed",
        "north, m",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

#[test]
fn the_report_draws_the_papers_figures() {
    let (_, page) = page(&["replay", &stored(FOG)]);
    let titles = [
        "Inclination U over the azimuth at the start (Szymanowski 2003, Fig. 9)",
        "Inclination U near its minimum",
        "Stop criterion of the rates, Ω − |ω|",
        "Stop criterion of the forces, g − |f|",
        "threshold",
        "stop 2",
        "W = 2 Ω_h |sin(δ/2)|",
        "Where the vehicle went",
        "What the solution leaves of the vertical at each stop",
        "Azimuth at the end as it converged",
        "Error budget",
        "Stops",
    ];
    assert_drawn(&page, &titles);
    assert!(!page.contains("no points to draw"));
}

/// A plain copy of a recording with its text changed.
fn changed(scratch: &Scratch, name: &str, change: impl FnOnce(String) -> String) -> String {
    scratch.with("changed.csv", change(unpacked(name)))
}

#[test]
fn the_page_of_a_parked_vehicle_shows_what_was_left_out_and_why_sigma_grows() {
    let (_, page) = page(&["replay", &stored(PARKED)]);
    assert!(page.contains("class=\"left-out\""), "the second of the blow stands in the timeline");
    assert!(page.contains("left out from "), "with its time");
    assert!(page.contains("biases beyond stated"), "beside the curve of σ");
}

#[test]
fn a_false_truth_changes_nothing_but_the_errors() {
    let lie = |text: String| {
        text.replace("truth_azimuth_deg: 12.562100", "truth_azimuth_deg: 200.0")
            .replace("truth_start_azimuth_deg: 72.562100", "truth_start_azimuth_deg: 3.0")
    };
    let scratch = Scratch::new("lie");
    let lied = object(&meridian(&["replay", &changed(&scratch, THREE, lie), "--json"]));
    let mut lied = lied.as_object().expect("an object").clone();
    let mut reported =
        object(&replayed(THREE, &["--json"])).as_object().expect("an object").clone();
    for key in ["error_deg", "start_error_deg", "file"] {
        assert_ne!(lied.remove(key), reported.remove(key), "{key}");
    }
    assert_eq!(lied, reported);
}

#[test]
fn a_refusal_is_reported_with_its_reason_and_exit_one() {
    let one_stop = |text: String| {
        text.replace("# stops_s: 0-60;960-1020", "# stops_s: 0-60")
            .replace("displacements_north_east_m", "unknown")
    };
    let scratch = Scratch::new("one-stop");
    let output = meridian(&["replay", &changed(&scratch, FOG, one_stop), "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let object = object(&output);
    assert_eq!(object["status"], "refused");
    assert!(object["reason"].is_string() && object.get("azimuth_deg").is_none(), "{object}");
}

#[test]
fn options_that_a_vehicle_cannot_take_are_misuse_and_other_kinds_are_refused() {
    let misuses: [&[&str]; 6] = [
        &["--half", "east"],
        &["--method", "siap", "--half", "east"],
        &["--method", "static", "--criterion", "least-squares"],
        &["--method", "static", "--displacements", "0,0;1,2"],
        &["--method", "rotating", "--displacements", "0,0;1,2"],
        &["--displacements", "1,2;3"],
    ];
    for misuse in misuses {
        let output = replayed(FOG, misuse);
        assert_eq!(output.status.code(), Some(2), "{misuse:?}");
    }
    let kind = replayed("stepwise-paper-1", &["--method", "siap", "--json"]);
    assert_eq!(kind.status.code(), Some(1));
    assert_eq!(object(&kind)["status"], "failed");
    let one_gyro = replayed("static-gyro-1h", &["--method", "static"]);
    let words = String::from_utf8_lossy(&one_gyro.stderr);
    assert!(words.contains("three gyros and three accelerometers"), "{words}");
}

#[test]
fn latitude_and_displacements_may_come_from_the_command_line() {
    let bare = |text: String| {
        text.replace("# latitude_deg: 52.000000\n", "")
            .replace("# displacements_north_east_m: 0.0,0.0;-2134.0,2737.8\n", "")
    };
    let scratch = Scratch::new("bare");
    let path = changed(&scratch, IDEAL, bare);
    let nothing = meridian(&["replay", &path]);
    let reported = meridian(&[
        "replay",
        &path,
        "--latitude",
        "52",
        "--displacements",
        "0,0;-2134.0,2737.8",
        "--json",
    ]);
    assert_eq!(nothing.status.code(), Some(1));
    let [mut reported, mut stored] =
        [reported, replayed(IDEAL, &["--json"])].map(|output| object(&output));
    // The header says the same.
    for value in [&mut reported, &mut stored] {
        value["file"].take();
        assert!(value["azimuth_deg"].is_f64(), "{value}");
    }
    assert_eq!(reported, stored);
}
