//! The aligner: a method of alignment from power-on to its verdict, and again as it is ordered.

use super::Order;
use crate::alignment::progress::Progress;
use crate::alignment::{Azimuth, Listener, Method, Refusal, Request, method};
use crate::signal::{SwayNoise, Timed};
use crate::units::{Instant, Metres};

/// Longest time until the mechanism's angles are valid, µs: six searches of a stage for its index
/// over the whole travel, with the rests between them, 15 minutes.
const LONGEST_HOMING: u64 = 900_000_000;

/// Input of the aligner beside the samples. What it does follows from both and their order alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Input {
    /// The mechanism's angles are valid; noise that the compensated sway of the base leaves in the
    /// samples.
    Homed(SwayNoise),
    /// Answer to [`Request::Locate`]: displacement of the vehicle, north and east.
    Displaced([Metres; 2]),
    /// An order.
    Ordered(Order),
    /// A sample of this time came while the mechanism's angles were not valid.
    Passed(Instant),
}

/// State of the aligner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The mechanism's angles are not valid yet; samples are passed by.
    Homing,
    /// The method takes samples.
    Aligning,
    /// The alignment is over; samples are passed by.
    Idle,
}

/// A method of alignment whose samples are of the type `S`, and its state.
pub struct Aligner<'m, S> {
    /// The method.
    method: &'m mut dyn Method<S>,
    /// State of the alignment.
    pub state: State,
    /// Time of the first sample that was passed by, and of the latest that the method has taken.
    since: Option<Instant>,
    taken: Option<Instant>,
    /// Azimuth that was found, until it is handed over.
    found: Option<(Instant, Azimuth)>,
}

impl<'m, S: Timed> Aligner<'m, S> {
    /// Takes a method that has not begun.
    pub fn new(method: &'m mut dyn Method<S>) -> Self {
        Self { method, state: State::Idle, since: None, taken: None, found: None }
    }

    /// The method, with its verdict where the alignment is over.
    #[must_use]
    pub fn method(&self) -> &dyn Method<S> {
        self.method
    }

    /// Time of the latest sample that the method has taken.
    #[must_use]
    pub fn taken(&self) -> Option<Instant> {
        self.taken
    }

    /// The azimuth that was found and the time of the sample to which it belongs, once.
    pub fn hand_over(&mut self) -> Option<(Instant, Azimuth)> {
        self.found.take()
    }

    /// Begins the first alignment, or another one.
    pub fn begin(&mut self, listener: Listener) -> Request {
        (self.state, self.since) = (State::Homing, None);
        let request = self.method.begin(listener);
        self.follow(request, listener)
    }

    /// Takes an input.
    pub fn take(&mut self, input: &Input, listener: Listener) -> Request {
        match input {
            Input::Homed(sway) if self.state == State::Homing => {
                self.state = State::Aligning;
                self.pass(method::Input::Sway(sway), listener)
            }
            Input::Homed(_) => Request::Continue,
            Input::Displaced(place) => self.pass(method::Input::Displaced(place), listener),
            Input::Ordered(order) => self.obey(order, listener),
            Input::Passed(now) => self.wait(*now, listener),
        }
    }

    /// Takes a sample.
    pub fn sample(&mut self, sample: &S, listener: Listener) -> Request {
        if self.state != State::Aligning {
            return self.wait(sample.time(), listener);
        }
        self.taken = Some(sample.time());
        self.pass(method::Input::Sample(sample), listener)
    }

    /// Passes a sample by, and ends an alignment that waits for the mechanism for too long.
    fn wait(&mut self, now: Instant, listener: Listener) -> Request {
        if self.state != State::Homing {
            return Request::Continue;
        }
        let since = *self.since.get_or_insert(now);
        if now.0.saturating_sub(since.0) <= LONGEST_HOMING {
            return Request::Continue;
        }
        self.fail(&Refusal::TimeExhausted, listener)
    }

    /// Obeys an order. An alignment that is over cannot fail, and one in progress is not begun.
    fn obey(&mut self, order: &Order, listener: Listener) -> Request {
        match (order, self.state) {
            (Order::Restart, State::Idle) => self.begin(listener),
            (Order::Restart, _) | (_, State::Idle) => Request::Continue,
            (Order::Fail(reason), _) => self.fail(reason, listener),
            (Order::Skip, _) => {
                self.state = State::Idle;
                Request::Done
            }
        }
    }

    /// Computes what the latest request announced.
    pub fn compute(&mut self, listener: Listener) -> Request {
        let request = self.method.compute(listener);
        self.follow(request, listener)
    }

    /// Ends the alignment with a reason.
    fn fail(&mut self, reason: &Refusal, listener: Listener) -> Request {
        self.pass(method::Input::Failed(reason), listener)
    }

    /// Passes an input to the method.
    fn pass(&mut self, input: method::Input<'_, S>, listener: Listener) -> Request {
        let request = self.method.take(input, listener);
        self.follow(request, listener)
    }

    /// Ends the alignment with the method's last request.
    fn follow(&mut self, request: Request, listener: Listener) -> Request {
        if request == Request::Done && self.state != State::Idle {
            self.state = State::Idle;
            self.conclude(listener);
        }
        request
    }

    /// Reports the verdict, and keeps the azimuth with the time of the sample that ended it.
    fn conclude(&mut self, listener: Listener) {
        match self.method.verdict() {
            Some(Ok(solution)) => {
                listener(Progress::Concluded(solution));
                self.found = self.taken.map(|taken| (taken, solution.azimuth));
            }
            Some(Err(reason)) => listener(Progress::Refused(reason)),
            None => {}
        }
    }
}
