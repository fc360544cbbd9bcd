//! Cost of the instrument, without that of the simulation beside it.
//!
//! All work is done within polls, and the simulated chips and world work within [`Meter::outside`],
//! so the instrument's own instructions are the difference. Logging within a poll counts as the
//! instrument's.

use core::cell::Cell;
use core::future::poll_fn;
use core::pin::Pin;

use measure::counter::{Cost, Counter};

/// Number of empty outside calls that calibrate their own cost.
const CALIBRATIONS: u64 = 1000;

/// Cost of the instrument and of the simulation beside it: at one moment, or between two.
#[derive(Clone, Copy, Default)]
pub struct Accounts {
    /// Cost of the instrument.
    pub instrument: Cost,
    /// Cost of the simulation.
    pub simulation: Cost,
    /// Virtual time, µs.
    pub microseconds: u64,
}

/// Counter with its two accounts.
pub struct Meter {
    counter: Counter,
    /// Cost of all polls.
    all: Cell<Cost>,
    /// Cost of the simulation and of its metering within these polls.
    outside: Cell<Cost>,
    /// Cost of an empty outside call.
    fee: Cost,
    /// Accounts at the first mark and at the last.
    marks: Cell<Option<[Accounts; 2]>>,
}

impl Meter {
    /// Creates a meter and calibrates its own cost.
    pub fn new(counter: Counter) -> Self {
        let [all, outside] = [Cost::default(); 2].map(Cell::new);
        let mut meter =
            Self { counter, all, outside, fee: Cost::default(), marks: Cell::new(None) };
        let (cost, ()) = meter.counter.measure(|| {
            for _ in 0..CALIBRATIONS {
                meter.outside(|| ());
            }
        });
        meter.fee = (cost - meter.outside.take()) / CALIBRATIONS;
        meter
    }

    /// Polls the executor, metered.
    pub fn poll(&self, work: impl FnOnce()) {
        let (cost, ()) = self.counter.measure(work);
        self.all.set(self.all.get() + cost);
    }

    /// Does work that is not the instrument's.
    pub fn outside<T>(&self, work: impl FnOnce() -> T) -> T {
        let (cost, result) = self.counter.measure(work);
        self.outside.set(self.outside.get() + cost + self.fee);
        result
    }

    /// Does work and returns the instrument's part of its cost.
    fn inside<T>(&self, work: impl FnOnce() -> T) -> (Cost, T) {
        let before = self.outside.get();
        let (cost, result) = self.counter.measure(work);
        (cost - (self.outside.get() - before), result)
    }

    /// Marks this moment. The poll in progress is not included.
    pub fn mark(&self, microseconds: u64) {
        let simulation = self.outside.get();
        let now = Accounts { instrument: self.all.get() - simulation, simulation, microseconds };
        let first = self.marks.get().map_or(now, |[first, _]| first);
        self.marks.set(Some([first, now]));
    }

    /// Cost between the first mark and the last.
    pub fn between_marks(&self) -> Accounts {
        let [first, last] = self.marks.get().unwrap_or_default();
        Accounts {
            instrument: last.instrument - first.instrument,
            simulation: last.simulation - first.simulation,
            microseconds: last.microseconds - first.microseconds,
        }
    }
}

/// Polls of one task.
#[derive(Default)]
pub struct Task {
    /// Name in the log.
    pub name: &'static str,
    /// Number of polls.
    pub polls: Cell<u64>,
    /// Cost of all polls.
    pub total: Cell<Cost>,
    /// Cost of the most expensive poll.
    pub worst: Cell<Cost>,
}

impl Task {
    /// Runs a future and meters each of its polls. The future must pass on its results by itself:
    /// moving a large one out of every poll would be metered too.
    pub async fn run(&self, meter: &Meter, mut future: Pin<&mut impl Future<Output = ()>>) {
        poll_fn(|context| {
            let (cost, poll) = meter.inside(|| future.as_mut().poll(context));
            self.add(cost);
            poll
        })
        .await;
    }

    /// Adds the cost of a poll.
    fn add(&self, cost: Cost) {
        self.polls.set(self.polls.get() + 1);
        self.total.set(self.total.get() + cost);
        self.worst.set(self.worst.get().max(cost));
    }
}
