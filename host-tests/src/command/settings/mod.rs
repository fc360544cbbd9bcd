//! `meridian settings`: the settings of an instrument, one by one or in a file.

mod files;
mod values;

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::{Args, Subcommand};
use host::link::address::Address;
use host::link::conversation::Conversation;
use host::outcome::keys::Keys;
use host::output::manner::Manner;
use host::report::Lines;
use host::settings::value;
use serde_json::{Map, Value};

use super::link::LinkOptions;
use super::{Answer, Failure, examples};

/// Where the instrument is, and what is done.
#[derive(Args)]
pub struct SettingsOptions {
    /// Where the instrument is: a serial port, as /dev/ttyACM0 or COM3, or a byte stream, tcp:PORT or tcp:HOST:PORT.
    #[arg(value_parser = Address::parse)]
    port: Address,
    #[command(subcommand)]
    action: Action,
    #[command(flatten)]
    link: LinkOptions,
}

/// What is done with the settings.
#[derive(Subcommand)]
enum Action {
    /// Shows settings, all of them where none is named.
    #[command(after_help = examples::SETTINGS_GET)]
    Get(GetOptions),
    /// Changes settings until the instrument is switched off; `meridian send PORT save` keeps them in its flash.
    #[command(after_help = examples::SETTINGS_SET)]
    Set(SetOptions),
    /// Writes all settings to a file, with carrier, serial number and firmware.
    #[command(after_help = examples::SETTINGS_SAVE)]
    Save(SaveOptions),
    /// Sets what differs in a file, keeps it in flash and reads it back; if anything is refused, nothing is changed.
    #[command(after_help = examples::SETTINGS_LOAD)]
    Load(LoadOptions),
}

/// Which settings.
#[derive(Args)]
struct GetOptions {
    /// Names of settings, or carrier, serial, firmware.
    #[arg(value_name = "NAME")]
    names: Vec<String>,
}

/// Which settings, and their values.
#[derive(Args)]
struct SetOptions {
    /// A name and its value, as `latitude 47.58` or `latitude=47.58`; several of them one after the other.
    #[arg(value_name = "NAME VALUE", required = true, allow_negative_numbers = true)]
    pairs: Vec<String>,
}

/// Where the settings go.
#[derive(Args)]
struct SaveOptions {
    /// The file that is to have them.
    #[arg(value_name = "FILE.toml")]
    file: PathBuf,
    /// Writes over a file that is there.
    #[arg(long)]
    overwrite: bool,
}

/// Where the settings come from.
#[derive(Args)]
struct LoadOptions {
    /// The file that has them.
    #[arg(value_name = "FILE.toml")]
    file: PathBuf,
    /// Takes a file of another board, without its calibrations.
    #[arg(long)]
    other_board: bool,
}

/// Does what is asked for.
pub fn run(options: &SettingsOptions, manner: Manner) -> Result<Answer, Failure> {
    match &options.action {
        Action::Get(of) => values::get(options, of, manner),
        Action::Set(of) => values::set(options, of, manner),
        Action::Save(of) => files::save(options, of, manner),
        Action::Load(of) => files::load(options, of, manner),
    }
}

impl SettingsOptions {
    /// A conversation with the instrument.
    fn open(&self) -> Result<Conversation, String> {
        self.link.open(&self.port)
    }

    /// The keys that every object has.
    fn keys(&self) -> Keys {
        Keys::default().with("status", "ok").with("port", self.port.to_string())
    }

    /// The heading of every report.
    fn title(&self, what: &str) -> String {
        format!("{what} of the instrument at {}", self.port)
    }
}

/// Names and values as an object.
fn in_object(values: &BTreeMap<String, String>) -> Map<String, Value> {
    values.iter().map(|(name, it)| (name.clone(), value::object(name, it))).collect()
}

/// Names and values as lines under a heading.
fn in_lines(title: &str, values: &BTreeMap<String, String>) -> Lines {
    values.iter().fold(Lines::new(title), |lines, (name, value)| lines.with(name, value))
}
