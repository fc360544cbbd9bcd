//! The campaign of a turning platform as the README prints it: equations.md §4 over azimuths and
//! unevenness phases, and a molecular-electronic sensor at one speed and two.

use std::fs;
use std::path::Path;

use bench::campaign::rotating::{molecular, stages};
use bench::campaign::statistics::Precision;

/// Runs of a flat gyro, and of a sensor with two speeds, which take twenty times as long.
const RUNS: [usize; 2] = [500, 60];

fn assert_in_readme(rows: &[String]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    let readme = fs::read_to_string(path).expect("the README is there");
    let lacks: Vec<&String> = rows.iter().filter(|row| !readme.contains(row.as_str())).collect();
    assert!(lacks.is_empty(), "the README lacks {lacks:#?}");
}

fn percent(precision: &Precision) -> String {
    let [one, two, three] = precision.coverage_percent;
    format!("{one:.1}, {two:.1}, {three:.1} %")
}

#[test]
fn a_flat_gyro_reaches_its_limit_after_every_stage_of_compensation() {
    let mut rows = Vec::new();
    for row in stages::rows(RUNS[0], || {}) {
        let precision = &row.precision;
        assert_eq!(precision.refused, 0, "{precision:?}");
        let [raw, coupling, senses, full] =
            [0, 1, 2, 3].map(|index| row.stages.get(index).map_or(f64::NAN, |s| s.rms_deg));
        // The platform's own motion leaves 0.002°, which only the quietest gyro shows.
        assert!(
            precision.ratio < if row.n_deg_sqrt_h < 0.001 { 1.15 } else { 1.05 },
            "{precision:?}"
        );
        assert!(precision.ratio > 0.92, "{precision:?}");
        rows.push(format!(
            "| N {} | {raw:.1}° | {coupling:.2}° | {senses:.2}° | {full:.4}° | {:.4}° | {:.3} | {} |",
            row.n_deg_sqrt_h,
            precision.limit_deg,
            precision.ratio,
            percent(precision)
        ));
    }
    assert_in_readme(&rows);
}

#[test]
fn two_speeds_free_a_molecular_electronic_sensor_of_its_g_sensitivity() {
    let mut rows = Vec::new();
    for row in molecular::rows(RUNS[1], || {}) {
        let precision = &row.precision;
        assert_eq!(precision.refused, 0, "{precision:?}");
        let is_aligned = row.coupling_deg == 0.0;
        assert!(row.two_speeds_rms_deg < if is_aligned { 0.01 } else { 0.02 }, "{row:?}");
        assert!(row.off_prediction_deg < 0.03, "{row:?}");
        assert!(row.noise_ratio < 2.5, "{row:?}");
        rows.push(format!(
            "| {}° | {} | {:.4}° | {:.4}° | {:.4}° | {:.2} | {:.3} |",
            row.coupling_deg,
            row.ratio,
            row.one_speed_rms_deg,
            row.predicted_rms_deg,
            row.two_speeds_rms_deg,
            row.noise_ratio,
            precision.ratio
        ));
    }
    assert_in_readme(&rows);
}
