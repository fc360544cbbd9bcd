//! `meridian run`: the whole board application on simulated chips, a subcommand for each platform.

mod keeping;
mod options;
mod spin;
mod stage;
mod terminal;
mod turntable;
pub mod usual;
mod vehicle;

use clap::{Args, Subcommand};
use host::new_file::NewFile;
use host::outcome::Source;
use host::outcome::run::RunDetails;
use host::output::manner::Manner;
use simulated::fault::{Fault, Platform};

use self::options::Common;
use self::terminal::Terminal;
use super::examples;
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
    #[command(after_help = examples::STAGE)]
    Stage(Box<stage::StageOptions>),
    /// A gyro in two frames: four headings, and vertical to keep the azimuth.
    #[command(after_help = examples::TWO_FRAME)]
    TwoFrame(Box<stage::FramesOptions>),
    /// A platform that turns all the time, on a slip ring.
    #[command(after_help = examples::TURNTABLE)]
    Turntable(Box<turntable::TurntableOptions>),
    /// Three gyros in a vehicle that drives from stop to stop.
    #[command(after_help = examples::VEHICLE)]
    Vehicle(Box<vehicle::VehicleOptions>),
    /// The roll of a body in fast rotation.
    #[command(after_help = examples::SPIN)]
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
    fn run(&self, begun: &Begun) -> Result<Ran, String>;
}

/// What a run begins with, beside the options of its platform.
struct Begun {
    /// What goes wrong.
    fault: Option<Fault>,
    /// How it is shown.
    manner: Manner,
    /// The place of its recording.
    record: Option<NewFile>,
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
                let beside = stated.beside(&["fault"]);
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
        let record = Written::recording(common.record.as_ref());
        let page = Written::page(common.report.as_ref());
        let files: Vec<_> = [record].into_iter().chain(options.files()).chain([page]).collect();
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
pub fn run(options: &RunOptions, stated: &Stated, manner: Manner) -> Result<Answer, Failure> {
    options.check(stated).map_err(Failure::misuse)?;
    let (platform, common, options) = options.platform.of();
    let Common { seed, fault, report, .. } = common;
    let fault = match fault {
        Some(FaultChoice::List) => return Ok(faults::list(platform, manner)?),
        Some(FaultChoice::One(fault)) => Some(*fault),
        None => None,
    };
    let record = files::opened("the recording", common.record.as_ref())?;
    let page = files::opened("the report", report.as_ref())?;
    let begun = Begun { fault, manner, record };
    let Ran { shown, details, written } = options.run(&begun)?;
    let written = written.and_then(|()| begun.record.map_or(Ok(()), NewFile::keep));
    let details = details.made_wrong(fault.map(|fault| fault.to_string()).as_deref());
    let outcome = shown.finished.outcome(&shown.truth).of_run(Source::Seed(*seed), details);
    Ok(shown.answer(&outcome, page, manner)?.with_written(written))
}
