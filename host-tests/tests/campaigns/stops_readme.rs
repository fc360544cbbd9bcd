//! The campaign of vehicles as the README prints it: Szymanowski's Table 1 by simulation, and parked
//! vehicles, quiet and swaying.

use std::fs;
use std::path::Path;

use bench::campaign::statistics::Precision;
use bench::campaign::szymanowski::{drives, parked};

/// Drives, and parked vehicles.
const RUNS: [usize; 2] = [400, 200];

fn assert_in_readme(rows: &[String]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    let readme = fs::read_to_string(path).expect("the README is there");
    let lacks: Vec<&String> = rows.iter().filter(|row| !readme.contains(row.as_str())).collect();
    assert!(lacks.is_empty(), "the README lacks {lacks:#?}");
}

/// RMS error, limit, their ratio and the coverage.
fn figures(precision: &Precision) -> String {
    let Precision { rms_deg, limit_deg, coverage_percent: [one, two, three], .. } = precision;
    let ratio = rms_deg / limit_deg;
    format!("{rms_deg:.3}° | {limit_deg:.3}° | {ratio:.3} | {one:.1}, {two:.1}, {three:.1} % |")
}

#[test]
fn rest_rates_and_third_stops_take_the_gyros_biases_off_the_azimuth() {
    let mut rows = Vec::new();
    for case in [0, 3] {
        let row = drives::row(case, RUNS[0], &|| {});
        let precision = &row.precision;
        assert_eq!(precision.refused, 0, "{precision:?}");
        assert!(precision.rms_deg / precision.limit_deg < 1.1, "{precision:?}");
        assert!(row.brent_difference_deg < 1e-6, "{row:?}");
        // Biases of 1 °/h are found to what their noise leaves.
        assert!(row.bias_ratio.is_some_and(|ratio| ratio < 1.1), "{row:?}");
        rows.push(format!(
            "| {} | {:.2}° | {:.2}° | {}",
            row.case,
            row.averaging_rms_deg,
            row.plain_rms_deg,
            figures(precision)
        ));
    }
    assert_in_readme(&rows);
}

#[test]
fn sway_and_doors_cost_an_azimuth_from_inertial_space_less_than_half_as_much_again() {
    let rows = [1, 2, 3].map(|case| parked::row(case, RUNS[1], &|| {}));
    let quiet = rows[0].precision.rms_deg;
    for row in &rows {
        assert!(row.precision.refused <= RUNS[1] / 100, "{:?}", row.precision);
        assert!(row.precision.rms_deg < 1.5 * quiet, "{:?}", row.precision);
    }
    let text = rows.map(|row| {
        let figures = figures(&row.precision);
        format!("| {} | {:.2}° | {figures}", row.case, row.averaging_rms_deg)
    });
    assert_in_readme(&text);
}
