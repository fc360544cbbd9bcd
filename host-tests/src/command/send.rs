//! `meridian send`: one command to an instrument, and its answer.

use clap::Args;
use host::link::address::Address;
use host::link::conversation::{Reply, in_words, refusal};
use host::link::records;
use host::outcome::keys::Keys;
use host::output::manner::Manner;
use host::settings::value;
use serde_json::{Map, Value, json};

use super::link::{LinkOptions, worded};
use super::{Answer, Failure};

/// What is sent, and where to.
#[derive(Args)]
pub struct SendOptions {
    /// Where the instrument is: a serial port, as /dev/ttyACM0 or COM3, or a byte stream, tcp:PORT or tcp:HOST:PORT.
    #[arg(value_parser = Address::parse)]
    port: Address,
    /// The command: start, stop, realign, azimuth AZIMUTH SIGMA, get, get NAME, set NAME VALUE, save, restore, test, log or
    /// reboot.
    #[arg(value_name = "COMMAND", required = true, allow_negative_numbers = true)]
    words: Vec<String>,
    #[command(flatten)]
    link: LinkOptions,
}

/// Sends the command and prints its answer.
pub fn run(options: &SendOptions, manner: Manner) -> Result<Answer, Failure> {
    let command = worded(options.words.iter().map(String::as_str))?;
    let mut instrument = options.link.open(&options.port)?;
    let reply = instrument.ask(&command)?;
    let line = command.line();
    let (whole, lacking) = records::whole(&reply.parts);
    let refusal = reply.refused.as_ref().map(|reason| refusal(&line, reason));
    let damaged = is_list(&line) && !(reply.damaged.is_empty() && lacking.is_empty());
    let refusal = refusal.or_else(|| damaged.then(|| not_whole(&line, &reply, &lacking)));
    let object = object(&options.port.to_string(), &line, &reply, &whole);
    let answer = Answer::of(refusal, manner, &object, || text(&line, &reply, &whole))?;
    let told = (!damaged && !reply.damaged.is_empty())
        .then(|| format!("answers of the instrument {}", in_words(&reply.damaged)));
    Ok(answer.with_warnings(told.into_iter().collect()))
}

/// Whether a command is answered by many sentences, of which one that is damaged is missing.
fn is_list(line: &str) -> bool {
    ["get", "log"].contains(&line)
}

/// That something is missing from an answer of many sentences.
fn not_whole(line: &str, reply: &Reply, lacking: &[u32]) -> String {
    let damaged =
        (!reply.damaged.is_empty()).then(|| format!("answers {}", in_words(&reply.damaged)));
    let records = if lacking.len() == 1 { "record" } else { "records" };
    let numbers = lacking.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
    let lacking =
        (!lacking.is_empty()).then(|| format!("parts of {records} {numbers} are missing"));
    let why = damaged.into_iter().chain(lacking).collect::<Vec<_>>().join("; ");
    format!("the answer to `{line}` is not whole: {why}; send it once more")
}

/// The answer in words.
fn text(line: &str, reply: &Reply, records: &[records::Record]) -> String {
    if reply.refused.is_some() {
        return String::new();
    }
    let values = reply.values.iter().map(|(name, value)| format!("{name} = {value}"));
    let records =
        records.iter().map(|(record, bytes)| format!("record {record}: {}", digits(bytes)));
    let lines: Vec<_> = values.chain(records).collect();
    if lines.is_empty() { format!("{line}: done") } else { lines.join("\n") }
}

/// The answer as an object.
fn object(port: &str, line: &str, reply: &Reply, records: &[records::Record]) -> Keys {
    let values = reply.values.iter().map(|(name, it)| (name.clone(), value::object(name, it)));
    let values = (!reply.values.is_empty()).then(|| values.collect::<Map<_, _>>());
    let records =
        records.iter().map(|(record, bytes)| json!({ "record": record, "bytes": digits(bytes) }));
    let records = (!reply.parts.is_empty()).then(|| records.collect::<Vec<Value>>());
    Keys::default()
        .with("status", if reply.refused.is_some() { "refused" } else { "ok" })
        .with("port", port)
        .with("command", line)
        .with_found("values", values)
        .with_found("records", records)
}

/// Bytes as hexadecimal digits.
fn digits(bytes: &[u8]) -> String {
    let nibbles = bytes.iter().flat_map(|byte| [byte >> 4, byte & 0xF]);
    let digits = nibbles.filter_map(|nibble| char::from_digit(nibble.into(), 16));
    digits.map(|digit| digit.to_ascii_uppercase()).collect()
}
