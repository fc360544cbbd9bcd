//! How much a device may fail before it is started again, and before it is given up.

use drivers::fault::Fault;
use orientation::device::Trouble;
use orientation::words;

/// Readings in a row that may be lost to the bus before the device is started again.
const LOST_IN_A_ROW: u8 = 3;
/// How often a device may be started again in one session: a device that needs more is sick, and
/// its gaps would cost more dwells than a session repeats.
const RESTARTS: u8 = 5;

/// What a device shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symptom {
    /// The driver reports a fault.
    Chip(Fault),
    /// It signals no more data.
    Silent,
    /// It gives the same reading again and again.
    Stuck,
    /// Its bus takes far too long.
    Slow,
    /// A reading that cannot be: too far from the one before.
    Jumped,
    /// It converts at other times than those that it is to be in step with.
    OutOfStep,
}

words! { Symptom:
    Self::Chip(fault) => "{}", fault;
    Self::Silent => "no data in time";
    Self::Stuck => "the same reading again and again";
    Self::Slow => "its bus hangs";
    Self::Jumped => "too far from the one before";
    Self::OutOfStep => "out of step with the others";
}

impl From<Symptom> for Trouble {
    fn from(symptom: Symptom) -> Self {
        match symptom {
            Symptom::Chip(Fault::Bus) => Self::Bus,
            Symptom::Chip(Fault::Checksum) => Self::Checksum,
            Symptom::Chip(Fault::Reset) => Self::Resets,
            Symptom::Chip(Fault::Identity { .. }) => Self::Identity,
            Symptom::Chip(Fault::SelfTest) => Self::SelfTest,
            Symptom::Chip(Fault::NotAsWritten { .. }) => Self::NotAsWritten,
            Symptom::Chip(Fault::Alarm { .. }) => Self::Alarm,
            Symptom::Chip(Fault::NotReady) | Symptom::Silent => Self::Silent,
            Symptom::Stuck | Symptom::Jumped => Self::Stuck,
            Symptom::Slow => Self::Slow,
            Symptom::OutOfStep => Self::OutOfStep,
        }
    }
}

/// What to do about a symptom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Remedy {
    /// Do without this reading.
    Drop,
    /// Start the device again.
    Restart,
    /// Give the device up.
    GiveUp(Trouble),
}

/// What is left of the retry budget with one device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RetryBudget {
    lost: u8,
    restarts: u8,
    /// Whether it ever gave a good reading.
    has_worked: bool,
    /// What began the trouble that is going on.
    cause: Option<Symptom>,
}

impl RetryBudget {
    /// How often the device was to be started again.
    #[must_use]
    pub fn restarts(&self) -> u8 {
        self.restarts
    }

    /// A reading was good.
    pub fn succeeded(&mut self) {
        self.lost = 0;
        self.has_worked = true;
        self.cause = None;
    }

    /// A reading failed. Repeating helps against the bus, starting again against the rest.
    pub fn failed(&mut self, symptom: Symptom) -> Remedy {
        let cause = *self.cause.get_or_insert(symptom);
        let passing = matches!(symptom, Symptom::Chip(Fault::Bus | Fault::Checksum));
        if passing && self.lost < LOST_IN_A_ROW {
            self.lost += 1;
            return Remedy::Drop;
        }
        self.lost = 0;
        if self.restarts >= RESTARTS {
            return Remedy::GiveUp(self.reason(cause, symptom).into());
        }
        self.restarts += 1;
        Remedy::Restart
    }

    /// Which of two symptoms tells more: a sick bus, or a device that fell silent or stuck, explains
    /// all that follows; what else began the trouble is told better by what came last. A device that
    /// has worked is no other one: it answers no more.
    fn reason(&self, first: Symptom, last: Symptom) -> Symptom {
        match (first, last) {
            (
                Symptom::Chip(Fault::Bus | Fault::Checksum)
                | Symptom::Silent
                | Symptom::Stuck
                | Symptom::Slow,
                _,
            ) => first,
            (_, Symptom::Chip(Fault::Identity { .. })) if self.has_worked => Symptom::Silent,
            _ => last,
        }
    }
}
