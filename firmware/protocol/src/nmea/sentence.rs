//! A sentence as it is sent.

use core::fmt::{self, Display};
use core::ops::Deref;

use heapless::Vec;

use super::LONGEST;

/// A sentence with its frame and the end of its line, of ASCII characters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sentence {
    letters: Vec<u8, LONGEST>,
}

impl Sentence {
    /// Adds a character of ASCII; whether there was room.
    pub(super) fn push(&mut self, letter: u8) -> bool {
        self.letters.push(letter).is_ok()
    }

    /// Its characters.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        &self.letters
    }
}

impl Deref for Sentence {
    type Target = str;

    fn deref(&self) -> &str {
        // They are ASCII.
        str::from_utf8(&self.letters).unwrap_or_default()
    }
}

impl Display for Sentence {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self)
    }
}
