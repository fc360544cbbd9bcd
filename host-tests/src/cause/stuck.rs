//! Columns that hold one value although what they measure goes on.

use orientation::earth::{EARTH_RATE, Latitude};

use crate::median::extremes;
use crate::recording::repeated::alone;
use crate::recording::{Body, Header, RotatingRow, StageRow};

/// Fewest equal values in a row that are no chance.
const FEWEST: usize = 64;
/// Part of a recording for which an angle must stand still to be looked at.
const MOST: f64 = 0.5;
/// Parts of a standstill whose mean rates are compared.
const PARTS: usize = 8;
/// By how much the mean rates of parts differ where the stage turned, in the noise of one of them.
const DIFFERENT: f64 = 5.0;
/// By how much the mean rates of parts differ where the stage turned, as a part of the horizontal Earth rate.
const EARTHLY: f64 = 0.3;
/// Rate from which on a platform turns, rad/s.
const TURNS: f64 = 0.01;

/// A stuck gyro or encoder of a stage that stops.
pub fn of_stage(header: &Header, body: &Body) -> Option<String> {
    let Body::Stage(rows) = body else { return None };
    let horizontal = header.latitude_deg.and_then(Latitude::from_degrees);
    let horizontal = horizontal.map_or(EARTH_RATE, |latitude| latitude.horizontal_rate().0);
    let line = |row: &StageRow| row.line;
    let gyro = alone(rows, FEWEST, |row| row.rate_rad_s).map(|run| describe("g_rad_s", run, line));
    gyro.or_else(|| {
        let run = longest(rows, |row| row.stage_rad);
        let is_long = run.len() as f64 > MOST * rows.len() as f64;
        (is_long && is_turned(run, horizontal)).then(|| describe("stage_rad", run, line))
    })
}

/// What is stuck on a platform that turns all the time.
pub fn of_platform(rows: &[RotatingRow]) -> Option<String> {
    let line = |row: &RotatingRow| row.line;
    let gyro = alone(rows, FEWEST, |row| row.rate_rad_s).map(|run| describe("g_rad_s", run, line));
    gyro.or_else(|| {
        let run = longest(rows, |row| row.stage_rad);
        let turning = run.iter().filter(|row| row.stage_rate_rad_s.abs() > TURNS).count();
        let is_long = turning as f64 > MOST * rows.len() as f64;
        is_long.then(|| describe("stage_rad", run, line))
    })
}

/// The rows in which a value stands still for longest.
fn longest<R>(rows: &[R], value: fn(&R) -> f64) -> &[R] {
    let runs = rows.chunk_by(|a, b| value(a) == value(b));
    runs.max_by_key(|run| run.len()).unwrap_or_default()
}

/// Whether the gyro shows that the stage turned meanwhile: the Earth rate along it is not the same in all parts.
fn is_turned(run: &[StageRow], horizontal: f64) -> bool {
    let size = run.len() / PARTS;
    if size < 2 {
        return false;
    }
    let mean =
        |rows: &[StageRow]| rows.iter().map(|row| row.rate_rad_s).sum::<f64>() / rows.len() as f64;
    let differences = run.windows(2).map(|pair| (pair[1].rate_rad_s - pair[0].rate_rad_s).powi(2));
    let noise = (0.5 * differences.sum::<f64>() / (run.len() - 1) as f64 / size as f64).sqrt();
    let [least, greatest] = extremes(run.chunks_exact(size).take(PARTS).map(mean));
    greatest - least > (DIFFERENT * noise).max(EARTHLY * horizontal)
}

fn describe<R>(column: &str, run: &[R], line: fn(&R) -> u64) -> String {
    let (begin, count) = (run.first().map_or(0, line), run.len());
    format!(
        "column {column} holds the same value in {count} rows from line {begin} on: the sensor is stuck; check its \
         supply and cable, or what wrote the column"
    )
}
