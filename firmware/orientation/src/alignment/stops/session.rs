//! Procedure of a vehicle that drives between stops, as a state machine without I/O.
//!
//! ```text
//!  stop, level ─▶ drive ─▶ stop, level ─▶ (drive ─▶ stop …) ─▶ azimuth ± σ, or why none
//! ```
//!
//! It requests stops and drives, but takes the motion from the sensors alone, so that a recording
//! replays the same session.

use heapless::Vec;

use super::Setting;
use super::conclusion::Conclusion;
use super::residual::Residual;
use super::stop::{STOPS, Stop};
use super::stop_detector::{Rests, StopDetector};
use crate::alignment::period::{CONVERTER_TOLERANCE, PERIOD_TOLERANCE, contradiction};
use crate::alignment::refusal::Refusal;
use crate::alignment::setup::SetupError;
use crate::signal::InertialSample;
use crate::signal::rest::{Criteria, Limits};
use crate::units::Instant;

/// Input of a session.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A sample of gyros and accelerometers.
    Sample(&'a InertialSample),
    /// Reported position of the present or last stop, north and east of the first, m.
    Displaced([f64; 2]),
    /// The end of the recording: there are no more samples.
    End,
    /// A permanent failure of the instrument.
    Failed(Refusal),
}

/// Output of a session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Continue sampling.
    Wait,
    /// The vehicle may drive, because this stop was long enough; returned once at each stop.
    Drive,
    /// The session is over and its conclusion is final.
    Finished,
}

/// State of the session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The vehicle has not stood yet.
    Waiting,
    /// The vehicle stands at the stop with this index.
    Standing(usize),
    /// The vehicle drives after this number of stops.
    Driving(usize),
    /// The session is over.
    Done,
}

/// Procedure of a session with stops.
#[must_use]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Procedure {
    /// Source of the stops.
    pub rests: Rests,
    /// Number of stops after which the session concludes; zero to conclude at the end of the
    /// samples.
    pub stops: usize,
    /// Time for which the vehicle is to stand at each stop, s.
    pub stop_seconds: f64,
    /// Longest time of the whole session, s.
    pub longest_seconds: f64,
    /// Sample period, s.
    pub sample_seconds: f64,
    /// Tolerance of the time stamps against that period, relative: angles between two samples are
    /// wrong by the same ratio.
    pub period_tolerance: f64,
    /// Positions of the stops, north and east of the first, m, where they are known in advance.
    pub displacements: Vec<[f64; 2], STOPS>,
}

/// Default length of a stop, s: the short levelling of Szymanowski 2003.
const STOP_SECONDS: f64 = 60.0;
/// Default longest time of the whole session, s.
const LONGEST_SECONDS: f64 = 6.0 * 3600.0;

impl Procedure {
    /// Procedure with this number of stops of a minute, which the stop criteria find.
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

    /// Procedure for a recording with this sample period, whatever it contains.
    pub fn recorded(rests: Rests, sample_seconds: f64) -> Self {
        Self {
            rests,
            longest_seconds: f64::INFINITY,
            period_tolerance: PERIOD_TOLERANCE,
            ..Self::new(0, sample_seconds)
        }
    }

    /// Checks the procedure.
    ///
    /// # Errors
    /// [`SetupError::NoStops`], as for [`Session::new`].
    pub fn check(&self) -> Result<(), SetupError> {
        let is_period = self.sample_seconds > 0.0 && self.sample_seconds.is_finite();
        let has_stops = self.stops <= STOPS && (self.stops != 1 || self.rests == Rests::Whole);
        if is_period && has_stops && self.stop_seconds > 0.0 {
            Ok(())
        } else {
            Err(SetupError::NoStops)
        }
    }
}

/// One alignment by stops.
#[derive(Clone, Debug)]
pub struct Session {
    /// Configuration of the alignment.
    setting: Setting,
    /// Procedure.
    procedure: Procedure,
    /// Stops so far.
    stop_detector: StopDetector,
    /// State of the session.
    phase: Phase,
    /// Time of the first complete second.
    begun: Option<Instant>,
    /// Number of samples so far.
    samples: u32,
    /// Whether the command to drive was returned for this stop.
    is_reported: bool,
    /// Conclusion, once the session is over.
    conclusion: Option<Conclusion>,
}

impl Session {
    /// Creates a session before its first event.
    ///
    /// # Errors
    /// [`SetupError::NoStops`]: no sample period, no length of a stop, a single stop, or too
    /// many.
    pub fn new(setting: Setting, procedure: Procedure) -> Result<Self, SetupError> {
        procedure.check()?;
        Ok(Self::of(setting, procedure))
    }

    /// Session of a procedure that was checked, built at its final place in memory, because it is
    /// too large for a small stack.
    #[must_use]
    #[inline]
    pub fn of(setting: Setting, procedure: Procedure) -> Self {
        let gravity = setting.site.latitude.gravity();
        let period = procedure.sample_seconds;
        let stop_detector =
            StopDetector::new(procedure.rests.clone(), &setting.sensors(), gravity, period);
        let phase = Phase::Waiting;
        let (begun, samples, is_reported, conclusion) = (None, 0, false, None);
        Self { setting, procedure, stop_detector, phase, begun, samples, is_reported, conclusion }
    }

    /// Takes one event and returns the command that follows.
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

    /// Configuration of the alignment.
    #[must_use]
    pub fn setting(&self) -> &Setting {
        &self.setting
    }

    /// Procedure of the session.
    pub fn procedure(&self) -> &Procedure {
        &self.procedure
    }

    /// State of the session.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Stops so far; the last one may still continue.
    #[must_use]
    pub fn stops(&self) -> &[Stop] {
        self.stop_detector.stops()
    }

    /// Stop criteria of the last ten seconds, and their limits; updated once a second.
    #[must_use]
    pub fn criteria(&self) -> Option<(Criteria, Limits)> {
        self.stop_detector.criteria()
    }

    /// Conclusion; `None` until the session is over.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.conclusion.as_ref()
    }

    /// What the solution leaves of a stop, by its number from zero; none without a solution, or where
    /// the place of the stop is not known.
    #[must_use]
    pub fn residual(&self, stop: usize) -> Option<Residual> {
        self.conclusion()?.residual(&self.setting, &self.stop_detector, stop)
    }

    #[inline]
    fn sample(&mut self, sample: &InertialSample) -> Command {
        self.samples += 1;
        if self.stop_detector.push(sample) { self.second(sample.time) } else { Command::Wait }
    }

    /// Updates phase and limits once a second.
    fn second(&mut self, now: Instant) -> Command {
        let begun = *self.begun.get_or_insert(now);
        self.report_displacements();
        let count = self.stop_detector.stops().len();
        let phase = match (self.stop_detector.is_at_rest, count) {
            (_, 0) => Phase::Waiting,
            (true, count) => Phase::Standing(count - 1),
            (false, count) => Phase::Driving(count),
        };
        if phase != self.phase {
            self.is_reported = false;
            self.phase = phase;
        }
        if self.procedure.stops > 0 && self.stop_detector.loss.is_some() {
            return self.conclude();
        }
        if now.seconds() - begun.seconds() > self.procedure.longest_seconds {
            return self.conclude();
        }
        self.stand(count)
    }

    /// Returns the command to drive, or concludes, once the vehicle has stood for long enough.
    fn stand(&mut self, count: usize) -> Command {
        let Phase::Standing(_) = self.phase else { return Command::Wait };
        let length = self.stop_detector.stops().last().map_or(0.0, Stop::seconds);
        if self.is_reported || length < self.procedure.stop_seconds {
            return Command::Wait;
        }
        self.is_reported = true;
        if count == self.procedure.stops { self.conclude() } else { Command::Drive }
    }

    /// Reports the position of the last stop, if it is known in advance.
    fn report_displacements(&mut self) {
        let Some(last) = self.stop_detector.stops().len().checked_sub(1) else { return };
        if let Some(displacement) = self.procedure.displacements.get(last) {
            self.stop_detector.displace(*displacement);
        }
    }

    /// Concludes from the stops so far.
    #[inline(never)]
    fn conclude(&mut self) -> Command {
        let conclusion = match self.contradiction() {
            Some(reason) => Conclusion::refused(reason),
            None => Conclusion::of(&self.setting, &mut self.stop_detector),
        };
        self.finish(conclusion)
    }

    /// Refusal of samples whose time stamps contradict the configured period.
    fn contradiction(&self) -> Option<Refusal> {
        let Procedure { sample_seconds: stated, period_tolerance, .. } = self.procedure;
        let found = self.stop_detector.elapsed() / f64::from(self.samples.max(1));
        // Missing samples are reported as such instead.
        let is_whole = self.samples > 0 && self.stop_detector.loss.is_none();
        contradiction(stated, found, period_tolerance).filter(|_| is_whole)
    }

    /// Ends the session with a conclusion.
    fn finish(&mut self, conclusion: Conclusion) -> Command {
        self.conclusion = Some(conclusion);
        self.phase = Phase::Done;
        Command::Finished
    }
}
