//! Refusals of an inertial-frame alignment from stop to stop, with the sentences that are printed
//! for them.

use crate::units::{DegreesPerHour, MetresPerSecondSquared, Seconds};
use crate::words::Rounded;

/// Reason for which an inertial-frame alignment gives no azimuth, beside those that several methods have.
/// Quantities are in the units of its sentence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// No stop of the vehicle was detected.
    NoStop,
    /// A single stop was detected; the azimuth needs two stops (Szymanowski 2003).
    OneStop {
        /// Beginning of the stop.
        from: Seconds,
        /// End of the stop.
        to: Seconds,
    },
    /// A stop of the vehicle is too short.
    StopTooShort {
        /// Number of the stop, counted from one.
        stop: usize,
        /// Length of the stop.
        seconds: Seconds,
        /// Least length required.
        least: Seconds,
    },
    /// The Earth turned too little between the first and the last stop to show the azimuth.
    DriveTooShort {
        /// Time between the middles of these stops.
        seconds: Seconds,
        /// Least time required.
        least: Seconds,
    },
    /// The vehicle moved during an interval that was configured as a stop.
    VehicleMoves {
        /// Number of the stop, counted from one.
        stop: usize,
        /// Deviation of the mean rate from the Earth's.
        rate: DegreesPerHour,
        /// Deviation of the mean specific force from gravity.
        force: MetresPerSecondSquared,
    },
    /// Gyros and accelerometers disagree on the sway of the body: an axis or a sign is wrong.
    AxesDisagree {
        /// Power of the force changes after rotation by the gyros' angles over their power before
        /// it; below 1 where the axes agree.
        ratio: f64,
    },
    /// Samples are missing, and the rotation during the gap is unknown.
    RotationMissing {
        /// Time at which the gap begins.
        at: Seconds,
        /// Length of the gap.
        seconds: Seconds,
    },
    /// A gyro reached the limit of its range, and the rotation beyond it is unknown.
    RotationClipped {
        /// Time at which the gyro was saturated.
        at: Seconds,
    },
    /// Most of the time at rest was disturbed.
    RestDisturbed {
        /// Number of short means that were excluded.
        disturbed: u32,
        /// Number of all short means.
        of: u32,
    },
    /// At most stops the gyros measured another rotation than the Earth's.
    EarthNotFelt {
        /// Number of stops with another rotation.
        stops: u32,
        /// Number of all stops.
        of: u32,
    },
    /// Velocity integrated from the forces does not return to zero at the end of half of the drives
    /// or more.
    DrivesDisagree {
        /// Number of drives that do not end at rest.
        drives: u32,
        /// Number of all drives.
        of: u32,
    },
}

crate::words! { Refusal:
    Self::NoStop => "the vehicle stood nowhere: stop it, engine off, for a minute";
    Self::OneStop { from, to } =>
        "the vehicle stood once only, from {} to {} s: drive and stop again, or align it as one that stands",
        Rounded::<1>(from.0), Rounded::<1>(to.0);
    Self::StopTooShort { stop, seconds, least } =>
        "stop {} has {} s of rest: {} are needed",
        stop, Rounded::<1>(seconds.0), Rounded::<0>(least.0);
    Self::DriveTooShort { seconds, least } =>
        "{} s between the stops are too few for the Earth to turn: {} are needed",
        Rounded::<1>(seconds.0), Rounded::<0>(least.0);
    Self::VehicleMoves { stop, rate, force } =>
        "the vehicle moves at stop {}: its rate is {} °/h from the Earth's, its force {} m/s² from gravity",
        stop, Rounded::<2>(rate.0), Rounded::<3>(force.0);
    Self::AxesDisagree { ratio } =>
        "turned by what the gyros show, the forces change {} times more: check axes and signs of both",
        Rounded::<1>(ratio);
    Self::RotationMissing { at, seconds } =>
        "samples are missing after {} s, for {} s: what the vehicle turned meanwhile is lost",
        Rounded::<3>(at.0), Rounded::<3>(seconds.0);
    Self::RotationClipped { at } =>
        "a gyro stood at the limit of its range at {} s: what the vehicle turned beyond is lost",
        Rounded::<3>(at.0);
    Self::RestDisturbed { disturbed, of } =>
        "{} of {} means at rest were disturbed: keep the vehicle still", disturbed, of;
    Self::EarthNotFelt { stops, of } =>
        "at {} of {} stops the gyros turn otherwise than the Earth: check latitude, axes, signs and scale",
        stops, of;
    Self::DrivesDisagree { drives, of } =>
        "{} of {} drives do not end at rest by their forces: check accelerometers, gyros and displacement",
        drives, of;
}
