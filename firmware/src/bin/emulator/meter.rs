//! What the instrument takes, without what the simulation beside it takes.
//!
//! All work is done inside of polls, and the simulated chips and world work inside of
//! [`Meter::outside`], so the instrument's own instructions are the difference. Whatever a poll logs
//! counts as the instrument's.

use core::cell::Cell;
use core::future::poll_fn;
use core::pin::Pin;

use crate::counter::{Cost, Counter};

/// How often nothing is put outside, to learn what that costs.
const CALIBRATIONS: u64 = 1000;

/// The accounts at one moment.
#[derive(Clone, Copy, Default)]
pub struct Mark {
    instrument: Cost,
    simulation: Cost,
    microseconds: u64,
}

/// What was taken between two moments.
pub struct Stretch {
    /// By the instrument.
    pub instrument: Cost,
    /// By the simulation.
    pub simulation: Cost,
    /// Virtual time, µs.
    pub microseconds: u64,
}

/// The counter with its two accounts.
pub struct Meter {
    counter: Counter,
    /// Everything inside of polls.
    all: Cell<Cost>,
    /// Of that, the simulation and the metering of it.
    outside: Cell<Cost>,
    /// What putting something outside costs by itself.
    fee: Cost,
    /// The accounts at the first mark and at the last.
    marks: Cell<Option<[Mark; 2]>>,
}

impl Meter {
    /// A meter that has learnt its own cost.
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

    /// Polls the executor.
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

    /// Does work and tells what the instrument had of it.
    fn inside<T>(&self, work: impl FnOnce() -> T) -> (Cost, T) {
        let before = self.outside.get();
        let (cost, result) = self.counter.measure(work);
        (cost - (self.outside.get() - before), result)
    }

    /// Marks this moment. The poll that is going on does not count yet.
    pub fn mark(&self, microseconds: u64) {
        let simulation = self.outside.get();
        let now = Mark { instrument: self.all.get() - simulation, simulation, microseconds };
        let first = self.marks.get().map_or(now, |[first, _]| first);
        self.marks.set(Some([first, now]));
    }

    /// What was taken between the first mark and the last.
    pub fn between_marks(&self) -> Stretch {
        let [first, last] = self.marks.get().unwrap_or_default();
        Stretch {
            instrument: last.instrument - first.instrument,
            simulation: last.simulation - first.simulation,
            microseconds: last.microseconds - first.microseconds,
        }
    }
}

/// The polls of one task.
pub struct Task {
    name: &'static str,
    polls: Cell<u64>,
    total: Cell<Cost>,
    worst: Cell<Cost>,
}

impl Task {
    /// A task that has not run.
    pub fn new(name: &'static str) -> Self {
        let [total, worst] = [Cost::default(); 2].map(Cell::new);
        Self { name, polls: Cell::new(0), total, worst }
    }

    /// Runs a future and meters each of its polls. It hands over its results by itself: moving a
    /// great one out of every poll would be metered, too.
    pub async fn run(&self, meter: &Meter, mut future: Pin<&mut impl Future<Output = ()>>) {
        poll_fn(|context| {
            let (cost, poll) = meter.inside(|| future.as_mut().poll(context));
            self.add(cost);
            poll
        })
        .await;
    }

    fn add(&self, cost: Cost) {
        self.polls.set(self.polls.get() + 1);
        self.total.set(self.total.get() + cost);
        self.worst.set(self.worst.get().max(cost));
    }

    /// Its name in the log.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// How often it was polled.
    pub fn polls(&self) -> u64 {
        self.polls.get()
    }

    /// All its polls together.
    pub fn total(&self) -> Cost {
        self.total.get()
    }

    /// Its longest poll.
    pub fn worst(&self) -> Cost {
        self.worst.get()
    }
}
