//! Decodes an image's defmt stream with the strings that its ELF file holds.

use std::fmt;

use defmt_decoder::{DecodeError, Frame, StreamDecoder, Table};

/// One line of the log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Time since the start, as the image words it.
    pub time: String,
    /// Level; none for a line that is printed at every level.
    pub level: Option<&'static str>,
    /// Words of the line.
    pub words: String,
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:>12} {:<5} {}", self.time, self.level.unwrap_or("-"), self.words)
    }
}

impl Line {
    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the method's type has no name here"
    )]
    fn of(frame: &Frame) -> Self {
        Self {
            time: frame.display_timestamp().map(|time| time.to_string()).unwrap_or_default(),
            level: frame.level().map(|level| level.as_str()),
            words: frame.display_message().to_string(),
        }
    }
}

/// The strings of an image.
///
/// # Errors
/// Where the file is no image with a defmt log.
pub fn table(elf: &[u8]) -> Result<Table, String> {
    match Table::parse(elf) {
        Ok(Some(table)) => Ok(table),
        Ok(None) => Err("the image has no defmt strings".to_owned()),
        Err(error) => Err(format!("the image's defmt strings cannot be read: {error:#}")),
    }
}

/// Takes bytes of a stream and hands over the lines that they complete.
///
/// # Errors
/// An error of `on_line`, or bytes that are no defmt frame: nothing is lost on the way from the
/// emulator, so something else has printed there.
pub fn take(
    stream: &mut dyn StreamDecoder,
    bytes: &[u8],
    mut on_line: impl FnMut(&Line) -> Result<(), String>,
) -> Result<(), String> {
    stream.received(bytes);
    loop {
        match stream.decode() {
            Ok(frame) => on_line(&Line::of(&frame))?,
            Err(DecodeError::UnexpectedEof) => return Ok(()),
            Err(DecodeError::Malformed) => {
                return Err("the emulator's log holds bytes that are no defmt frame".to_owned());
            }
        }
    }
}
