//! What is wrong with a command line, in one line, and what may have been meant.

use std::path::Path;

use clap::Command;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// How the lines of an error begin that only hint at what else there is: here that is part of the one line.
const HINTS: [&str; 2] = ["tip: ", "For more information"];
/// Least similarity (Jaro's) of two names of which one may be the other, mistyped.
const SIMILAR: f64 = 0.8;

/// What is wrong in one line, whose help says more, and what may have been meant.
pub fn message(error: &clap::Error, program: &Command) -> String {
    let text = error.render().to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let lines = lines.filter(|line| !HINTS.iter().any(|hint| line.starts_with(hint)));
    let message = lines.filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    let message = message.strip_prefix("error: ").unwrap_or(&message);
    match error.kind() {
        ErrorKind::UnknownArgument => {
            let meant = elsewhere(error, program).or_else(|| behind(error, program));
            let meant = meant.unwrap_or_else(|| self::meant(error));
            format!("{message}; see `{} --help`{meant}", command(&text))
        }
        ErrorKind::InvalidSubcommand => {
            format!("{message}{}", replayed(error).unwrap_or_else(|| meant(error)))
        }
        _ => format!("{message}{}", meant(error)),
    }
}

/// The command whose usage an error shows.
fn command(text: &str) -> String {
    let usage = text.lines().find_map(|line| line.trim().strip_prefix("Usage: "));
    let is_name = |word: &&str| !word.starts_with(['-', '[', '<']);
    usage.unwrap_or_default().split(' ').take_while(is_name).collect::<Vec<_>>().join(" ")
}

/// What an error says of one of its circumstances.
fn told(error: &clap::Error, kind: ContextKind) -> Option<&str> {
    match error.get(kind)? {
        ContextValue::String(name) => Some(name),
        // The most similar one comes last.
        ContextValue::Strings(names) => names.last().map(String::as_str),
        _ => None,
    }
}

/// The platforms that have an option which another platform was given.
fn elsewhere(error: &clap::Error, program: &Command) -> Option<String> {
    let option = told(error, ContextKind::InvalidArg)?.strip_prefix("--")?;
    let run = program.find_subcommand("run")?;
    let has = |platform: &&Command| platform.get_opts().any(|of| of.get_long() == Some(option));
    let having: Vec<_> = run.get_subcommands().filter(has).map(Command::get_name).collect();
    (!having.is_empty()).then(|| format!("; it is an option of run {}", having.join(", ")))
}

/// Where the platform of a run belongs, that stands behind its options.
fn behind(error: &clap::Error, program: &Command) -> Option<String> {
    let name = told(error, ContextKind::InvalidArg)?;
    program.find_subcommand("run")?.find_subcommand(name)?;
    Some(format!("; the platform comes first: `meridian run {name}`, then its options"))
}

/// The name of a command, an option or a value that resembles what was typed, as a question; nothing where none does.
fn meant(error: &clap::Error) -> String {
    use ContextKind as Kind;
    let kinds = [
        (Kind::InvalidSubcommand, Kind::SuggestedSubcommand),
        (Kind::InvalidArg, Kind::SuggestedArg),
        (Kind::InvalidValue, Kind::SuggestedValue),
    ];
    let found = kinds
        .into_iter()
        .find_map(|(typed, suggested)| Some((told(error, typed)?, told(error, suggested)?)));
    found.map(|(typed, name)| nearest(typed, [name].into_iter())).unwrap_or_default()
}

/// Of these names the one that resembles what was typed most, as a question; nothing where none does.
pub fn nearest<N: AsRef<str>>(typed: &str, names: impl Iterator<Item = N>) -> String {
    // What all options have in common is no resemblance.
    let bare = |name: &str| name.trim_start_matches('-').to_owned();
    let rated = names.map(|name| (strsim::jaro(&bare(typed), &bare(name.as_ref())), name));
    let similar = rated.filter(|(similarity, _)| *similarity >= SIMILAR);
    let nearest = similar.max_by(|(one, _), (other, _)| one.total_cmp(other));
    nearest.map(|(_, name)| format!("; did you mean `{}`?", name.as_ref())).unwrap_or_default()
}

/// The command that takes a file, where the name of one stands in the place of a command.
fn replayed(error: &clap::Error) -> Option<String> {
    let name = told(error, ContextKind::InvalidSubcommand)?;
    let is_file = Path::new(name).exists() || Path::new(name).extension().is_some();
    is_file.then(|| format!("; `meridian replay {name}` replays a recording"))
}
