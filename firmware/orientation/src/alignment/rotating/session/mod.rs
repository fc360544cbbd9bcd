//! Procedure of a continuously rotating platform (carouselling) as a state machine without I/O.
//!
//! ```text
//!  level ─▶ [ modulated ─▶ clockwise ─▶ counter-clockwise ] each speed ─▶ azimuth ± σ, or why none
//! ```
//!
//! It commands the platform's rate, but takes the motion from the encoder alone, so that a
//! recording replays the same session.

mod procedure;

pub use procedure::Procedure;

use super::conclusion::Conclusion;
use super::misalignment::AxisMisalignment;
use super::turn::{Sense, Stretch};
use super::turn_accumulator::{Mode, TurnAccumulator};
use super::{Progress, Refusal, Setting};
use crate::alignment::period::contradiction;
use crate::alignment::progress::Progress::Rotating;
use crate::alignment::{self, Input, Listener, Method, Request, SetupError, Solution, Verdict};
use crate::signal::Sample;
use crate::units::{
    Angle, Instant, MetresPerSecondSquared, Radians, RadiansPerSecond, Seconds, TURN,
};

/// State of the session; speeds are given by their index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Phase {
    /// The tilt is measured before anything turns.
    Level,
    /// The platform makes rate-modulated turns at a speed.
    Modulated(usize),
    /// The platform accelerates to a speed, and the sensor settles.
    Settle(usize, Sense),
    /// The platform turns at constant rate.
    Even(usize, Sense),
    /// A recording is processed, whatever it contains.
    Recorded,
    /// Samples are passed by until the conclusion is drawn.
    Conclude,
    /// The session is over.
    Done,
}

/// Time between two commands of a rate-modulated turn, µs.
const COMMAND_PERIOD: u64 = 20_000;
/// Time allowed for a stretch: factor on its planned time, and additional time, s.
const ALLOWANCE: (f64, f64) = (2.0, 30.0);
/// Distance of two samples, in sample periods, that counts as a gap.
const GAP: f64 = 3.5;

/// One alignment on a rotating platform.
#[derive(Clone, Debug)]
pub struct Session {
    /// Configuration of the alignment.
    pub setting: Setting,
    /// Procedure.
    pub procedure: Procedure,
    /// Accumulator of the turns that have been made.
    pub turn_accumulator: TurnAccumulator,
    /// State of the session.
    phase: Phase,
    /// State within the phase.
    now: Now,
    /// Time of the latest command.
    commanded: Instant,
    /// Time of the latest sample.
    last: Option<Instant>,
    /// Distance of two samples that counts as a gap, µs.
    gap: u64,
    /// Forces at rest.
    level: Level,
    /// Conclusion, once the session is over.
    conclusion: Option<Conclusion>,
}

/// State within a phase, which begins anew with each.
#[derive(Clone, Copy, Debug, Default)]
struct Now {
    /// Beginning of the phase.
    since: Option<Instant>,
    /// Number of samples of this phase, and whether some of it are missing.
    samples: u32,
    has_gap: bool,
    /// Time in this phase after which the sensor has settled, and after which the phase ends, µs.
    settled: u64,
    end: u64,
    /// Beginning and encoder angle of the turn whose speed is measured, and the measured rate,
    /// rad/s; zero before.
    measured: Option<(Instant, Angle)>,
    rate: f64,
    /// Number of turns of this phase.
    turns: u32,
}

/// Sums of the forces at rest, µm/s², and the latest temperature.
#[derive(Clone, Copy, Debug, Default)]
struct Level {
    sums: [i64; 3],
    count: u32,
    temperature: Option<f32>,
}

impl Session {
    /// Creates a session before its first event.
    ///
    /// # Errors
    /// [`SetupError::TableCorrupt`], [`SetupError::OutOfRange`], and [`SetupError::NoSpeed`] for a
    /// speed of zero, too few turns or no modulation.
    pub fn new(setting: Setting, procedure: Procedure) -> Result<Self, SetupError> {
        setting.check()?;
        procedure.check()?;
        Ok(Self::of(setting, procedure))
    }

    /// Session of a procedure that was checked, built at its final place in memory.
    #[must_use]
    pub fn of(setting: Setting, procedure: Procedure) -> Self {
        let is_recorded = procedure.speeds.is_empty();
        let mode = if is_recorded { Mode::Recorded } else { Mode::Ignore };
        Self {
            setting,
            turn_accumulator: TurnAccumulator::new(procedure.periods(), mode),
            phase: if is_recorded { Phase::Recorded } else { Phase::Level },
            now: Now { end: microseconds(procedure.level_seconds.0), ..Now::default() },
            commanded: Instant::default(),
            last: None,
            gap: microseconds(GAP * procedure.sample_seconds.0),
            level: Level::default(),
            conclusion: None,
            procedure,
        }
    }

    /// Takes a sample of a recording, with the platform's rate that was recorded beside it, rad/s.
    pub fn take_recorded(&mut self, sample: &Sample, turning: f32) -> Request {
        if self.phase != Phase::Recorded {
            return Request::Done;
        }
        self.sample(sample, Some(turning), &mut |_| ())
    }

    /// Number of turns at constant rate that are done, and planned.
    #[must_use]
    pub fn turns(&self) -> (u32, u32) {
        let done = self.turn_accumulator.stretches.iter().map(Stretch::count).sum();
        let speeds = 0..self.procedure.speeds.len();
        (done, speeds.map(|index| 2 * self.procedure.turns_at(index)).sum())
    }

    /// Mean force at rest; none without force readings.
    pub(crate) fn force(&self) -> Option<[MetresPerSecondSquared; 3]> {
        let count = f64::from(self.level.count);
        let mean = |sum| MetresPerSecondSquared(sum as f64 * 1e-6 / count);
        (count > 0.0).then(|| self.level.sums.map(mean))
    }

    /// Axis misalignments that were measured, with date and temperature, to be stored.
    pub fn misalignments(&self) -> impl Iterator<Item = AxisMisalignment> {
        let temperature = self.level.temperature.unwrap_or(f32::NAN);
        let found = self.turn_accumulator.modulated.iter();
        found
            .filter_map(|stretch| stretch.misalignment(self.setting.site.noise.model()))
            .map(move |it| AxisMisalignment { date: self.procedure.date, temperature, ..it })
    }

    /// Conclusion; `None` until the session is over.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.conclusion.as_ref()
    }

    /// Processes a sample.
    fn sample(&mut self, sample: &Sample, turning: Option<f32>, listener: Listener) -> Request {
        let now = sample.time;
        let last = self.last.replace(now).unwrap_or(now);
        if now.0.saturating_sub(last.0) > self.gap {
            self.turn_accumulator.restart();
            self.now.has_gap = true;
        }
        if let Some(temperature) = sample.temperature {
            self.level.temperature = Some(temperature.celsius() as f32);
        }
        let has_turned = self.turn_accumulator.push(sample, turning);
        let since = *self.now.since.get_or_insert(now);
        let elapsed = now.0.saturating_sub(since.0);
        self.now.samples = self.now.samples.saturating_add(1);
        let is_even = matches!(self.phase, Phase::Recorded | Phase::Even(..));
        let is_first = is_even && has_turned && self.now.turns == 0;
        if is_first && let Some(reason) = self.contradiction() {
            return self.conclude(Some(reason));
        }
        match self.phase {
            Phase::Level => self.level(sample, elapsed, listener),
            Phase::Modulated(index) => self.modulated(index, sample, elapsed, listener),
            Phase::Settle(index, sense) => self.settle(index, sense, elapsed, listener),
            Phase::Even(index, sense) => self.even(index, sense, (has_turned, elapsed), listener),
            Phase::Recorded => {
                self.now.turns += u32::from(has_turned);
                Request::Continue
            }
            Phase::Conclude | Phase::Done => Request::Continue,
        }
    }

    /// Refusal of samples whose time stamps in this phase contradict the configured period, unless some are missing.
    fn contradiction(&self) -> Option<alignment::Refusal> {
        let (since, last) = (self.now.since?, self.last?);
        let elapsed = last.0.saturating_sub(since.0) as f64 * 1e-6;
        let found = elapsed / f64::from(self.now.samples.max(2) - 1);
        let Procedure { sample_seconds, period_tolerance, .. } = self.procedure;
        contradiction(sample_seconds, Seconds(found), period_tolerance)
            .filter(|_| !self.now.has_gap)
    }

    /// Measures the tilt at rest.
    fn level(&mut self, sample: &Sample, elapsed: u64, listener: Listener) -> Request {
        if let Some(force) = sample.force {
            for (sum, part) in self.level.sums.iter_mut().zip(force) {
                *sum += i64::from(part.0);
            }
            self.level.count += 1;
        }
        if elapsed < self.now.end {
            return Request::Continue;
        }
        if let Some(reason) = self.contradiction() {
            return self.conclude(Some(reason));
        }
        let (site, force) = (&self.setting.site, self.force());
        if let Some(force) = force {
            listener(alignment::Progress::levelled(force));
        }
        let [x, y, _] = force.unwrap_or_default();
        match site.check_tilt(libm::hypot(x.0, y.0) / site.latitude.gravity().0) {
            Ok(()) => self.begin_speed(0, listener),
            Err(reason) => self.conclude(Some(reason)),
        }
    }

    /// Begins with a speed: with rate-modulated turns first, where they are configured.
    fn begin_speed(&mut self, index: usize, listener: Listener) -> Request {
        if self.procedure.modulated_turns == 0 {
            return self.begin_sense(index, Sense::Clockwise);
        }
        // The first ramp is part of the rate-modulated motion.
        self.enter(Phase::Modulated(index), Mode::Ignore);
        listener(Rotating(Progress::Modulated(self.speed(index))));
        Request::Turn(self.speed(index))
    }

    /// Turns once at constant rate to measure the speed, then rate-modulated for the configured
    /// number of turns once the sensor has settled.
    fn modulated(
        &mut self,
        index: usize,
        sample: &Sample,
        elapsed: u64,
        listener: Listener,
    ) -> Request {
        if self.now.rate <= 0.0 {
            self.measure(index, sample, elapsed);
            return Request::Continue;
        }
        if elapsed >= self.now.end {
            return self.end_modulated(index, listener);
        }
        if sample.time.0.saturating_sub(self.commanded.0) < COMMAND_PERIOD {
            return Request::Continue;
        }
        self.commanded = sample.time;
        if self.turn_accumulator.mode == Mode::Ignore && elapsed >= self.now.settled {
            self.turn_accumulator.follow_modulated(self.procedure.modulation_width());
        }
        let time = (elapsed as f64 - self.now.settled as f64) * 1e-6;
        let rate = self.procedure.modulated_rate(self.speed(index).0, self.now.rate, time);
        Request::Turn(RadiansPerSecond(rate))
    }

    /// Measures the platform's speed by the encoder over one turn: a motor driver's clock may be
    /// off by some per cent, and the modulation must stay synchronous with the turns.
    fn measure(&mut self, index: usize, sample: &Sample, elapsed: u64) {
        let Some((since, stage)) = self.now.measured else {
            if elapsed >= microseconds(self.procedure.ramp_seconds.0) {
                self.now.measured = Some((sample.time, sample.stage));
            }
            return;
        };
        let seconds = sample.time.0.saturating_sub(since.0) as f64 * 1e-6;
        if seconds < TURN / self.speed(index).0 {
            return;
        }
        self.now.rate = (TURN + (sample.stage - stage).signed_rad()) / seconds;
        self.now.since = Some(sample.time);
        self.now.end = self.now.settled
            + microseconds(f64::from(self.procedure.modulated_turns) * TURN / self.now.rate);
    }

    /// Ends the session where the axis misalignment is too large, or the platform did not turn.
    fn end_modulated(&mut self, index: usize, listener: Listener) -> Request {
        let Some(misalignment) = self.misalignments().nth(index) else {
            let wanted = self.speed(index).into();
            return self.conclude(Some(Refusal::PlatformStopped { wanted }.into()));
        };
        let [angle, sigma] = [misalignment.angle(), Radians(misalignment.sine_sigma)];
        listener(Rotating(Progress::Misalignment(angle, sigma)));
        match self.setting.accept(&misalignment) {
            Ok(()) => self.begin_sense(index, Sense::Clockwise),
            Err(reason) => self.conclude(Some(reason)),
        }
    }

    /// Begins a sense of rotation at a speed.
    fn begin_sense(&mut self, index: usize, sense: Sense) -> Request {
        self.enter(Phase::Settle(index, sense), Mode::Ignore);
        Request::Turn(RadiansPerSecond(sense.signed(self.speed(index).0)))
    }

    /// Waits until platform and sensor have settled.
    fn settle(&mut self, index: usize, sense: Sense, elapsed: u64, listener: Listener) -> Request {
        if elapsed >= self.now.end {
            self.enter(Phase::Even(index, sense), Mode::Even);
            listener(Rotating(Progress::Stretch(sense, self.speed(index))));
        }
        Request::Continue
    }

    /// Counts turns until all are done; refuses when that takes far too long.
    fn even(
        &mut self,
        index: usize,
        sense: Sense,
        (has_turned, elapsed): (bool, u64),
        listener: Listener,
    ) -> Request {
        // The number of planned turns is computed only with a complete turn: it costs 600
        // instructions.
        if has_turned {
            self.now.turns += 1;
            let (done, of) = self.turns();
            listener(Rotating(Progress::Turned(done, of)));
            if self.now.turns >= self.procedure.turns_at(index) {
                return self.go_on(index, sense, listener);
            }
        }
        if elapsed >= self.now.end {
            let wanted = RadiansPerSecond(sense.signed(self.speed(index).0)).into();
            return self.conclude(Some(Refusal::PlatformStopped { wanted }.into()));
        }
        Request::Continue
    }

    /// Goes on to the other sense, to the next speed, or to the conclusion.
    fn go_on(&mut self, index: usize, sense: Sense, listener: Listener) -> Request {
        if sense == Sense::Clockwise {
            return self.begin_sense(index, Sense::CounterClockwise);
        }
        if index + 1 < self.procedure.speeds.len() {
            return self.begin_speed(index + 1, listener);
        }
        self.conclude(None)
    }

    /// Enters a phase and restarts its counters.
    fn enter(&mut self, phase: Phase, mode: Mode) {
        self.phase = phase;
        let settled = microseconds(self.settle_seconds());
        self.now = Now { settled, end: microseconds(self.longest(phase)), ..Now::default() };
        self.turn_accumulator.follow(mode);
    }

    /// Speed with this index; zero beyond the last.
    fn speed(&self, index: usize) -> RadiansPerSecond {
        self.procedure.speeds.get(index).copied().unwrap_or_default()
    }

    /// Longest time of a phase, s.
    fn longest(&self, phase: Phase) -> f64 {
        match phase {
            Phase::Settle(..) => self.settle_seconds(),
            Phase::Even(index, _) => {
                let turned = f64::from(self.procedure.turns_at(index)) * TURN;
                ALLOWANCE.0 * turned / self.speed(index).0 + ALLOWANCE.1
            }
            // The end of a rate-modulated stretch follows from the speed that it measures.
            _ => 0.0,
        }
    }

    /// Time after a change of speed that is not used, s.
    fn settle_seconds(&self) -> f64 {
        self.procedure.ramp_seconds.0 + self.setting.sensor.settle_seconds.0
    }

    /// Ends the session with the turns so far, or at once with a reason.
    fn conclude(&mut self, reason: Option<alignment::Refusal>) -> Request {
        let conclusion = self.conclusion.insert(Conclusion::default());
        if let Some(reason) = reason {
            conclusion.verdict = Err(reason);
            self.phase = Phase::Done;
            return Request::Done;
        }
        self.phase = Phase::Conclude;
        Request::Compute
    }

    /// Whether the axis misalignment is known, or need not be: it is negligible by the sensor's
    /// statement, will be estimated by rate-modulated turns, or is known from a calibration.
    fn is_misalignment_settled(&self) -> bool {
        let is_known = self.setting.misalignments.iter().any(Option::is_some);
        self.setting.sensor.is_flat || self.procedure.modulated_turns > 0 || is_known
    }

    /// Resets the session in place for another alignment.
    fn restart(&mut self) {
        self.phase = Phase::Level;
        self.turn_accumulator.clear();
        self.level = Level::default();
        self.now = Now { end: microseconds(self.procedure.level_seconds.0), ..Now::default() };
        (self.commanded, self.last, self.conclusion) = (Instant::default(), None, None);
    }
}

impl Method<Sample> for Session {
    fn begin(&mut self, listener: Listener) -> Request {
        if self.last.is_some() || self.conclusion.is_some() {
            self.restart();
        }
        let ((_, turns), latitude) = (self.turns(), self.setting.site.latitude);
        listener(Rotating(Progress::Begun { turns, latitude }));
        match self.setting.site.check_latitude() {
            Err(reason) => self.conclude(Some(reason)),
            Ok(()) if self.is_misalignment_settled() => Request::Continue,
            Ok(()) => self.conclude(Some(alignment::Refusal::MisalignmentUnknown)),
        }
    }

    fn take(&mut self, input: Input<'_, Sample>, listener: Listener) -> Request {
        match input {
            _ if self.phase == Phase::Done => Request::Done,
            _ if self.phase == Phase::Conclude => Request::Continue,
            Input::Sample(sample) => self.sample(sample, None, listener),
            Input::Sway(_) | Input::Displaced(_) => Request::Continue,
            Input::End => self.conclude(None),
            Input::Failed(reason) => self.conclude(Some(*reason)),
        }
    }

    fn misalignment(&self, speed: usize) -> Option<AxisMisalignment> {
        self.misalignments().nth(speed)
    }

    fn compute(&mut self, listener: Listener) -> Request {
        let Some(conclusion) = self.conclusion.as_mut().filter(|_| self.phase == Phase::Conclude)
        else {
            return Request::Continue;
        };
        self.turn_accumulator.finish();
        conclusion.draw(&self.setting, &self.turn_accumulator);
        for average in conclusion.pairs.iter().flat_map(|pair| [&pair.clockwise, &pair.counter]) {
            if average.left_out > 0 {
                listener(Rotating(Progress::LeftOut(average.left_out, average.sense)));
            }
        }
        self.phase = Phase::Done;
        Request::Done
    }

    fn required_sigma(&self) -> Option<Radians> {
        Some(self.setting.site.required_sigma)
    }

    fn verdict(&self) -> Option<Verdict> {
        let conclusion = self.conclusion.as_ref().filter(|_| self.phase == Phase::Done)?;
        let limit = conclusion.fit.as_ref().map(|fit| fit.limit).unwrap_or_default();
        Some(conclusion.verdict.map(|azimuth| Solution { azimuth, limit }))
    }
}

/// Converts seconds to whole µs.
fn microseconds(seconds: f64) -> u64 {
    Instant::from_seconds(seconds).0
}
