//! The instrument on simulated chips inside QEMU, at the board's own addresses.
//!
//! ```text
//!  instrument ─▶ meter, outside ─▶ hal-mock's chips and world
//!      │              │
//!  executor ◀─▶ clock (virtual)     counter, stack
//!      └───────── results, costs ─────────┴─────▶ log (defmt by semihosting)
//! ```
//!
//! `meridian emulate` builds and runs this image, reads its log, and compares what it found with its
//! own run of the same seed. The log speaks of three things that the host parses: `outcome` and
//! `dwell` lines carry the bits of every number that was found, `effort` and `stack` lines what it
//! took. Nothing here prints by semihosting: it would fall into the middle of the log.
#![no_std]
#![no_main]

mod clock;
#[path = "../measure/counter.rs"]
mod counter;
mod executor;
mod log;
mod meter;
mod outside;
mod results;
mod seed;
#[path = "../measure/stack.rs"]
mod stack;

use core::cell::{OnceCell, RefCell};
use core::pin::pin;

use cortex_m_rt::entry;
use embassy_executor::SpawnError;
use embassy_executor::raw::Executor;
use firmware::ports::NoRecorder;
use firmware::simulated;
use firmware::simulated::fault::Plan;
use firmware::simulated::scenario::Scenario;
use orientation::session::Session;
use semihosting::process::ExitCode;
use static_cell::StaticCell;

use counter::Counter;
use executor::Deadlock;
use meter::{Meter, Task};
use outside::{Log, Metered, NoLink};

/// Why nothing was found.
#[derive(defmt::Format)]
enum Failure {
    /// The core's peripherals were taken before.
    NoTimer,
    /// The host gave no seed.
    NoSeed,
    /// The instrument's task could not be started.
    NotStarted,
    /// Every task waits for something that no time brings.
    Deadlock,
    /// The session cannot begin.
    Session,
    /// The session did not conclude.
    NoConclusion,
}

impl From<SpawnError> for Failure {
    fn from(_: SpawnError) -> Self {
        Self::NotStarted
    }
}

impl From<Deadlock> for Failure {
    fn from(Deadlock: Deadlock) -> Self {
        Self::Deadlock
    }
}

/// What the tasks share with [`main`].
struct Bench {
    meter: Meter,
    instrument: Task,
    finished: OnceCell<Finished>,
}

/// What is left when the instrument has finished.
struct Finished {
    session: &'static Session,
    samples: u64,
}

static BENCH: StaticCell<Bench> = StaticCell::new();
static SESSION: StaticCell<Session> = StaticCell::new();
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

/// Runs the instrument to its end and logs what it found and what it took.
fn run() -> Result<(), Failure> {
    let seed = seed::from_host().ok_or(Failure::NoSeed)?;
    let peripherals = cortex_m::Peripherals::take().ok_or(Failure::NoTimer)?;
    let meter = Meter::new(Counter::start(peripherals.SYST));
    let bench: &'static Bench =
        BENCH.init(Bench { meter, instrument: Task::new("instrument"), finished: OnceCell::new() });
    let scenario = Scenario { seed, ..Scenario::default() };
    let session = scenario.session().ok_or(Failure::Session)?;
    let executor: &'static Executor = EXECUTOR.init_with(executor::new);
    executor.spawner().spawn(instrument(bench, scenario, SESSION.init(session))?);
    executor::run(executor, &bench.meter, || bench.finished.get().is_some())?;
    let Finished { session, samples } = bench.finished.get().ok_or(Failure::NoConclusion)?;
    let conclusion = session.conclusion().ok_or(Failure::NoConclusion)?;
    results::log(seed, conclusion, session.dwells());
    log::effort(&bench.meter, *samples);
    log::task(&bench.instrument);
    Ok(())
}

/// The one task: the instrument on its simulated chips.
#[embassy_executor::task]
async fn instrument(bench: &'static Bench, scenario: Scenario, session: &'static mut Session) {
    let run = pin!(async {
        let plan = Plan::of(None);
        let board = Metered::new(simulated::board(&scenario, &plan), &bench.meter);
        let board = RefCell::new(board);
        let outside =
            simulated::Outside { link: NoLink, recorder: NoRecorder, observer: Log(&bench.meter) };
        let health = simulated::run(&board, &scenario, &plan, outside, session).await;
        // It runs once: nothing has finished before.
        let _ = bench.finished.set(Finished { session, samples: health.samples.into() });
    });
    bench.instrument.run(&bench.meter, run).await;
}
