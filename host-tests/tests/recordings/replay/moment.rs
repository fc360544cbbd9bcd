//! Columns of another moment: late or early, at the recording's ends filled up with their first or last value, or cut.

use host::recording::{Body, Header, StageRow};

use crate::support::files::recording;

use super::{ALL, of_rows};

/// What makes a column of a recording's row that of another row.
type Shift = fn(&mut StageRow, &StageRow);

const COLUMNS: [(&str, Shift); 2] = [
    ("g_rad_s", |row, other| row.rate_rad_s = other.rate_rad_s),
    ("stage_rad", |row, other| row.stage_rad = other.stage_rad),
];

/// By how much a column is late, in lengths of the first dwell.
const LATE: [f64; 9] = [0.02, 0.05, 0.5, 0.9, 1.0, 1.1, 1.5, 2.0, 3.0];

/// A recording of a stage with its truth.
struct Sound {
    header: Header,
    rows: Vec<StageRow>,
    truth_deg: f64,
    /// Rows of its first dwell, and to where the second one begins.
    dwell: usize,
    period: usize,
}

fn sound(name: &str) -> Sound {
    let (header, body, truth) = recording(name).into_parts();
    let Body::Stage(rows) = body else { panic!("{name} is no stage") };
    let truth_deg = truth.azimuth_deg.expect("it carries a truth");
    let dwell = rows.partition_point(|row| (row.stage_rad - rows[0].stage_rad).abs() < 1e-3);
    let is_still = |pair: &&[StageRow]| pair[0].stage_rad == pair[1].stage_rad;
    let turning = rows[dwell..].windows(2).take_while(|pair| !is_still(pair)).count();
    Sound { header, rows, truth_deg, dwell, period: dwell + turning }
}

/// The rows with a column that is late by so many; what is missing at an end repeats, or is cut off.
fn shifted(rows: &[StageRow], late: isize, shift: Shift, is_cut: bool) -> Vec<StageRow> {
    let last = rows.len() - 1;
    let mut shifted = rows.to_vec();
    for (index, row) in shifted.iter_mut().enumerate() {
        shift(row, &rows[index.saturating_add_signed(-late).min(last)]);
    }
    let lost = late.unsigned_abs();
    let kept = if late > 0 { lost..rows.len() } else { 0..rows.len() - lost };
    if is_cut { shifted[kept].to_vec() } else { shifted }
}

/// By how much each dwell is said to put north off, °.
fn each_deg(assumed: &[String]) -> Option<f64> {
    let line = assumed.iter().find(|line| line.starts_with("gyro and stage of the same moment"))?;
    line.split_once("north is ")?.1.split_once('°')?.0.parse().ok()
}

/// How many of all shifts are refused; what is answered is right, or stated with its size.
fn refused(sound: &Sound, (column, shift): (&str, Shift), is_cut: bool) -> usize {
    let mut refused = 0;
    for late in LATE.iter().flat_map(|late| [late * sound.dwell as f64, -late * sound.dwell as f64])
    {
        let rows = shifted(&sound.rows, late as isize, shift, is_cut);
        let words = format!("{column} late by {late} of {} rows", sound.dwell);
        let replayed = match of_rows(&sound.header, rows, sound.truth_deg) {
            Ok(replayed) => replayed,
            Err(error) => {
                refused += 1;
                let named = format!("column {column}: ");
                assert!(error.to_string().starts_with(&named), "{words}: {error}");
                continue;
            }
        };
        let Some((error, sigma)) = replayed.answer() else {
            refused += 1;
            continue;
        };
        let error = error.abs();
        let each = each_deg(&replayed.replay.assumed).expect("it is stated of each answer");
        let dwells = (late.abs() / sound.period as f64).ceil();
        assert!(error < each * dwells + 5.0 * sigma, "{words}: {error}° ± {sigma}°, {each}° each");
    }
    refused
}

#[test]
fn a_column_of_another_moment_is_refused_or_gives_an_azimuth_that_is_reported_with_its_size() {
    for name in ALL {
        let sound = sound(name);
        let is_arc = name.starts_with("stepwise-paper");
        for column in COLUMNS {
            let refused = refused(&sound, column, false);
            let least = if is_arc && column.0 == "stage_rad" { 1 } else { 12 };
            assert!(refused >= least, "{name}, {}: only {refused} of 18 refused", column.0);
        }
    }
}

#[test]
fn a_column_of_another_moment_whose_ends_are_cut_is_reported_with_its_size() {
    let refused: usize = ALL.map(|name| refused(&sound(name), COLUMNS[0], true)).iter().sum();
    assert!(refused < 18 * ALL.len(), "none is answered at all");
}
