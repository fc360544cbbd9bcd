//! Progress of a multi-position alignment, with the sentences of the log.

use super::quality::Disturbance;
use crate::earth::Latitude;
use crate::noise::fit::{Coefficient, Estimate};
use crate::units::{DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES};
use crate::words::Rounded;

/// Progress of a multi-position alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The alignment begins.
    Begun {
        /// Number of planned positions.
        positions: usize,
        /// Duration of the dwell at each position, s.
        dwell: f64,
        /// Geodetic latitude.
        latitude: Latitude,
    },
    /// A survey of the gyro's noise begins; the stage stands still for this time, s.
    Surveying(f64),
    /// A noise coefficient of the gyro, in its field unit, estimated from the survey.
    Noise(Coefficient, Estimate),
    /// The measuring plan that follows from the noise coefficients.
    Planned {
        /// Number of positions.
        positions: usize,
        /// Duration of the dwell at each position, s.
        dwell: f64,
        /// Total duration with all movements, s.
        seconds: f64,
        /// Predicted 1σ of the azimuth, rad.
        sigma: f64,
    },
    /// A dwell was completed: its number from 1, the number of planned dwells, its mean rate, rad/s.
    Dwelled(usize, usize, f64),
    /// The dwell is shorter than planned because the stage moved without a command: its duration,
    /// s.
    CutShort(f64),
    /// A dwell is measured again: its number and the disturbance.
    Repeated(usize, Disturbance),
    /// A dwell is excluded from the fit: its number and the disturbance.
    LeftOut(usize, Disturbance),
}

crate::words! { Progress:
    Self::Begun { positions, dwell, latitude } =>
        "begin: {} positions of {} s at latitude {}°",
        positions, Rounded::<1>(dwell), Rounded::<4>(latitude.rad() * DEGREES);
    Self::Surveying(seconds) =>
        "survey: standing still for {} s to know the gyro", Rounded::<0>(seconds);
    Self::Noise(coefficient, estimate) => "{}: {}", coefficient, estimate;
    Self::Planned { positions, dwell, seconds, sigma } =>
        "plan: {} positions of {} s, {} s in all, for {}° (1σ)",
        positions, Rounded::<2>(dwell), Rounded::<0>(seconds), Rounded::<4>(sigma * DEGREES);
    Self::Dwelled(number, of, rate) =>
        "dwell {} of {}: {} °/h", number, of, Rounded::<4>(rate / DEGREE_PER_HOUR);
    Self::CutShort(seconds) =>
        "that dwell is short, {} s: the stage moved of itself", Rounded::<1>(seconds);
    Self::Repeated(number, why) => "dwell {} is measured again: {}", number, why;
    Self::LeftOut(number, why) => "dwell {} is left out: {}", number, why;
}
