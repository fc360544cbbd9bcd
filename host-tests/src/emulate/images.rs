//! The firmware's images for the emulator.

use std::path::PathBuf;

use execution::built::{executable, of_firmware};

/// The images, as files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Images {
    /// The instrument on simulated chips.
    pub emulator: PathBuf,
    /// The count of the cores' instructions.
    pub cost: PathBuf,
}

/// Builds both images; cargo's progress goes to standard error.
///
/// # Errors
/// One line: what is missing, or that cargo said what is wrong.
pub fn build() -> Result<Images, String> {
    artifacts(&of_firmware(&["--package", "emulator"])?)
}

/// The executables in cargo's messages, one JSON object in a line.
///
/// # Errors
/// Which is not there.
pub fn artifacts(messages: &str) -> Result<Images, String> {
    Ok(Images { emulator: executable(messages, "emulator")?, cost: executable(messages, "cost")? })
}
