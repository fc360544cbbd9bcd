//! Progress of an alignment by continuous rotation, with the sentences of the log.

use super::turn::Sense;
use crate::earth::Latitude;
use crate::units::{DEGREES_PER_RADIAN as DEGREES, Radians, RadiansPerSecond};
use crate::words::Rounded;

/// Progress of an alignment by continuous rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The alignment begins.
    Begun {
        /// Number of planned turns.
        turns: u32,
        /// Geodetic latitude.
        latitude: Latitude,
    },
    /// The platform begins rate-modulated turns, which make the axis misalignment observable, at
    /// this mean rate.
    Modulated(RadiansPerSecond),
    /// The estimated axis misalignment, the elevation of the gyro's sensitive axis above the plane
    /// of rotation, and its 1σ.
    Misalignment(Radians, Radians),
    /// Turns are evaluated from here on: sense of rotation and speed.
    Stretch(Sense, RadiansPerSecond),
    /// A turn was completed: its number from 1, the number of planned turns.
    Turned(u32, u32),
    /// The number of turns of one sense of rotation that are excluded from the fit.
    LeftOut(u32, Sense),
}

crate::words! { Progress:
    Self::Begun { turns, latitude } =>
        "begin: {} turns at latitude {}°", turns, Rounded::<4>(latitude.rad() * DEGREES);
    Self::Modulated(rate) =>
        "rate-modulated turns, {} °/s in the mean, to measure the axis misalignment",
        Rounded::<2>(rate.degrees_per_second());
    Self::Misalignment(angle, sigma) =>
        "gyro's axis {}° ± {}° (1σ) above the platform",
        Rounded::<4>(angle.degrees()), Rounded::<4>(sigma.degrees());
    Self::Stretch(sense, speed) =>
        "turns count from here: {}, {} °/s", sense, Rounded::<2>(speed.degrees_per_second());
    Self::Turned(number, of) => "turn {} of {}", number, of;
    Self::LeftOut(turns, sense) =>
        "{} turn(s) {} left out: something disturbed them", turns, sense;
}
