//! The retry budget of a device: the failures after which it is started again, after which it is
//! given up, and the pause after which it is tried again all the same.

use drivers::fault::Fault;
use embassy_time::Duration;
use orientation::device::Trouble;
use orientation::words;

/// Number of consecutive readings that may be lost on the bus before the device is started again.
const LOST_IN_A_ROW: u8 = 3;
/// Number of restarts that a device may need without a minute of work between them. A device that
/// needs more is defective, and its gaps would cost more dwells than a session may repeat.
const RESTARTS: u8 = 5;
/// Time after which a device that was given up is tried again while an azimuth is kept.
pub(crate) const RETRY: Duration = Duration::from_secs(10);

/// A symptom of a failing device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symptom {
    /// The driver reports a fault.
    Chip(Fault),
    /// The device does not signal new data.
    Silent,
    /// The device repeats the same reading.
    Stuck,
    /// The reading is impossible, as it differs too much from the one before.
    Jumped,
    /// The device does not convert synchronously with the others.
    OutOfStep,
    /// The device has been at the limit of its range for too long, which no restart mends.
    Saturated,
}

words! { Symptom:
    Self::Chip(fault) => "{}", fault;
    Self::Silent => "no data in time";
    Self::Stuck => "the same reading again and again";
    Self::Jumped => "too far from the one before";
    Self::OutOfStep => "out of step with the others";
    Self::Saturated => "at the limit of its range for too long";
}

impl From<Symptom> for Trouble {
    fn from(symptom: Symptom) -> Self {
        match symptom {
            Symptom::Chip(Fault::Bus) => Self::Bus,
            Symptom::Chip(Fault::Hung) => Self::Slow,
            Symptom::Chip(Fault::Checksum) => Self::Checksum,
            Symptom::Chip(Fault::Reset) => Self::Resets,
            Symptom::Chip(Fault::Identity { .. }) => Self::Identity,
            Symptom::Chip(Fault::SelfTest) => Self::SelfTest,
            Symptom::Chip(Fault::NotAsWritten { .. }) => Self::NotAsWritten,
            Symptom::Chip(Fault::Alarm { .. }) => Self::Alarm,
            Symptom::Chip(Fault::NotReady) | Symptom::Silent => Self::Silent,
            Symptom::Stuck | Symptom::Jumped => Self::Stuck,
            Symptom::OutOfStep => Self::OutOfStep,
            Symptom::Saturated => Self::Saturated,
        }
    }
}

/// The reaction to a symptom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Remedy {
    /// Discard the reading.
    Drop,
    /// Start the device again.
    Restart,
    /// Give the device up, for this reason.
    GiveUp(Trouble),
}

/// The failures of one device so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RetryBudget {
    /// Consecutive readings lost on the bus.
    lost: u8,
    /// Restarts so far.
    restarts: u8,
    /// Whether the device has ever given a good reading.
    has_worked: bool,
    /// The first symptom of the present failure.
    cause: Option<Symptom>,
}

impl RetryBudget {
    /// Records a good reading, which ends a failure.
    pub fn succeeded(&mut self) {
        self.lost = 0;
        self.has_worked = true;
        self.cause = None;
    }

    /// Forgives the restarts of a device that has worked for long since the latest one.
    pub fn forgive(&mut self) {
        self.restarts = 0;
    }

    /// Records a failed reading and returns the reaction: bus errors, and transfers that hung, are
    /// repeated up to three times, everything else needs a restart, at most five times. A saturated
    /// device is given up.
    pub fn failed(&mut self, symptom: Symptom) -> Remedy {
        if symptom == Symptom::Saturated {
            return Remedy::GiveUp(symptom.into());
        }
        let cause = *self.cause.get_or_insert(symptom);
        let passing = matches!(symptom, Symptom::Chip(Fault::Bus | Fault::Hung | Fault::Checksum));
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

    /// Selects the symptom that explains a failure best. An error of the bus, or a device that
    /// became silent or stuck, explains what follows, so the first symptom counts; in other cases
    /// the last one counts. A wrong identity of a device that has worked means that it does not
    /// answer any more.
    fn reason(&self, first: Symptom, last: Symptom) -> Symptom {
        match (first, last) {
            (
                Symptom::Chip(Fault::Bus | Fault::Hung | Fault::Checksum)
                | Symptom::Silent
                | Symptom::Stuck,
                _,
            ) => first,
            (_, Symptom::Chip(Fault::Identity { .. })) if self.has_worked => Symptom::Silent,
            _ => last,
        }
    }
}
