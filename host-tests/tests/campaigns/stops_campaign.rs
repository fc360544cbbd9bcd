//! Szymanowski's Table 1 by simulation, in few runs.

use std::process::Command;

use bench::campaign::szymanowski::{drives, parked};
use serde_json::Value;

const RUNS: usize = 6;

#[test]
fn stops_make_the_azimuth_better_than_averaging_did_and_rest_rates_better_still() {
    let rows = drives::rows(RUNS, || {});
    assert_eq!(rows.len(), drives::COUNT);
    for row in rows.iter().filter(|row| !row.case.contains("found")) {
        println!("{row:?}");
        assert_eq!(row.precision.refused, 0, "{}: {:?}", row.case, row.precision.first_reason);
        assert!(row.plain_rms_deg < row.averaging_rms_deg, "{}", row.case);
        assert!(row.precision.rms_deg < row.plain_rms_deg, "{}", row.case);
        assert!(row.brent_difference_deg < 1e-6, "{}", row.brent_difference_deg);
        assert!(row.precision.worst_sigmas < 4.5, "{}", row.case);
        assert_eq!(row.errors.len(), RUNS);
    }
    // B/Ω_h: 6.2° for 1 °/h at 52°.
    assert!((2.0..15.0).contains(&rows[0].averaging_rms_deg), "{}", rows[0].averaging_rms_deg);
}

#[test]
fn sway_turns_averaging_by_degrees_and_the_inertial_frame_hardly() {
    let rows = parked::rows(RUNS, || {});
    assert_eq!(rows.len(), parked::COUNT);
    let [_, quiet, swaying, slammed] = &rows[..] else { panic!("four rows") };
    assert!(quiet.averaging_rms_deg < 1.0, "{}", quiet.averaging_rms_deg);
    for row in [swaying, slammed] {
        println!("{row:?}");
        assert!(row.averaging_rms_deg > 1.0, "{}", row.averaging_rms_deg);
        assert!(row.precision.rms_deg < 1.0, "{}", row.precision.rms_deg);
    }
}

#[test]
fn the_command_prints_both_tables_and_draws() {
    let page = std::env::temp_dir().join(format!("szymanowski-{}.html", std::process::id()));
    let path = page.display().to_string();
    let run = |more: &[&str]| {
        let arguments = [&["campaign", "szymanowski", "--runs", "1"], more].concat();
        Command::new(env!("CARGO_BIN_EXE_meridian")).args(arguments).output().expect("it runs")
    };
    let output = run(&["--report", path.as_str()]);
    let text = String::from_utf8_lossy(&output.stdout);
    for words in ["before: averaging", "the paper's method", "Brent's search", "Parked for 660 s"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let drawn = std::fs::read_to_string(&page).expect("it was written");
    std::fs::remove_file(&page).expect("the file is ours");
    for title in ["Drives: RMS errors", "Parked vehicles", "W = 2 Ω_h |sin(δ/2)|", "three stops"]
    {
        assert!(drawn.contains(title), "{title}");
    }
    let output = run(&["--json"]);
    let object: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(object["campaign"], "szymanowski");
    assert_eq!(object["drives"].as_array().map(Vec::len), Some(drives::COUNT));
    assert!(object["parked"][0]["averaging_rms_deg"].is_f64(), "{object}");
}
