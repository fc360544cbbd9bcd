//! The `meridian` command line: runs the board, replays recordings, runs campaigns and the emulated
//! firmware.
//!
//! Results go to standard output, progress and errors to standard error. The exit code is 0 with a
//! result, 1 where it is refused or failed, 2 for misuse.
#![forbid(unsafe_code)]

mod command;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use host::interrupt;
use host::new_file;
use host::output::manner::{self, Manner};
use host::output::{printable, say};
use host::report::{Grade, Verbosity};

use crate::command::allan::AllanOptions;
use crate::command::campaign::CampaignOptions;
use crate::command::doctor;
use crate::command::emulate::EmulateOptions;
use crate::command::log::LogOptions;
use crate::command::plan::PlanOptions;
use crate::command::replay::ReplayOptions;
use crate::command::run::{RunOptions, usual};
use crate::command::send::SendOptions;
use crate::command::settings::SettingsOptions;
use crate::command::shell::{self, CompletionsOptions, ManOptions};
use crate::command::stated::Stated;
use crate::command::{Answer, Failure, OUTPUT, Output, examples, mistyped, print, taken};

/// Finds true north, with its standard deviation, from precise gyros on a stage, in two frames, on a turntable or in a
/// vehicle; and the roll of a spinning body.
///
/// Without a command it is `run stage`.
#[derive(Parser)]
#[command(
    name = "meridian",
    version = env!("MERIDIAN_VERSION"),
    override_usage = "meridian [OPTIONS] [COMMAND]",
    after_help = examples::PROGRAM
)]
struct CommandLine {
    /// One JSON object on standard output instead of text.
    #[arg(long, global = true, help_heading = OUTPUT)]
    json: bool,
    /// Shows the log of a run, line by line, and all that stands behind the result.
    #[arg(short, long, global = true, help_heading = OUTPUT)]
    verbose: bool,
    /// Shows errors alone, and the shortest form of the result.
    #[arg(short, long, global = true, help_heading = OUTPUT)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

impl CommandLine {
    /// How the command is to say what came of it.
    ///
    /// # Errors
    /// It is to be quiet and verbose.
    fn manner(&self) -> Result<Manner, clap::Error> {
        let verbosity = match (self.verbose, self.quiet) {
            (false, false) => Verbosity::Usual,
            (true, false) => Verbosity::Verbose,
            (false, true) => Verbosity::Quiet,
            (true, true) => {
                let wrong = "--quiet: --verbose asks for the opposite; leave one out";
                return Err(CommandLine::command().error(ErrorKind::ArgumentConflict, wrong));
            }
        };
        Ok(Manner { as_json: self.json, verbosity })
    }
}

#[derive(Subcommand)]
enum Command {
    /// Runs the whole board application on simulated chips.
    ///
    /// Without a platform it is a stage, with the options below; each other platform has its own, as
    /// `meridian run vehicle --help` lists them.
    #[command(override_usage = "meridian run [PLATFORM] [OPTIONS]", after_help = examples::RUN)]
    Run(RunOptions),
    /// Runs the alignment on a recording of kind `stage`, `dwells`, `rotating` or `imu`, finds the
    /// roll of a spinning body on one of kind `spin`, or does again all that a run did by its inputs.
    #[command(after_help = examples::REPLAY)]
    Replay(ReplayOptions),
    /// Plans positions and dwells for a gyro's noise.
    #[command(override_usage = PLAN, after_help = examples::PLAN)]
    Plan(PlanOptions),
    /// Finds a gyro's noise from a recording of kind `static`: Allan deviation and coefficients.
    #[command(after_help = examples::ALLAN)]
    Allan(AllanOptions),
    /// Runs many simulated alignments and prints their errors beside the limit.
    #[command(after_help = examples::CAMPAIGN)]
    Campaign(CampaignOptions),
    /// Runs the firmware on an emulated Cortex-M4F, compares its result with the host's bit for bit,
    /// and holds its instructions and memory to their budget. Needs qemu-system-arm.
    #[command(after_help = examples::EMULATE)]
    Emulate(EmulateOptions),
    /// Prints the lines of its log that a board has kept in flash: which device failed and how, how a run ended, what came
    /// of an alignment.
    #[command(after_help = examples::LOG)]
    Log(LogOptions),
    /// Sends a command to an instrument over its link and prints its answer.
    #[command(after_help = examples::SEND)]
    Send(SendOptions),
    /// Shows and changes the settings of an instrument over its link, keeps them in a file, and loads them from one.
    #[command(after_help = examples::SETTINGS)]
    Settings(SettingsOptions),
    /// Looks for what is needed to build the firmware, to flash a board and to talk to it; says how to get what is missing.
    #[command(after_help = examples::DOCTOR)]
    Doctor,
    /// Prints what a shell needs to complete commands, options and their values.
    #[command(after_help = examples::COMPLETIONS)]
    Completions(CompletionsOptions),
    /// Prints the manual page of the program, or of a command.
    #[command(after_help = examples::MAN)]
    Man(ManOptions),
}

/// What `plan` needs.
const PLAN: &str = "meridian plan [OPTIONS] --arw N --latitude D (--seconds S | --sigma D)";

/// What was asked, and which options stand on the command line.
struct Parsed {
    manner: Manner,
    command: Command,
    stated: Stated,
}

/// The program as shells, manual pages and its help know it: a run takes the options of a stage without its name.
fn program() -> clap::Command {
    usual::optional(CommandLine::command())
}

/// The command line; without a command it is a run of a stage with all its defaults.
fn parse() -> Result<Parsed, clap::Error> {
    let mut arguments: Vec<_> = std::env::args_os().collect();
    let named = usual::named(arguments.split_off(1.min(arguments.len())));
    let program = taking_negative_numbers(program());
    let matches = program.try_get_matches_from(arguments.iter().chain(&named))?;
    let line = CommandLine::from_arg_matches(&matches)?;
    Ok(Parsed { manner: line.manner()?, command: line.command, stated: Stated::of(&matches) })
}

/// The program, in which an option that takes a number may have a value that begins with a minus: what it may be, its
/// parser knows.
fn taking_negative_numbers(program: clap::Command) -> clap::Command {
    program.mut_subcommands(|command| {
        taking_negative_numbers(command.mut_args(|arg| {
            let is_number = takes_number(&arg);
            arg.allow_hyphen_values(is_number)
        }))
    })
}

/// Whether an argument is an option whose value is no name of a file or of anything else.
fn takes_number(arg: &clap::Arg) -> bool {
    let takes = arg.get_long().is_some() && arg.get_action().takes_values();
    let mut names = arg.get_value_names().unwrap_or_default().iter();
    let is_name = names.any(|name| name.starts_with("FILE") || name.as_str() == "NAME");
    takes && !is_name && arg.get_possible_values().is_empty()
}

/// Stack of a campaign's thread, bytes: a session on the host has room for 1 024 dwells and passes over it.
const STACK: usize = 16 << 20;

fn main() -> ExitCode {
    let Parsed { manner, command, stated } = match parse() {
        Ok(asked) => asked,
        Err(error) => return misuse(&error),
    };
    // Where there is a pool already, or no room for another one, that one serves.
    let _ = rayon::ThreadPoolBuilder::new().stack_size(STACK).build_global();
    // Where it cannot be listened to, Ctrl-C ends the program as the system has it.
    let _ = interrupt::listen(move |reason| end(reason, manner));
    match answer(&command, &stated, manner) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(failure) if failure.is_misuse => misused(&failure.reason),
        Err(failure) => failed(&explained(failure), manner),
    }
}

/// A failure, whose reason is the interruption where there was one: what it left is too little for anything.
fn explained(failure: Failure) -> Failure {
    match interrupt::ended() {
        Some(reason) => Failure { reason, ..failure },
        None => failure,
    }
}

/// Prints help where that was asked for, else what is wrong with the options.
fn misuse(error: &clap::Error) -> ExitCode {
    if error.use_stderr() {
        return misused(&mistyped::message(error, &program()));
    }
    match taken(error.print()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            say_why(&reason, false);
            ExitCode::from(1)
        }
    }
}

/// Says what is wrong with the options.
fn misused(wrong: &str) -> ExitCode {
    say(&printable(&format!("error: {wrong}")));
    ExitCode::from(2)
}

/// Says why there is no result, as JSON too where that was asked for.
fn failed(Failure { reason, warnings, .. }: &Failure, manner: Manner) -> ExitCode {
    if manner.as_json {
        let mut object = serde_json::json!({});
        if interrupt::is_asked() {
            object["status"] = Grade::Interrupted.status().into();
        }
        let output = Output::Object(object);
        let refusal = Some(reason.clone());
        let (warnings, doubts) = (warnings.clone(), Vec::new());
        let nothing = Answer { output, refusal, is_told: true, warnings, doubts };
        // The reason goes to standard error all the same.
        let _ = print(&nothing.printed());
    }
    warn(warnings, manner);
    say_why(reason, manner.as_json);
    ExitCode::from(1)
}

/// Says why there is no result, unless that stands in the output already and a person sees both.
fn say_why(reason: &str, is_told: bool) {
    if !(is_told && manner::is_one_terminal()) {
        say(&printable(&format!("meridian: {reason}")));
    }
}

/// Ends the program at once, and says why.
fn end(reason: &str, manner: Manner) {
    new_file::clear();
    failed(&reason.to_owned().into(), manner);
    std::process::exit(1);
}

/// Says what there is to be said beside the result.
fn warn(warnings: &[String], manner: Manner) {
    if manner.warns() {
        doubt(warnings);
    }
}

/// Says why a number may be wrong, however little is to be told.
fn doubt(warnings: &[String]) {
    for warning in warnings {
        say(&printable(&format!("warning: {warning}")));
    }
}

/// Runs the command and prints what came of it; whether there was a result.
fn answer(command: &Command, stated: &Stated, manner: Manner) -> Result<bool, Failure> {
    let answer = match command {
        Command::Run(options) => command::run::run(options, stated, manner)?,
        Command::Replay(options) => command::replay::run(options, stated, manner)?,
        Command::Plan(options) => command::plan::run(options, manner)?,
        Command::Allan(options) => command::allan::run(options, manner)?,
        Command::Campaign(options) => command::campaign::run(options, manner)?,
        Command::Emulate(options) => command::emulate::run(options, manner)?,
        Command::Log(options) => command::log::run(options, manner)?,
        Command::Send(options) => command::send::run(options, manner)?,
        Command::Settings(options) => command::settings::run(options, manner)?,
        Command::Doctor => doctor::run(manner)?,
        Command::Completions(options) => shell::completions(options, program(), manner)?,
        Command::Man(options) => shell::man(options, program(), manner)?,
    };
    print(&answer.printed())?;
    warn(&answer.warnings, manner);
    doubt(&answer.doubts);
    if let Some(reason) = &answer.refusal {
        say_why(reason, answer.is_told);
    }
    Ok(answer.refusal.is_none())
}
