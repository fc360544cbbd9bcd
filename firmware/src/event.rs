//! The events that the instrument reports. The log prints each as a sentence, so that a log, read
//! in order, shows what the instrument did and why.

use drivers::fault::Fault;
use orientation::alignment::Progress;
use orientation::device::{Device, Trouble};
use orientation::navigation;
use orientation::roll;
use orientation::words;
use orientation::words::Rounded;

use crate::kept_lines::Weight;
use crate::not_begun::NotBegun;
use crate::remembered::Remembered;
use crate::retry_budget::Symptom;

/// An event. Angles are in degrees and times in seconds, unless the variant states another unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// Progress of an alignment, or of the tracking of a roll.
    Alignment(Progress),
    /// Progress of the navigator.
    Navigation(navigation::Progress),
    /// A device has passed identification and self-test and is configured.
    Started(Device),
    /// A reading of a device was lost, with the symptom.
    Lost(Device, Symptom),
    /// A gyro has come to the limit of its range, for the first time in this session.
    Clipped(Device),
    /// A device is started again because of a symptom.
    Restarting(Device, Symptom),
    /// A device is given up: its retry budget is exhausted.
    GivenUp(Device, Trouble),
    /// The number of samples that are missing before the current one.
    Missing(u32),
    /// A sample came at the wrong time: its deviation from the expected time, µs, late positive.
    Late(i32),
    /// So many samples came while the aligner computed, and were not needed.
    PassedBy(u32),
    /// The number of consecutive samples that were discarded because the queue to the session was
    /// full.
    Overflowed(u32),
    /// The base is nearly at rest, so its motion is not subtracted: RMS of its angle, °.
    BaseStill(f64),
    /// The base sways, and its motion is subtracted: RMS of its angle, °; its frequency, Hz; RMS of
    /// the residual angle, °.
    BaseSways(f64, f64, f64),
    /// An axis searches its index switch.
    Homing(Device),
    /// An axis has found its index, at this encoder angle, °.
    Homed(Device, f64),
    /// An axis begins to move to this angle, °.
    Turning(Device, f64),
    /// An axis has stopped: its angle, °, and the duration of the movement, s.
    Arrived(Device, f64, f64),
    /// An axis has stopped beside its target by this angle, °, and is sent again.
    Corrected(Device, f64),
    /// An axis begins to turn at this rate, °/s, clockwise positive; zero means that it is brought
    /// to rest.
    Revolving(Device, f64),
    /// An axis is blocked; the movement is tried again.
    Blocked(Device),
    /// An axis neither answers nor comes to rest, so the current of the motors is taken away.
    CurrentOff(Device),
    /// The gyro's sensitive axis has been set vertical to hold the azimuth: angles of the outer and
    /// the inner frame, °.
    Stored(f64, f64),
    /// A stored axis misalignment is used.
    Recalled(Remembered),
    /// No stored axis misalignment fits the speeds of this session and is recent enough.
    NothingRecalled,
    /// The stored calibrations cannot be read.
    CalibrationUnreadable(Fault),
    /// An axis misalignment was stored for later sessions.
    CalibrationSaved(Remembered),
    /// An axis misalignment could not be stored.
    CalibrationNotSaved(Fault),
    /// The heading cannot be stored for the next start.
    HeadingNotKept(Fault),
    /// The link does not take what is sent.
    LinkSilent,
    /// Nothing begins, for this reason.
    NotBegun(NotBegun),
}

impl Event {
    /// Whether it is told over the link: what came of an alignment or of the azimuth that is kept, and what was given up.
    pub(crate) fn is_told(&self) -> bool {
        self.weight() == Some(Weight::Outcome)
    }

    /// How much it tells once the supply was lost: which device failed and how, and what came of an alignment or of the
    /// azimuth that is kept; [`None`] for what goes as it should.
    #[must_use]
    pub const fn weight(&self) -> Option<Weight> {
        use navigation::Progress as Navigated;
        match self {
            Self::Lost(..)
            | Self::Clipped(_)
            | Self::Restarting(..)
            | Self::Missing(_)
            | Self::Late(_)
            | Self::Overflowed(_)
            | Self::Blocked(_)
            | Self::LinkSilent => Some(Weight::Symptom),
            Self::Navigation(
                Navigated::Keeping(_) | Navigated::DownGyro(_) | Navigated::Realigning,
            ) => None,
            Self::GivenUp(..)
            | Self::CurrentOff(_)
            | Self::Alignment(
                Progress::Concluded(_)
                | Progress::Refused(_)
                | Progress::Roll(roll::Progress::Flown(..) | roll::Progress::Ended(_)),
            )
            | Self::Navigation(_)
            | Self::NotBegun(_)
            | Self::CalibrationUnreadable(_)
            | Self::CalibrationNotSaved(_)
            | Self::HeadingNotKept(_) => Some(Weight::Outcome),
            _ => None,
        }
    }
}

words! { Event:
    Self::Alignment(progress) => "{}", progress;
    Self::Navigation(progress) => "{}", progress;
    Self::Started(device) => "{}: identity and self-test passed, configured", device;
    Self::Lost(device, symptom) => "{}: reading lost: {}", device, symptom;
    Self::Clipped(device) => "{}: at the limit of its range", device;
    Self::Restarting(device, symptom) => "{}: {}: starting it again", device, symptom;
    Self::GivenUp(device, trouble) => "{}: given up: {}", device, trouble;
    Self::Missing(count) => "{} sample(s) missing", count;
    Self::Late(microseconds) => "a sample came {} µs beside its time", microseconds;
    Self::PassedBy(count) => "{} sample(s) not needed while a conclusion or a plan was computed", count;
    Self::Overflowed(count) => "{} sample(s) lost: the queue was full", count;
    Self::BaseStill(angle) =>
        "base: still within {}°, nothing is subtracted", Rounded::<4>(angle);
    Self::BaseSways(angle, hertz, left) =>
        "base: sways by {}° at {} Hz (RMS); it is subtracted but for {}°",
        Rounded::<4>(angle), Rounded::<2>(hertz), Rounded::<4>(left);
    Self::Homing(axis) => "{}: looking for its index", axis;
    Self::Homed(axis, angle) => "{}: index found at {}°", axis, Rounded::<3>(angle);
    Self::Turning(axis, angle) => "{}: to {}°", axis, Rounded::<3>(angle);
    Self::Arrived(axis, angle, seconds) =>
        "{}: stands at {}° after {} s", axis, Rounded::<3>(angle), Rounded::<2>(seconds);
    Self::Corrected(axis, angle) =>
        "{}: {}° beside its target, going again", axis, Rounded::<3>(angle);
    Self::Revolving(axis, 0.0) => "{}: comes to rest", axis;
    Self::Revolving(axis, rate) => "{}: turns at {} °/s", axis, Rounded::<2>(rate);
    Self::Blocked(axis) => "{}: blocked, trying again", axis;
    Self::CurrentOff(axis) => "{}: not brought to rest: the motors' current is taken away", axis;
    Self::Stored(outer, inner) =>
        "gyro vertical to store the azimuth: outer frame at {}°, inner frame at {}°",
        Rounded::<3>(outer), Rounded::<3>(inner);
    Self::Recalled(misalignment) => "axis misalignment recalled: {}", misalignment;
    Self::NothingRecalled => "no stored axis misalignment is of these speeds, and fresh";
    Self::CalibrationUnreadable(fault) => "stored axis misalignments cannot be read: {}", fault;
    Self::CalibrationSaved(misalignment) => "axis misalignment saved: {}", misalignment;
    Self::CalibrationNotSaved(fault) => "axis misalignment not saved: {}", fault;
    Self::HeadingNotKept(fault) => "the heading cannot be kept for the next start: {}", fault;
    Self::LinkSilent => "link: does not take what is sent";
    Self::NotBegun(reason) => "{}", reason;
}
