//! `host-tests/README.md` names every command and option, and none that there is not.

use std::collections::BTreeSet;

use super::page;
use crate::support::program::{code, meridian, text};

/// Where the command line is described.
const PAGE: &str = "host-tests/README.md";
/// How the heading of a command begins.
const HEADING: &str = "\n### `meridian ";
/// Options of cargo, in commands that begin with it.
const OF_CARGO: [&str; 1] = ["--release"];

/// The help of a command.
fn help(command: &[&str]) -> String {
    let output = meridian(&[command, &["--help"]].concat());
    assert_eq!(code(&output), 0, "{command:?}");
    text(&output.stdout)
}

/// The commands below a command, by their whole names.
fn below(command: &str) -> Vec<String> {
    let words: Vec<_> = command.split_whitespace().collect();
    let help = help(&words);
    let (_, behind) = help.split_once("Commands:\n").unwrap_or_default();
    let lines = behind.lines().take_while(|line| !line.is_empty());
    // A name stands two columns from the edge, the rest of its meaning far behind it.
    let names = lines.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let names = names.filter(|name| !name.is_empty() && *name != "help");
    names.map(|name| format!("{command} {name}").trim().to_owned()).collect()
}

/// All commands.
pub(super) fn commands() -> Vec<String> {
    let first = below("");
    let second: Vec<_> = first.iter().flat_map(|command| below(command)).collect();
    [first, second].concat()
}

/// The long options that a text names.
pub(super) fn options(text: &str) -> BTreeSet<String> {
    let words = text.split(|letter: char| letter != '-' && !letter.is_ascii_lowercase());
    let is_option = |word: &&str| {
        let name = word.strip_prefix("--");
        name.is_some_and(|name| name.starts_with(|letter: char| letter.is_ascii_lowercase()))
    };
    words.filter(is_option).map(str::to_owned).collect()
}

/// The long options that a command has, those of its platforms too.
pub(super) fn options_of(command: &str, commands: &[String]) -> BTreeSet<String> {
    let its = commands
        .iter()
        .filter(|other| other.as_str() == command || other.starts_with(&format!("{command} ")));
    let mut all = BTreeSet::new();
    for command in its {
        let help = help(&command.split_whitespace().collect::<Vec<_>>());
        let lines = help.lines().filter(|line| line.trim_start().starts_with('-'));
        all.extend(lines.flat_map(options));
    }
    all
}

#[test]
fn the_page_of_the_command_line_describes_every_command_and_no_other() {
    let text = page(PAGE);
    let headings = text.split(HEADING).skip(1).filter_map(|behind| behind.split('`').next());
    let described: BTreeSet<_> = headings.map(str::to_owned).collect();
    assert_eq!(described, commands().into_iter().collect());
}

#[test]
fn every_option_of_every_command_stands_on_the_page_of_the_command_line() {
    let named = options(&page(PAGE));
    let commands = commands();
    for command in &commands {
        let mut missing = options_of(command, &commands);
        missing.retain(|option| !named.contains(option));
        assert!(missing.is_empty(), "{PAGE} does not say what {missing:?} of {command} are");
    }
}

#[test]
fn every_option_that_the_page_of_the_command_line_names_is_one_of_its_command() {
    let text = page(PAGE);
    let commands = commands();
    let mut all = BTreeSet::from(OF_CARGO.map(str::to_owned));
    let mut sections = text.split(HEADING);
    let before = sections.next().expect("a page has a beginning");
    for section in sections {
        let (command, described) = section.split_once('`').expect("a heading has an end");
        let (described, behind) = described.split_once("\n## ").unwrap_or((described, ""));
        let has = options_of(command, &commands);
        let unknown: Vec<_> = options(described).difference(&has).cloned().collect();
        assert!(unknown.is_empty(), "{command} has no {unknown:?}");
        all.extend(has);
        let unknown: Vec<_> = options(behind).difference(&all).cloned().collect();
        assert!(unknown.is_empty(), "no command has {unknown:?}");
    }
    let unknown: Vec<_> = options(before).difference(&all).cloned().collect();
    assert!(unknown.is_empty(), "no command has {unknown:?}");
}
