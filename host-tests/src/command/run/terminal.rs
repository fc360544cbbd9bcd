//! What is shown while a board works: how far it is, and its log where that is asked for.

use std::cell::Cell;
use std::time::{Duration, Instant as WallClock};

use embassy_time::Instant;
use firmware::event::Event;
use firmware::ports::Observer;
use host::instrument::RunError;
use host::interrupt;
use host::output::manner::Manner;
use host::output::progress::Progress;
use host::output::seconds;
use orientation::alignment::{self, rotating, stepwise, stops};
use orientation::navigation::{self, aligner};

use super::options::Inputs;

/// Parts of a run after each of which its progress is shown.
const PARTS: u64 = 200;
/// What is followed of a spinning body, which has no steps.
pub(super) const FLIGHT: &str = "flight";
/// What is followed before the first step.
const START: &str = "start";

/// Shows the log and the progress while a board works, and has its inputs written.
pub(super) struct Terminal<'t> {
    inputs: &'t Inputs,
    manner: Manner,
    shown: Progress,
    /// What the steps of its alignment are called.
    steps: &'static str,
    stage: Cell<Stage>,
    /// Planned stops of a vehicle.
    stops: Cell<usize>,
    /// Time from power-on to the end, as expected, with the dwells that are measured again, ms.
    expected: Cell<u64>,
    /// Time of the latest dwell's end, ms.
    dwelled: Cell<u64>,
    /// Time of what is shown, ms.
    latest: Cell<u64>,
}

/// How far a board is.
#[derive(Clone, Copy)]
enum Stage {
    /// It starts, levels or surveys.
    Preparing,
    /// It aligns itself: steps that are done, of how many.
    Aligning(usize, usize),
    /// It keeps what it found.
    Keeping,
    /// It follows a roll.
    Flying,
}

/// A run for a terminal: how it is shown, what its steps are called, and how long it takes by its own time, s.
pub(super) type Watched = (Manner, &'static str, f64);

impl<'t> Terminal<'t> {
    /// Runs a board; with the time that it took on this machine.
    pub(super) fn watching<T>(
        watched: Watched,
        inputs: &'t Inputs,
        run: impl FnOnce(&Self) -> Result<T, RunError>,
    ) -> Result<(T, Duration), String> {
        let begun = WallClock::now();
        let watch = Self::new(watched, inputs);
        interrupt::end_input();
        watch.show();
        let ran = run(&watch);
        if interrupt::ended().is_some() {
            watch.show();
        }
        watch.shown.finish();
        ran.map(|ran| (ran, begun.elapsed())).map_err(|error| error.to_string())
    }

    fn new((manner, steps, seconds): Watched, inputs: &'t Inputs) -> Self {
        let (stage, words) = match steps {
            FLIGHT => (Stage::Flying, FLIGHT),
            _ => (Stage::Preparing, START),
        };
        let expected = Cell::new((seconds * 1e3) as u64);
        let (stage, stops) = (Cell::new(stage), Cell::new(0));
        let [dwelled, latest] = [Cell::new(0), Cell::new(0)];
        let shown = Progress::new(manner, words);
        Self { inputs, manner, shown, steps, stage, stops, expected, dwelled, latest }
    }

    /// Notes how many of the planned dwells, turns or stops are done; alignments anew are part of the keeping.
    fn follow(&self, progress: &alignment::Progress) {
        if matches!(self.stage.get(), Stage::Keeping) {
            return;
        }
        let (done, planned) = match *progress {
            alignment::Progress::Stepwise(stepwise::Progress::Dwelled(done, of, _)) => {
                self.dwelled.set(Instant::now().as_millis());
                (done, of)
            }
            alignment::Progress::Stepwise(stepwise::Progress::Repeated(..)) => {
                return self.lengthen();
            }
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
            alignment::Progress::Concluded(_) | alignment::Progress::Refused(_) => {
                return self.stage.set(Stage::Keeping);
            }
            _ => return,
        };
        self.stage.set(Stage::Aligning(done, planned));
        self.show();
    }

    /// A dwell is measured again: all that comes is later by the time that it took.
    fn lengthen(&self) {
        let now = Instant::now().as_millis();
        self.expected.set(self.expected.get() + now - self.dwelled.replace(now));
    }

    /// An azimuth is kept from now on, be it handed over from outside or found.
    fn keep(&self) {
        if !matches!(self.stage.get(), Stage::Flying) {
            self.stage.set(Stage::Keeping);
        }
    }

    /// Shows how far the board is, where it has got further by a small part of the whole.
    fn pass(&self) {
        let now = Instant::now().as_millis();
        if now >= self.latest.get() + self.expected.get() / PARTS {
            self.latest.set(now);
            self.show();
        }
    }

    /// Shows how far the board is.
    fn show(&self) {
        let expected = self.expected.get();
        let now = Instant::now().as_millis().min(expected - 1);
        let time = format!("{} of {} s", now / 1000, expected / 1000);
        let words = match self.stage.get() {
            Stage::Preparing => format!("{START}, {time}"),
            Stage::Aligning(done, planned) => format!("{} {done}/{planned}, {time}", self.steps),
            Stage::Keeping => format!("keeping, {time}"),
            Stage::Flying => format!("{}, {time}", self.steps),
        };
        self.shown.reached((now, expected), &words);
    }
}

impl Observer for Terminal<'_> {
    fn aligns(&self, input: &aligner::Input) {
        self.inputs.iter().for_each(|inputs| inputs.aligns(input));
        self.pass();
    }

    fn navigates(&self, input: &navigation::Input) {
        self.inputs.iter().for_each(|inputs| inputs.navigates(input));
        self.pass();
    }

    fn event(&self, at: Instant, event: &Event) {
        if self.manner.shows_log() {
            let at_s = seconds(at);
            self.shown.log(&format!("{at_s:>11.6} {event}"));
        }
        match event {
            Event::Alignment(progress) => self.follow(progress),
            Event::Navigation(navigation::Progress::HandedOver(..)) => self.keep(),
            _ => {}
        }
    }
}
