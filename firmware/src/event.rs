//! What the instrument tells of itself: read in a row, these sentences say what it did and why.

use drivers::fault::Fault;
use orientation::align::quality::Disturbance;
use orientation::align::rotating::turn::Sense;
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::keep::restart::Doubt;
use orientation::keep::{Handover, Realigned, State, spin};
use orientation::noise::fit::{Coefficient, Estimate};
use orientation::units::DEGREES_PER_RADIAN as DEGREES;
use orientation::words;
use orientation::words::Rounded;

use crate::keep::VerticalGyro;
use crate::retry_budget::Symptom;
use crate::storage::Remembered;

/// Something that happened. Angles in degrees, rates in degrees per hour, times in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The instrument begins.
    Begun {
        /// Positions that are planned.
        positions: usize,
        /// Time at each, s.
        dwell: f64,
        /// Latitude, °.
        latitude: f64,
    },
    /// The instrument begins, on a platform that turns all the time.
    BegunTurning {
        /// Turns that are planned.
        turns: u32,
        /// Latitude, °.
        latitude: f64,
    },
    /// The instrument begins, in a vehicle that goes from stop to stop.
    BegunStops {
        /// Latitude, °.
        latitude: f64,
    },
    /// A device has passed identity and self-test and is configured.
    Started(Device),
    /// A reading was lost.
    Lost(Device, Symptom),
    /// A gyro has come to the limit of its range, for the first time in this session.
    Clipped(Device),
    /// A device is started again.
    Restarting(Device, Symptom),
    /// A device is given up.
    GivenUp(Device, Trouble),
    /// Samples are missing before this one.
    Missing(u32),
    /// A sample came at the wrong time, by so many µs.
    Late(i32),
    /// So many samples in a row were thrown away because nobody took them.
    Overflowed(u32),
    /// The base hardly sways: RMS of its angle, °.
    BaseStill(f64),
    /// The base sways, which is subtracted: RMS of its angle, °, its frequency, Hz, and the RMS of
    /// what is left of the angle, °.
    BaseSways(f64, f64, f64),
    /// An axis looks for its index.
    Homing(Device),
    /// An axis found its index at this angle, °.
    Homed(Device, f64),
    /// An axis is sent to this angle, °.
    Turning(Device, f64),
    /// An axis stands: at this angle, after so many seconds.
    Arrived(Device, f64, f64),
    /// An axis stands beside its target by this angle, °, and goes again.
    Corrected(Device, f64),
    /// An axis begins to turn at this rate, °/s, clockwise positive, or is to come to rest.
    Revolving(Device, f64),
    /// An axis is blocked and tries again.
    Blocked(Device),
    /// The gyro's axis stands vertical, to store the azimuth: angles of the outer and the inner frame.
    Stored(f64, f64),
    /// The platform is level enough: pitch and roll of the platform, °.
    Levelled(f64, f64),
    /// The stage stands still for so many seconds, to know the gyro.
    Surveying(f64),
    /// A coefficient of the gyro's noise as the survey found it.
    Noise(Coefficient, Estimate),
    /// The plan that follows from the noise.
    Planned {
        /// Positions.
        positions: usize,
        /// Time at each, s.
        dwell: f64,
        /// Time for all with the rotations, s.
        seconds: f64,
        /// 1σ of the azimuth that it promises, °.
        sigma: f64,
    },
    /// A dwell was taken: number, of how many, its mean rate.
    Dwelled(usize, usize, f64),
    /// The dwell is shorter than planned, so many seconds: the stage moved of itself.
    CutShort(f64),
    /// A dwell is measured again.
    Repeated(usize, Disturbance),
    /// A dwell is left out of the fit.
    LeftOut(usize, Disturbance),
    /// The platform turns unevenly on purpose, at this mean rate, °/s.
    Uneven(f64),
    /// How far the gyro's axis stands from the platform's plane, and its 1σ, °.
    Coupled(f64, f64),
    /// A coupling that was stored is used again.
    Recalled(Remembered),
    /// None that is stored will do.
    NothingRecalled,
    /// What is stored cannot be read.
    CalibrationUnreadable(Fault),
    /// A coupling is stored for the next time.
    CalibrationSaved(Remembered),
    /// It could not be stored.
    CalibrationNotSaved(Fault),
    /// Turns count from here: which way, at this speed, °/s.
    Stretch(Sense, f64),
    /// A turn was taken: number, of how many.
    Turned(u32, u32),
    /// So many turns are left out of the fit.
    TurnsLeftOut(u32, Sense),
    /// The vehicle stands: which stop, after so many seconds of driving.
    Stopped(usize, f64),
    /// At this stop the vehicle stands so far north and east of the first one, m.
    Displaced(usize, [f64; 2]),
    /// A stop was long enough: which, its seconds, pitch and roll of the vehicle, °. It may drive on.
    MayDrive(usize, f64, [f64; 2]),
    /// The vehicle drives.
    Driving,
    /// The bias of a gyro as it was found, and its 1σ, °/h.
    Bias(Device, f64, f64),
    /// The azimuth, its σ and the limit that no estimator can beat, °.
    Concluded(f64, f64, f64),
    /// There is no azimuth.
    Refused(Refusal),
    /// An azimuth and its 1σ are handed to the keeper, °, and what it does with them.
    HandedOver(f64, f64, Realigned),
    /// The keeper's state has changed.
    Keeping(State),
    /// No motion is measured any more.
    NoMotion,
    /// The azimuth is not known any more.
    AzimuthLost,
    /// A gyro's bias is beyond what was stated of it.
    BiasBeyondStated,
    /// Which gyro shows the down axis from now on.
    DownGyro(VerticalGyro),
    /// The vehicle stands: its azimuth is found anew.
    Realigning,
    /// The vehicle stands as it stood before the restart: azimuth and its 1σ, °.
    HeadingRecalled(f64, f64),
    /// The heading of before the restart is not believed.
    Doubted(Doubt),
    /// The heading cannot be kept for the next start.
    HeadingNotKept(Fault),
    /// The instrument begins, on a spinning body.
    BegunSpin,
    /// What the roll of a spinning body rests on from now on.
    Roll(spin::State),
    /// The lift shows the roll again, after so many seconds.
    LiftBack(f64),
    /// The roll is followed no more: a sensor is given up.
    RollEnded(Refusal),
    /// The flight is over.
    Flown {
        /// Whole turns since the first sample.
        turns: i32,
        /// The roll, °.
        roll: f64,
        /// Its 1σ, °, where it is known.
        sigma: Option<f64>,
    },
    /// The link does not take status lines.
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
    Self::Overflowed(count) => "{} sample(s) lost: nobody took them in time", count;
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
    Self::Uneven(rate) =>
        "uneven turns, {} °/s in the mean, to know how the gyro feels the platform", Rounded::<2>(rate);
    Self::Coupled(angle, sigma) =>
        "gyro's axis {}° ± {}° (1σ) above the platform", Rounded::<4>(angle), Rounded::<4>(sigma);
    Self::Recalled(coupling) => "coupling recalled: {}", coupling;
    Self::NothingRecalled => "no stored coupling is of these speeds, and fresh";
    Self::CalibrationUnreadable(fault) => "stored couplings cannot be read: {}", fault;
    Self::CalibrationSaved(coupling) => "coupling kept: {}", coupling;
    Self::CalibrationNotSaved(fault) => "coupling lost, it could not be kept: {}", fault;
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
    Self::Doubted(doubt) => "the heading of before the restart is not believed: {}", doubt;
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
    /// What becomes of an azimuth that is handed over.
    #[must_use]
    pub fn handed_over(handover: &Handover, outcome: Realigned) -> Self {
        let [azimuth, sigma] = [handover.azimuth, handover.sigma].map(|angle| angle * DEGREES);
        Self::HandedOver(azimuth, sigma, outcome)
    }
}
