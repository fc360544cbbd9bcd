//! Configuration of the roll estimation: the gyro of the spinning body, and the method.

use crate::alignment::period::PERIOD_TOLERANCE;
use crate::alignment::setup::{GREATEST, PERIODS, SetupError, check_ranges};
use crate::units::{RadiansPerRootSecond, RadiansPerSecond, Seconds};

/// Method by which the roll is corrected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Method {
    /// Extrema without interpolation (Nekrasova 2017): at every extremum of a force the roll is set
    /// to that of the extremum, accurate to half a sample at best.
    Extrema,
    /// Extrema located between the samples by a parabola.
    Interpolated,
    /// Phase lock: phase of all samples of a turn, with the gyro's scale error estimated from turn
    /// to turn.
    #[default]
    PhaseLocked,
}

/// Configuration of the roll estimation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Setting {
    /// Sample period.
    pub sample_seconds: Seconds,
    /// Tolerance of the time stamps' mean step against that period, relative.
    pub period_tolerance: f64,
    /// Angle random walk N of the x-gyro.
    pub angle_random_walk: RadiansPerRootSecond,
    /// Standard deviation of the x-gyro's scale factor, 1σ, relative.
    pub scale_sigma: f64,
    /// Standard deviation of the x-gyro's bias, 1σ.
    pub bias_sigma: RadiansPerSecond,
    /// Method by which the roll is corrected.
    pub method: Method,
}

impl Setting {
    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`].
    pub fn check(&self) -> Result<(), SetupError> {
        let positive = [0.0, GREATEST];
        check_ranges(&[
            ("sample_seconds", self.sample_seconds.0, PERIODS),
            ("period_tolerance", self.period_tolerance, [0.0, 1.0]),
            ("angle_random_walk", self.angle_random_walk.0, positive),
            ("scale_sigma", self.scale_sigma, positive),
            ("bias_sigma", self.bias_sigma.0, positive),
        ])
    }

    /// Configuration of a phase-locked gyro of 0.06 °/√s, with its scale known to 1 % and its bias
    /// to 0.06 °/s.
    #[must_use]
    pub fn new(sample_seconds: Seconds) -> Self {
        Self {
            sample_seconds,
            period_tolerance: PERIOD_TOLERANCE,
            angle_random_walk: RadiansPerRootSecond(1e-3),
            scale_sigma: 0.01,
            bias_sigma: RadiansPerSecond(1e-3),
            method: Method::PhaseLocked,
        }
    }
}
