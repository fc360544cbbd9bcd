//! The commands of the program, one file each: options in, [`Told`] out.

pub mod allan;
pub mod campaign;
pub mod emulate;
pub mod replay;
pub mod run;

use std::fmt;
use std::io::Write;

use serde::Serialize;

/// What came of a command, ready to print.
pub struct Told {
    /// Whether there was a result.
    pub found: bool,
    /// For standard output.
    pub output: String,
    /// Why there was none.
    pub refusal: Option<String>,
}

impl Told {
    /// The object, or the text that a writer makes.
    fn of(
        found: bool,
        as_json: bool,
        object: &impl Serialize,
        text: impl FnOnce(&mut String) -> fmt::Result,
    ) -> Result<Self, String> {
        let mut output = String::new();
        if as_json {
            output = serde_json::to_string_pretty(object).map_err(|error| error.to_string())?;
        } else {
            text(&mut output).map_err(|error| error.to_string())?;
        }
        Ok(Self { found, output, refusal: None })
    }
}

/// Writes to standard output; a closed pipe is no error of ours.
pub fn print(output: &str) -> Result<(), String> {
    match writeln!(std::io::stdout(), "{output}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}
