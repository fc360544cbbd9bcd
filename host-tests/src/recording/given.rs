//! What the session of a recorded run was given beside its samples, and how it ended.
//!
//! A replay that gives the same to the same session comes to the same result, to the last bit; without it, a
//! replay has to find out from the samples what the instrument was given. It stands in the header as JSON under
//! the key `session`.

use std::fmt;

use orientation::error::Refusal;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::Header;
use super::header::SESSION;

/// What a replay of a run rests on.
pub(crate) const GIVEN: &str = "what the board was given about place and instrument";

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
    /// The text was changed, or belongs to another kind of session: why it cannot be read.
    pub fn of(header: &Header) -> Result<Option<Self>, String> {
        let read = header.session.as_ref().map(|text| serde_json::from_str(text));
        read.transpose().map_err(|error| error.to_string())
    }
}

impl<S: Serialize, P: Serialize> fmt::Display for Given<S, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = serde_json::to_string(self).map_err(|_| fmt::Error)?;
        write!(f, "# {SESSION}: {text}")
    }
}
