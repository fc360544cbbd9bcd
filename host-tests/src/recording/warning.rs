//! What in a recording is passed over although it looks as if it was meant: reported, for it changes no number.

use thiserror::Error;

use super::quote::shortened;

/// Most warnings that are kept of one recording.
pub(super) const MOST: usize = 20;

/// Something that is passed over. Its text is one line.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line}, {about}")]
pub struct Warning {
    /// The line, from 1.
    pub line: u64,
    /// What stands in the line.
    pub about: About,
}

/// What is passed over, and what it may have been meant to be.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum About {
    /// An unknown key, and the known one that it resembles.
    #[error("key {key}: is not known and passed over; if {1} is meant, write that", key = shortened(.0))]
    Key(String, &'static str),
    /// A column that is not known, but resembles one that is.
    #[error("column {name}: is not known and passed over; if {1} is meant, write that", name = shortened(.0))]
    Column(String, &'static str),
    /// A field of a `truth_` column that is no number.
    #[error(
        "column {name}: \"{text}\" is not a number; correct it or leave the column out",
        name = shortened(.0), text = shortened(.1)
    )]
    NoTruth(String, String),
    /// Columns of a true attitude, of which this one is missing.
    #[error("columns truth_qw to truth_qz: {0} is missing, so the others are passed over")]
    PartOfTruth(&'static str),
    /// Columns of a true attitude that hold none in any row.
    #[error(
        "columns truth_qw to truth_qz: no row holds a quaternion of length one; all are passed over"
    )]
    NoAttitude,
}
