//! Multi-position alignment as a state machine without I/O: each input is answered by a request.
//!
//! ```text
//!  level ─▶ (survey) ─▶ dwell ─▶ rotate ─▶ dwell ─▶ … ─▶ match ─▶ azimuth ± σ, or the reason for none
//!                        ▲└─disturbed: again─┘
//! ```
//!
//! The motion of the stage is taken from its encoder alone: a dwell is an interval of constant
//! angle, whatever commanded it. So a recording replays the same session that a board runs.

mod accuracy;
mod prepared;
pub mod procedure;
pub mod schedule;
mod survey;
mod timing;

pub use prepared::Prepared;

use heapless::Vec;

use self::procedure::Procedure;
use self::schedule::{Position, StopRule};
use self::survey::Store;
use self::timing::{SECTIONS, Target, Timing};
use super::conclusion::Conclusion;
use super::criterion::Criterion;
use super::quality::{Disturbance, ExpectedScatter};
use super::setting::Setting;
use super::{Progress, Refusal};
use crate::alignment::period::contradiction;
use crate::alignment::progress::Progress::Stepwise;
use crate::alignment::{self, Input, Listener, Method, Request, SetupError, Solution, Verdict};
use crate::device::{Device, Trouble};
use crate::filter::Coefficients;
use crate::noise::fit::NoiseFit;
use crate::signal::dwell::DwellAverage;
use crate::signal::{Dwell, Sample};
use crate::units::{Degrees, Instant, Radians, RadiansPerSecond, Seconds, TURN};

/// Fraction of the planned dwell above which a dwell counts as complete.
const WHOLE: f64 = 0.99;

/// Greatest number of repetitions that are recorded: two at each of twelve positions.
const REPETITIONS: usize = 24;

/// Refusal of samples without a force.
const FORCELESS: alignment::Refusal =
    alignment::Refusal::Device { device: Device::Accelerometer, trouble: Trouble::Silent };

/// State of the session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// The tilt is measured before anything turns.
    Level,
    /// The stage stands still while the gyro's noise is surveyed.
    Survey,
    /// A dwell is being averaged.
    Dwell,
    /// The stage has been rotating since this time.
    Rotate(Instant),
    /// Samples are passed by until this is computed.
    Compute(Task),
    /// The session is over.
    Done,
}

/// What is to be computed in a call of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Task {
    /// The noise that the survey shows, and the plan that follows; the time of its last sample.
    Learn(Instant),
    /// Whether the accuracy is reached or out of reach, with the time allowed, and that of the
    /// latest sample.
    Weigh(Seconds, Instant),
    /// The conclusion, refused where there is a reason that further dwells cannot remove.
    Conclude(Option<alignment::Refusal>),
}

/// Record of a dwell that was discarded and measured again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repetition {
    /// Index of the position.
    pub position: usize,
    /// Disturbance of the discarded dwell.
    pub why: Disturbance,
}

/// One alignment from the first sample to its conclusion.
#[derive(Clone, Debug)]
pub struct Session {
    /// Site, instrument and requirements.
    pub setting: Setting,
    /// Procedure.
    pub procedure: Procedure,
    /// Coefficients of the stage filter.
    coefficients: Coefficients<SECTIONS>,
    /// Procedure in the units of the sample path.
    timing: Timing,
    /// State of the session.
    pub phase: Phase,
    /// Position to which the stage was sent.
    target: Target,
    /// Time of the first sample.
    begun: Option<Instant>,
    /// Average of the standstill in progress.
    average: Option<DwellAverage<SECTIONS>>,
    /// Dwells, or the survey before them.
    store: Store,
    /// Noise found by the survey.
    pub surveyed: Option<NoiseFit>,
    /// Dwells that were measured again; with more than 24 the first ones.
    pub repetitions: Vec<Repetition, REPETITIONS>,
    /// Repetitions at the present position.
    tries: usize,
    /// Conclusion, once the session is over.
    conclusion: Option<Conclusion>,
}

impl Session {
    /// Creates a session before its first event; nothing moves yet.
    ///
    /// # Errors
    /// [`SetupError`] for a procedure that the filter or the stage cannot follow.
    pub fn new(setting: Setting, procedure: Procedure) -> Result<Self, SetupError> {
        Prepared::new(setting, procedure).map(Self::from)
    }

    /// Dwells so far.
    #[must_use]
    pub fn dwells(&self) -> &[Dwell] {
        self.store.dwells()
    }

    /// Number of planned positions.
    #[must_use]
    pub fn planned(&self) -> usize {
        match self.procedure.stop {
            StopRule::Accuracy { .. } => self.procedure.schedule.len_beyond(self.dwells().len()),
            _ => self.procedure.schedule.len(),
        }
    }

    /// Conclusion; `None` until the session is over.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.conclusion.as_ref()
    }

    /// Conclusion from the dwells so far, for reporting progress and for stopping early.
    pub fn preview(&self) -> Conclusion {
        Conclusion::of(&self.setting, self.dwells(), Criterion::MaximumLikelihood)
    }

    /// Takes a dwell that was averaged elsewhere, for example in a table of dwells; concludes with
    /// the last one.
    pub fn take_dwell(&mut self, dwell: &Dwell) {
        let is_taken = self.store.push(*dwell);
        if !is_taken || self.dwells().len() >= self.planned() {
            self.draw(None);
            self.finish(&mut |_| ());
        }
    }

    /// Processes a sample.
    fn sample(&mut self, sample: &Sample, listener: Listener) -> Request {
        let begun = *self.begun.get_or_insert(sample.time);
        if sample.time.0.saturating_sub(begun.0) > self.timing.longest {
            return self.conclude(Some(alignment::Refusal::TimeExhausted));
        }
        if let Some(request) = self.follow(sample, listener) {
            return request;
        }
        match self.phase {
            Phase::Level => self.level(sample.time, listener),
            Phase::Survey => self.survey(sample),
            Phase::Dwell => self.dwell(sample.time, listener),
            Phase::Rotate(since) => self.rotate(sample, since),
            Phase::Compute(_) | Phase::Done => Request::Continue,
        }
    }

    /// Averages while the stage stands; where it moves, ends the dwell and begins a new average.
    fn follow(&mut self, sample: &Sample, listener: Listener) -> Option<Request> {
        let mut ended = None;
        match &mut self.average {
            Some(average) if average.stands_at(sample.stage, self.timing.still) => {
                average.push(&self.coefficients, sample);
                return None;
            }
            Some(_) if matches!(self.phase, Phase::Dwell) => {
                ended = Some(self.complete(sample.time, listener));
            }
            _ => {}
        }
        self.average = Some(DwellAverage::begin(&self.coefficients, sample));
        ended
    }

    /// Tests the tilt once there are enough samples and a force, then goes to the first position.
    fn level(&mut self, now: Instant, listener: Listener) -> Request {
        let is_long = |average: &&DwellAverage<SECTIONS>| average.count() >= self.timing.level;
        let Some(average) = self.average.as_ref().filter(is_long) else { return Request::Continue };
        let Some(force) = average.force() else {
            let is_silent = average.count() >= self.timing.forceless;
            return if is_silent { self.conclude(Some(FORCELESS)) } else { Request::Continue };
        };
        listener(alignment::Progress::levelled(force));
        let ([x, y, _], site) = (force, &self.setting.site);
        if let Err(reason) = site.check_tilt(libm::hypot(x.0, y.0) / site.latitude.gravity().0) {
            return self.conclude(Some(reason));
        }
        if let Some(survey) = self.procedure.survey.filter(|_| self.surveyed.is_none()) {
            listener(Stepwise(Progress::Surveying(survey.seconds)));
            self.store.begin_survey();
            self.phase = Phase::Survey;
            self.average = None;
            return Request::Continue;
        }
        if self.stands_at_target() {
            self.phase = Phase::Dwell;
            return Request::Continue;
        }
        self.send(now)
    }

    /// Sends the stage to the target.
    fn send(&mut self, now: Instant) -> Request {
        self.phase = Phase::Rotate(now);
        Request::Point(self.target.position.angle)
    }

    /// Whether the running average began at the commanded angle.
    fn stands_at_target(&self) -> bool {
        let (stage, arrival) = (self.target.stage, self.timing.arrival);
        self.average.as_ref().is_some_and(|average| average.stands_at(stage, arrival))
    }

    /// Ends the dwell when its time is over.
    fn dwell(&mut self, now: Instant, listener: Listener) -> Request {
        let count = self.average.as_ref().map_or(0, DwellAverage::count);
        if count < self.target.samples { Request::Continue } else { self.complete(now, listener) }
    }

    /// Waits until the stage stands at the commanded angle; refuses when that takes too long.
    fn rotate(&mut self, sample: &Sample, since: Instant) -> Request {
        let count = self.average.as_ref().map_or(0, DwellAverage::count);
        if self.stands_at_target() && count > 1 && count >= self.timing.settle {
            self.phase = Phase::Dwell;
        } else if sample.time.0.saturating_sub(since.0) > self.timing.longest_rotation {
            let [target, actual] =
                [self.target.stage, sample.stage].map(|a| Degrees(a.rad() / TURN * 360.0));
            return self.conclude(Some(Refusal::StageNotThere { target, actual }.into()));
        }
        Request::Continue
    }

    /// Takes the dwell in progress, or orders its repetition. A dwell that an uncommanded motion of
    /// the stage cut short is begun again at its position.
    fn complete(&mut self, now: Instant, listener: Listener) -> Request {
        if let Some(reason) = self.wrong_period() {
            return self.conclude(Some(reason));
        }
        let finished = self
            .average
            .take()
            .and_then(|average| average.finish(&self.coefficients, self.procedure.sample_seconds));
        let Some(dwell) = finished else { return self.send(now) };
        if !self.store.push(dwell) {
            return self.conclude(None);
        }
        match ExpectedScatter::of(&self.setting, self.dwells()).disturbance(&dwell) {
            Some(why) if self.tries < self.procedure.retries => self.repeat(why, listener),
            _ => {
                let request = self.go_on(now);
                self.report(&dwell, listener);
                request
            }
        }
    }

    /// Refusal of samples whose time stamps contradict the configured period.
    fn wrong_period(&self) -> Option<alignment::Refusal> {
        let Procedure { sample_seconds, period_tolerance, .. } = self.procedure;
        let step = self.average.as_ref().and_then(DwellAverage::step)?;
        contradiction(sample_seconds, step, period_tolerance)
    }

    /// Discards the last dwell; the stage stays, and the next sample begins the dwell anew.
    fn repeat(&mut self, why: Disturbance, listener: Listener) -> Request {
        self.store.pop();
        self.tries += 1;
        listener(Stepwise(Progress::Repeated(self.dwells().len() + 1, why)));
        // A full record omits one more repetition, never a dwell.
        let _ = self.repetitions.push(Repetition { position: self.dwells().len(), why });
        Request::Continue
    }

    /// Reports a completed dwell, and whether it was shorter than planned.
    fn report(&self, dwell: &Dwell, listener: Listener) {
        listener(Stepwise(Progress::Dwelled(self.dwells().len(), self.planned(), dwell.rate)));
        if dwell.seconds.0 < WHOLE * self.procedure.schedule.shortest().0 {
            listener(Stepwise(Progress::CutShort(dwell.seconds)));
        }
    }

    /// Sends the stage to the next position, or concludes.
    fn go_on(&mut self, now: Instant) -> Request {
        self.tries = 0;
        if let StopRule::Accuracy { seconds } = self.procedure.stop {
            return self.go_on_until(seconds, now);
        }
        let sigma = self.difference_sigma();
        let (schedule, dwells) = (&self.procedure.schedule, self.store.dwells());
        let stops = schedule
            .last_difference(dwells, sigma)
            .is_some_and(|difference| self.procedure.stop.stops(difference, sigma));
        let [low, high] = self.procedure.travel;
        match schedule.next(dwells, sigma) {
            Some(next) if !stops && (low..=high).contains(&next.angle) => self.go_to(next, now),
            _ => self.conclude(None),
        }
    }

    /// Makes a position the next target and sends the stage there.
    fn go_to(&mut self, position: Position, now: Instant) -> Request {
        self.target = Target::new(position, self.procedure.sample_seconds);
        self.send(now)
    }

    /// Standard deviation of the difference of two dwells, 1σ.
    fn difference_sigma(&self) -> RadiansPerSecond {
        let white = ExpectedScatter::of(&self.setting, self.dwells()).white;
        RadiansPerSecond(libm::sqrt(2.0 * white / self.procedure.schedule.shortest().0))
    }

    /// Ends the session with the dwells so far, or with a reason that further dwells cannot remove.
    fn conclude(&mut self, reason: Option<alignment::Refusal>) -> Request {
        self.compute_later(Task::Conclude(reason))
    }

    /// Passes samples by until this is computed.
    fn compute_later(&mut self, task: Task) -> Request {
        self.phase = Phase::Compute(task);
        Request::Compute
    }

    /// Draws the conclusion.
    #[inline(never)]
    fn draw(&mut self, reason: Option<alignment::Refusal>) {
        let conclusion = self.conclusion.insert(Conclusion::default());
        conclusion.draw(&self.setting, self.store.dwells(), self.procedure.criterion);
        if let Some(reason) = reason {
            conclusion.verdict = Err(reason);
        }
    }

    /// Ends the session with a conclusion that was drawn, and reports it.
    fn finish(&mut self, listener: Listener) -> Request {
        self.phase = Phase::Done;
        let disturbances = self.conclusion.iter().flat_map(|conclusion| &conclusion.disturbances);
        for (number, why) in (1..).zip(disturbances) {
            if let Some(why) = why {
                listener(Stepwise(Progress::LeftOut(number, *why)));
            }
        }
        Request::Done
    }
}

impl Method<Sample> for Session {
    fn begin(&mut self, listener: Listener) -> Request {
        if self.begun.is_some() || self.conclusion.is_some() {
            self.restart();
        }
        let dwell = self.procedure.schedule.shortest();
        let (positions, latitude) = (self.planned(), self.setting.site.latitude);
        listener(Stepwise(Progress::Begun { positions, dwell, latitude }));
        match self.setting.site.check_latitude() {
            Ok(()) => Request::Continue,
            Err(reason) => self.conclude(Some(reason)),
        }
    }

    fn take(&mut self, input: Input<'_, Sample>, listener: Listener) -> Request {
        match input {
            _ if matches!(self.phase, Phase::Done) => Request::Done,
            _ if matches!(self.phase, Phase::Compute(_)) => Request::Continue,
            Input::Sample(sample) => self.sample(sample, listener),
            Input::Sway(sway) => {
                self.setting.sway = *sway;
                Request::Continue
            }
            Input::Displaced(_) => Request::Continue,
            Input::End => self.conclude(None),
            Input::Failed(reason) => self.conclude(Some(*reason)),
        }
    }

    fn compute(&mut self, listener: Listener) -> Request {
        let Phase::Compute(task) = self.phase else { return Request::Continue };
        match task {
            Task::Learn(now) => self.learn(now, listener),
            Task::Weigh(seconds, now) => self.weigh(seconds, now, listener),
            Task::Conclude(reason) => {
                self.draw(reason);
                self.finish(listener)
            }
        }
    }

    fn required_sigma(&self) -> Option<Radians> {
        Some(self.setting.site.required_sigma)
    }

    fn verdict(&self) -> Option<Verdict> {
        let conclusion = self.conclusion.as_ref().filter(|_| matches!(self.phase, Phase::Done))?;
        let limit = conclusion.fit.as_ref().map(|fit| fit.limit).unwrap_or_default();
        Some(conclusion.verdict.map(|azimuth| Solution { azimuth, limit }))
    }
}
