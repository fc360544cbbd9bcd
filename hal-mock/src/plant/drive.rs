//! A train with what goes wrong with it: caught and let go by time, an encoder that slips.

use embassy_time::Instant;

use super::StageFault;
use super::train::{StageConfiguration, Train};
use crate::stage::StageState;

/// A train and its faults.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drive<'a> {
    train: Train,
    faults: &'a [StageFault],
    /// When it is next caught or let go.
    next_change: Instant,
}

impl<'a> Drive<'a> {
    /// A drive at the start of the clock.
    pub(crate) fn new(configuration: &StageConfiguration, faults: &'a [StageFault]) -> Self {
        let train = Train::new(configuration);
        let mut drive = Self { train, faults, next_change: Instant::MIN };
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

    /// Catches it or lets it go, as is due.
    #[cold]
    fn change(&mut self) {
        let at = self.next_change;
        self.train.advance(at);
        self.train.hold(self.faults.iter().any(|fault| fault.blocks(at)));
        let changes = self.faults.iter().filter_map(|fault| fault.change_after(at));
        self.next_change = changes.min().unwrap_or(Instant::MAX);
    }

    /// The motor's field stops where it is.
    pub(crate) fn stop(&mut self, now: Instant) {
        self.advance(now);
        self.train.stop();
    }

    /// The motor's field stands at `microsteps` and turns at `microsteps_per_s` from `now` on.
    pub(crate) fn drive(&mut self, now: Instant, microsteps: f64, microsteps_per_s: f64) {
        self.advance(now);
        self.train.drive(microsteps, microsteps_per_s);
    }

    /// Angle and rate at the moment last reached.
    #[inline]
    pub(crate) fn state(&self) -> StageState {
        self.train.state()
    }

    /// Whether the motor cannot follow.
    pub(crate) fn is_blocked(&self) -> bool {
        self.train.is_blocked()
    }

    /// Left and right reference switch.
    pub(crate) fn switches(&self) -> [bool; 2] {
        self.train.switches()
    }

    /// How far the encoder has slipped, rad.
    pub(crate) fn slip_rad(&self, now: Instant) -> f64 {
        self.faults.iter().map(|fault| fault.slip_rad(now)).sum()
    }
}

impl StageFault {
    /// Whether it holds the stage at `now`.
    fn blocks(&self, now: Instant) -> bool {
        matches!(*self, Self::Block { from, until } if (from..until).contains(&now))
    }

    /// When it next catches the stage or lets it go.
    fn change_after(&self, now: Instant) -> Option<Instant> {
        match *self {
            Self::Block { from, until } => [from, until].into_iter().filter(|at| *at > now).min(),
            Self::Slip { .. } => None,
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
