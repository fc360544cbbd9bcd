//! A train with what goes wrong with it: caught and let go by time, an encoder that slips or creeps.

use embassy_time::Instant;

use super::StageFault;
use super::train::{StageConfiguration, Train};
use crate::environment::Mechanics;
use crate::stage::StageState;

/// A train and its faults. It goes through every beginning and end of a fault at its own time, so that the
/// motion does not depend on how often it is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive<'a> {
    /// The drive without faults.
    train: Train,
    /// What goes wrong with it, in any order.
    faults: &'a [StageFault],
    /// When a fault next begins or ends.
    next_change: Instant,
    /// How fast the encoder creeps while the stage turns, rad/s.
    creep_rad_s: f64,
    /// How far it had crept when the latest command came, rad.
    crept_rad: f64,
}

impl<'a> Drive<'a> {
    /// A drive at the start of the clock.
    pub(crate) fn new(configuration: &StageConfiguration, faults: &'a [StageFault]) -> Self {
        let train = Train::new(configuration);
        let next_change = Instant::MIN;
        let mut drive = Self { train, faults, next_change, creep_rad_s: 0.0, crept_rad: 0.0 };
        drive.advance(Instant::MIN);
        drive
    }

    /// Moves on to `now`, so that switches and stall are those of that moment.
    #[inline]
    pub(crate) fn advance(&mut self, now: Instant) {
        while self.next_change <= now {
            self.change();
        }
        self.train.advance(now);
    }

    /// Begins and ends the faults that are due.
    #[cold]
    fn change(&mut self) {
        let at = self.next_change;
        self.train.advance(at);
        self.creep();
        self.train.hold(self.faults.iter().any(|fault| fault.blocks(at)));
        self.creep_rad_s = self.faults.iter().map(|fault| fault.creep_rad_s(at)).sum();
        let changes = self.faults.iter().filter_map(|fault| fault.change_after(at));
        self.next_change = changes.min().unwrap_or(Instant::MAX);
    }

    /// The motor's field stops where it is.
    pub(crate) fn stop(&mut self, now: Instant) {
        self.advance(now);
        self.creep();
        self.train.stop();
    }

    /// Keeps what has crept under the command that ends now.
    fn creep(&mut self) {
        if self.creep_rad_s != 0.0 {
            self.crept_rad += self.creep_rad_s * self.train.driven_s();
        }
    }

    /// Angle and rate at the moment last reached.
    #[inline]
    pub(crate) fn state(&self) -> StageState {
        self.train.state
    }

    /// How far the encoder has slipped and crept, rad.
    pub(crate) fn slip_rad(&self, now: Instant) -> f64 {
        let slipped: f64 = self.faults.iter().map(|fault| fault.slip_rad(now)).sum();
        if self.creep_rad_s == 0.0 && self.crept_rad == 0.0 {
            return slipped;
        }
        slipped + (self.crept_rad + self.creep_rad_s * self.train.driven_s())
    }
}

impl Mechanics for Drive<'_> {
    fn drive(&mut self, now: Instant, microsteps: f64, microsteps_per_s: f64) {
        self.advance(now);
        self.creep();
        self.train.drive(microsteps, microsteps_per_s);
    }

    fn is_blocked(&self) -> bool {
        self.train.is_blocked()
    }

    fn reference_switches(&self) -> [bool; 2] {
        self.train.switches()
    }

    fn beyond_edge(&self) -> f64 {
        self.train.beyond_edge()
    }
}

impl StageFault {
    /// Whether the fault holds the stage at `now`.
    fn blocks(&self, now: Instant) -> bool {
        matches!(*self, Self::Block { from, until } if (from..until).contains(&now))
    }

    /// When the fault next begins or ends to act on the motion.
    fn change_after(&self, now: Instant) -> Option<Instant> {
        match *self {
            Self::Block { from, until } => [from, until].into_iter().filter(|at| *at > now).min(),
            Self::Creep { from, .. } => Some(from).filter(|from| *from > now),
            Self::Slip { .. } => None,
        }
    }

    /// How fast it moves the encoder of a turning stage, rad/s.
    fn creep_rad_s(&self, now: Instant) -> f64 {
        match *self {
            Self::Creep { from, rad_per_s } if from <= now => rad_per_s,
            _ => 0.0,
        }
    }

    /// How far it has moved the encoder, rad.
    fn slip_rad(&self, now: Instant) -> f64 {
        match *self {
            Self::Slip { at, by_rad } if at <= now => by_rad,
            _ => 0.0,
        }
    }
}
