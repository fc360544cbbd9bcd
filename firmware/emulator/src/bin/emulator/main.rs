//! The instrument on simulated chips inside QEMU, at the board's own addresses.
//!
//! ```text
//!  instrument ─▶ meter, outside ─▶ hal-mock's chips and world
//!      │              │
//!  executor ◀─▶ clock (virtual)     counter, stack
//!      └───────── results, costs ─────────┴─────▶ log (defmt by semihosting)
//! ```
//!
//! `meridian emulate` builds and runs this image, reads its log, and compares its results with its
//! own run of the same seed. The host parses these lines of the log: `row` lines carry the bits of
//! every result, `effort`, `task` and `stack` lines the cost. No output goes directly to
//! semihosting: it would fall into the middle of the log.
#![no_std]
#![no_main]

mod clock;
mod executor;
mod job;
mod log;
mod meter;
mod outside;
mod setup;

use core::cell::OnceCell;
use core::pin::pin;

use cortex_m_rt::entry;
use embassy_executor::raw::Executor;
use measure::counter::Counter;
use measure::stack;
use semihosting::process::ExitCode;
use static_cell::StaticCell;

use job::Job;
use meter::{Meter, Task};
use outside::Metering;
use setup::{AnyMethod, Ground};

/// Reason for which there is no result.
#[derive(defmt::Format)]
enum Failure {
    /// The core's peripherals were taken before.
    NoTimer,
    /// The host requested no valid job.
    NoJob,
    /// The task of the instrument could not be started.
    NotStarted,
    /// Every task waits for an event that no passage of time brings.
    Deadlock,
    /// The session cannot begin.
    Session,
}

/// State that the tasks share with [`main`].
struct Harness {
    meter: Meter,
    acquisition: Task,
    instrument: Task,
    /// Method of the instrument, once it has come to its end.
    finished: OnceCell<&'static AnyMethod>,
}

static HARNESS: StaticCell<Harness> = StaticCell::new();
static EXECUTOR: StaticCell<Executor> = StaticCell::new();

#[entry]
fn main() -> ! {
    let (_, result) = stack::stack_of(run);
    log::stack(stack::greatest_stack());
    match result {
        Ok(()) => ExitCode::SUCCESS.exit_process(),
        Err(failure) => {
            defmt::error!("{}", failure);
            ExitCode::FAILURE.exit_process()
        }
    }
}

/// Runs the instrument to its end and logs results and costs.
fn run() -> Result<(), Failure> {
    let job = Job::from_host().ok_or(Failure::NoJob)?;
    let peripherals = cortex_m::Peripherals::take().ok_or(Failure::NoTimer)?;
    let harness: &'static Harness = HARNESS.init(Harness {
        meter: Meter::new(Counter::start(peripherals.SYST)),
        acquisition: Task { name: "acquisition", ..Task::default() },
        instrument: Task { name: "instrument", ..Task::default() },
        finished: OnceCell::new(),
    });
    clock::book(&harness.meter);
    let executor: &'static Executor = EXECUTOR.init_with(executor::new);
    let (ground, method) = job.begin(&harness.meter).ok_or(Failure::Session)?;
    let spawner = executor.spawner();
    spawner.spawn(acquisition(harness, ground).map_err(|_| Failure::NotStarted)?);
    spawner.spawn(instrument(harness, ground, method).map_err(|_| Failure::NotStarted)?);
    let finished = || harness.finished.get();
    let finished = executor::run(executor, &harness.meter, finished).ok_or(Failure::Deadlock)?;
    finished.log();
    log::effort(&harness.meter, job.sample_rate());
    log::task(&harness.acquisition);
    log::task(&harness.instrument);
    Ok(())
}

#[embassy_executor::task]
async fn acquisition(harness: &'static Harness, ground: &'static Ground) {
    let future = pin!(ground.sample(Metering(&harness.meter)));
    harness.acquisition.run(&harness.meter, future).await;
}

#[embassy_executor::task]
async fn instrument(
    harness: &'static Harness,
    ground: &'static Ground,
    method: &'static mut AnyMethod,
) {
    let future = pin!(async move {
        method.run(ground, Metering(&harness.meter)).await;
        // The task runs once, so nothing was set before.
        let _ = harness.finished.set(method);
    });
    harness.instrument.run(&harness.meter, future).await;
}
