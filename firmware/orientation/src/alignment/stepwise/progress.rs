//! Progress of a multi-position alignment, with the sentences of the log.

use super::quality::Disturbance;
use crate::earth::Latitude;
use crate::noise::fit::{Coefficient, Estimate};
use crate::units::{DEGREES_PER_RADIAN as DEGREES, Radians, RadiansPerSecond, Seconds};
use crate::words::Rounded;

/// Progress of a multi-position alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The alignment begins.
    Begun {
        /// Number of planned positions.
        positions: usize,
        /// Duration of the dwell at each position.
        dwell: Seconds,
        /// Geodetic latitude.
        latitude: Latitude,
    },
    /// A survey of the gyro's noise begins; the stage stands still for this time.
    Surveying(Seconds),
    /// A noise coefficient of the gyro, in its field unit, estimated from the survey.
    Noise(Coefficient, Estimate),
    /// The measuring plan that follows from the noise coefficients.
    Planned {
        /// Number of positions.
        positions: usize,
        /// Duration of the dwell at each position.
        dwell: Seconds,
        /// Total duration with all movements.
        seconds: Seconds,
        /// Predicted 1σ of the azimuth.
        sigma: Radians,
    },
    /// A dwell was completed: its number from 1, the number of planned dwells, its mean rate.
    Dwelled(usize, usize, RadiansPerSecond),
    /// The dwell is shorter than planned because the stage moved without a command: its duration.
    CutShort(Seconds),
    /// A dwell is measured again: its number and the disturbance.
    Repeated(usize, Disturbance),
    /// A dwell is excluded from the fit: its number and the disturbance.
    LeftOut(usize, Disturbance),
}

crate::words! { Progress:
    Self::Begun { positions, dwell, latitude } =>
        "begin: {} positions of {} s at latitude {}°",
        positions, Rounded::<1>(dwell.0), Rounded::<4>(latitude.rad() * DEGREES);
    Self::Surveying(seconds) =>
        "survey: standing still for {} s to know the gyro", Rounded::<0>(seconds.0);
    Self::Noise(coefficient, estimate) => "{}: {}", coefficient, estimate;
    Self::Planned { positions, dwell, seconds, sigma } =>
        "plan: {} positions of {} s, {} s in all, for {}° (1σ)",
        positions, Rounded::<2>(dwell.0), Rounded::<0>(seconds.0), Rounded::<4>(sigma.degrees());
    Self::Dwelled(number, of, rate) =>
        "dwell {} of {}: {} °/h", number, of, Rounded::<4>(rate.degrees_per_hour());
    Self::CutShort(seconds) =>
        "that dwell is short, {} s: the stage moved of itself", Rounded::<1>(seconds.0);
    Self::Repeated(number, why) => "dwell {} is measured again: {}", number, why;
    Self::LeftOut(number, why) => "dwell {} is left out: {}", number, why;
}
