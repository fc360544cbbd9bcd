//! Zero-velocity detection: whether a vehicle stands, by the stop criteria of Szymanowski 2003 on
//! low-pass averages.
//!
//! Kryt1 = Ω − |ω| compares the mean rate with the Earth's, Kryt2 = g − |f| the mean specific force
//! with gravity. Kryt2 alone takes steady driving for a stop, so either both must hold, or Kryt1
//! alone. The limits follow from the noise and the biases of the sensors and from the averaging
//! time.

use crate::earth::EARTH_RATE;
use crate::units::{
    ForceNoise, MetresPerSecondSquared, RadiansPerRootSecond, RadiansPerSecond, Seconds,
};

/// Limit of a criterion at rest, in standard deviations.
const BOUND: f64 = 4.0;
/// Rotation of a vehicle at rest by wind and engine between both ends of an average, rad: 20″.
const SHAKING: f64 = 1e-4;
/// Deviation of gravity from normal gravity, m/s²: 1.5 km of height.
const GRAVITY_TOLERANCE: f64 = 5e-3;
/// Speed at which a vehicle at rest rocks back and forth at both ends of an average, m/s.
const SWINGING: f64 = 0.02;

/// Limits of the two stop criteria.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Limit EPSGM of Kryt1.
    pub rate: RadiansPerSecond,
    /// Limit EPS of Kryt2.
    pub force: MetresPerSecondSquared,
}

/// Stated noise and biases of the sensors of a vehicle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensors {
    /// Angle random walk N of each gyro.
    pub angle_random_walk: RadiansPerRootSecond,
    /// 1σ of the gyros' biases, bias instability included.
    pub bias_sigma: RadiansPerSecond,
    /// Noise of the accelerometers, one-sided, m/s²/√Hz.
    pub force_noise: ForceNoise,
    /// 1σ of the accelerometers' biases.
    pub force_bias_sigma: MetresPerSecondSquared,
}

impl Sensors {
    /// Limits for averages over this time, > 0.
    #[must_use]
    pub fn limits(&self, seconds: Seconds) -> Limits {
        let seconds = seconds.0;
        let rate = libm::hypot(self.angle_random_walk.0 / libm::sqrt(seconds), self.bias_sigma.0);
        let force =
            libm::hypot(self.force_noise.0 / libm::sqrt(2.0 * seconds), self.force_bias_sigma.0);
        Limits {
            rate: RadiansPerSecond(BOUND * rate + SHAKING / seconds),
            force: MetresPerSecondSquared(BOUND * force + GRAVITY_TOLERANCE + SWINGING / seconds),
        }
    }
}

/// Values of the two criteria for one average.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Criteria {
    /// Kryt1 = Ω − |ω|.
    pub rate: RadiansPerSecond,
    /// Kryt2 = g − |f|.
    pub force: MetresPerSecondSquared,
}

impl Criteria {
    /// Criteria from the magnitudes of the mean rate, rad/s, and of the mean specific force, m/s²,
    /// for the local gravity, m/s².
    pub(crate) fn of(rate: f64, force: f64, gravity: f64) -> Self {
        let (rate, force) = (EARTH_RATE - rate, gravity - force);
        Self { rate: RadiansPerSecond(rate), force: MetresPerSecondSquared(force) }
    }

    /// Criteria for a single gyro that is turned between averages, from the deviation of its mean
    /// rate from its usual one, rad/s. At rest two such rates differ by at most twice the Earth's
    /// rate, so only the excess over that counts.
    pub(crate) fn of_axis(deviation: f64, force: f64, gravity: f64) -> Self {
        let beyond = (deviation.abs() - 2.0 * EARTH_RATE).max(0.0);
        Self { rate: RadiansPerSecond(-beyond), force: MetresPerSecondSquared(gravity - force) }
    }

    /// Whether the vehicle stands by both criteria.
    #[must_use]
    pub fn is_rest(&self, limits: &Limits) -> bool {
        self.rate.0.abs() <= limits.rate.0 && self.force.0.abs() <= limits.force.0
    }
}
