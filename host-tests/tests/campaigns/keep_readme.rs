//! What `campaign keep` gives as the README prints it: Burov's classes, half an hour after their alignment.

use std::fs;
use std::path::Path;

use bench::campaign::keep::{self, Row, Spread};
use bench::campaign::statistics::NORMAL_COVERAGE;
use bench::recording;
use bench::vertical::errors::Errors;
use bench::vertical::{Options, replay};

/// Vehicles of each class: the RMS is then known to 5 %, the coverage of all to 1.5 points.
const RUNS: usize = 200;
/// Classes; the rows after them stand for comparison.
const CLASSES: usize = 5;

/// As the README has it.
fn line(row: &Row) -> String {
    let covered = |spread: &Spread| {
        let [one, two, three] = spread.coverage_percent;
        format!("{one:.1}, {two:.1}, {three:.1} %")
    };
    format!(
        "| {} | {:.2}° | {:.3}° | {:.3}° | {:.3}° | {} | {:.2}° | {:.3}° | {} |",
        row.class,
        row.wanted_azimuth_deg,
        row.azimuth_driving.rms_deg,
        row.azimuth.rms_deg,
        row.azimuth_limit_deg,
        covered(&row.azimuth),
        row.wanted_level_deg,
        row.level.rms_deg,
        covered(&row.level),
    )
}

/// The coverage over all classes, per cent.
fn over_all(rows: &[Row], of: impl Fn(&Row) -> Spread) -> [f64; 3] {
    [0, 1, 2].map(|index| {
        rows.iter().map(|row| of(row).coverage_percent[index]).sum::<f64>() / rows.len() as f64
    })
}

#[test]
fn each_class_keeps_azimuth_pitch_and_roll_as_its_row_wants_and_sigma_covers_them() {
    let rows: Vec<Row> = (0..CLASSES).map(|case| keep::row(case, RUNS, &|| {})).collect();
    let lines: Vec<String> = rows.iter().map(line).collect();
    println!("{}", lines.join("\n"));
    for row in &rows {
        assert!(row.is_wanted && row.is_met && row.lost == 0, "{row:?}");
    }
    for covered in [over_all(&rows, |row| row.azimuth), over_all(&rows, |row| row.level)] {
        for (covered, normal) in covered.iter().zip(NORMAL_COVERAGE) {
            assert!((covered - normal).abs() <= 3.0, "{covered} {normal}");
        }
    }
    assert_in_readme(&lines);
}

/// Trials of BROAD: what was done, and inclination and heading RMSE of VQF, ° (`tests/vertical_replay.rs`).
const TRIALS: [(&str, &str, [f64; 2]); 6] = [
    ("imu-broad-01", "01, slow rotation", [0.517, 2.387]),
    ("imu-broad-06", "06, fast rotation", [0.445, 0.299]),
    ("imu-broad-08", "08, fast rotation with breaks", [1.958, 5.775]),
    ("imu-broad-11", "11, slow translation", [0.417, 0.304]),
    ("imu-broad-21", "21, fast, both", [1.607, 3.949]),
    ("imu-broad-24", "24, tapping", [0.494, 0.476]),
];

#[test]
fn the_readme_has_the_errors_against_cameras_beside_those_of_vqf() {
    let rows = TRIALS.map(|(file, name, [inclination, heading])| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/recordings");
        let recording = recording::read(&folder.join(file).with_extension("csv.gz"));
        let (header, body, truth) = recording.expect("it reads").into_parts();
        let replay = replay(&header, &body, &Options::default()).expect("it replays");
        let errors = Errors::of(&replay.moments, &truth.attitude).expect("it carries a truth");
        let Errors { inclination_rmse_deg, heading_rmse_deg, .. } = errors;
        format!(
            "| {name} | {inclination_rmse_deg:.3}° | {inclination:.3}° | {heading_rmse_deg:.3}° | {heading:.3}° |"
        )
    });
    assert_in_readme(&rows);
}

fn assert_in_readme(rows: &[String]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    let readme = fs::read_to_string(path).expect("the README is there");
    let lacks: Vec<&String> = rows.iter().filter(|row| !readme.contains(row.as_str())).collect();
    assert!(lacks.is_empty(), "the README lacks {lacks:#?}");
}
