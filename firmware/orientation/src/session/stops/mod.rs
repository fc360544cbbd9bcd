//! The procedure of a vehicle that drives between stops, as a state machine without I/O.
//!
//! ```text
//!  stop, level ─▶ drive ─▶ stop, level ─▶ (drive ─▶ stop …) ─▶ azimuth ± σ, or why none
//! ```
//!
//! It asks for stops and drives, but judges by the sensors alone what the vehicle did: a recording replays
//! the same session.

use heapless::Vec;

use super::procedure::{CONVERTER_TOLERANCE, PERIOD_TOLERANCE, ProcedureError, contradiction};
use crate::align::stops::Setting;
use crate::align::stops::conclusion::Conclusion;
use crate::align::stops::stop::{STOPS, Stop};
use crate::align::stops::stop_detector::{Rests, StopDetector};
use crate::error::Refusal;
use crate::signal::InertialSample;
use crate::signal::rest::{Criteria, Limits};
use crate::units::Instant;

/// What happens to a session.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A sample.
    Sample(&'a InertialSample),
    /// Where the stop that lasts, or the last one, is: north and east of the first, m.
    Displaced([f64; 2]),
    /// There will be no more.
    End,
    /// The instrument cannot go on.
    Failed(Refusal),
}

/// What the session asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Go on sampling.
    Wait,
    /// The vehicle may drive: this stop was long enough. Said once at each.
    Drive,
    /// Nothing more: the conclusion stands.
    Finished,
}

/// Where the session is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The vehicle did not stand yet.
    Waiting,
    /// It stands, for which time this is the index.
    Standing(usize),
    /// It drives, after that many stops.
    Driving(usize),
    /// The conclusion stands.
    Done,
}

/// How the session goes about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Procedure {
    /// Where the stops are.
    pub rests: Rests,
    /// Stops after which it concludes; zero: when there are no more samples.
    pub stops: usize,
    /// How long the vehicle is to stand at each, s.
    pub stop_seconds: f64,
    /// Longest time for everything, s.
    pub longest_seconds: f64,
    /// Sample period, s.
    pub sample_seconds: f64,
    /// By how much the samples' times may contradict it, relative: what turned between two of them is wrong by
    /// as much.
    pub period_tolerance: f64,
    /// Displacements of the stops from the first, north and east, m, where they are known beforehand.
    pub displacements: Vec<[f64; 2], STOPS>,
}

/// Default length of a stop, s: Szymanowski's short levelling.
const STOP_SECONDS: f64 = 60.0;
/// Longest time for everything, s.
const LONGEST_SECONDS: f64 = 6.0 * 3600.0;

impl Procedure {
    /// So many stops of a minute, which the criteria find.
    #[must_use]
    pub fn new(stops: usize, sample_seconds: f64) -> Self {
        Self {
            rests: Rests::Found,
            stops,
            stop_seconds: STOP_SECONDS,
            longest_seconds: LONGEST_SECONDS,
            sample_seconds,
            period_tolerance: CONVERTER_TOLERANCE,
            displacements: Vec::new(),
        }
    }

    /// Whatever a recording with this sample period shows.
    #[must_use]
    pub fn recorded(rests: Rests, sample_seconds: f64) -> Self {
        Self {
            rests,
            longest_seconds: f64::INFINITY,
            period_tolerance: PERIOD_TOLERANCE,
            ..Self::new(0, sample_seconds)
        }
    }

    /// Whether it can be gone about.
    ///
    /// # Errors
    /// As [`Session::new`].
    pub fn check(&self) -> Result<(), ProcedureError> {
        let is_period = self.sample_seconds > 0.0 && self.sample_seconds.is_finite();
        let has_stops = self.stops <= STOPS && (self.stops != 1 || self.rests == Rests::Whole);
        if is_period && has_stops && self.stop_seconds > 0.0 {
            Ok(())
        } else {
            Err(ProcedureError::NoStops)
        }
    }
}

/// One alignment from stops.
#[derive(Clone, Debug)]
pub struct Session {
    setting: Setting,
    procedure: Procedure,
    stop_detector: StopDetector,
    phase: Phase,
    begun: Option<Instant>,
    /// Samples so far.
    samples: u32,
    /// Whether this stop was said to be long enough.
    is_told: bool,
    conclusion: Option<Conclusion>,
}

impl Session {
    /// A session that has not begun.
    ///
    /// # Errors
    /// [`ProcedureError::NoStops`]: no sample period, no length of a stop, one stop only, or too many.
    pub fn new(setting: Setting, procedure: Procedure) -> Result<Self, ProcedureError> {
        procedure.check()?;
        Ok(Self::of(setting, procedure))
    }

    /// The same of a procedure that was checked, made where it is to stay: it is too great for a small
    /// stack.
    #[must_use]
    #[inline]
    pub fn of(setting: Setting, procedure: Procedure) -> Self {
        let gravity = setting.common.latitude.gravity();
        let period = procedure.sample_seconds;
        let stop_detector =
            StopDetector::new(procedure.rests.clone(), &setting.sensors(), gravity, period);
        let phase = Phase::Waiting;
        let (begun, samples, is_told, conclusion) = (None, 0, false, None);
        Self { setting, procedure, stop_detector, phase, begun, samples, is_told, conclusion }
    }

    /// Takes one event and answers what is to be done now.
    pub fn handle(&mut self, event: Event) -> Command {
        match event {
            _ if self.phase == Phase::Done => Command::Finished,
            Event::Sample(sample) => self.sample(sample),
            Event::Displaced(displacement) => {
                self.stop_detector.displace(displacement);
                Command::Wait
            }
            Event::End => self.conclude(),
            Event::Failed(reason) => self.finish(Conclusion::refused(reason)),
        }
    }

    /// What is known beforehand.
    #[must_use]
    pub fn setting(&self) -> &Setting {
        &self.setting
    }

    /// How the session goes about it.
    #[must_use]
    pub fn procedure(&self) -> &Procedure {
        &self.procedure
    }

    /// Where the session is.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// The stops so far; the last may last.
    #[must_use]
    pub fn stops(&self) -> &[Stop] {
        self.stop_detector.stops()
    }

    /// The criteria of the last ten seconds, and what they are held to; new once a second.
    #[must_use]
    pub fn criteria(&self) -> Option<(Criteria, Limits)> {
        self.stop_detector.criteria()
    }

    /// The conclusion, once the session has finished.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.conclusion.as_ref()
    }

    #[inline]
    fn sample(&mut self, sample: &InertialSample) -> Command {
        self.samples += 1;
        if self.stop_detector.push(sample) { self.second(sample.time) } else { Command::Wait }
    }

    /// Looks about once a second.
    fn second(&mut self, now: Instant) -> Command {
        let begun = *self.begun.get_or_insert(now);
        self.tell_displacements();
        let count = self.stop_detector.stops().len();
        let phase = match (self.stop_detector.is_at_rest(), count) {
            (_, 0) => Phase::Waiting,
            (true, count) => Phase::Standing(count - 1),
            (false, count) => Phase::Driving(count),
        };
        if phase != self.phase {
            self.is_told = false;
            self.phase = phase;
        }
        if self.procedure.stops > 0 && self.stop_detector.loss().is_some() {
            return self.conclude();
        }
        if now.seconds() - begun.seconds() > self.procedure.longest_seconds {
            return self.conclude();
        }
        self.stand(count)
    }

    /// Looks whether the vehicle stood for long enough.
    fn stand(&mut self, count: usize) -> Command {
        let Phase::Standing(_) = self.phase else { return Command::Wait };
        let length = self.stop_detector.stops().last().map_or(0.0, Stop::seconds);
        if self.is_told || length < self.procedure.stop_seconds {
            return Command::Wait;
        }
        self.is_told = true;
        if count == self.procedure.stops { self.conclude() } else { Command::Drive }
    }

    /// Where the last stop is, if that is known beforehand.
    fn tell_displacements(&mut self) {
        let Some(last) = self.stop_detector.stops().len().checked_sub(1) else { return };
        if let Some(displacement) = self.procedure.displacements.get(last) {
            self.stop_detector.displace(*displacement);
        }
    }

    #[inline(never)]
    fn conclude(&mut self) -> Command {
        let conclusion = match self.contradiction() {
            Some(reason) => Conclusion::refused(reason),
            None => Conclusion::of(&self.setting, &mut self.stop_detector),
        };
        self.finish(conclusion)
    }

    /// Whether the samples come at another pace than was told.
    fn contradiction(&self) -> Option<Refusal> {
        let Procedure { sample_seconds: told, period_tolerance, .. } = self.procedure;
        let found = self.stop_detector.elapsed() / f64::from(self.samples.max(1));
        // What is missing is told as such.
        let is_whole = self.samples > 0 && self.stop_detector.loss().is_none();
        contradiction(told, found, period_tolerance).filter(|_| is_whole)
    }

    fn finish(&mut self, conclusion: Conclusion) -> Command {
        self.conclusion = Some(conclusion);
        self.phase = Phase::Done;
        Command::Finished
    }
}
