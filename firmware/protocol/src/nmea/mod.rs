//! Sentences of NMEA 0183, as public descriptions of IEC 61162-1 have them: at most 82 characters from `$` to the line's
//! end, a checksum of two hexadecimal digits in capitals, numbers of variable length, empty fields for what is unknown.
//!
//! | sentence | what | while it is not valid |
//! |---|---|---|
//! | [`hdt`] | heading, true | the field is empty |
//! | [`ths`] | heading, true, with its mode | the field is empty, mode V |
//! | [`rot`] | rate of turn | the field is empty, status V |
//! | [`phtro`] | pitch and roll, as fibre-optic gyrocompasses send them | it is not sent |
//! | [`phinf`] | their word of status | its bits say so |
//! | [`pmrds`] | state, σ, faults: the instrument's own | its fields are empty |
//! | [`pmrdl`] | roll of a spinning body: the instrument's own | its fields are empty |
//! | [`txt`] | words | |
//!
//! The talker is HE, a gyrocompass that seeks north.

mod fixed;
mod heading;
mod inclination;
mod sentence;
mod status;
mod writer;

pub use heading::{hdt, rot, ths};
pub use inclination::phtro;
pub use sentence::Sentence;
pub use status::{WORDS, phinf, pmrdl, pmrds, txt};

pub(crate) use writer::Writer;

/// Most characters of a sentence, `$` and the end of the line included.
pub const LONGEST: usize = 82;
/// Characters of a sentence beside its content: `$`, `*`, two digits, carriage return and line feed.
pub(crate) const FRAME: usize = 6;

/// The checksum of a sentence's content: all its bytes, added modulo two.
#[must_use]
pub fn checksum(content: &[u8]) -> u8 {
    content.iter().fold(0, |sum, byte| sum ^ byte)
}

/// Whether a field of a sentence may have this character: printable ASCII without those that have a meaning there.
#[must_use]
pub fn is_allowed(letter: char) -> bool {
    matches!(letter, ' '..='}') && !"$!*,\\^".contains(letter)
}

/// A character as a field may have it: a comma becomes a semicolon, and what else it may not have a space.
pub(crate) fn plain(letter: char) -> char {
    match letter {
        ',' => ';',
        _ if is_allowed(letter) => letter,
        _ => ' ',
    }
}
