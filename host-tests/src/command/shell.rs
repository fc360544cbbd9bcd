//! `meridian completions` and `meridian man`: what a shell and a manual are to know about the program.

use clap::builder::PossibleValuesParser;
use clap::{Args, Command};
use clap_complete::{Shell, generate};
use clap_mangen::Man;
use host::campaign::disturbed;
use host::link::words::commands;
use host::output::manner::Manner;
use serde_json::json;
use simulated::fault::Platform;

use super::mistyped::nearest;
use super::run::usual;
use super::{Answer, Failure, faults};

/// Which shell.
#[derive(Args)]
pub struct CompletionsOptions {
    /// The shell that is to complete commands, options and their values.
    shell: Shell,
}

/// Which command.
#[derive(Args)]
pub struct ManOptions {
    /// The command whose page is wanted, as `run vehicle`; the page of the program where there is none.
    #[arg(value_name = "COMMAND")]
    command: Vec<String>,
}

/// Prints what a shell needs to complete the program's command lines.
pub fn completions(
    options: &CompletionsOptions,
    mut program: Command,
    manner: Manner,
) -> Result<Answer, Failure> {
    let (mut script, name) = (Vec::new(), program.get_name().to_owned());
    program = naming_values(program);
    generate(options.shell, &mut program, name, &mut script);
    text(&script, manner)
}

/// The program with the names that values may have where its parsers know them, which would fill its help and its messages.
fn naming_values(program: Command) -> Command {
    let platforms = || Platform::ALL.into_iter().map(|platform| platform.name().to_owned());
    let faulty = |command, platform| naming(command, "fault", fault_names(platform));
    program
        .mut_subcommand("run", |run| {
            let run = faulty(run, usual::USUAL);
            Platform::ALL.into_iter().fold(run, |run, platform| {
                run.mut_subcommand(platform.name(), |command| faulty(command, platform))
            })
        })
        .mut_subcommand("campaign", |campaign| {
            let classes = disturbed::classes().map(|class| class.fault.name);
            naming(naming(campaign, "platform", platforms()), "class", classes)
        })
        .mut_subcommand("emulate", |emulate| {
            naming(emulate, "board", platforms().chain(["all".to_owned()]))
        })
        .mut_subcommand("send", |send| {
            naming(send, "words", commands().iter().map(|word| (*word).to_owned()))
        })
}

/// A command of which an option has one of these values. Their names live as long as the program, which ends with them.
fn naming(command: Command, option: &str, names: impl Iterator<Item = String>) -> Command {
    let names = names.map(|name| &*name.leak());
    command.mut_arg(option, |arg| arg.value_parser(PossibleValuesParser::new(names)))
}

/// What `--fault` may be on a platform.
fn fault_names(platform: Platform) -> impl Iterator<Item = String> {
    faults::names(platform).chain(["list".to_owned()])
}

/// Prints the page of a command for `man`.
pub fn man(options: &ManOptions, mut program: Command, manner: Manner) -> Result<Answer, Failure> {
    program.build();
    let mut command = &program;
    for name in &options.command {
        let found = command.find_subcommand(name);
        let parent = command.get_name();
        let meant = || nearest(name, command.get_subcommands().map(Command::get_name));
        let wrong = || format!("COMMAND: {parent} has no command {name}{}", meant());
        command = found.ok_or_else(|| Failure::misuse(wrong()))?;
    }
    let mut page = Vec::new();
    let version = program.get_version().unwrap_or_default();
    let source = format!("{} {version}", program.get_name());
    let man = Man::new(as_in_help(command.clone()));
    let man = man.date(NO_DATE).source(source).manual(MANUAL);
    man.render(&mut page).map_err(|error| error.to_string())?;
    let page = String::from_utf8_lossy(&page).replace(UNNAMED, EXAMPLES);
    text(page.as_bytes(), manner)
}

/// A command whose synopsis is the usage that its help has.
fn as_in_help(mut command: Command) -> Command {
    let usage = command.render_usage().to_string();
    let usage = usage.strip_prefix("Usage: ").unwrap_or(&usage).to_owned();
    command.override_usage(usage)
}

/// The date of a page that has none: without quotation marks the next part of its title would stand in its place.
const NO_DATE: &str = "\"\"";
/// What the pages belong to, in their titles.
const MANUAL: &str = "Meridian manual";
/// What the page has above the examples, which it takes for any text.
const UNNAMED: &str = ".SH EXTRA\nExamples:\n";
/// What stands there instead: a heading, and that lines are to be left as they are.
const EXAMPLES: &str = ".SH EXAMPLES\n";

/// A text, as it is or in an object.
fn text(bytes: &[u8], manner: Manner) -> Result<Answer, Failure> {
    let text = String::from_utf8_lossy(bytes).into_owned();
    let object = json!({ "status": "ok", "text": text });
    Ok(Answer::of(None, manner, &object, || text.trim_end().to_owned())?)
}
