//! What is wrong with a recording, where, and what to do about it, in one line.

use std::io::ErrorKind;

use thiserror::Error;

use super::problem::Problem;
use super::quote::shortened;
use crate::output::printable;

/// Why a recording was not read. Its text is one line, whatever the file holds:
/// `walk.csv: line 812, column g_rad_s: "abc" is not a number; …`.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}: {place}{problem}", printable(file))]
pub struct ReadError {
    /// The name under which the recording was read.
    pub file: String,
    /// Where in the file.
    pub place: Place,
    /// What is wrong, and the remedy.
    pub problem: Problem,
}

impl ReadError {
    /// The message with the unit in which a number beyond its range is likely to stand.
    #[must_use]
    pub fn message(&self) -> String {
        match &self.problem {
            Problem::OutOfRange(_, range) => format!("{self}{}", range.mistaken()),
            _ => self.to_string(),
        }
    }
}

/// Where in a recording something is wrong. Lines count from 1, of the text after decompression.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Place {
    /// The file as a whole.
    #[error("")]
    Whole,
    /// A line.
    #[error("line {0}: ")]
    Line(u64),
    /// A header key, and its line.
    #[error("line {line}, key {}: ", shortened(.1), line = .0)]
    Key(u64, String),
    /// A column, and the line of the row or of the column names.
    #[error("line {line}, column {}: ", shortened(.1), line = .0)]
    Column(u64, String),
}

/// A [`ReadError`] before it learns the file's name.
#[derive(Debug)]
pub(super) struct Fault {
    place: Place,
    problem: Problem,
}

impl Fault {
    /// A problem at a place.
    pub fn new(place: Place, problem: Problem) -> Self {
        Self { place, problem }
    }

    /// A problem of one line.
    pub fn line(line: u64, problem: Problem) -> Self {
        Self::new(Place::Line(line), problem)
    }

    /// A problem of one column in one line.
    pub fn column(line: u64, name: &str, problem: Problem) -> Self {
        Self::new(Place::Column(line, name.to_owned()), problem)
    }

    /// A problem of one header key.
    pub fn key(line: u64, name: &str, problem: Problem) -> Self {
        Self::new(Place::Key(line, name.to_owned()), problem)
    }

    /// The fault where a column is called otherwise in the file.
    pub fn renamed(self, from: &str, to: &str) -> Self {
        let place = match self.place {
            Place::Column(line, name) if name == from => Place::Column(line, to.to_owned()),
            place => place,
        };
        let problem = match self.problem {
            Problem::MissingColumn(all) => Problem::MissingColumn(all.replace(from, to)),
            problem => problem,
        };
        Self { place, problem }
    }

    /// Whether the compressed data end too early.
    pub fn is_cut_short(&self) -> bool {
        matches!(self.problem, Problem::Io(ErrorKind::UnexpectedEof, _))
    }

    /// Names the file.
    pub fn in_file(self, file: &str) -> ReadError {
        ReadError { file: file.to_owned(), place: self.place, problem: self.problem }
    }
}
