//! The campaign of vehicles: Szymanowski's Table 1 by simulation, and parked vehicles, quiet and swaying.

use host::campaign::statistics::Precision;
use host::campaign::szymanowski::{drives, parked};

use crate::support::campaign::{Extent, campaigns};
use crate::support::program::{assert_drawn, meridian, object, page, text};

/// Of each row, those that `ACCURACY.md` does not print too.
const FEW: usize = 6;
/// Drives, and parked vehicles, as `ACCURACY.md` prints them.
const RUNS: [usize; 2] = [400, 200];

#[test]
fn stops_make_the_azimuth_better_than_averaging_did_and_rest_rates_better_still() {
    let rows: Vec<_> = (0..drives::COUNT).map(|case| drives::row(case, FEW, &|| {})).collect();
    assert_eq!(rows.len(), drives::COUNT);
    for row in rows.iter().filter(|row| !row.case.contains("found")) {
        println!("{row:?}");
        assert_eq!(row.precision.refused, 0, "{}: {:?}", row.case, row.precision.first_reason);
        assert!(row.plain_rms_deg < row.averaging_rms_deg, "{}", row.case);
        assert!(row.precision.rms_deg < row.plain_rms_deg, "{}", row.case);
        assert!(row.brent_difference_deg < 1e-6, "{}", row.brent_difference_deg);
        assert!(row.precision.worst_sigmas < 4.5, "{}", row.case);
        assert_eq!(row.errors.len(), FEW);
    }
    // B/Ω_h: 6.2° for 1 °/h at 52°.
    assert!((2.0..15.0).contains(&rows[0].averaging_rms_deg), "{}", rows[0].averaging_rms_deg);
}

#[test]
fn sway_turns_averaging_by_degrees_and_the_inertial_frame_hardly() {
    let rows: Vec<_> = (0..parked::COUNT).map(|case| parked::row(case, FEW, &|| {})).collect();
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
    let arguments = ["campaign", "szymanowski", "--runs", "1"];
    let (output, page) = page(&arguments);
    let text = text(&output.stdout);
    for words in ["before: averaging", "the paper's method", "Brent's search", "parked for 660 s"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let titles = ["Drives: RMS errors", "Parked vehicles", "W = 2 Ω_h |sin(δ/2)|", "three stops"];
    assert_drawn(&page, &titles);
    let object = object(&meridian(&[&arguments[..], &["--json"]].concat()));
    assert_eq!(object["campaign"], "szymanowski");
    assert_eq!(object["drives"].as_array().map(Vec::len), Some(drives::COUNT));
    assert!(object["parked"][0]["averaging_rms_deg"].is_f64(), "{object}");
}

/// RMS error, limit, their ratio and the coverage.
fn figures(precision: &Precision) -> String {
    let Precision { rms_deg, limit_deg, coverage_percent: [one, two, three], .. } = precision;
    let ratio = rms_deg / limit_deg;
    format!("{rms_deg:.3}° | {limit_deg:.3}° | {ratio:.3} | {one:.1}, {two:.1}, {three:.1} % |")
}

campaigns! {
    rest_rates_and_third_stops_take_the_gyros_biases_off_the_azimuth;
    sway_and_doors_cost_an_azimuth_from_inertial_space_less_than_half_as_much_again;
}

fn rest_rates_and_third_stops_take_the_gyros_biases_off_the_azimuth(extent: Extent) {
    let runs = extent.of(RUNS[0]);
    // Of 400 days the standard error of an RMS is 0.035 of it.
    let most = 1.0 + extent.rms(0.12, runs);
    let mut rows = Vec::new();
    for case in [0, 3] {
        let row = drives::row(case, runs, &|| {});
        let precision = &row.precision;
        assert_eq!(precision.refused, 0, "{precision:?}");
        assert!(precision.rms_deg / precision.limit_deg < most, "{precision:?}");
        assert!(row.brent_difference_deg < 1e-6, "{row:?}");
        // Biases of 1 °/h are found to what their noise leaves.
        assert!(row.bias_ratio.is_some_and(|ratio| ratio < most), "{row:?}");
        rows.push(format!(
            "| {} | {:.2}° | {:.2}° | {}",
            row.case,
            row.averaging_rms_deg,
            row.plain_rms_deg,
            figures(precision)
        ));
    }
    extent.assert_in_accuracy(&rows);
}

fn sway_and_doors_cost_an_azimuth_from_inertial_space_less_than_half_as_much_again(extent: Extent) {
    let runs = extent.of(RUNS[1]);
    let rows = [1, 2, 3].map(|case| parked::row(case, runs, &|| {}));
    let quiet = rows[0].precision.rms_deg;
    for row in &rows {
        assert!(row.precision.refused <= runs / 100, "{:?}", row.precision);
        assert!(row.precision.rms_deg < 1.5 * quiet, "{:?}", row.precision);
    }
    let text = rows.map(|row| {
        let figures = figures(&row.precision);
        format!("| {} | {:.2}° | {figures}", row.case, row.averaging_rms_deg)
    });
    extent.assert_in_accuracy(&text);
}
