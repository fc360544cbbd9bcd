//! `meridian log`: lines of its log that a board has kept in flash, of a dump of that or asked for over its link.

use std::path::{Path, PathBuf};

use clap::Args;
use execution::kept::{Line, lines, lines_of};
use host::link::address::Address;
use host::link::conversation::in_words;
use host::link::records;
use host::output::manner::Manner;
use host::recording;
use serde::Serialize;

use super::link::LinkOptions;
use super::{Answer, Failure};

/// The image, and what was read from the flash.
#[derive(Args)]
pub struct LogOptions {
    /// The ELF file of the image that the board has: the words are in it alone.
    #[arg(value_name = "FILE.elf")]
    image: PathBuf,
    /// The pages with the lines, as bytes: `probe-rs read --chip STM32L475VGTx b32 0x080F7000 8192 --format binary --output
    /// FILE`; or where the instrument is: a serial port, as /dev/ttyACM0 or COM3, or a byte stream, tcp:PORT or
    /// tcp:HOST:PORT.
    #[arg(value_name = "FILE|PORT")]
    from: PathBuf,
    #[command(flatten)]
    link: LinkOptions,
}

/// What is printed.
#[derive(Serialize)]
struct Object {
    lines: Vec<Line>,
}

/// Prints the lines.
pub fn run(options: &LogOptions, manner: Manner) -> Result<Answer, Failure> {
    let LogOptions { image, from, link } = options;
    let elf = read(image)?;
    let port = from.to_str().and_then(Address::of_port);
    let (lines, warnings) = match port {
        Some(port) => {
            let (records, warnings) = asked(link, &port)?;
            (lines_of(&elf, records), warnings)
        }
        None => (lines(&elf, &read(from)?), Vec::new()),
    };
    let lines = lines.map_err(|error| format!("{}: {error}", image.display()))?;
    let refusal = lines.is_empty().then(|| format!("{}: no line was kept there", from.display()));
    let text = lines.iter().map(Line::to_string).collect::<Vec<_>>().join("\n");
    let answer = Answer::of(refusal, manner, &Object { lines }, || text)?;
    Ok(answer.with_warnings(warnings))
}

/// The records of the instrument at a port, and what is to be said of those that are not whole.
fn asked(
    link: &LinkOptions,
    port: &Address,
) -> Result<(Vec<records::Record>, Vec<String>), String> {
    let reply = link.open(port)?.say(&["log"])?.done("log")?;
    let (whole, lacking) = records::whole(&reply.parts);
    let lacking = lacking.iter().map(|record| format!("record {record}: a part of it is missing"));
    let damaged =
        (!reply.damaged.is_empty()).then(|| format!("answers {}", in_words(&reply.damaged)));
    Ok((whole, lacking.chain(damaged).collect()))
}

/// Reads a file.
fn read(path: &Path) -> Result<Vec<u8>, String> {
    let unread = |error| recording::unread(&path.display().to_string(), &error).message();
    std::fs::read(path).map_err(unread)
}
