//! The events that the instrument reports. The log prints each as a sentence, so that a log, read
//! in order, shows what the instrument did and why.

use drivers::fault::Fault;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::turn::Sense;
use orientation::alignment::stepwise::quality::Disturbance;
use orientation::attitude::restart::RecallRefusal;
use orientation::attitude::{Handover, Realigned, State};
use orientation::device::{Device, Trouble};
use orientation::noise::fit::{Coefficient, Estimate};
use orientation::roll as spin;
use orientation::units::DEGREES_PER_RADIAN as DEGREES;
use orientation::words;
use orientation::words::Rounded;

use crate::keep::VerticalGyro;
use crate::retry_budget::Symptom;
use crate::storage::Remembered;

/// An event. Angles are in degrees, angular rates in degrees per hour, times in seconds, unless the
/// variant states another unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A multi-position alignment begins.
    Begun {
        /// Number of planned positions.
        positions: usize,
        /// Duration of the dwell at each position, s.
        dwell: f64,
        /// Latitude, °, north positive.
        latitude: f64,
    },
    /// An alignment by continuous rotation begins.
    BegunTurning {
        /// Number of planned turns.
        turns: u32,
        /// Latitude, °, north positive.
        latitude: f64,
    },
    /// An inertial-frame alignment from stop to stop begins in a vehicle.
    BegunStops {
        /// Latitude, °, north positive.
        latitude: f64,
    },
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
    /// The gyro's sensitive axis has been set vertical to hold the azimuth: angles of the outer and
    /// the inner frame, °.
    Stored(f64, f64),
    /// The platform is within its levelling limit: inclination along and across the gyro's
    /// sensitive axis, °.
    Levelled(f64, f64),
    /// A survey of the gyro's noise begins; the stage stands still for this time, s.
    Surveying(f64),
    /// A noise coefficient of the gyro, estimated from the survey.
    Noise(Coefficient, Estimate),
    /// The measuring plan that follows from the noise coefficients.
    Planned {
        /// Number of positions.
        positions: usize,
        /// Duration of the dwell at each position, s.
        dwell: f64,
        /// Total duration with all movements, s.
        seconds: f64,
        /// Predicted 1σ of the azimuth, °.
        sigma: f64,
    },
    /// A dwell was completed: its number from 1, the number of planned dwells, its mean rate, °/h.
    Dwelled(usize, usize, f64),
    /// The dwell is shorter than planned because the stage moved without a command: its duration,
    /// s.
    CutShort(f64),
    /// A dwell is measured again: its number and the disturbance.
    Repeated(usize, Disturbance),
    /// A dwell is excluded from the fit: its number and the disturbance.
    LeftOut(usize, Disturbance),
    /// The platform begins rate-modulated turns, which make the axis misalignment observable, at
    /// this mean rate, °/s.
    Modulated(f64),
    /// The estimated axis misalignment, the elevation of the gyro's sensitive axis above the plane
    /// of rotation, and its 1σ, °.
    Misalignment(f64, f64),
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
    /// Turns are evaluated from here on: sense of rotation and speed, °/s.
    Stretch(Sense, f64),
    /// A turn was completed: its number from 1, the number of planned turns.
    Turned(u32, u32),
    /// The number of turns of one sense of rotation that are excluded from the fit.
    TurnsLeftOut(u32, Sense),
    /// A stop was detected: its number, and the duration of the drive before it, s.
    Stopped(usize, f64),
    /// The displacement of a stop from the first one: its number, and metres north and east.
    Displaced(usize, [f64; 2]),
    /// The vehicle may drive on, because the stop was long enough: its number, its duration, s, and
    /// pitch and roll of the vehicle, °.
    MayDrive(usize, f64, [f64; 2]),
    /// The vehicle has set off.
    Driving,
    /// The estimated bias of a gyro and its 1σ, °/h.
    Bias(Device, f64, f64),
    /// The alignment has concluded: azimuth, its 1σ, and the Cramér–Rao bound of that σ, °.
    Concluded(f64, f64, f64),
    /// The alignment has concluded without an azimuth, with the reason.
    Refused(Refusal),
    /// An azimuth and its 1σ, °, are handed to the attitude keeper, with the keeper's decision.
    HandedOver(f64, f64, Realigned),
    /// The attitude keeper has changed its state.
    Keeping(State),
    /// No inertial samples arrive any more.
    NoMotion,
    /// The azimuth has become unknown; it must be found or handed over again.
    AzimuthLost,
    /// The estimated bias of a gyro exceeds five times its stated 1σ; the stated values are not
    /// used any more.
    BiasBeyondStated,
    /// The gyro that measures the rotation about the down axis from now on.
    DownGyro(VerticalGyro),
    /// The vehicle has come to rest, and a new alignment begins.
    Realigning,
    /// The heading from before the restart is used again, since the vehicle has not moved: azimuth
    /// and its 1σ, °.
    HeadingRecalled(f64, f64),
    /// The heading from before the restart is rejected, with the reason.
    RecallRefused(RecallRefusal),
    /// The heading cannot be stored for the next start.
    HeadingNotKept(Fault),
    /// Tracking of the roll angle of a spinning body begins.
    BegunSpin,
    /// The source of the roll estimate from now on.
    Roll(spin::State),
    /// The modulation of the lift is detected again, after this time, s.
    LiftBack(f64),
    /// The tracking of the roll has ended, because a sensor was given up.
    RollEnded(Refusal),
    /// The flight is over.
    Flown {
        /// Number of whole turns since the first sample, positive in the sense of positive roll.
        turns: i32,
        /// Roll angle, °.
        roll: f64,
        /// The 1σ of the roll, °; [`None`] if the roll is unknown.
        sigma: Option<f64>,
    },
    /// The link does not accept status lines.
    LinkSilent,
}

words! { Event:
    Self::Begun { positions, dwell, latitude } =>
        "begin: {} positions of {} s at latitude {}°",
        positions, Rounded::<1>(dwell), Rounded::<4>(latitude);
    Self::BegunTurning { turns, latitude } =>
        "begin: {} turns at latitude {}°", turns, Rounded::<4>(latitude);
    Self::BegunStops { latitude } =>
        "begin: level, drive, stop and level again, at latitude {}°", Rounded::<4>(latitude);
    Self::Started(device) => "{}: identity and self-test passed, configured", device;
    Self::Lost(device, symptom) => "{}: reading lost: {}", device, symptom;
    Self::Clipped(device) => "{}: at the limit of its range", device;
    Self::Restarting(device, symptom) => "{}: {}: starting it again", device, symptom;
    Self::GivenUp(device, trouble) => "{}: given up: {}", device, trouble;
    Self::Missing(count) => "{} sample(s) missing", count;
    Self::Late(microseconds) => "a sample came {} µs beside its time", microseconds;
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
    Self::Stored(outer, inner) =>
        "gyro vertical to store the azimuth: outer frame at {}°, inner frame at {}°",
        Rounded::<3>(outer), Rounded::<3>(inner);
    Self::Levelled(pitch, roll) =>
        "level: platform inclined by {}° along and {}° across the gyro's axis",
        Rounded::<3>(pitch), Rounded::<3>(roll);
    Self::Surveying(seconds) => "survey: standing still for {} s to know the gyro", Rounded::<0>(seconds);
    Self::Noise(coefficient, estimate) => "{}: {}", coefficient, estimate;
    Self::Planned { positions, dwell, seconds, sigma } =>
        "plan: {} positions of {} s, {} s in all, for {}° (1σ)",
        positions, Rounded::<2>(dwell), Rounded::<0>(seconds), Rounded::<4>(sigma);
    Self::Dwelled(number, of, rate) => "dwell {} of {}: {} °/h", number, of, Rounded::<4>(rate);
    Self::CutShort(seconds) =>
        "that dwell is short, {} s: the stage moved of itself", Rounded::<1>(seconds);
    Self::Repeated(number, why) => "dwell {} is measured again: {}", number, why;
    Self::LeftOut(number, why) => "dwell {} is left out: {}", number, why;
    Self::Modulated(rate) =>
        "rate-modulated turns, {} °/s in the mean, to measure the axis misalignment", Rounded::<2>(rate);
    Self::Misalignment(angle, sigma) =>
        "gyro's axis {}° ± {}° (1σ) above the platform", Rounded::<4>(angle), Rounded::<4>(sigma);
    Self::Recalled(misalignment) => "axis misalignment recalled: {}", misalignment;
    Self::NothingRecalled => "no stored axis misalignment is of these speeds, and fresh";
    Self::CalibrationUnreadable(fault) => "stored axis misalignments cannot be read: {}", fault;
    Self::CalibrationSaved(misalignment) => "axis misalignment saved: {}", misalignment;
    Self::CalibrationNotSaved(fault) => "axis misalignment not saved: {}", fault;
    Self::Stretch(sense, speed) =>
        "turns count from here: {}, {} °/s", sense, Rounded::<2>(speed);
    Self::Turned(number, of) => "turn {} of {}", number, of;
    Self::TurnsLeftOut(turns, sense) =>
        "{} turn(s) {} left out: something disturbed them", turns, sense;
    Self::Stopped(number, seconds) =>
        "stop {} found after {} s of driving", number, Rounded::<0>(seconds);
    Self::Displaced(number, [north, east]) =>
        "stop {} is {} m north and {} m east of the first",
        number, Rounded::<1>(north), Rounded::<1>(east);
    Self::MayDrive(number, seconds, [pitch, roll]) =>
        "stop {} levelled for {} s: pitch {}°, roll {}°; the vehicle may drive",
        number, Rounded::<0>(seconds), Rounded::<3>(pitch), Rounded::<3>(roll);
    Self::Driving => "driving";
    Self::Bias(gyro, bias, sigma) =>
        "{}: bias {} °/h ± {} °/h (1σ)", gyro, Rounded::<4>(bias), Rounded::<4>(sigma);
    Self::Concluded(azimuth, sigma, limit) =>
        "azimuth {}° ± {}° (1σ), limit {}°",
        Rounded::<4>(azimuth), Rounded::<4>(sigma), Rounded::<4>(limit);
    Self::Refused(reason) => "no azimuth: {}", reason;
    Self::HandedOver(azimuth, sigma, Realigned::Taken) =>
        "azimuth {}° ± {}° (1σ) handed over: it is kept", Rounded::<4>(azimuth), Rounded::<4>(sigma);
    Self::HandedOver(azimuth, sigma, Realigned::Fused { sigmas }) =>
        "realigned: azimuth {}° ± {}° (1σ) agrees with what was kept, by {} σ",
        Rounded::<4>(azimuth), Rounded::<4>(sigma), Rounded::<1>(sigmas);
    Self::HandedOver(azimuth, sigma, Realigned::Disagrees { sigmas }) =>
        "azimuth {}° ± {}° (1σ) disagrees with what was kept, by {} σ: neither is believed",
        Rounded::<4>(azimuth), Rounded::<4>(sigma), Rounded::<1>(sigmas);
    Self::Keeping(state) => "keeping: {}", state;
    Self::NoMotion => "keeping: no motion is measured any more";
    Self::AzimuthLost => "keeping: the azimuth is lost until it is found or handed over again";
    Self::BiasBeyondStated =>
        "keeping: a gyro's bias is beyond five of the 1σ stated for it: nothing stated of the biases is believed";
    Self::DownGyro(VerticalGyro::Coarse) => "keeping: the coarse gyro shows how the base turns about down";
    Self::DownGyro(VerticalGyro::Calibrated) =>
        "keeping: the coarse gyro, as it was compared, shows how the base turns about down";
    Self::DownGyro(VerticalGyro::Precise) => "keeping: the precise gyro shows how the base turns about down";
    Self::Realigning => "the vehicle stands: aligning anew";
    Self::HeadingRecalled(azimuth, sigma) =>
        "the vehicle stands as it stood before the restart: azimuth {}° ± {}° (1σ) recalled",
        Rounded::<4>(azimuth), Rounded::<4>(sigma);
    Self::RecallRefused(reason) => "the heading of before the restart is not believed: {}", reason;
    Self::HeadingNotKept(fault) => "the heading cannot be kept for the next start: {}", fault;
    Self::BegunSpin => "begin: following the roll of a spinning body";
    Self::Roll(state) => "roll: {}", state;
    Self::LiftBack(seconds) => "roll: locked, the lift is back after {} s", Rounded::<2>(seconds);
    Self::RollEnded(reason) => "no roll: {}", reason;
    Self::Flown { turns, roll, sigma: Some(sigma) } =>
        "flown: {} turns and {}° ± {}° (1σ)", turns, Rounded::<4>(roll), Rounded::<4>(sigma);
    Self::Flown { turns, roll, sigma: None } =>
        "flown: {} turns and {}°, not known", turns, Rounded::<1>(roll);
    Self::LinkSilent => "link: takes no status lines";
}

impl Event {
    /// The event of an azimuth handed to the attitude keeper, with angles converted to degrees.
    #[must_use]
    pub fn handed_over(handover: &Handover, outcome: Realigned) -> Self {
        let [azimuth, sigma] = [handover.azimuth, handover.sigma].map(|angle| angle * DEGREES);
        Self::HandedOver(azimuth, sigma, outcome)
    }
}
