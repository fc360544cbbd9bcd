//! Recordings in CSV: a header of `# key: value` lines, one line of column names, rows of numbers.
//!
//! [`read`] takes a file, plain or gzip-compressed, of any size and content and gives a
//! [`Recording`] or one line that says what is wrong and where. Nothing is guessed: a number that
//! is missing, not finite, outside the range of its quantity or out of order is an error. Tolerated
//! are CRLF line ends, blank lines, spaces around fields, a byte order mark, unknown keys, comments
//! and columns that the kind does not know. What of these resembles something that is known, and a truth that is
//! none, is passed over with a [`Warning`].
//!
//! What a simulator knows goes to [`Truth`] while the file is read; [`Recording::into_parts`] takes
//! it off, and a solver is given only a [`Header`] and a [`Body`], which cannot hold it.

mod at_rest;
mod begun;
mod checksum;
mod columns;
mod error;
mod given;
mod header;
pub mod inputs;
mod lines;
mod number;
pub mod period;
mod problem;
mod quote;
mod range;
pub mod repeated;
mod resemblance;
mod rows;
mod spacing;
mod stops;
mod timing;
mod warning;

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

pub use at_rest::{Opened, RestRows};
pub use error::{Place, ReadError};
pub(crate) use given::rate;
pub use given::{GIVEN, Given};
pub use header::{Header, Sensor, Truth};
pub use lines::{MAX_LINE_BYTES, MAX_ROWS, MAX_STREAMED_ROWS};
pub use problem::Problem;
pub(crate) use problem::are_milliseconds;
pub use range::{Range, Short};
pub use rows::{
    DwellRow, GREATEST_BODY_RATE, GREATEST_SPIN_RATE, ImuRow, ImuSample, RotatingRow, SpinRow,
    StageRow, StaticRow,
};
pub(crate) use spacing::Spacer;
pub use spacing::{Gap, MOST_GAPS, Spacing, Unsteady};
pub use stops::displacements;
pub use warning::{About, Warning};

use crate::output::printable;
use begun::Begun;
use error::Fault;
use lines::Lines;

/// What a recording holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What the header says about the site and the instrument.
    pub header: Header,
    /// The rows.
    pub body: Body,
    /// What only a check may know.
    pub truth: Truth,
    /// What was passed over although it looks as if it was meant.
    pub warnings: Vec<Warning>,
}

impl Recording {
    /// The parts, so that the truth can be kept from the solver.
    #[must_use]
    pub fn into_parts(self) -> (Header, Body, Truth) {
        (self.header, self.body, self.truth)
    }

    /// The warnings in words, a line each, of a recording in this file.
    #[must_use]
    pub fn warning_lines(&self, file: &Path) -> Vec<String> {
        warning_lines(&self.warnings, file)
    }
}

/// Warnings in words, a line each, of what was read from this file.
#[must_use]
pub fn warning_lines(warnings: &[Warning], file: &Path) -> Vec<String> {
    let file = printable(&file.display().to_string());
    warnings.iter().map(|warning| format!("{file}: {warning}")).collect()
}

/// The rows of a recording, at least one, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// Samples of one gyro on a rotation stage.
    Stage(Vec<StageRow>),
    /// Samples of one sensor on a stage that turns all the time.
    Rotating(Vec<RotatingRow>),
    /// One row a position, already averaged.
    Dwells(Vec<DwellRow>),
    /// Samples of three gyros and three accelerometers.
    Imu(Vec<ImuRow>),
    /// Samples of a body in fast rotation about its long axis.
    Spin(Vec<SpinRow>),
    /// Samples at rest; samples may be missing, as [`Spacing`] says.
    Static(Vec<StaticRow>),
}

impl Body {
    /// The kind of the recording that holds the rows.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Stage(_) => Kind::Stage,
            Self::Rotating(_) => Kind::Rotating,
            Self::Dwells(_) => Kind::Dwells,
            Self::Imu(_) => Kind::Imu,
            Self::Spin(_) => Kind::Spin,
            Self::Static(_) => Kind::Static,
        }
    }
}

/// The kinds that the format has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One gyro on a rotation stage that stops; read here.
    Stage,
    /// One sensor on a stage that turns all the time; read here.
    Rotating,
    /// Three gyros and three accelerometers fixed to a vehicle; read here.
    Imu,
    /// A body in fast rotation about its long axis; read here.
    Spin,
    /// A gyro at rest, for Allan variance; read here.
    Static,
    /// One row a position, already averaged; read here.
    Dwells,
}

/// The names of the kinds, for messages; a test compares them with [`Kind`].
const KINDS: &str = "stage, rotating, imu, spin, static or dwells";

impl Kind {
    /// The kinds, in the order of the format.
    pub const ALL: [Self; 6] =
        [Self::Stage, Self::Rotating, Self::Imu, Self::Spin, Self::Static, Self::Dwells];

    /// The kind's name in a header.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stage => "stage",
            Self::Rotating => "rotating",
            Self::Imu => "imu",
            Self::Spin => "spin",
            Self::Static => "static",
            Self::Dwells => "dwells",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Reads a recording from a file, plain or gzip-compressed.
///
/// # Errors
/// [`ReadError`] names file, line, column and remedy in one line.
pub fn read(path: &Path) -> Result<Recording, ReadError> {
    read_from(&path.display().to_string(), open(path)?)
}

/// Opens a file to read a recording from.
///
/// # Errors
/// [`ReadError`] that names it.
fn open(path: &Path) -> Result<File, ReadError> {
    File::open(path).map_err(|error| unread(&path.display().to_string(), &error))
}

/// That a file of this name cannot be opened.
#[must_use]
pub fn unread(name: &str, error: &io::Error) -> ReadError {
    lines::refused(Place::Whole, error).in_file(name)
}

/// Reads a recording from any reader; `name` stands in the errors. Reads no more than 32 KiB past
/// the place where reading stops, when the input is not compressed.
///
/// # Errors
/// As [`read`].
pub fn read_from(name: &str, reader: impl Read) -> Result<Recording, ReadError> {
    parse(reader).map_err(|fault| fault.in_file(name))
}

/// Reads a recording. A further kind is one of [`Kind`] and of [`Body`], with its row; the compiler names the
/// places that tell them apart.
fn parse(reader: impl Read) -> Result<Recording, Fault> {
    let Begun { mut lines, entries, kind, header, names: (line, names), mut warnings } =
        Begun::new(Lines::new(reader)?)?;
    let (body, Truth { roll_rad, attitude, .. }) =
        body(kind, &mut lines, line, &names, &mut warnings)?;
    let rate = entries.get("rate_hz").map(|(line, _)| line).zip(header.rate_hz);
    // A run notifies its session of a gap by the times alone.
    if header.session.is_none() {
        check_times(&body, rate)?;
    }
    if let Body::Imu(rows) = &body {
        stops::check_inside(&entries, &header, rows)?;
    }
    let truth = Truth { roll_rad, attitude, ..entries.truth()? };
    warnings.truncate(warning::MOST);
    Ok(Recording { header, body, truth, warnings })
}

/// The rows of a kind below the column names, which stand in line `line`, and what of the truth is in them.
fn body(
    kind: Kind,
    lines: &mut Lines<'_>,
    line: u64,
    names: &str,
    warnings: &mut Vec<Warning>,
) -> Result<(Body, Truth), Fault> {
    let mut truth = Truth::default();
    let body = match kind {
        Kind::Stage => Body::Stage(rows::read(lines, line, names, warnings)?),
        Kind::Rotating => Body::Rotating(rows::read(lines, line, names, warnings)?),
        Kind::Dwells => Body::Dwells(rows::read(lines, line, names, warnings)?),
        Kind::Static => Body::Static(rows::read(lines, line, names, warnings)?),
        Kind::Imu => {
            let both = rows::read::<(ImuRow, _)>(lines, line, names, warnings)?;
            let (rows, known): (_, Vec<_>) = both.into_iter().unzip();
            truth.attitude = known.into_iter().flatten().collect();
            if !truth.attitude.is_empty() && truth.attitude.iter().all(Option::is_none) {
                warnings.push(Warning { line, about: About::NoAttitude });
            }
            Body::Imu(rows)
        }
        Kind::Spin => {
            let both = rows::read::<(SpinRow, _)>(lines, line, names, warnings)?;
            let (rows, known): (_, Vec<_>) = both.into_iter().unzip();
            truth.roll_rad = known.into_iter().flatten().collect();
            Body::Spin(rows)
        }
    };
    Ok((body, truth))
}

/// Refuses gaps and a rate (its line, and Hz) that the times contradict. Dwells have no rate; what
/// [`Spacing`] finds in a record at rest is no error.
fn check_times(body: &Body, rate: Option<(u64, f64)>) -> Result<(), Fault> {
    match body {
        Body::Stage(rows) => timing::check(rows, |row| (row.line, row.time_s), rate),
        Body::Rotating(rows) => timing::check(rows, |row| (row.line, row.time_s), rate),
        Body::Imu(rows) => timing::check(rows, |row| (row.line, row.time_s), rate),
        Body::Spin(rows) => timing::check(rows, |row| (row.line, row.time_s), rate),
        Body::Dwells(_) | Body::Static(_) => Ok(()),
    }
}
