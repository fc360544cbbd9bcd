//! What in a recording is passed over although it looks as if it was meant: told, for it changes no number.

use std::fmt;

use super::quote::shortened;

/// Most warnings that are kept of one recording.
pub(super) const MOST: usize = 20;

/// Something that is passed over. [`Display`](fmt::Display) is one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The line, from 1.
    pub line: u64,
    /// What stands there.
    pub about: About,
}

/// What is passed over, and what it may have been meant to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum About {
    /// An unknown key, and the known one that it resembles.
    Key(String, &'static str),
    /// The same of a column.
    Column(String, &'static str),
    /// A field of a `truth_` column that is no number.
    NoTruth(String, String),
    /// Columns of a true attitude, of which this one is missing.
    PartOfTruth(&'static str),
    /// Columns of a true attitude that hold none in any row.
    NoAttitude,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, ", self.line)?;
        match &self.about {
            About::Key(key, known) => {
                let key = shortened(key);
                write!(f, "key {key}: is not known and passed over; if {known} is meant, write that")
            }
            About::Column(name, known) => {
                let name = shortened(name);
                write!(f, "column {name}: is not known and passed over; if {known} is meant, write that")
            }
            About::NoTruth(name, text) => {
                let (name, text) = (shortened(name), shortened(text));
                write!(f, "column {name}: \"{text}\" is not a number; correct it or leave the column out")
            }
            About::PartOfTruth(missing) => {
                write!(f, "columns truth_qw to truth_qz: {missing} is missing, so the others are passed over")
            }
            About::NoAttitude => f.write_str(
                "columns truth_qw to truth_qz: no row holds a quaternion of length one; all are passed over",
            ),
        }
    }
}
