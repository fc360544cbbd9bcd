//! Progress of an inertial-frame alignment from stop to stop, with the sentences of the log.

use crate::device::Device;
use crate::earth::Latitude;
use crate::units::{DEGREES_PER_RADIAN as DEGREES, Metres, Radians, RadiansPerSecond, Seconds};
use crate::words::Rounded;

/// Progress of an inertial-frame alignment from stop to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The alignment begins.
    Begun {
        /// Number of planned stops; zero where the samples end the alignment.
        stops: usize,
        /// Geodetic latitude of the first stop.
        latitude: Latitude,
    },
    /// The vehicle stands at its first stop.
    Standing,
    /// A further stop was detected: its number from 1, and the duration of the drive before it.
    Stopped(usize, Seconds),
    /// The displacement of a stop from the first one: its number from 1, and metres north and east.
    Displaced(usize, [Metres; 2]),
    /// The vehicle may drive on, because the stop was long enough: its number from 1, its duration,
    /// and pitch and roll of the vehicle.
    MayDrive(usize, Seconds, [Radians; 2]),
    /// The vehicle has set off.
    Driving,
    /// The estimated bias of a gyro and its 1σ.
    Bias(Device, RadiansPerSecond, RadiansPerSecond),
}

crate::words! { Progress:
    Self::Begun { latitude, .. } =>
        "begin: level, drive, stop and level again, at latitude {}°",
        Rounded::<4>(latitude.rad() * DEGREES);
    Self::Standing => "stop 1: the vehicle stands";
    Self::Stopped(number, seconds) =>
        "stop {} found after {} s of driving", number, Rounded::<0>(seconds.0);
    Self::Displaced(number, [north, east]) =>
        "stop {} is {} m north and {} m east of the first",
        number, Rounded::<1>(north.0), Rounded::<1>(east.0);
    Self::MayDrive(number, seconds, [pitch, roll]) =>
        "stop {} levelled for {} s: pitch {}°, roll {}°; the vehicle may drive",
        number, Rounded::<0>(seconds.0), Rounded::<3>(pitch.degrees()), Rounded::<3>(roll.degrees());
    Self::Driving => "driving";
    Self::Bias(gyro, bias, sigma) =>
        "{}: bias {} °/h ± {} °/h (1σ)",
        gyro, Rounded::<4>(bias.degrees_per_hour()), Rounded::<4>(sigma.degrees_per_hour());
}
