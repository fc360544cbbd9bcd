//! `meridian emulate`: the firmware on an emulated Cortex-M4F, or a board's own image behind a model of its
//! microcontroller.

use clap::Args;
use execution::options;
use firmware::platform::Platform;
use host::emulate::decode::Line;
use host::emulate::executed::{Executed, Options, execute};
use host::emulate::jobs::Job;
use host::emulate::{STEPS, emulate};
use host::output::manner::Manner;
use host::output::progress::Progress;
use host::output::{emulation, executed, say};

use super::mistyped::nearest;
use super::{Answer, Failure};

/// What to emulate.
#[derive(Args)]
pub struct EmulateOptions {
    /// What fixes everything random in the simulated world.
    #[arg(long, default_value_t = 1, value_parser = super::seed)]
    seed: u64,
    /// Executes the image that `cargo board` flashes for a carrier (stage, two-frame, turntable, vehicle, spin),
    /// or the images of all of them, in the place of the one that is made for the emulator.
    #[arg(long, value_name = "CARRIER", value_parser = carriers)]
    board: Option<Carriers>,
    /// With --board: cycles of the core for an instruction, wait states of the flash included.
    #[arg(long, default_value_t = 1.4, requires = "board", value_parser = options::cycles)]
    cycles: f64,
    /// With --board: how long it goes on after its result, s; 10 unless stated.
    #[arg(long, value_name = "SECONDS", requires = "board", value_parser = options::afterwards)]
    afterwards: Option<f64>,
    /// With --board and one carrier: the link as a byte stream for one client after the other; the first is waited for.
    #[arg(long, value_name = "tcp:PORT", requires = "board", value_parser = options::port)]
    link: Option<u16>,
}

/// Carriers whose images are executed.
#[derive(Clone, Debug)]
struct Carriers(Vec<Platform>);

/// A carrier by its name, or all of them.
fn carriers(name: &str) -> Result<Carriers, String> {
    if name == "all" {
        return Ok(Carriers(Platform::ALL.to_vec()));
    }
    let found = options::carrier(name).map(|carrier| Carriers(vec![carrier]));
    found.map_err(|names| {
        let meant = nearest(name, Platform::ALL.map(Platform::name).into_iter());
        format!("{names} or all are meant{meant}")
    })
}

/// Runs the firmware's images; whether all is as it must be.
pub fn run(options: &EmulateOptions, manner: Manner) -> Result<Answer, Failure> {
    if let Some(Carriers(carriers)) = &options.board {
        return run_boards(carriers, options, manner);
    }
    let progress = Progress::of_steps(manner, STEPS as u64, "emulated runs");
    let on_line = |job: &Job, line: &Line| {
        if manner.shows_log() {
            progress.log(&format!("{:<9} {line}", job.word));
        }
    };
    let found = emulate(options.seed, &on_line, &progress);
    progress.finish();
    let found = found.map_err(|failed| {
        if !manner.shows_log() {
            failed.last.iter().for_each(|line| say(&line.to_string()));
        }
        failed.reason
    })?;
    let object = emulation::object(&found);
    let refusal = (!found.is_right()).then(|| "not all is as it must be".to_owned());
    Ok(Answer::reported(refusal, manner, &object, || emulation::report(&found))?)
}

/// Executes the images of boards; whether no azimuth is wrong.
fn run_boards(
    carriers: &[Platform],
    options: &EmulateOptions,
    manner: Manner,
) -> Result<Answer, Failure> {
    if options.link.is_some() && carriers.len() > 1 {
        let wrong = "--link: one carrier has one link, and --board names several";
        return Err(Failure::misuse(wrong.to_owned()));
    }
    let EmulateOptions { seed, cycles, afterwards, link, .. } = *options;
    let options = Options { seed, cycles, afterwards, link };
    let progress = Progress::of_steps(manner, carriers.len() as u64, "executed images");
    let found = execute(carriers, &options, manner.shows_log(), &progress);
    progress.finish();
    let found = found?;
    let is_right = found.iter().flat_map(Executed::complaints).next().is_none();
    let refusal = (!is_right).then(|| "not all is as it must be".to_owned());
    let object = executed::object(&found);
    Ok(Answer::reported(refusal, manner, &object, || executed::report(&found, &options))?)
}
