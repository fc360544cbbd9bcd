//! What the instrument tells of itself: read in a row, these sentences say what it did and why.

use orientation::align::quality::Disturbance;
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::words;
use orientation::words::Rounded;

use crate::patience::Symptom;

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
    /// A device has passed identity and self-test and is configured.
    Started(Device),
    /// A reading was lost.
    Lost(Device, Symptom),
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
    /// The stage looks for its index.
    Homing,
    /// The stage found its index at this angle, °.
    Homed(f64),
    /// The stage is sent to this angle, °.
    Turning(f64),
    /// The stage stands: at this angle, after so many seconds.
    Arrived(f64, f64),
    /// The stage stands beside its target by this angle, °, and goes again.
    Corrected(f64),
    /// The stage is blocked and tries again.
    Blocked,
    /// The platform is level enough: pitch and roll of the platform, °.
    Levelled(f64, f64),
    /// A dwell was taken: number, of how many, its mean rate.
    Dwelled(usize, usize, f64),
    /// The dwell is shorter than planned, so many seconds: the stage moved of itself.
    CutShort(f64),
    /// A dwell is measured again.
    Repeated(usize, Disturbance),
    /// A dwell is left out of the fit.
    LeftOut(usize, Disturbance),
    /// The azimuth, its σ and the limit that no estimator can beat, °.
    Concluded(f64, f64, f64),
    /// There is no azimuth.
    Refused(Refusal),
    /// The link does not take status lines.
    LinkSilent,
}

words! { Event:
    Self::Begun { positions, dwell, latitude } =>
        "begin: {} positions of {} s at latitude {}°",
        positions, Rounded::<1>(dwell), Rounded::<4>(latitude);
    Self::Started(device) => "{}: identity and self-test passed, configured", device;
    Self::Lost(device, symptom) => "{}: reading lost: {}", device, symptom;
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
    Self::Homing => "stage: looking for its index";
    Self::Homed(angle) => "stage: index found at {}°", Rounded::<3>(angle);
    Self::Turning(angle) => "stage: to {}°", Rounded::<3>(angle);
    Self::Arrived(angle, seconds) =>
        "stage: stands at {}° after {} s", Rounded::<3>(angle), Rounded::<2>(seconds);
    Self::Corrected(angle) => "stage: {}° beside its target, going again", Rounded::<3>(angle);
    Self::Blocked => "stage: blocked, trying again";
    Self::Levelled(pitch, roll) =>
        "level: platform inclined by {}° along and {}° across the gyro's axis",
        Rounded::<3>(pitch), Rounded::<3>(roll);
    Self::Dwelled(number, of, rate) => "dwell {} of {}: {} °/h", number, of, Rounded::<4>(rate);
    Self::CutShort(seconds) =>
        "that dwell is short, {} s: the stage moved of itself", Rounded::<1>(seconds);
    Self::Repeated(number, why) => "dwell {} is measured again: {}", number, why;
    Self::LeftOut(number, why) => "dwell {} is left out: {}", number, why;
    Self::Concluded(azimuth, sigma, limit) =>
        "azimuth {}° ± {}° (1σ), limit {}°",
        Rounded::<4>(azimuth), Rounded::<4>(sigma), Rounded::<4>(limit);
    Self::Refused(reason) => "no azimuth: {}", reason;
    Self::LinkSilent => "link: takes no status lines";
}
