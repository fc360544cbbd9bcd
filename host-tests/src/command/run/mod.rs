//! `meridian run`: the whole board application on simulated chips, a subcommand for each platform.

mod keeping;
mod options;
mod spin;
mod stage;
mod turntable;
pub mod usual;
mod vehicle;

use std::cell::Cell;
use std::time::{Duration, Instant as WallClock};

use clap::{Args, Subcommand};
use embassy_time::Instant;
use firmware::event::Event;
use firmware::ports::Observer;
use host::instrument::RunError;
use host::outcome::Source;
use host::outcome::run::RunDetails;
use host::output::progress::Progress;
use orientation::alignment::{self, rotating, stepwise, stops};
use orientation::navigation::{self, aligner};
use simulated::fault::{Fault, Platform};

use self::options::{Common, Inputs};
use super::faults::{self, FaultChoice};
use super::files::{self, Written};
use super::stated::{self, Stated};
use super::{Answer, Failure, Shown};

/// What is run.
#[derive(Args)]
pub struct RunOptions {
    #[command(subcommand)]
    platform: Carrier,
}

/// What carries the sensors.
#[derive(Subcommand)]
enum Carrier {
    /// A gyro on a single-axis stage: positions on the full circle, unless a plan is asked for. What runs where no
    /// platform is named.
    Stage(Box<stage::StageOptions>),
    /// A gyro in two frames: four headings, and vertical to keep the azimuth.
    TwoFrame(Box<stage::FramesOptions>),
    /// A platform that turns all the time, on a slip ring.
    Turntable(Box<turntable::TurntableOptions>),
    /// Three gyros in a vehicle that drives from stop to stop.
    Vehicle(Box<vehicle::VehicleOptions>),
    /// The roll of a body in fast rotation.
    Spin(spin::SpinOptions),
}

/// A platform that is run as its options say.
trait Simulated {
    /// What cannot go together, beyond what the parser of the arguments refuses.
    ///
    /// # Errors
    /// The options, and why.
    fn check(&self, _stated: &Stated) -> Result<(), String> {
        Ok(())
    }

    /// The files that it writes beside those of every platform.
    fn files(&self) -> Vec<Written> {
        Vec::new()
    }

    /// Runs the board.
    ///
    /// # Errors
    /// What keeps it from running; a refusal is none.
    fn run(&self, fault: Option<Fault>) -> Result<Ran, String>;
}

/// A finished run, ready to be shown.
struct Ran {
    /// The analysis of the run.
    shown: Shown<'static>,
    /// How the board did, and what it kept.
    details: RunDetails,
    /// Whether what was written beside is whole.
    written: Result<(), String>,
}

impl RunOptions {
    /// What cannot go together.
    ///
    /// # Errors
    /// The options, and why.
    fn check(&self, stated: &Stated) -> Result<(), String> {
        let (platform, common, options) = self.platform.of();
        match common.fault {
            Some(FaultChoice::List) => {
                let beside = stated.beside(&["fault", "json"]);
                return beside.map_or(Ok(()), |option| {
                    Err(format!("{}: --fault list runs nothing", stated::long(option)))
                });
            }
            Some(FaultChoice::One(fault)) => faults::check(fault, platform)?,
            None => {}
        }
        if platform == Platform::Spin && common.inputs_file().is_some() {
            return Err(
                "--record: a flight keeps its roll alone, and its CSV replays whole; name FILE.csv"
                    .to_owned(),
            );
        }
        options.check(stated)?;
        let Common { record, report, .. } = common.clone();
        let record = ("--record", "the recording", record);
        let report = ("--report", "the page", report);
        let files: Vec<_> = [record].into_iter().chain(options.files()).chain([report]).collect();
        files::check(None, &files)
    }
}

impl Carrier {
    /// The platform as the catalogue of faults names it, what every platform takes, and the platform's own options.
    fn of(&self) -> (Platform, &Common, &dyn Simulated) {
        match self {
            Self::Stage(options) => (Platform::Stage, &options.base.common, &**options),
            Self::TwoFrame(options) => (Platform::TwoFrame, &options.base.common, &**options),
            Self::Turntable(options) => (Platform::Turntable, &options.common, &**options),
            Self::Vehicle(options) => (Platform::Vehicle, &options.common, &**options),
            Self::Spin(options) => (Platform::Spin, &options.common, options),
        }
    }
}

/// Runs the board and reports what came of it.
pub fn run(options: &RunOptions, stated: &Stated, as_json: bool) -> Result<Answer, Failure> {
    options.check(stated).map_err(Failure::misuse)?;
    let (platform, common, options) = options.platform.of();
    let Common { seed, fault, report, .. } = common;
    let fault = match fault {
        Some(FaultChoice::List) => return Ok(faults::list(platform, as_json)?),
        Some(FaultChoice::One(fault)) => Some(*fault),
        None => None,
    };
    common.open()?;
    let Ran { shown, details, written } = options.run(fault)?;
    let outcome = shown.finished.outcome(&shown.truth).of_run(Source::Seed(*seed), details);
    Ok(shown.answer(&outcome, report.as_deref(), as_json)?.with_written(written))
}

/// Shows the log and the progress while a board works, and has its inputs written.
struct Terminal<'t> {
    inputs: &'t Inputs,
    shown: Progress,
    /// Planned stops of a vehicle.
    stops: Cell<usize>,
}

impl<'t> Terminal<'t> {
    /// Shows how many of the planned dwells, turns or stops are done.
    fn follow(&self, progress: &alignment::Progress) {
        let (done, planned) = match *progress {
            alignment::Progress::Stepwise(stepwise::Progress::Dwelled(done, of, _)) => (done, of),
            alignment::Progress::Rotating(rotating::Progress::Turned(done, of)) => {
                (done as usize, of as usize)
            }
            alignment::Progress::Stops(stops::Progress::Begun { stops, .. }) => {
                return self.stops.set(stops);
            }
            alignment::Progress::Stops(stops::Progress::Standing) => (1, self.stops.get()),
            alignment::Progress::Stops(stops::Progress::Stopped(stop, _)) => {
                (stop, self.stops.get())
            }
            _ => return,
        };
        self.shown.steps((done as u64, planned as u64));
    }

    /// Runs a board, whose progress counts these; with the time that it took on this machine.
    fn watching<T>(
        steps: &'static str,
        inputs: &'t Inputs,
        run: impl FnOnce(&Self) -> Result<T, RunError>,
    ) -> Result<(T, Duration), String> {
        let begun = WallClock::now();
        let watch = Self { inputs, shown: Progress::new(0, steps), stops: Cell::new(0) };
        let ran = run(&watch);
        watch.shown.finish();
        ran.map(|ran| (ran, begun.elapsed())).map_err(|error| error.to_string())
    }
}

impl Observer for Terminal<'_> {
    fn aligns(&self, input: &aligner::Input) {
        self.inputs.iter().for_each(|inputs| inputs.aligns(input));
    }

    fn navigates(&self, input: &navigation::Input) {
        self.inputs.iter().for_each(|inputs| inputs.navigates(input));
    }

    fn event(&self, at: Instant, event: &Event) {
        let seconds = at.as_micros() as f64 * 1e-6;
        self.shown.log(&format!("{seconds:>11.6} {event}"));
        if let Event::Alignment(progress) = event {
            self.follow(progress);
        }
    }
}
