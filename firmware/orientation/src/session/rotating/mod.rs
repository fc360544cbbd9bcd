//! The procedure of a platform that turns all the time, as a state machine without I/O.
//!
//! ```text
//!  level ─▶ [ uneven turn ─▶ clockwise ─▶ counter-clockwise ] each speed ─▶ azimuth ± σ, or why none
//! ```
//!
//! It commands the platform's rate, but judges by the encoder alone what the platform did: a recording
//! replays the same session.

mod procedure;

pub use procedure::{Procedure, check};

use super::procedure::{PERIOD_TOLERANCE, ProcedureError, contradiction};
use crate::align::rotating::Setting;
use crate::align::rotating::conclusion::Conclusion;
use crate::align::rotating::coupling::Coupling;
use crate::align::rotating::turn::{Sense, Stretch};
use crate::align::rotating::turn_accumulator::{Mode, TurnAccumulator};
use crate::error::Refusal;
use crate::signal::Sample;
use crate::units::{Angle, DEGREES_PER_RADIAN as DEGREES, Instant, TURN};

/// What happens to a session.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A sample, with a fresh angle of the encoder.
    Sample(&'a Sample),
    /// The same with the platform's rate as it was recorded, rad/s.
    Recorded(&'a Sample, f32),
    /// There will be no more.
    End,
    /// The instrument cannot go on.
    Failed(Refusal),
}

/// What the session asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Go on sampling.
    Wait,
    /// Turn the platform at this rate, rad/s, clockwise positive; zero: come to rest.
    Turn(f64),
    /// Nothing more: the conclusion stands.
    Finished,
}

/// Where the session is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// The tilt is looked at before anything turns.
    Level,
    /// The platform turns unevenly at a speed, the index of which this is.
    Uneven(usize),
    /// It takes on a speed, and the sensor settles.
    Settle(usize, Sense),
    /// It turns evenly.
    Even(usize, Sense),
    /// A recording is followed, whatever it shows.
    Recorded,
    /// The conclusion stands.
    Done,
}

/// Between two commands of an uneven turn, µs.
const COMMAND_PERIOD: u64 = 20_000;
/// How often more time than planned a stretch may take, and how much more, s.
const PATIENCE: (f64, f64) = (2.0, 30.0);
/// Sample periods that make a gap.
const GAP: f64 = 3.5;

/// One alignment on a turning platform.
#[derive(Clone, Debug)]
pub struct Session {
    setting: Setting,
    procedure: Procedure,
    turn_accumulator: TurnAccumulator,
    phase: Phase,
    /// When the phase began, and when the last command was given.
    since: Option<Instant>,
    commanded: Instant,
    last: Option<Instant>,
    /// Samples of this phase.
    samples: u32,
    /// After how long in this phase the sensor has settled, and the phase ends, µs.
    settled: u64,
    end: u64,
    /// When and where a turn began whose speed is measured, and what was found, rad/s; zero until then.
    measured: Option<(Instant, Angle)>,
    rate: f64,
    /// What makes a gap between two samples, µs.
    gap: u64,
    /// Turns of this phase.
    turns: u32,
    level: Level,
    conclusion: Option<Conclusion>,
}

/// Sums of the forces at rest, µm/s².
#[derive(Clone, Copy, Debug, Default)]
struct Level {
    sums: [i64; 3],
    count: u32,
    temperature: Option<f32>,
}

impl Session {
    /// A session that has not begun.
    ///
    /// # Errors
    /// [`ProcedureError::TableCorrupt`], and [`ProcedureError::NoSpeed`] for a speed that is none, too few
    /// turns or no modulation.
    pub fn new(setting: Setting, procedure: Procedure) -> Result<Self, ProcedureError> {
        check(&procedure)?;
        Ok(Self::of(setting, procedure))
    }

    /// The same of a procedure that was checked, so that it can be made where it is to lie.
    #[must_use]
    pub fn of(setting: Setting, procedure: Procedure) -> Self {
        let is_recorded = procedure.speeds.is_empty();
        let mode = if is_recorded { Mode::Recorded } else { Mode::Ignore };
        Self {
            setting,
            turn_accumulator: TurnAccumulator::new(procedure.periods(), mode),
            phase: if is_recorded { Phase::Recorded } else { Phase::Level },
            since: None,
            commanded: Instant::default(),
            last: None,
            samples: 0,
            settled: 0,
            measured: None,
            rate: 0.0,
            end: microseconds(procedure.level_seconds),
            gap: microseconds(GAP * procedure.sample_seconds),
            turns: 0,
            level: Level::default(),
            conclusion: None,
            procedure,
        }
    }

    /// Takes one event and answers what is to be done now.
    pub fn handle(&mut self, event: Event) -> Command {
        match event {
            _ if self.phase == Phase::Done => Command::Finished,
            Event::Sample(sample) => self.sample(sample, None),
            Event::Recorded(sample, turning) => self.sample(sample, Some(turning)),
            Event::End => self.conclude(None),
            Event::Failed(reason) => self.conclude(Some(reason)),
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

    /// What the platform did so far.
    #[must_use]
    pub fn turn_accumulator(&self) -> &TurnAccumulator {
        &self.turn_accumulator
    }

    /// Even turns done, and planned.
    #[must_use]
    pub fn turns(&self) -> (u32, u32) {
        let done = self.turn_accumulator.stretches().iter().map(Stretch::count).sum();
        let speeds = 0..self.procedure.speeds.len();
        (done, speeds.map(|index| 2 * self.procedure.turns_at(index)).sum())
    }

    /// Mean force at rest, m/s², where there was one.
    #[must_use]
    pub fn force(&self) -> Option<[f64; 3]> {
        let count = f64::from(self.level.count);
        (count > 0.0).then(|| self.level.sums.map(|sum| sum as f64 * 1e-6 / count))
    }

    /// The couplings that were found, with date and temperature: to be stored.
    pub fn couplings(&self) -> impl Iterator<Item = Coupling> {
        let temperature = self.level.temperature.unwrap_or(f32::NAN);
        let found = self.turn_accumulator.uneven().iter();
        found
            .filter_map(|uneven| uneven.coupling(&self.setting.common.noise))
            .map(move |coupling| Coupling { date: self.procedure.date, temperature, ..coupling })
    }

    /// The conclusion, once the session has finished.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.conclusion.as_ref()
    }

    fn sample(&mut self, sample: &Sample, turning: Option<f32>) -> Command {
        let now = sample.time;
        let last = self.last.replace(now).unwrap_or(now);
        if now.0.saturating_sub(last.0) > self.gap {
            self.turn_accumulator.restart();
        }
        if let Some(temperature) = sample.temperature {
            self.level.temperature = Some(temperature.celsius() as f32);
        }
        let has_turned = self.turn_accumulator.push(sample, turning);
        let since = *self.since.get_or_insert(now);
        let elapsed = now.0.saturating_sub(since.0);
        self.samples = self.samples.saturating_add(1);
        if has_turned && let Some(reason) = self.contradiction() {
            return self.conclude(Some(reason));
        }
        match self.phase {
            Phase::Level => self.level(sample, elapsed),
            Phase::Uneven(index) => self.uneven(index, sample, elapsed),
            Phase::Settle(index, sense) => self.settle(index, sense, elapsed),
            Phase::Even(index, sense) => self.even(index, sense, has_turned, elapsed),
            Phase::Recorded | Phase::Done => Command::Wait,
        }
    }

    /// Whether a recording's samples up to its first turn come at another pace than was told.
    fn contradiction(&mut self) -> Option<Refusal> {
        if self.phase != Phase::Recorded || core::mem::replace(&mut self.turns, 1) > 0 {
            return None;
        }
        let (since, last) = (self.since?, self.last?);
        let elapsed = last.0.saturating_sub(since.0) as f64 * 1e-6;
        let found = elapsed / f64::from(self.samples.max(2) - 1);
        let told = self.procedure.sample_seconds;
        contradiction(told, found, PERIOD_TOLERANCE)
    }

    /// Looks at the tilt at rest.
    fn level(&mut self, sample: &Sample, elapsed: u64) -> Command {
        if let Some(force) = sample.force {
            for (sum, part) in self.level.sums.iter_mut().zip(force) {
                *sum += i64::from(part.0);
            }
            self.level.count += 1;
        }
        if elapsed < self.end {
            return Command::Wait;
        }
        let common = &self.setting.common;
        let [x, y, _] = self.force().unwrap_or_default();
        let tilt = libm::asin((libm::hypot(x, y) / common.latitude.gravity()).min(1.0));
        if tilt > common.allowed_tilt {
            let [tilt, allowed] = [tilt, common.allowed_tilt].map(|angle| angle * DEGREES);
            return self.conclude(Some(Refusal::TiltTooGreat { tilt, allowed }));
        }
        self.begin_speed(0)
    }

    /// Begins with a speed: unevenly first, where that is wanted.
    fn begin_speed(&mut self, index: usize) -> Command {
        if self.procedure.uneven_turns == 0 {
            return self.begin_sense(index, Sense::Clockwise);
        }
        // Its first ramp is part of the unevenness.
        self.enter(Phase::Uneven(index), Mode::Ignore);
        Command::Turn(self.speed(index))
    }

    /// Turns once to know the speed, then unevenly: for so many turns once the sensor has settled.
    fn uneven(&mut self, index: usize, sample: &Sample, elapsed: u64) -> Command {
        if self.rate <= 0.0 {
            self.measure(index, sample, elapsed);
            return Command::Wait;
        }
        if elapsed >= self.end {
            return self.end_uneven(index);
        }
        if sample.time.0.saturating_sub(self.commanded.0) < COMMAND_PERIOD {
            return Command::Wait;
        }
        self.commanded = sample.time;
        if self.turn_accumulator.mode() == Mode::Ignore && elapsed >= self.settled {
            self.turn_accumulator.follow_uneven(self.procedure.modulation_width());
        }
        let time = (elapsed as f64 - self.settled as f64) * 1e-6;
        Command::Turn(self.procedure.uneven_rate(self.speed(index), self.rate, time))
    }

    /// Measures by the encoder how fast the platform turns, over the time of one turn: a motor driver's
    /// clock is some hundredths off, and the modulation must keep to the turns.
    fn measure(&mut self, index: usize, sample: &Sample, elapsed: u64) {
        let Some((since, stage)) = self.measured else {
            if elapsed >= microseconds(self.procedure.ramp_seconds) {
                self.measured = Some((sample.time, sample.stage));
            }
            return;
        };
        let seconds = sample.time.0.saturating_sub(since.0) as f64 * 1e-6;
        if seconds < TURN / self.speed(index) {
            return;
        }
        self.rate = (TURN + (sample.stage - stage).signed_rad()) / seconds;
        self.since = Some(sample.time);
        self.end =
            self.settled + microseconds(f64::from(self.procedure.uneven_turns) * TURN / self.rate);
    }

    /// Ends where the sensor stands badly, or the platform did not turn.
    fn end_uneven(&mut self, index: usize) -> Command {
        let Some(coupling) = self.couplings().nth(index) else {
            let wanted = self.speed(index) * DEGREES;
            return self.conclude(Some(Refusal::PlatformStopped { wanted }));
        };
        match self.setting.accept(&coupling) {
            Ok(()) => self.begin_sense(index, Sense::Clockwise),
            Err(reason) => self.conclude(Some(reason)),
        }
    }

    fn begin_sense(&mut self, index: usize, sense: Sense) -> Command {
        self.enter(Phase::Settle(index, sense), Mode::Ignore);
        Command::Turn(sense.signed(self.speed(index)))
    }

    fn settle(&mut self, index: usize, sense: Sense, elapsed: u64) -> Command {
        if elapsed >= self.end {
            self.enter(Phase::Even(index, sense), Mode::Even);
        }
        Command::Wait
    }

    /// Turns until the turns are full; gives up where that takes far too long.
    fn even(&mut self, index: usize, sense: Sense, has_turned: bool, elapsed: u64) -> Command {
        // How many there are to be is asked with a turn alone: it costs 600 instructions.
        if has_turned {
            self.turns += 1;
            if self.turns >= self.procedure.turns_at(index) {
                return self.go_on(index, sense);
            }
        }
        if elapsed >= self.end {
            let wanted = sense.signed(self.speed(index)) * DEGREES;
            return self.conclude(Some(Refusal::PlatformStopped { wanted }));
        }
        Command::Wait
    }

    fn go_on(&mut self, index: usize, sense: Sense) -> Command {
        if sense == Sense::Clockwise {
            return self.begin_sense(index, Sense::CounterClockwise);
        }
        if index + 1 < self.procedure.speeds.len() {
            return self.begin_speed(index + 1);
        }
        self.conclude(None)
    }

    fn enter(&mut self, phase: Phase, mode: Mode) {
        self.phase = phase;
        self.settled = microseconds(self.settle_seconds());
        self.end = microseconds(self.longest(phase));
        self.since = None;
        self.samples = 0;
        (self.measured, self.rate) = (None, 0.0);
        self.turns = 0;
        self.turn_accumulator.follow(mode);
    }

    /// A speed, rad/s.
    fn speed(&self, index: usize) -> f64 {
        self.procedure.speeds.get(index).copied().unwrap_or_default()
    }

    /// How long a phase lasts at most, s.
    fn longest(&self, phase: Phase) -> f64 {
        match phase {
            Phase::Settle(..) => self.settle_seconds(),
            Phase::Even(index, _) => {
                let turned = f64::from(self.procedure.turns_at(index)) * TURN;
                PATIENCE.0 * turned / self.speed(index) + PATIENCE.1
            }
            // An uneven turn's end follows from the speed that it measures.
            Phase::Uneven(_) | Phase::Level | Phase::Recorded | Phase::Done => 0.0,
        }
    }

    /// How long nothing counts after a change of speed, s.
    fn settle_seconds(&self) -> f64 {
        self.procedure.ramp_seconds + self.setting.sensor.settle_seconds
    }

    /// Ends the session with what there is, or with a reason.
    fn conclude(&mut self, reason: Option<Refusal>) -> Command {
        let conclusion = self.conclusion.insert(Conclusion::default());
        if let Some(reason) = reason {
            conclusion.verdict = Err(reason);
        } else {
            self.turn_accumulator.finish();
            conclusion.draw(&self.setting, &self.turn_accumulator);
        }
        self.phase = Phase::Done;
        Command::Finished
    }
}

/// Seconds as whole µs.
fn microseconds(seconds: f64) -> u64 {
    Instant::from_seconds(seconds).0
}
