//! Columns of a stage's recording that are not of the same moment, as both of its ends show.
//!
//! A column that is late repeats its first value, one that is early its last. A gyro that does so for a whole dwell shows
//! at each position what belongs to another; a stage's column that does so makes the first dwell, or the last, longer
//! than the others, and the rate steps within it. By less than a dwell, the dwells themselves show it.

use orientation::alignment::stepwise::quality::Disturbance;
use orientation::alignment::stepwise::session::Session;
use orientation::signal::dwell::Dwell;

use thiserror::Error;

use crate::median::median;
use crate::recording::StageRow;
use crate::recording::repeated::alone;

/// Fewest equal rates at an end of a recording that are no chance.
const FEWEST_REPEATED: usize = 16;
/// Part of a dwell that is all of it, but for a transient that the average may leave out.
const WHOLE_DWELL: f64 = 0.9;
/// By how much longer than usual a dwell is no longer as long as the others.
const LONGER: f64 = 1.25;

/// An end of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum End {
    /// The end where the recording begins.
    #[error("first")]
    First,
    /// The end where the recording stops.
    #[error("last")]
    Last,
}

/// A column that is not of the same moment as the others, by so many seconds.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Late {
    /// The rate of the gyro is late or early.
    #[error(
        "column g_rad_s: the {0} value again and again for {1:.1} s, a whole dwell: the column is {way} by as long, or \
         the gyro did not measure; record again",
        way = .0.way()
    )]
    Gyro(End, f64),
    /// The angle of the stage is late or early.
    #[error(
        "column stage_rad: the {0} dwell lasts {1:.1} s longer than the others, and the rate is not the same all \
         through it: the column is {way} by as long, or the platform moved; record again",
        way = .0.way()
    )]
    Stage(End, f64),
}

impl End {
    /// Which way a column is off that repeats itself there.
    fn way(self) -> &'static str {
        if self == Self::First { "late" } else { "early" }
    }
}

/// Refuses a gyro's column that repeats its first or last value for a whole dwell there, of so many seconds each.
///
/// # Errors
/// Which end, and for how long.
pub fn check_gyro(
    rows: &[StageRow],
    sample_seconds: f64,
    [first, last]: [f64; 2],
) -> Result<(), Late> {
    let run = alone(rows, FEWEST_REPEATED, |row| row.rate_rad_s).unwrap_or_default();
    // One that repeats itself for half of the recording is stuck: what is left gives no azimuth, and that is named.
    if 2 * run.len() >= rows.len() {
        return Ok(());
    }
    let seconds = run.len() as f64 * sample_seconds;
    let ends = [
        (End::First, run.first(), rows.first(), first),
        (End::Last, run.last(), rows.last(), last),
    ];
    for (end, repeated, row, dwell) in ends {
        let is_there = repeated.zip(row).is_some_and(|(repeated, row)| repeated.line == row.line);
        if is_there && seconds > WHOLE_DWELL * dwell {
            return Err(Late::Gyro(end, seconds));
        }
    }
    Ok(())
}

/// What an azimuth from samples assumes of their columns: one that is early or late by whole dwells, and begins and ends
/// as the others do, shows nothing of it.
pub(crate) fn assumption(session: &Session) -> Option<String> {
    session.conclusion().filter(|conclusion| conclusion.verdict.is_ok())?;
    let angle = |pair: &[Dwell]| (pair[1].stage - pair[0].stage).signed_rad().abs();
    let step = median(session.dwells().windows(2).map(angle)).to_degrees();
    Some(format!(
        "gyro and stage of the same moment: by each dwell that one is late north is {step:.1}° off"
    ))
}

/// Refuses a first or last dwell that is longer than the others where the rate is not the same all through it.
///
/// # Errors
/// Which end, and by how long.
pub fn check_stage(session: &Session) -> Result<(), Late> {
    let found = session.conclusion().filter(|conclusion| conclusion.verdict.is_ok());
    let Some(conclusion) = found else { return Ok(()) };
    let lengths = || session.dwells().iter().map(|dwell| dwell.end().0 - dwell.start().0);
    let ends = [(End::First, lengths().next()), (End::Last, lengths().next_back())];
    let ends = ends.map(|(end, length)| (end, length.unwrap_or_default()));
    let usual = median(lengths());
    let whys = [conclusion.disturbances.first(), conclusion.disturbances.last()];
    let longer = ends.into_iter().zip(whys).filter(|((_, length), _)| *length > LONGER * usual);
    for ((end, length), why) in longer {
        let seconds = length - usual;
        match why.copied().flatten() {
            None
            | Some(Disturbance::Samples(_) | Disturbance::Moved(_) | Disturbance::Driving(..)) => {}
            Some(_) => return Err(Late::Stage(end, seconds)),
        }
    }
    Ok(())
}
