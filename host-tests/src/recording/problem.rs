//! The problems a recording can have, by the stage of reading that finds them.

use std::fmt;
use std::io;

use super::KINDS;
use super::quote::{printable, quoted};
use super::range::{Range, Short};

/// What is wrong with a recording.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// The text cannot be had.
    Source(SourceProblem),
    /// The header or the column names do not say what is needed.
    Header(HeaderProblem),
    /// A row's shape or a value is wrong.
    Value(ValueProblem),
    /// The times contradict each other or the header.
    Time(TimeProblem),
    /// The stops or their displacements do not do.
    Stops(StopProblem),
}

/// Why the text cannot be had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SourceProblem {
    /// The system refuses: its kind of error and its text.
    Io(io::ErrorKind, String),
    /// There is no line that is not blank.
    Empty,
    /// The line is not UTF-8.
    NotUtf8,
    /// The line is longer than this many bytes.
    LongLine(u64),
    /// There is more than this reader holds: the limit and what it counts.
    TooMany(u64, &'static str),
}

/// Why the header or the line of column names does not do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HeaderProblem {
    /// No `# kind: …` line.
    NoKind,
    /// A kind that the format does not have.
    UnknownKind(String),
    /// A key given twice: the value here, the value before and its line.
    Contradiction(String, String, u64),
    /// A key that matters, below the line of column names.
    Late,
    /// Not two numbers with a comma.
    NotAPair(String),
    /// Neither `gyro` nor `met`.
    UnknownSensor(String),
    /// The header ends without a line of column names.
    NoColumnNames,
    /// A needed column is missing; the columns that the kind needs.
    MissingColumn(String),
    /// A column's name is given twice.
    DuplicateColumn,
    /// The column at this position, from 1, has no name.
    UnnamedColumn(usize),
}

/// Why a row or a value does not do.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueProblem {
    /// The row's number of fields, and the number of columns.
    FieldCount(usize, usize),
    /// The same, in a last line that has no line end.
    CutShort(usize, usize),
    /// Nothing stands in the field.
    EmptyField,
    /// The text is not a number.
    NotANumber(String),
    /// The text is `nan` where only a `truth_` column may hold it.
    Nan(String),
    /// The number is infinite, or too large for a double.
    Infinite(String),
    /// The number is outside its range.
    OutOfRange(String, &'static Range),
    /// There is no row.
    NoRows,
}

/// Why the times do not do. All in seconds.
#[derive(Clone, Debug, PartialEq)]
pub enum TimeProblem {
    /// The time here is not later than the one before.
    NotLater {
        /// The time here.
        time_s: f64,
        /// The time before.
        before_s: f64,
        /// The line of the time before.
        before_line: u64,
    },
    /// Samples are missing.
    Gap {
        /// The step to this line.
        gap_s: f64,
        /// The line before.
        before_line: u64,
        /// The sample period.
        period_s: f64,
    },
    /// The header's rate, in Hz, and the rate that the times have.
    Rate(f64, f64),
}

/// Why stops or their displacements do not do. Times in seconds, displacements in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum StopProblem {
    /// Not two numbers with a minus.
    NotAStop(String),
    /// Not two numbers with a comma.
    NotADisplacement(String),
    /// More than this many.
    TooMany(usize),
    /// A stop that does not end after it begins.
    Backwards(f64, f64),
    /// A stop, and the next one, which begins before it ends.
    Overlap([f64; 2], [f64; 2]),
    /// The first stop is displaced from itself.
    NotFromFirst([f64; 2]),
    /// There is not one displacement for each stop.
    Count {
        /// Displacements.
        displacements: usize,
        /// Stops.
        stops: usize,
    },
    /// A stop that the recording does not hold.
    Aiding {
        /// The stop, from … to.
        stop: [f64; 2],
        /// Times of the first and the last row.
        recording: [f64; 2],
    },
}

impl From<SourceProblem> for Problem {
    fn from(problem: SourceProblem) -> Self {
        Self::Source(problem)
    }
}

impl From<HeaderProblem> for Problem {
    fn from(problem: HeaderProblem) -> Self {
        Self::Header(problem)
    }
}

impl From<ValueProblem> for Problem {
    fn from(problem: ValueProblem) -> Self {
        Self::Value(problem)
    }
}

impl From<TimeProblem> for Problem {
    fn from(problem: TimeProblem) -> Self {
        Self::Time(problem)
    }
}

impl From<StopProblem> for Problem {
    fn from(problem: StopProblem) -> Self {
        Self::Stops(problem)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Source(problem) => problem.fmt(f),
            Self::Header(problem) => problem.fmt(f),
            Self::Value(problem) => problem.fmt(f),
            Self::Time(problem) => problem.fmt(f),
            Self::Stops(problem) => problem.fmt(f),
        }
    }
}

impl fmt::Display for SourceProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(kind, text) => system(*kind, text, f),
            Self::Empty => f.write_str("the file is empty; record again or name another file"),
            Self::NotUtf8 => f.write_str("is not UTF-8 text; save the file as UTF-8"),
            Self::LongLine(limit) => {
                write!(f, "is longer than {limit} bytes; is this a recording in CSV?")
            }
            Self::TooMany(limit, what) => {
                write!(f, "more than {limit} {what}; split the recording")
            }
        }
    }
}

/// The system's refusals that a user meets have words of their own.
fn system(kind: io::ErrorKind, text: &str, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    use io::ErrorKind as E;
    match kind {
        E::NotFound => f.write_str("there is no such file"),
        E::PermissionDenied => f.write_str("may not be read; change its permissions"),
        E::IsADirectory => f.write_str("is a directory; name a file in it"),
        E::UnexpectedEof | E::InvalidData | E::InvalidInput => {
            let text = printable(text);
            write!(f, "the compressed data are damaged or cut short ({text}); copy the file again")
        }
        _ => write!(f, "cannot be read: {}", printable(text)),
    }
}

impl fmt::Display for HeaderProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoKind => {
                write!(f, "the header does not name the kind; add a line `# kind: …` with {KINDS}")
            }
            Self::UnknownKind(text) => write!(f, "{} is not a kind; use {KINDS}", quoted(text)),
            Self::Contradiction(here, before, line) => {
                let (here, before) = (quoted(here), quoted(before));
                write!(f, "{here} contradicts {before} of line {line}; keep one of them")
            }
            Self::Late => f.write_str("stands below the column names; move it above them"),
            Self::NotAPair(text) => {
                write!(f, "{} is not two numbers with a comma between", quoted(text))
            }
            Self::UnknownSensor(text) => {
                write!(f, "{} is not a sensor; use gyro or met", quoted(text))
            }
            Self::NoColumnNames => f.write_str("the file ends without a line of column names"),
            Self::MissingColumn(all) => write!(f, "is missing; the kind needs {all}"),
            Self::DuplicateColumn => f.write_str("is named twice; rename or remove one of them"),
            Self::UnnamedColumn(position) => {
                write!(f, "column {position} has no name; name it or remove the comma")
            }
        }
    }
}

impl fmt::Display for ValueProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FieldCount(found, columns) => {
                write!(f, "{found} fields, but {columns} columns are named")
            }
            Self::CutShort(found, columns) => {
                write!(f, "truncated: {found} of {columns} fields and no line end; remove the line")
            }
            Self::EmptyField => f.write_str("the field is empty"),
            Self::NotANumber(text) => write!(f, "{} is not a number", quoted(text)),
            Self::Nan(text) => write!(f, "{} is allowed only in truth_ columns", quoted(text)),
            Self::Infinite(text) => write!(f, "{} is not a finite number", quoted(text)),
            Self::OutOfRange(text, range) => {
                write!(f, "{} is outside the range of {range}; check the unit", quoted(text))
            }
            Self::NoRows => f.write_str("no rows follow the column names"),
        }
    }
}

impl fmt::Display for TimeProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotLater { time_s, before_s, before_line } => {
                let (time, before) = (Short(*time_s), Short(*before_s));
                write!(f, "{time} s does not come after {before} s of line {before_line}")
            }
            Self::Gap { gap_s, before_line, period_s } => {
                let (gap, period) = (Rounded(*gap_s), Rounded(*period_s));
                write!(f, "{gap} s after line {before_line} is a gap longer than three sample ")?;
                write!(f, "periods of {period} s; split the recording here")
            }
            Self::Rate(header, times) => {
                let (header, times) = (Rounded(*header), Rounded(*times));
                write!(f, "{header} Hz contradicts the times, which have {times} Hz; correct it")
            }
        }
    }
}

impl fmt::Display for StopProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAStop(text) => {
                write!(f, "{} is not a stop; write from-to;from-to in seconds", quoted(text))
            }
            Self::NotADisplacement(text) => {
                let text = quoted(text);
                write!(f, "{text} is not a displacement; write north,east;north,east in metres")
            }
            Self::TooMany(limit) => write!(f, "more than {limit} of them; split the recording"),
            Self::Backwards(from, to) => {
                let (from, to) = (Short(*from), Short(*to));
                write!(f, "the stop {from}-{to} does not end after it begins; correct it")
            }
            Self::Overlap([from, to], [next_from, next_to]) => {
                let [from, to, next, end] = [*from, *to, *next_from, *next_to].map(Short);
                write!(f, "the stop {next}-{end} begins before {from}-{to} ends; ")?;
                f.write_str("name the stops one after the other")
            }
            Self::NotFromFirst([north, east]) => {
                let (north, east) = (Short(*north), Short(*east));
                write!(f, "the first stop lies {north},{east} m from itself; ")?;
                f.write_str("displacements count from the first stop, which is at 0,0")
            }
            Self::Count { displacements, stops } => {
                write!(f, "{displacements} for {stops} stops; give one for each stop")
            }
            Self::Aiding { stop: [from, to], recording: [begin, end] } => {
                let [from, to, begin, end] = [*from, *to, *begin, *end].map(Short);
                write!(f, "the stop {from}-{to} lies outside of the recording, ")?;
                write!(f, "which goes from {begin} s to {end} s; correct it")
            }
        }
    }
}

/// A difference of times to six digits: the rest is what binary fractions leave over.
struct Rounded(f64);

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = format!("{:.5e}", self.0).parse::<f64>().unwrap_or(self.0);
        Short(rounded).fmt(f)
    }
}
