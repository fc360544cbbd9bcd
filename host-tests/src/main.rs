//! The `meridian` command line: replays recordings and runs campaigns.
//!
//! Results go to standard output, progress and errors to standard error. The exit code is 0 with a
//! result, 1 where it is refused or failed, 2 for misuse.
#![forbid(unsafe_code)]

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use bench::campaign::sokolov::{self, Turn};
use bench::demonstration;
use bench::output::progress::Progress;
use bench::output::{json, table, text};
use bench::recording::{self, Recording};
use bench::replay::{Options, replay};
use clap::{Args, Parser, Subcommand, ValueEnum};
use orientation::align::criterion::Criterion;
use orientation::earth::Latitude;

/// Finds true north from a precise gyro on a rotation stage, with its standard deviation.
///
/// Without a command a small built-in recording is replayed.
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
    /// Runs the alignment on a recording of kind `stage` or `dwells`.
    Replay(ReplayOptions),
    /// Runs many simulated alignments and prints their errors beside the limit.
    Campaign(CampaignOptions),
}

#[derive(Args)]
struct CampaignOptions {
    /// Which campaign.
    #[arg(value_enum, default_value = "sokolov")]
    name: Campaign,
    /// Realisations on each schedule for the ratio to the limit and the coverage of σ.
    #[arg(long, default_value_t = 5000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    runs: u32,
}

#[derive(Clone, Copy, ValueEnum)]
enum Campaign {
    /// The numerical experiment of Sokolov 2019: stepwise gyrocompassing, all five criteria.
    Sokolov,
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

fn main() -> ExitCode {
    let line = match CommandLine::try_parse() {
        Ok(line) => line,
        Err(error) => return misuse(&error),
    };
    match run(&line) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => failed(&message, line.json),
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
fn run(line: &CommandLine) -> Result<bool, String> {
    match &line.command {
        None => {
            let recording = recording::read_from(demonstration::NAME, demonstration::RECORDING)
                .map_err(|error| error.to_string())?;
            replayed(demonstration::NAME, recording, &Options::default(), line.json)
        }
        Some(Command::Replay(options)) => {
            let recording = recording::read(&options.file).map_err(|error| error.to_string())?;
            let name = options.file.display().to_string();
            replayed(&name, recording, &options.into(), line.json)
        }
        Some(Command::Campaign(options)) => match options.name {
            Campaign::Sokolov => sokolov(options.runs as usize, line.json).map(|()| true),
        },
    }
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
fn sokolov(runs: usize, as_json: bool) -> Result<(), String> {
    let turns = [Turn::Arc, Turn::Circle];
    let total = turns.len() * (3 * sokolov::TABLE_RUNS + runs);
    let progress = Progress::new(total as u64, "alignments");
    let tick = || progress.step();
    let tables = turns.map(|turn| sokolov::tabulate(turn, tick));
    let tables = tables.into_iter().collect::<Result<Vec<_>, _>>()?;
    let precisions = turns.map(|turn| sokolov::precision(turn, runs, tick));
    let precisions = precisions.into_iter().collect::<Result<Vec<_>, _>>()?;
    progress.finish();
    let output = if as_json {
        let object = serde_json::json!({
            "campaign": "sokolov", "status": "ok", "tables": tables, "precision": precisions,
        });
        serde_json::to_string_pretty(&object).map_err(|error| error.to_string())?
    } else {
        let mut text = String::new();
        table::sokolov(&mut text, &tables, &precisions).map_err(|error| error.to_string())?;
        text
    };
    print(&output)
}

/// Writes to standard output; a closed pipe is no error of ours.
fn print(output: &str) -> Result<(), String> {
    match writeln!(std::io::stdout(), "{output}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}
