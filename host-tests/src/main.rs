//! The `meridian` command line: replays recordings, runs campaigns and the emulated firmware.
//!
//! Results go to standard output, progress and errors to standard error. The exit code is 0 with a
//! result, 1 where it is refused or failed, 2 for misuse.
#![forbid(unsafe_code)]

mod command;

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use bench::campaign;
use bench::campaign::sokolov::{self, Turn};
use bench::emulate::emulate;
use bench::output::progress::Progress;
use bench::output::{emulation, json, table, text};
use bench::recording::{self, Recording};
use bench::replay::{Options, replay};
use clap::{Args, FromArgMatches, Parser, Subcommand, ValueEnum};
use firmware::simulated::fault::Fault;
use orientation::align::criterion::Criterion;
use orientation::earth::Latitude;

use crate::command::run::{RunOptions, Told};

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
    Run(RunOptions),
    /// Runs the alignment on a recording of kind `stage` or `dwells`.
    Replay(ReplayOptions),
    /// Runs many simulated alignments and prints their errors beside the limit.
    Campaign(CampaignOptions),
    /// Runs the firmware on an emulated Cortex-M4F, compares its result with the host's bit for bit,
    /// and holds its instructions and memory to their budget. Needs qemu-system-arm.
    Emulate(EmulateOptions),
}

#[derive(Args)]
struct EmulateOptions {
    /// What fixes everything random in the simulated world.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Args)]
struct CampaignOptions {
    /// Which campaign.
    #[arg(value_enum, default_value = "sokolov")]
    name: Campaign,
    /// How many runs: of sokolov on each schedule (5000), of instrument (500), of faults each (1).
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    runs: Option<u32>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Campaign {
    /// The numerical experiment of Sokolov 2019: stepwise gyrocompassing, all five criteria.
    Sokolov,
    /// The whole instrument on simulated chips, over drawn sites and attitudes.
    Instrument,
    /// Every chip with every fault.
    Faults,
}

#[derive(Args)]
struct ReplayOptions {
    /// The recording, CSV, also gzip-compressed.
    file: PathBuf,
    /// Method; the default follows from the kind.
    #[arg(long, value_enum)]
    method: Option<Method>,
    /// Latitude in degrees, north positive, instead of the recording's.
    #[arg(long, value_name = "DEGREES", value_parser = latitude, allow_negative_numbers = true)]
    latitude: Option<Latitude>,
    /// How the azimuth is found: ml, table (ml over the etalon table), least-squares, least-absolute, within-squares=A1 in (°/h)²,
    /// within-absolute=A in °/h.
    #[arg(long, default_value = "ml", value_parser = bench::criterion::parse)]
    criterion: Criterion,
    /// Greatest standard deviation that is accepted, in degrees (1σ).
    #[arg(long, value_name = "DEGREES", default_value = "10", value_parser = sigma)]
    require_sigma: f64,
}

#[derive(Clone, Copy, ValueEnum)]
enum Method {
    /// Stepwise gyrocompassing.
    Stepwise,
}

fn latitude(text: &str) -> Result<Latitude, String> {
    let degrees: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    Latitude::from_degrees(degrees).ok_or_else(|| "outside ±90°".to_owned())
}

/// A standard deviation in degrees, as radians.
fn sigma(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(degrees) if degrees > 0.0 && degrees <= 180.0 => Ok(degrees.to_radians()),
        _ => Err("not a number of degrees above 0, at most 180".to_owned()),
    }
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
    match run(&command, as_json) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => failed(&message, as_json),
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
    eprintln!("{}", message.join(" "));
    ExitCode::from(2)
}

/// Says why there is no result, as JSON too where that was asked for.
fn failed(message: &str, as_json: bool) -> ExitCode {
    if as_json {
        let object = serde_json::json!({ "status": "failed", "reason": message });
        // The reason goes to standard error all the same.
        let _ = print(&object.to_string());
    }
    eprintln!("meridian: {message}");
    ExitCode::from(1)
}

/// Runs the command; whether there was a result.
fn run(command: &Command, as_json: bool) -> Result<bool, String> {
    match command {
        Command::Run(options) => simulated(options, as_json),
        Command::Replay(options) => {
            let recording = recording::read(&options.file).map_err(|error| error.to_string())?;
            let name = options.file.display().to_string();
            replayed(&name, recording, &options.into(), as_json)
        }
        Command::Emulate(options) => emulated(options.seed, as_json),
        Command::Campaign(options) => match options.name {
            Campaign::Sokolov => sokolov(options.runs.unwrap_or(5000) as usize, as_json),
            Campaign::Instrument => instrument(options.runs.unwrap_or(500) as usize, as_json),
            Campaign::Faults => faults(u64::from(options.runs.unwrap_or(1)), as_json),
        },
    }
}

fn simulated(options: &RunOptions, as_json: bool) -> Result<bool, String> {
    let Told { found, output, refusal } = command::run::run(options, as_json)?;
    print(&output)?;
    if let (Some(reason), true) = (refusal, as_json) {
        eprintln!("meridian: {reason}");
    }
    Ok(found)
}

impl From<&ReplayOptions> for Options {
    fn from(options: &ReplayOptions) -> Self {
        // One method so far: naming it changes nothing.
        let (Some(Method::Stepwise) | None) = options.method;
        Self {
            latitude: options.latitude,
            criterion: options.criterion,
            required_sigma: Some(options.require_sigma),
        }
    }
}

fn replayed(
    name: &str,
    recording: Recording,
    options: &Options,
    as_json: bool,
) -> Result<bool, String> {
    let (header, body, truth) = recording.into_parts();
    let progress = Progress::new(0, "positions");
    let replay = replay(&header, &body, options, |session| progress.session(session))
        .map_err(|error| format!("{name}: {error}"))?;
    progress.finish();
    let conclusion = replay.session.conclusion().ok_or("the session did not end")?;
    let output = if as_json {
        let object = json::azimuth(&replay, conclusion, truth.azimuth_deg);
        serde_json::to_string_pretty(&object).map_err(|error| error.to_string())?
    } else {
        let mut block = String::new();
        text::block(&mut block, name, &replay, conclusion, truth.azimuth_deg)
            .map_err(|error| error.to_string())?;
        block
    };
    print(&output)?;
    if let (Err(reason), true) = (&conclusion.verdict, as_json) {
        eprintln!("meridian: {name}: {reason}");
    }
    Ok(conclusion.verdict.is_ok())
}

/// Both schedules: the paper's table, then the precision.
fn sokolov(runs: usize, as_json: bool) -> Result<bool, String> {
    let turns = [Turn::Arc, Turn::Circle];
    let total = turns.len() * (3 * sokolov::TABLE_RUNS + runs);
    let progress = Progress::new(total as u64, "alignments");
    let tick = || progress.step();
    let tables = turns.map(|turn| sokolov::tabulate(turn, tick));
    let tables = tables.into_iter().collect::<Result<Vec<_>, _>>()?;
    let precisions = turns.map(|turn| sokolov::precision(turn, runs, tick));
    let precisions = precisions.into_iter().collect::<Result<Vec<_>, _>>()?;
    progress.finish();
    let object = serde_json::json!({
        "campaign": "sokolov", "status": "ok", "tables": tables, "precision": precisions,
    });
    tell(as_json, &object, |text| table::sokolov(text, &tables, &precisions))?;
    Ok(true)
}

/// The whole instrument over many seeds; whether none was refused.
fn instrument(runs: usize, as_json: bool) -> Result<bool, String> {
    let progress = Progress::new(runs as u64, "alignments");
    let row = campaign::instrument::precision(runs, || progress.step())
        .map_err(|error| error.to_string())?;
    progress.finish();
    let object = serde_json::json!({ "campaign": "instrument", "status": "ok", "precision": row });
    tell(as_json, &object, |text| table::instrument(text, &row))?;
    Ok(row.refused == 0)
}

/// Every fault with one seed; whether no north was wrong.
fn faults(seed: u64, as_json: bool) -> Result<bool, String> {
    let progress = Progress::new(Fault::all().count() as u64, "faults");
    let rows =
        campaign::faults::rows(seed, || progress.step()).map_err(|error| error.to_string())?;
    progress.finish();
    let object = serde_json::json!({ "campaign": "faults", "status": "ok", "faults": rows });
    tell(as_json, &object, |text| table::faults(text, &rows))?;
    Ok(rows.iter().all(|row| row.outcome != campaign::faults::WRONG))
}

/// Prints an object, or the text that a table makes.
fn tell(
    as_json: bool,
    object: &serde_json::Value,
    table: impl FnOnce(&mut String) -> std::fmt::Result,
) -> Result<(), String> {
    let mut text = String::new();
    if as_json {
        text = serde_json::to_string_pretty(object).map_err(|error| error.to_string())?;
    } else {
        table(&mut text).map_err(|error| error.to_string())?;
    }
    print(&text)
}

/// Runs the firmware's images; whether all is as it must be.
fn emulated(seed: u64, as_json: bool) -> Result<bool, String> {
    let found = emulate(seed, |line| eprintln!("{line}"))?;
    let output = if as_json {
        let object = emulation::object(&found);
        serde_json::to_string_pretty(&object).map_err(|error| error.to_string())?
    } else {
        let mut text = String::new();
        emulation::tables(&mut text, &found).map_err(|error| error.to_string())?;
        text
    };
    print(&output)?;
    Ok(found.is_right())
}

/// Writes to standard output; a closed pipe is no error of ours.
fn print(output: &str) -> Result<(), String> {
    match writeln!(std::io::stdout(), "{output}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}
