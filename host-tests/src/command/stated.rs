//! The options that stand on the command line, apart from those that have their defaults.

use clap::ArgMatches;
use clap::parser::ValueSource;

/// The options that every command takes, which change nothing of what it does.
const GLOBAL: [&str; 3] = ["json", "verbose", "quiet"];

/// The options of a command that stand on the command line, by the names of their fields.
#[derive(Default)]
pub struct Stated(Vec<String>);

impl Stated {
    /// Collects the options of a command and of its subcommands.
    pub fn of(matches: &ArgMatches) -> Self {
        // What begins with a capital letter is a group of options.
        let stands = |id: &&clap::Id| {
            id.as_str().starts_with(char::is_lowercase)
                && !GLOBAL.contains(&id.as_str())
                && matches.value_source(id.as_str()) == Some(ValueSource::CommandLine)
        };
        let mut stated: Vec<_> = matches.ids().filter(stands).map(ToString::to_string).collect();
        stated.extend(matches.subcommand().into_iter().flat_map(|(_, inner)| Self::of(inner).0));
        Self(stated)
    }

    /// Whether this one is among them.
    pub fn has(&self, option: &str) -> bool {
        self.0.iter().any(|stated| stated == option)
    }

    /// The first of these that is among them.
    pub fn first(&self, options: &[&'static str]) -> Option<&'static str> {
        options.iter().find(|option| self.has(option)).copied()
    }

    /// The first that is none of these.
    pub fn beside(&self, options: &[&str]) -> Option<&str> {
        self.0.iter().map(String::as_str).find(|stated| !options.contains(stated))
    }
}

/// An option as it stands on the command line.
pub fn long(option: &str) -> String {
    format!("--{}", option.replace('_', "-"))
}
