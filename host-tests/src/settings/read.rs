//! Reads all settings of an instrument, so that none is missing unseen.

use super::Snapshot;
use crate::link::conversation::{Conversation, in_words};

/// How often the settings are read until two readings agree.
const READINGS: usize = 4;

/// All settings, and what the instrument is. They are read until two readings agree: an answer that is lost as a whole
/// leaves no trace in a list.
///
/// # Errors
/// The instrument does not answer, refuses, or no two readings agree.
pub fn all(instrument: &mut Conversation) -> Result<Snapshot, String> {
    let (mut last, mut damaged) = (None, Vec::new());
    for _ in 0..READINGS {
        let reply = instrument.say(&["get"])?.done("get")?;
        let is_whole = reply.damaged.is_empty();
        damaged.extend(reply.damaged);
        let snapshot = Some(Snapshot::of(reply.values)).filter(|_| is_whole);
        if snapshot.is_some() && snapshot == last {
            return snapshot.filter(|it| !it.settings.is_empty()).ok_or_else(|| {
                format!("{}: the instrument names no settings", instrument.place())
            });
        }
        last = snapshot;
    }
    let came = if damaged.is_empty() { "they differ".to_owned() } else { in_words(&damaged) };
    Err(format!(
        "{}: no two of {READINGS} readings of all settings agree: answers {came}; check the line, and close other programs \
         that read the port",
        instrument.place()
    ))
}
