//! The procedure of a platform that turns all the time, as a state machine without I/O.
//!
//! ```text
//!  level ─▶ [ uneven turn ─▶ clockwise ─▶ counter-clockwise ] each speed ─▶ azimuth ± σ, or why none
//! ```
//!
//! It commands the platform's rate, but judges by the encoder alone what the platform did: a recording
//! replays the same session.

use heapless::Vec;

use super::procedure::ProcedureError;
use crate::align::etalon::Table;
use crate::align::rotating::Setting;
use crate::align::rotating::conclusion::Conclusion;
use crate::align::rotating::coupling::Coupling;
use crate::align::rotating::follower::{Follower, Mode};
use crate::align::rotating::solution::SPEEDS;
use crate::align::rotating::turn::{Sense, Stretch};
use crate::error::Refusal;
use crate::signal::Sample;
use crate::units::{DEGREES_PER_RADIAN as DEGREES, Instant, TURN};

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

/// How the session goes about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Procedure {
    /// Speeds, rad/s, > 0, one or two.
    pub speeds: Vec<f64, SPEEDS>,
    /// Even turns in either sense at each speed, two at least.
    pub turns: u32,
    /// Turns that are uneven on purpose before them; zero where the stored couplings are to do.
    pub uneven_turns: u32,
    /// Amplitude of their modulation over the speed.
    pub modulation: f64,
    /// Sample period, s.
    pub sample_seconds: f64,
    /// Length of the blocks to which samples are averaged, s.
    pub block_seconds: f64,
    /// How long the platform is levelled at rest, s.
    pub level_seconds: f64,
    /// How long the platform needs to take on any speed, s.
    pub ramp_seconds: f64,
    /// Date, s since 1970, with which a coupling is stored; zero where nobody knows.
    pub date: u64,
}

/// Frequencies of the modulation over that of the turn: far enough from it to be told apart in twelve
/// turns, and on both sides, so that what a sensor does between them is what it does at the turn.
const TONES: [f64; 2] = [0.83, 1.17];
/// Between two commands of an uneven turn, µs.
const COMMAND_PERIOD: u64 = 20_000;
/// How often more time than planned a stretch may take, and how much more, s.
const PATIENCE: (f64, f64) = (2.0, 30.0);
/// Sample periods that make a gap.
const GAP: f64 = 3.5;

impl Procedure {
    /// Speeds with a default number of turns: three minutes in either sense, twelve uneven turns modulated
    /// by a quarter.
    #[must_use]
    pub fn new(speeds: &[f64], sample_seconds: f64) -> Self {
        let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let turns = libm::ceil(DEFAULT_SECONDS * slowest / TURN).clamp(2.0, 1e6) as u32;
        Self {
            speeds: speeds.iter().copied().take(SPEEDS).collect(),
            turns,
            uneven_turns: 12,
            modulation: 0.25,
            sample_seconds,
            block_seconds: BLOCK_SECONDS.max(BLOCK_ANGLE / slowest),
            level_seconds: 2.0,
            ramp_seconds: 3.0,
            date: 0,
        }
    }

    /// Whatever a recording with this sample period shows.
    #[must_use]
    pub fn recorded(sample_seconds: f64) -> Self {
        Self { block_seconds: BLOCK_SECONDS, ..Self::new(&[], sample_seconds) }
    }

    /// Sample periods in a block.
    fn periods(&self) -> u32 {
        libm::round(self.block_seconds / self.sample_seconds).clamp(1.0, 1e6) as u32
    }

    /// Rate of the platform `time` s into an uneven turn, rad/s.
    fn uneven_rate(&self, speed: f64, time: f64) -> f64 {
        let tones: f64 = TONES.iter().map(|tone| libm::sin(tone * speed * time)).sum();
        speed * (1.0 + self.modulation / TONES.len() as f64 * tones)
    }
}

/// Default time in either sense, s.
const DEFAULT_SECONDS: f64 = 180.0;
/// Length of a block: what the platform turns meanwhile costs 1e-4 of the signal.
const BLOCK_SECONDS: f64 = 0.02;
/// The least that the platform turns in a block, rad: a tenth of a degree, so that the encoder's steps
/// are small.
const BLOCK_ANGLE: f64 = 0.1 / 360.0 * TURN;

/// One alignment on a turning platform.
#[derive(Clone, Debug)]
pub struct Session {
    setting: Setting,
    procedure: Procedure,
    follower: Follower,
    phase: Phase,
    /// When the phase began, and when the last command was given.
    since: Option<Instant>,
    commanded: Instant,
    last: Option<Instant>,
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
            follower: Follower::new(procedure.periods(), mode),
            procedure,
            phase: if is_recorded { Phase::Recorded } else { Phase::Level },
            since: None,
            commanded: Instant::default(),
            last: None,
            turns: 0,
            level: Level::default(),
            conclusion: None,
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
    pub fn follower(&self) -> &Follower {
        &self.follower
    }

    /// Even turns done, and planned.
    #[must_use]
    pub fn turns(&self) -> (u32, u32) {
        let done = self.follower.stretches().iter().map(Stretch::count).sum();
        (done, 2 * self.procedure.turns * self.procedure.speeds.len() as u32)
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
        let found = self.follower.uneven().iter();
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
        if now.0.saturating_sub(last.0) as f64 * 1e-6 > GAP * self.procedure.sample_seconds {
            self.follower.restart();
        }
        if let Some(temperature) = sample.temperature {
            self.level.temperature = Some(temperature.celsius() as f32);
        }
        let has_turned = self.follower.push(sample, turning);
        let since = *self.since.get_or_insert(now);
        let elapsed = now.0.saturating_sub(since.0);
        match self.phase {
            Phase::Level => self.level(sample, elapsed),
            Phase::Uneven(index) => self.uneven(index, now, elapsed),
            Phase::Settle(index, sense) => self.settle(index, sense, elapsed),
            Phase::Even(index, sense) => self.even(index, sense, has_turned, elapsed),
            Phase::Recorded | Phase::Done => Command::Wait,
        }
    }

    /// Looks at the tilt at rest.
    fn level(&mut self, sample: &Sample, elapsed: u64) -> Command {
        if let Some(force) = sample.force {
            for (sum, part) in self.level.sums.iter_mut().zip(force) {
                *sum += i64::from(part.0);
            }
            self.level.count += 1;
        }
        if !is_over(elapsed, self.procedure.level_seconds) {
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

    /// Turns unevenly, for so many turns once the sensor has settled.
    fn uneven(&mut self, index: usize, now: Instant, elapsed: u64) -> Command {
        let (speed, settle) = (self.speed(index), self.settle_seconds());
        let seconds = f64::from(self.procedure.uneven_turns) * TURN / speed;
        if is_over(elapsed, settle + seconds) {
            return self.end_uneven(index);
        }
        if now.0.saturating_sub(self.commanded.0) < COMMAND_PERIOD {
            return Command::Wait;
        }
        self.commanded = now;
        if self.follower.mode() == Mode::Ignore && is_over(elapsed, settle) {
            self.follower.follow(Mode::Uneven);
        }
        Command::Turn(self.procedure.uneven_rate(speed, elapsed as f64 * 1e-6))
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
        if is_over(elapsed, self.settle_seconds()) {
            self.enter(Phase::Even(index, sense), Mode::Even);
        }
        Command::Wait
    }

    /// Turns until the turns are full; gives up where that takes far too long.
    fn even(&mut self, index: usize, sense: Sense, has_turned: bool, elapsed: u64) -> Command {
        self.turns += u32::from(has_turned);
        if self.turns >= self.procedure.turns {
            return self.go_on(index, sense);
        }
        let planned = f64::from(self.procedure.turns) * TURN / self.speed(index);
        if is_over(elapsed, PATIENCE.0 * planned + PATIENCE.1) {
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
        self.since = None;
        self.turns = 0;
        self.follower.follow(mode);
    }

    /// A speed, rad/s.
    fn speed(&self, index: usize) -> f64 {
        self.procedure.speeds.get(index).copied().unwrap_or_default()
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
            self.follower.finish();
            conclusion.draw(&self.setting, &self.follower);
        }
        self.phase = Phase::Done;
        Command::Finished
    }
}

/// Whether so many µs are more than so many s.
fn is_over(elapsed: u64, seconds: f64) -> bool {
    elapsed as f64 * 1e-6 >= seconds
}

/// What a procedure must be.
///
/// # Errors
/// As [`Session::new`].
pub fn check(procedure: &Procedure) -> Result<(), ProcedureError> {
    Table::built_in().verify().map_err(|_| ProcedureError::TableCorrupt)?;
    let are_speeds = procedure.speeds.iter().all(|speed| *speed > 0.0 && speed.is_finite());
    let is_uneven = procedure.uneven_turns == 0 || procedure.modulation > 0.0;
    let has_turns = procedure.turns >= 2;
    let has_period = procedure.sample_seconds > 0.0 && procedure.sample_seconds.is_finite();
    if are_speeds && is_uneven && has_turns && has_period {
        Ok(())
    } else {
        Err(ProcedureError::NoSpeed)
    }
}
