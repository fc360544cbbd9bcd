//! Zero-velocity detection: whether a vehicle stands, by the stop criteria of Szymanowski 2003 on
//! low-pass averages (eqs. 11 and 12).
//!
//! Kryt1 = Ω − |ω| compares the mean rate with the Earth's, Kryt2 = g − |f| the mean specific force
//! with gravity. Kryt2 alone takes steady driving for a stop, so either both must hold, or Kryt1
//! alone. The limits follow from the noise and the biases of the sensors and from the averaging
//! time.

use crate::earth::EARTH_RATE;

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
    /// Limit EPSGM of Kryt1, rad/s.
    pub rate: f64,
    /// Limit EPS of Kryt2, m/s².
    pub force: f64,
}

/// Stated noise and biases of the sensors of a vehicle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensors {
    /// Angle random walk N of each gyro, rad/√s.
    pub angle_random_walk: f64,
    /// 1σ of the gyros' biases, bias instability included, rad/s.
    pub bias_sigma: f64,
    /// Noise of the accelerometers, one-sided, m/s²/√Hz.
    pub force_noise: f64,
    /// 1σ of the accelerometers' biases, m/s².
    pub force_bias_sigma: f64,
}

impl Sensors {
    /// Limits for averages over this many seconds (> 0).
    #[must_use]
    pub fn limits(&self, seconds: f64) -> Limits {
        let rate = libm::hypot(self.angle_random_walk / libm::sqrt(seconds), self.bias_sigma);
        let force =
            libm::hypot(self.force_noise / libm::sqrt(2.0 * seconds), self.force_bias_sigma);
        Limits {
            rate: BOUND * rate + SHAKING / seconds,
            force: BOUND * force + GRAVITY_TOLERANCE + SWINGING / seconds,
        }
    }
}

/// Values of the two criteria for one average.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Criteria {
    /// Kryt1 = Ω − |ω|, rad/s.
    pub rate: f64,
    /// Kryt2 = g − |f|, m/s².
    pub force: f64,
}

impl Criteria {
    /// Criteria from the magnitudes of the mean rate, rad/s, and of the mean specific force, m/s²,
    /// for the local gravity, m/s².
    pub fn of(rate: f64, force: f64, gravity: f64) -> Self {
        Self { rate: EARTH_RATE - rate, force: gravity - force }
    }

    /// Criteria for a single gyro that is turned between averages, from the deviation of its mean
    /// rate from its usual one, rad/s. At rest two such rates differ by at most twice the Earth's
    /// rate, so only the excess over that counts.
    pub fn of_axis(deviation: f64, force: f64, gravity: f64) -> Self {
        let beyond = (deviation.abs() - 2.0 * EARTH_RATE).max(0.0);
        Self { rate: -beyond, force: gravity - force }
    }

    /// Whether the vehicle stands by both criteria.
    #[must_use]
    pub fn is_rest(&self, limits: &Limits) -> bool {
        self.rate.abs() <= limits.rate && self.force.abs() <= limits.force
    }
}
