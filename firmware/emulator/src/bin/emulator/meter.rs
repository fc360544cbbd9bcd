//! Cost of the instrument, without that of the simulation beside it, and how much of it is that of
//! the time driver, which stands in for the board's.
//!
//! All work is done within polls, and the simulated chips and world work within [`Meter::outside`],
//! so the instrument's own instructions are the difference. What this image does in the place of a
//! part of the board that every sample needs works within [`Meter::stand_in`]: it stays in the
//! instrument's account and is told beside it. Metering counts as the simulation's, but for the clock's
//! look at whether there is a meter.

use core::cell::Cell;
use core::future::poll_fn;
use core::pin::Pin;

use critical_section::Mutex;
use measure::counter::{Cost, Counter};

/// Number of empty calls that calibrate the cost of metering one.
const CALIBRATIONS: u64 = 1000;

/// Cost of the instrument and of the simulation beside it: at one moment, or between two.
#[derive(Clone, Copy, Default)]
pub struct Accounts {
    /// Cost of the instrument.
    pub instrument: Cost,
    /// What of it is the cost of the emulator's stand-ins.
    pub stand_ins: Cost,
    /// Cost of the simulation.
    pub simulation: Cost,
    /// Virtual time, µs.
    pub microseconds: u64,
}

/// A value that every task and the time driver may read and replace.
struct Shared<T>(Mutex<Cell<T>>);

impl<T: Copy> Shared<T> {
    /// Creates one.
    const fn new(value: T) -> Self {
        Self(Mutex::new(Cell::new(value)))
    }

    /// Reads it.
    fn get(&self) -> T {
        critical_section::with(|section| self.0.borrow(section).get())
    }

    /// Replaces it.
    fn set(&self, value: T) {
        critical_section::with(|section| self.0.borrow(section).set(value));
    }
}

impl Shared<Cost> {
    /// Adds a cost to an account.
    fn add(&self, cost: Cost) {
        self.set(self.get() + cost);
    }
}

/// Counter with its accounts.
pub struct Meter {
    counter: Counter,
    /// Cost of all polls.
    all: Shared<Cost>,
    /// Cost of the simulation and of all metering within these polls.
    outside: Shared<Cost>,
    /// Cost of the stand-ins within these polls, where the simulation does not use them.
    stand_ins: Shared<Cost>,
    /// Whether the simulation is at work.
    is_outside: Shared<bool>,
    /// Cost of metering a call of the simulation, of a stand-in, and of a task.
    fees: [Cost; 3],
    /// Accounts at the first mark and at the last.
    marks: Shared<Option<[Accounts; 2]>>,
}

impl Meter {
    /// Creates a meter and calibrates its own cost.
    pub fn new(counter: Counter) -> Self {
        let [all, outside, stand_ins] = [Cost::default(); 3].map(Shared::new);
        let (is_outside, marks) = (Shared::new(false), Shared::new(None));
        let fees = [Cost::default(); 3];
        let mut meter = Self { counter, all, outside, stand_ins, is_outside, fees, marks };
        meter.fees = [
            meter.fee(|meter| meter.outside(|| ())),
            meter.fee(|meter| meter.stand_in(|| ())),
            meter.fee(|meter| _ = meter.inside(|| ())),
        ];
        meter.outside.set(Cost::default());
        meter.stand_ins.set(Cost::default());
        meter
    }

    /// Mean cost of metering work that does nothing.
    fn fee(&self, empty: impl Fn(&Self)) -> Cost {
        let (cost, ()) = self.counter.measure(|| (0..CALIBRATIONS).for_each(|_| empty(self)));
        cost / CALIBRATIONS
    }

    /// Polls the executor, metered.
    pub fn poll(&self, work: impl FnOnce()) {
        let (cost, ()) = self.counter.measure(work);
        self.all.add(cost);
    }

    /// Does work that is not the instrument's.
    pub fn outside<T>(&self, work: impl FnOnce() -> T) -> T {
        if self.is_outside.get() {
            return work();
        }
        self.is_outside.set(true);
        let (cost, result) = self.counter.measure(work);
        self.is_outside.set(false);
        self.outside.add(cost + self.fees[0]);
        result
    }

    /// Does the work of a part of the board that this image has otherwise. What the simulation uses
    /// of it is the simulation's.
    pub fn stand_in<T>(&self, work: impl FnOnce() -> T) -> T {
        if self.is_outside.get() {
            return work();
        }
        let (cost, result) = self.counter.measure(work);
        self.stand_ins.add(cost);
        self.outside.add(self.fees[1]);
        result
    }

    /// Does work and returns the instrument's part of its cost.
    fn inside<T>(&self, work: impl FnOnce() -> T) -> (Cost, T) {
        let before = self.outside.get();
        let (cost, result) = self.counter.measure(work);
        let cost = cost - (self.outside.get() - before);
        self.outside.add(self.fees[2]);
        (cost, result)
    }

    /// Marks this moment. The poll in progress is not included.
    pub fn mark(&self, microseconds: u64) {
        let simulation = self.outside.get();
        let instrument = self.all.get() - simulation;
        let stand_ins = self.stand_ins.get();
        let now = Accounts { instrument, stand_ins, simulation, microseconds };
        let first = self.marks.get().map_or(now, |[first, _]| first);
        self.marks.set(Some([first, now]));
    }

    /// Cost between the first mark and the last.
    pub fn between_marks(&self) -> Accounts {
        let [first, last] = self.marks.get().unwrap_or_default();
        Accounts {
            instrument: last.instrument - first.instrument,
            stand_ins: last.stand_ins - first.stand_ins,
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
            meter.outside(|| self.add(cost));
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
