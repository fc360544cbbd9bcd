//! `meridian log`: lines of its log that a board has kept in flash.

use std::path::{Path, PathBuf};

use clap::Args;
use execution::kept::{Line, lines};
use host::output::manner::Manner;
use host::recording;
use serde::Serialize;

use super::{Answer, Failure};

/// The image, and what was read from the flash.
#[derive(Args)]
pub struct LogOptions {
    /// The ELF file of the image that the board has: the words are in it alone.
    #[arg(value_name = "FILE.elf")]
    image: PathBuf,
    /// The pages with the lines, as bytes: `probe-rs read --chip STM32L475VGTx b32 0x080F7000 8192 --format binary --output
    /// FILE`.
    #[arg(value_name = "FILE")]
    pages: PathBuf,
}

/// What is printed.
#[derive(Serialize)]
struct Object {
    lines: Vec<Line>,
}

/// Prints the lines.
pub fn run(options: &LogOptions, manner: Manner) -> Result<Answer, Failure> {
    let LogOptions { image, pages } = options;
    let lines = lines(&read(image)?, &read(pages)?);
    let lines = lines.map_err(|error| format!("{}: {error}", image.display()))?;
    let refusal = lines.is_empty().then(|| format!("{}: no line was kept there", pages.display()));
    let text = lines.iter().map(Line::to_string).collect::<Vec<_>>().join("\n");
    Ok(Answer::of(refusal, manner, &Object { lines }, || text)?)
}

/// Reads a file.
fn read(path: &Path) -> Result<Vec<u8>, String> {
    let unread = |error| recording::unread(&path.display().to_string(), &error).message();
    std::fs::read(path).map_err(unread)
}
