//! Procedure of a vehicle that drives between stops, as a state machine without I/O.
//!
//! ```text
//!  stop, level ─▶ drive ─▶ stop, level ─▶ (drive ─▶ stop …) ─▶ azimuth ± σ, or why none
//! ```
//!
//! It requests stops and drives, but takes the motion from the sensors alone, so that a recording
//! replays the same session.

use heapless::Vec;

use super::conclusion::Conclusion;
use super::inclination::pitch_and_roll;
use super::residual::Residual;
use super::stop::{STOPS, Stop};
use super::stop_detector::{Rests, StopDetector};
use super::{Progress, Setting};
use crate::alignment::period::{PERIOD_TOLERANCE, contradiction};
use crate::alignment::progress::Progress::Stops;
use crate::alignment::setup::{LONGEST, PERIODS, check_ranges};
use crate::alignment::{Input, Listener, Method, Refusal, Request, SetupError, Solution, Verdict};
use crate::device::TRIAD;
use crate::signal::InertialSample;
use crate::signal::rest::{Criteria, Limits};
use crate::units::{Instant, Metres, Radians, Seconds};

/// State of the session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    /// The vehicle has not stood yet.
    Waiting,
    /// The vehicle stands at the stop with this index.
    Standing(usize),
    /// The vehicle drives after this number of stops.
    Driving(usize),
    /// Samples are passed by until the conclusion is drawn.
    Conclude,
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
    /// Time for which the vehicle is to stand at each stop.
    pub stop_seconds: Seconds,
    /// Longest time of the whole session.
    pub longest_seconds: Seconds,
    /// Sample period.
    pub sample_seconds: Seconds,
    /// Tolerance of the time stamps against that period, relative: angles between two samples are
    /// wrong by the same ratio.
    pub period_tolerance: f64,
    /// Positions of the stops, north and east of the first, where they are known in advance.
    pub displacements: Vec<[Metres; 2], STOPS>,
}

/// Default length of a stop: the short levelling of Szymanowski 2003.
const STOP_SECONDS: Seconds = Seconds(60.0);
/// Default longest time of the whole session.
const LONGEST_SECONDS: Seconds = Seconds(6.0 * 3600.0);

impl Procedure {
    /// Procedure with this number of stops of a minute, which the stop criteria find.
    pub fn new(stops: usize, sample_seconds: Seconds) -> Self {
        Self {
            rests: Rests::Found,
            stops,
            stop_seconds: STOP_SECONDS,
            longest_seconds: LONGEST_SECONDS,
            sample_seconds,
            period_tolerance: PERIOD_TOLERANCE,
            displacements: Vec::new(),
        }
    }

    /// Procedure for a recording with this sample period, whatever it contains.
    pub fn recorded(rests: Rests, sample_seconds: Seconds) -> Self {
        Self { rests, longest_seconds: Seconds(f64::INFINITY), ..Self::new(0, sample_seconds) }
    }

    /// Checks the procedure.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`] and [`SetupError::NoStops`], as for [`Session::new`].
    pub fn check(&self) -> Result<(), SetupError> {
        check_ranges(&[
            ("sample_seconds", self.sample_seconds.0, PERIODS),
            ("stop_seconds", self.stop_seconds.0, [0.0, LONGEST]),
            ("longest_seconds", self.longest_seconds.0, [0.0, f64::INFINITY]),
            ("period_tolerance", self.period_tolerance, [0.0, 1.0]),
        ])?;
        let has_stops = self.stops <= STOPS && (self.stops != 1 || self.rests == Rests::Whole);
        let is_possible = has_stops && self.stop_seconds.0 > 0.0;
        is_possible.then_some(()).ok_or(SetupError::NoStops)
    }
}

/// One alignment by stops.
#[derive(Clone, Debug)]
pub struct Session {
    /// Configuration of the alignment.
    pub setting: Setting,
    /// Procedure.
    pub procedure: Procedure,
    /// Stops so far.
    stop_detector: StopDetector,
    /// State of the session, and the time since when.
    phase: Phase,
    since: Instant,
    /// Displacement of the first stop, north and east, from which others count; none while it is
    /// not known.
    origin: Option<[Metres; 2]>,
    /// Number of the latest stop whose displacement is known, from zero.
    placed: usize,
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
    /// [`SetupError::OutOfRange`], and [`SetupError::NoStops`] for stops without a length, a single
    /// stop, or too many.
    pub fn new(setting: Setting, procedure: Procedure) -> Result<Self, SetupError> {
        setting.check()?;
        procedure.check()?;
        Ok(Self::of(setting, procedure))
    }

    /// Session of a procedure that was checked, built at its final place in memory, because it is
    /// too large for a small stack.
    #[inline]
    #[must_use]
    pub fn of(setting: Setting, procedure: Procedure) -> Self {
        let gravity = setting.site.latitude.gravity();
        let (sensors, period) = (setting.sensors(), procedure.sample_seconds);
        Self {
            // Built where it stays: it is too large for a copy.
            stop_detector: StopDetector::new(procedure.rests.clone(), &sensors, gravity, period),
            setting,
            procedure,
            phase: Phase::Waiting,
            since: Instant::default(),
            origin: Some([Metres(0.0); 2]),
            placed: 0,
            begun: None,
            samples: 0,
            is_reported: false,
            conclusion: None,
        }
    }

    /// Stops so far; the last one may still continue.
    #[must_use]
    pub fn stops(&self) -> &[Stop] {
        &self.stop_detector.stops
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
    fn sample(&mut self, sample: &InertialSample, listener: Listener) -> Request {
        self.samples += 1;
        if !self.stop_detector.push(sample) {
            return self.locate();
        }
        match self.second(sample.time, listener) {
            Request::Continue => self.locate(),
            request => request,
        }
    }

    /// Asks for the displacement of the present stop until it is known.
    fn locate(&self) -> Request {
        let Phase::Standing(index) = self.phase else { return Request::Continue };
        let is_known = if index == 0 { self.origin.is_some() } else { index <= self.placed };
        if is_known { Request::Continue } else { Request::Locate }
    }

    /// Takes the displacement of the present stop.
    fn displace(&mut self, &[north, east]: &[Metres; 2], listener: Listener) {
        let Phase::Standing(index) = self.phase else { return };
        if index == 0 {
            self.origin = self.origin.or(Some([north, east]));
            return;
        }
        if let Some(origin) = self.origin {
            let place = [Metres(north.0 - origin[0].0), Metres(east.0 - origin[1].0)];
            self.placed = index;
            self.stop_detector.displace(place);
            listener(Stops(Progress::Displaced(index + 1, place)));
        }
    }

    /// Updates phase and limits once a second.
    fn second(&mut self, now: Instant, listener: Listener) -> Request {
        let begun = *self.begun.get_or_insert(now);
        self.report_displacements();
        let count = self.stop_detector.stops.len();
        self.discard(count);
        let phase = match (self.stop_detector.state.is_at_rest, count) {
            (_, 0) => Phase::Waiting,
            (true, count) => Phase::Standing(count - 1),
            (false, count) => Phase::Driving(count),
        };
        if phase != self.phase {
            self.is_reported = false;
            self.enter(phase, now, listener);
        }
        let required = self.setting.site.required_sigma.0;
        if self.procedure.stops > 0 && self.stop_detector.loss(required).is_some() {
            return self.conclude();
        }
        if now.seconds() - begun.seconds() > self.procedure.longest_seconds.0 {
            return self.conclude();
        }
        self.stand(count, listener)
    }

    /// Forgets the place of the present stop where so many stops are left without it: it was too short for one.
    fn discard(&mut self, left: usize) {
        if self.phase != Phase::Standing(left) {
            return;
        }
        self.placed = left.saturating_sub(1);
        if left == 0 {
            self.origin = None;
        }
    }

    /// Enters a phase, and reports the begin of a stop, with the duration of the drive before it, or
    /// of a drive.
    fn enter(&mut self, phase: Phase, now: Instant, listener: Listener) {
        match (self.phase, phase) {
            (Phase::Driving(_), Phase::Standing(index)) => {
                let seconds = now.seconds() - self.since.seconds();
                listener(Stops(Progress::Stopped(index + 1, Seconds(seconds))));
            }
            (_, Phase::Standing(_)) => listener(Stops(Progress::Standing)),
            (_, Phase::Driving(_)) => listener(Stops(Progress::Driving)),
            _ => {}
        }
        (self.phase, self.since) = (phase, now);
    }

    /// Permits the vehicle to drive, or concludes, once it has stood for long enough.
    fn stand(&mut self, count: usize, listener: Listener) -> Request {
        let (Phase::Standing(_), Some(stop)) = (self.phase, self.stop_detector.stops.last()) else {
            return Request::Continue;
        };
        if self.is_reported || stop.seconds() < self.procedure.stop_seconds {
            return Request::Continue;
        }
        self.is_reported = true;
        if count == self.procedure.stops {
            return self.conclude();
        }
        let level = pitch_and_roll(&stop.force.mean());
        listener(Stops(Progress::MayDrive(count, stop.seconds(), level)));
        Request::MayDrive
    }

    /// Reports the position of the last stop, if it is known in advance.
    fn report_displacements(&mut self) {
        let Some(last) = self.stop_detector.stops.len().checked_sub(1) else { return };
        if let Some(displacement) = self.procedure.displacements.get(last) {
            self.stop_detector.displace(*displacement);
            self.placed = last;
        }
    }

    /// Ends the session with the stops so far.
    fn conclude(&mut self) -> Request {
        self.phase = Phase::Conclude;
        Request::Compute
    }

    /// Refusal of samples whose time stamps contradict the configured period.
    fn contradiction(&self) -> Option<Refusal> {
        let Procedure { sample_seconds: stated, period_tolerance, .. } = self.procedure;
        let found = self.stop_detector.elapsed() / f64::from(self.samples.max(1));
        // Lost rotation is reported as such instead.
        let is_whole = self.samples > 0
            && self.stop_detector.loss(self.setting.site.required_sigma.0).is_none();
        contradiction(stated, Seconds(found), period_tolerance).filter(|_| is_whole)
    }

    /// Ends the session with a conclusion, and reports the biases that it shows.
    fn finish(&mut self, conclusion: Conclusion, listener: Listener) -> Request {
        let Conclusion { found, .. } = self.conclusion.insert(conclusion);
        if let Some(found) = found.as_ref().filter(|found| found.are_biases_observed) {
            for ((gyro, bias), sigma) in TRIAD.into_iter().zip(found.biases).zip(found.bias_sigmas)
            {
                listener(Stops(Progress::Bias(gyro, bias, sigma)));
            }
        }
        self.phase = Phase::Done;
        Request::Done
    }

    /// Resets the session in place for another alignment, which does not know yet where its first
    /// stop is.
    fn restart(&mut self) {
        self.stop_detector.clear();
        (self.phase, self.since) = (Phase::Waiting, Instant::default());
        (self.origin, self.placed) = (None, 0);
        (self.begun, self.samples) = (None, 0);
        (self.is_reported, self.conclusion) = (false, None);
    }
}

impl Method<InertialSample> for Session {
    fn begin(&mut self, listener: Listener) -> Request {
        if self.samples > 0 || self.conclusion.is_some() {
            self.restart();
        }
        let (stops, latitude) = (self.procedure.stops, self.setting.site.latitude);
        listener(Stops(Progress::Begun { stops, latitude }));
        match self.setting.site.check_latitude() {
            Ok(()) => Request::Continue,
            Err(reason) => self.finish(Conclusion::refused(reason), listener),
        }
    }

    fn take(&mut self, input: Input<'_, InertialSample>, listener: Listener) -> Request {
        match input {
            _ if self.phase == Phase::Done => return Request::Done,
            _ if self.phase == Phase::Conclude => return Request::Continue,
            Input::Sample(sample) => return self.sample(sample, listener),
            Input::Displaced(displacement) => self.displace(displacement, listener),
            Input::Sway(_) => {}
            Input::End => return self.conclude(),
            Input::Failed(reason) => return self.finish(Conclusion::refused(*reason), listener),
        }
        Request::Continue
    }

    // Not inlined, so that its stack is free again while samples are taken.
    #[inline(never)]
    fn compute(&mut self, listener: Listener) -> Request {
        if self.phase != Phase::Conclude {
            return Request::Continue;
        }
        let conclusion = match self.contradiction() {
            Some(reason) => Conclusion::refused(reason),
            None => Conclusion::of(&self.setting, &mut self.stop_detector),
        };
        self.finish(conclusion, listener)
    }

    fn required_sigma(&self) -> Option<Radians> {
        Some(self.setting.site.required_sigma)
    }

    fn verdict(&self) -> Option<Verdict> {
        let Conclusion { verdict, found } = self.conclusion.as_ref()?;
        let limit = found.as_ref().map(|found| found.limit).unwrap_or_default();
        Some(verdict.map(|azimuth| Solution { azimuth, limit }))
    }
}
