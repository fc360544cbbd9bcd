//! The `meridian` command line: runs the board, replays recordings, runs campaigns and the emulated
//! firmware.
//!
//! Results go to standard output, progress and errors to standard error. The exit code is 0 with a
//! result, 1 where it is refused or failed, 2 for misuse.
#![forbid(unsafe_code)]

mod command;

use std::process::ExitCode;

use bench::output::say;
use clap::{FromArgMatches, Parser, Subcommand};

use crate::command::allan::AllanOptions;
use crate::command::campaign::CampaignOptions;
use crate::command::emulate::EmulateOptions;
use crate::command::plan::PlanOptions;
use crate::command::replay::ReplayOptions;
use crate::command::run::RunOptions;
use crate::command::{Told, print};

/// Finds true north from a precise gyro on a rotation stage, with its standard deviation.
///
/// Without a command it is `run`.
#[derive(Parser)]
#[command(name = "meridian", version)]
struct CommandLine {
    /// One JSON object on standard output instead of text.
    #[arg(long, global = true)]
    json: bool,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Runs the whole board application on simulated chips.
    Run(Box<RunOptions>),
    /// Runs the alignment on a recording of kind `stage`, `dwells`, `rotating` or `imu`, or finds
    /// the roll of a spinning body on one of kind `spin`.
    Replay(ReplayOptions),
    /// Plans positions and dwells for a gyro's noise.
    Plan(PlanOptions),
    /// Finds a gyro's noise from a recording of kind `static`: Allan deviation and coefficients.
    Allan(AllanOptions),
    /// Runs many simulated alignments and prints their errors beside the limit.
    Campaign(CampaignOptions),
    /// Runs the firmware on an emulated Cortex-M4F, compares its result with the host's bit for bit,
    /// and holds its instructions and memory to their budget. Needs qemu-system-arm.
    Emulate(EmulateOptions),
}

/// The command line; without a command it is `run` with all its defaults.
fn parse() -> Result<(bool, Command), clap::Error> {
    let CommandLine { json, command } = CommandLine::try_parse()?;
    if let Some(command) = command {
        return Ok((json, command));
    }
    let matches = Command::augment_subcommands(clap::Command::new("meridian"))
        .try_get_matches_from(["meridian", "run"])?;
    Ok((json, Command::from_arg_matches(&matches)?))
}

fn main() -> ExitCode {
    let (as_json, command) = match parse() {
        Ok(parsed) => parsed,
        Err(error) => return misuse(&error),
    };
    if let Err(wrong) = check(&command) {
        say(&format!("error: {wrong}"));
        return ExitCode::from(2);
    }
    match tell(&command, as_json) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => failed(&message, as_json),
    }
}

/// What cannot go together in a command's options.
fn check(command: &Command) -> Result<(), &'static str> {
    match command {
        Command::Run(options) => options.check(),
        Command::Campaign(options) => options.check(),
        Command::Replay(options) => options.check(),
        Command::Allan(_) | Command::Plan(_) | Command::Emulate(_) => Ok(()),
    }
}

/// Prints help where that was asked for, else what is wrong with the options in one line.
fn misuse(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        // Nothing is to be done where even the help cannot be printed.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    let text = error.render().to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let message: Vec<&str> = lines
        .filter(|line| !line.is_empty() && !line.starts_with("For more information"))
        .collect();
    say(&message.join(" "));
    ExitCode::from(2)
}

/// Says why there is no result, as JSON too where that was asked for.
fn failed(message: &str, as_json: bool) -> ExitCode {
    if as_json {
        let object = serde_json::json!({ "status": "failed", "reason": message });
        // The reason goes to standard error all the same.
        let _ = print(&object.to_string());
    }
    say(&format!("meridian: {message}"));
    ExitCode::from(1)
}

/// Runs the command and prints what came of it; whether there was a result.
fn tell(command: &Command, as_json: bool) -> Result<bool, String> {
    let Told { found, output, refusal } = match command {
        Command::Run(options) => command::run::run(options, as_json),
        Command::Replay(options) => command::replay::run(options, as_json),
        Command::Plan(options) => command::plan::run(options, as_json),
        Command::Allan(options) => command::allan::run(options, as_json),
        Command::Campaign(options) => command::campaign::run(options, as_json),
        Command::Emulate(options) => command::emulate::run(options, as_json),
    }?;
    print(&output)?;
    if let Some(reason) = refusal {
        say(&format!("meridian: {reason}"));
    }
    Ok(found)
}
