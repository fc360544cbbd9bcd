//! The problems a recording can have, by the stage of reading that finds them.

use std::{fmt, io};

use thiserror::Error;

use super::KINDS;
use super::inputs::VERSION;
use super::quote::{quoted, shortened};
use super::range::{Range, Short};
use crate::angle::AngleError;
use crate::output::printable;
use crate::refused;

/// What is wrong with a recording. Times are in seconds, displacements in metres.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Problem {
    /// The system refuses: its kind of error and its text.
    #[error("{}", system(*.0, .1))]
    Io(io::ErrorKind, String),
    /// There is no line that is not blank.
    #[error("the file is empty; record again or name another file")]
    Empty,
    /// The line is not UTF-8.
    #[error("is not UTF-8 text; save the file as UTF-8")]
    NotUtf8,
    /// The line is longer than this many bytes.
    #[error("is longer than {0} bytes; is this a recording in CSV?")]
    LongLine(u64),
    /// There is more than this reader holds: the limit and what it counts.
    #[error("more than {0} {1}; split the recording")]
    TooMany(u64, &'static str),
    /// No `# kind: …` line.
    #[error("the header does not name the kind; add a line `# kind: …` with {KINDS}")]
    NoKind,
    /// A kind that the format does not have.
    #[error("{} is not a kind; use {KINDS}", quoted(.0))]
    UnknownKind(String),
    /// A key given twice: the value here, the value before and its line.
    #[error("{} contradicts {} of line {line}; keep one of them", quoted(.0), quoted(.1), line = .2)]
    Contradiction(String, String, u64),
    /// A key that matters, below the line of column names.
    #[error("stands below the column names; move it above them")]
    Late,
    /// A header that is not the one that a run wrote.
    #[error(
        "the header was changed since its run; leave this line out to go by what the others say"
    )]
    Changed,
    /// Not two numbers with a comma.
    #[error("{} is not two numbers with a comma between", quoted(.0))]
    NotAPair(String),
    /// Neither `gyro` nor `met`.
    #[error("{} is not a sensor; use gyro or met", quoted(.0))]
    UnknownSensor(String),
    /// The inputs of a run, which are no CSV.
    #[error(
        "these are inputs of a run, which `replay` takes in a file whose name ends in .jsonl or .jsonl.gz"
    )]
    Inputs,
    /// The header ends without a line of column names.
    #[error("the file ends without a line of column names")]
    NoColumnNames,
    /// The names of the columns are separated by this, and not by commas.
    #[error(
        "columns are separated by {0:?}; commas must separate them, and points stand in numbers"
    )]
    Separator(char),
    /// A needed column is missing; the columns that the kind needs.
    #[error("is missing; the kind needs {0}")]
    MissingColumn(String),
    /// The name of a column in which there is no rate, and those in which there may be one.
    #[error("there is no rate column {0:?}; there is {1}")]
    NoRate(String, String),
    /// A column's name is given twice.
    #[error("is named twice; rename or remove one of them")]
    DuplicateColumn,
    /// The column at this position, from 1, has no name.
    #[error("column {0} has no name; name it or remove the comma")]
    UnnamedColumn(usize),
    /// The row's number of fields, and the number of columns.
    #[error("{0} fields, but {1} columns are named")]
    FieldCount(usize, usize),
    /// Fields are missing in a last line that has no line end.
    #[error("truncated: {0} of {1} fields and no line end; remove the line")]
    CutShort(usize, usize),
    /// Nothing stands in the field.
    #[error("the field is empty")]
    EmptyField,
    /// The text is not a number.
    #[error("{} is not a number", quoted(.0))]
    NotANumber(String),
    /// The text is not an angle, and why.
    #[error("{}: {}", quoted(.0), .1)]
    NotAnAngle(String, AngleError),
    /// The text is `nan` where only a `truth_` column may hold it.
    #[error("{} is allowed only in truth_ columns", quoted(.0))]
    Nan(String),
    /// The number is infinite, or too large for a double.
    #[error("{} is not a finite number", quoted(.0))]
    Infinite(String),
    /// The number is outside its range.
    #[error("{} is outside the range of {range}; check the unit", quoted(.0), range = .1)]
    OutOfRange(String, &'static Range),
    /// There is no row.
    #[error("no rows follow the column names")]
    NoRows,
    /// The time here is not later than the one before.
    #[error("{} s does not come after {} s of line {before_line}", Short(*time_s), Short(*before_s))]
    NotLater {
        /// Time of this row, s.
        time_s: f64,
        /// Time of the row before, s.
        before_s: f64,
        /// The line of the time before.
        before_line: u64,
    },
    /// Samples are missing.
    #[error(
        "{} s after line {before_line} is a gap longer than three sample periods of {} s; split the recording here",
        Rounded(*gap_s), Rounded(*period_s)
    )]
    Gap {
        /// The step to this line.
        gap_s: f64,
        /// The line before.
        before_line: u64,
        /// The sample period.
        period_s: f64,
    },
    /// The header's rate, in Hz, and the rate that the times have.
    #[error(
        "{} Hz contradicts the times, which have {} Hz; {}", Rounded(*.0), Rounded(*.1),
        correction(*.0, *.1)
    )]
    Rate(f64, f64),
    /// Not two numbers with a minus.
    #[error("{} is not a stop; write from-to;from-to in seconds", quoted(.0))]
    NotAStop(String),
    /// Not two numbers with a comma.
    #[error("{} is not a displacement; write north,east;north,east in metres", quoted(.0))]
    NotADisplacement(String),
    /// A stop that does not end after it begins.
    #[error("the stop {}-{} does not end after it begins; correct it", Short(*.0), Short(*.1))]
    Backwards(f64, f64),
    /// A stop, and the next one, which begins before it ends.
    #[error(
        "the stop {} begins before {} ends; name the stops one after the other",
        span(.1), span(.0)
    )]
    Overlap([f64; 2], [f64; 2]),
    /// The first stop is displaced from itself.
    #[error(
        "the first stop lies {},{} m from itself; displacements count from the first stop, which is at 0,0",
        Short(.0[0]), Short(.0[1])
    )]
    NotFromFirst([f64; 2]),
    /// There is not one displacement for each stop.
    #[error("{displacements} for {stops} stops; give one for each stop")]
    StopCount {
        /// Displacements.
        displacements: usize,
        /// Stops.
        stops: usize,
    },
    /// A stop that the recording does not hold.
    #[error(
        "the stop {} lies outside of the recording, which goes from {} s to {} s; correct it",
        span(stop), Short(recording[0]), Short(recording[1])
    )]
    StopOutside {
        /// The stop, from … to.
        stop: [f64; 2],
        /// Times of the first and the last row.
        recording: [f64; 2],
    },
    /// The first line is no header.
    #[error("is not the header of a run's inputs, with which such a file begins")]
    NoInputs,
    /// The header is of another version of the format, by this program.
    #[error("inputs of version {0}, of {program}; this program replays version {VERSION}", program = shortened(.1))]
    InputsVersion(u64, String),
    /// The header lacks something, or nothing can begin with what it holds.
    #[error("the header does not do: {0}")]
    InputsHeader(String),
    /// Not a line, or one of an instrument of another carrier.
    #[error("is no input of the carrier that the header names: {0}")]
    NoInput(String),
    /// A line behind that of the end.
    #[error("stands behind the line of the end; remove it")]
    AfterEnd,
    /// The halves have not come to what they came to in the run.
    #[error(
        "the replay has not come to this: a line before it is missing or was changed, or another version of the \
         program wrote it"
    )]
    Diverged,
    /// The lines are not those that the run wrote.
    #[error("a line before this end is missing or was changed since the run; record again")]
    InputsChanged,
    /// The file ends before the run did.
    #[error(
        "the inputs break off here, before the end of their run; the replay goes as far as they do"
    )]
    BrokenOff,
}

/// The system's refusals that a user meets have words of their own.
fn system(kind: io::ErrorKind, text: &str) -> String {
    use io::ErrorKind as E;
    let text = printable(text);
    match kind {
        E::NotFound => "there is no such file".to_owned(),
        E::PermissionDenied => "may not be read; change its permissions".to_owned(),
        E::IsADirectory => "is a directory; name a file in it".to_owned(),
        E::UnexpectedEof | E::InvalidData | E::InvalidInput => {
            format!("the compressed data are damaged or cut short ({text}); copy the file again")
        }
        _ => format!("cannot be read: {}", refused::words(kind, &text)),
    }
}

/// A stop, from-to in seconds.
fn span([from, to]: &[f64; 2]) -> String {
    format!("{}-{}", Short(*from), Short(*to))
}

/// A difference of times to six digits: the rest is what binary fractions leave over.
struct Rounded(f64);

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = format!("{:.5e}", self.0).parse::<f64>().unwrap_or(self.0);
        Short(rounded).fmt(f)
    }
}

/// Deviation of a ratio of rates from a thousand at which the times are milliseconds.
const NEAR: f64 = 0.3;

/// Whether a rate that is stated, Hz, says that times which have this one are milliseconds.
pub(crate) fn are_milliseconds(stated: f64, found: f64) -> bool {
    (stated / (1000.0 * found) - 1.0).abs() < NEAR
}

/// What to do about a rate, and another one that the times have, Hz.
fn correction(stated: f64, found: f64) -> &'static str {
    if are_milliseconds(stated, found) {
        "the times are in ms, as it seems, and must be in s"
    } else {
        "correct it"
    }
}
