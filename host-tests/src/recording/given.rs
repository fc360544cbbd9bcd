//! What the session of a recorded run was given beside its samples, and how it ended.
//!
//! A replay that gives the same to the same session comes to the same result, to the last bit; without it, a
//! replay has to find out from the samples what the instrument was given. It stands in the header as JSON under
//! the key `session`, behind the checksum of all that the header says: it counts as the run wrote it, or not at all.

use std::io::{self, Write};

use orientation::alignment::refusal::Refusal;
use orientation::units::AngularRate;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::Header;
use super::header::{self, SESSION};

/// What a run of a board rests on, and so its replay.
pub const GIVEN: &str = "what the board was given about place and instrument";

/// What a session was given beside its samples.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Given<S, P = ()> {
    /// Site, instrument and requirements.
    pub setting: S,
    /// How the session goes about it.
    pub procedure: P,
    /// Why the instrument ended the session before its end, where it did: a device failed, or time was over.
    pub ended: Option<Refusal>,
}

impl<S, P> Given<S, P> {
    /// What a session was given that ended so. A refusal of the session itself is not among it: a replay has to come
    /// to the same one.
    pub fn new(setting: S, procedure: P, ended: Option<Refusal>) -> Self {
        Self { setting, procedure, ended: ended.filter(is_from_outside) }
    }
}

/// Whether an instrument may end a session with this refusal, of which the samples show nothing.
fn is_from_outside(refusal: &Refusal) -> bool {
    matches!(
        refusal,
        Refusal::Device { .. }
            | Refusal::LatitudeTooHigh { .. }
            | Refusal::MisalignmentUnknown
            | Refusal::MovedDuringAlignment
            | Refusal::TimeExhausted
    )
}

impl<S: DeserializeOwned, P: DeserializeOwned> Given<S, P> {
    /// What the header says, where it comes from a run.
    ///
    /// # Errors
    /// It belongs to another kind of session, or to another version of it: why it cannot be read.
    pub fn of(header: &Header) -> Result<Option<Self>, String> {
        let read = header.session.as_ref().map(|text| serde_json::from_str(text));
        read.transpose().map_err(|error| error.to_string())
    }
}

/// A rate as a board had it: at its lower limit it stands in a recording a step above, where the column's range ends.
pub(crate) fn rate(rad_s: f64) -> AngularRate {
    let rate = AngularRate::from_rad_per_s(rad_s);
    if rate.0 == -i32::MAX { AngularRate(i32::MIN) } else { rate }
}

impl<S: Serialize + DeserializeOwned, P: Serialize + DeserializeOwned> Given<S, P> {
    /// Writes the lines of a header, and this as its last one.
    ///
    /// # Errors
    /// The file cannot be written, or holds a number that JSON does not have.
    pub fn write(&self, to: &mut impl Write, lines: &[u8]) -> io::Result<()> {
        let (lines, text) = (String::from_utf8_lossy(lines), serde_json::to_string(self)?);
        serde_json::from_str::<Self>(&text)?;
        let keys = lines.lines().filter_map(header::key_and_value);
        writeln!(to, "{lines}# {SESSION}: {} {text}", header::checksum(keys, &text))
    }
}
