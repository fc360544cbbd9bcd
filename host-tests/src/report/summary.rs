//! What a report says first: what was found, how good it is, and why where there is nothing.

use serde::{Serialize, Serializer};

/// The head of a report.
#[must_use]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// What came of it.
    pub grade: Grade,
    /// Why nothing was found.
    pub reasons: Vec<String>,
    /// What takes from what was found, or is to be said of the way there.
    pub remarks: Vec<String>,
    /// The quantity that was found, and its value with its uncertainty.
    pub found: Option<[String; 2]>,
    /// What is to be known beside it: label and value of each line.
    pub facts: Vec<[String; 2]>,
    /// Of what it was found: place, instrument, time. Shown where everything is.
    pub circumstances: Vec<[String; 2]>,
    /// The azimuth as a compass shows it.
    pub rose: Option<Rose>,
}

/// What came of an analysis: the one verdict that text, object, page and exit code tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Grade {
    /// A result, and nothing is wrong.
    #[default]
    Found,
    /// A result, beside which something is to be said.
    Degraded,
    /// No result.
    Refused,
    /// Not carried to its end: no result, or that of the part that was done.
    Interrupted,
}

impl Grade {
    /// The word for it.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::Degraded => "degraded",
            Self::Refused => "refused",
            Self::Interrupted => "interrupted",
        }
    }

    /// The `status` of an object with this verdict: `ok` where the exit code is 0, and nowhere else.
    #[must_use]
    pub fn status(self) -> &'static str {
        match self {
            Self::Found | Self::Degraded => "ok",
            Self::Refused | Self::Interrupted => self.word(),
        }
    }
}

impl Serialize for Grade {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.status())
    }
}

/// An azimuth as a compass shows it, in degrees from true north, clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rose {
    /// The azimuth found.
    pub azimuth_deg: f64,
    /// 1σ of it.
    pub sigma_deg: f64,
    /// Its Cramér–Rao bound, where it is known.
    pub limit_deg: Option<f64>,
    /// The true azimuth, where it is known.
    pub truth_deg: Option<f64>,
}
