//! Whether a vehicle stands: Szymanowski's criteria on low-pass averages (his eqs. 11 and 12).
//!
//! Kryt1 = Ω − |ω| compares the mean rate with the Earth's, Kryt2 = g − |f| the mean specific force with
//! gravity. Kryt2 alone takes steady driving for a stop, so both must hold, or Kryt1 alone. What they
//! are held to follows from the noise and the biases of the sensors, and from the averaging time.

use crate::earth::EARTH_RATE;
use crate::noise::model::GyroNoise;

/// Standard deviations that a criterion may be off at rest.
const BOUND: f64 = 4.0;
/// How far wind and engine turn a vehicle at rest between both ends of an average, rad: 20″.
const SHAKING: f64 = 1e-4;
/// How far gravity may be from the normal one, m/s²: 1.5 km of height.
const GRAVITY_TOLERANCE: f64 = 5e-3;
/// Speed by which a vehicle at rest moves back and forth at both ends of an average, m/s.
const SWINGING: f64 = 0.02;

/// What the criteria are held to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// EPSGM, of Kryt1, rad/s.
    pub rate: f64,
    /// EPS, of Kryt2, m/s².
    pub force: f64,
}

/// What is known of the sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensors {
    /// Angle random walk N of each gyro, rad/√s.
    pub angle_random_walk: f64,
    /// 1σ of the gyros' biases, rad/s.
    pub bias_sigma: f64,
    /// Noise of the accelerometers, one-sided, m/s²/√Hz.
    pub force_noise: f64,
    /// 1σ of the accelerometers' biases, m/s².
    pub force_bias_sigma: f64,
}

impl Sensors {
    /// Three gyros with this noise and these 1σ of their biases, rad/s, and accelerometers with this
    /// noise, m/s²/√Hz, and these 1σ of biases, m/s².
    #[must_use]
    pub fn new(
        noise: &GyroNoise,
        bias_sigma: f64,
        force_noise: f64,
        force_bias_sigma: f64,
    ) -> Self {
        let bias_sigma = libm::hypot(bias_sigma, noise.bias_instability);
        Self {
            angle_random_walk: noise.angle_random_walk,
            bias_sigma,
            force_noise,
            force_bias_sigma,
        }
    }

    /// What averages over so many seconds are held to.
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

/// Both criteria of one average.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Criteria {
    /// Kryt1, rad/s.
    pub rate: f64,
    /// Kryt2, m/s².
    pub force: f64,
}

impl Criteria {
    /// From the lengths of the mean rate, rad/s, and of the mean specific force, m/s², where gravity is
    /// so great, m/s².
    #[must_use]
    pub fn of(rate: f64, force: f64, gravity: f64) -> Self {
        Self { rate: EARTH_RATE - rate, force: gravity - force }
    }

    /// The same of one axis, which is turned between averages, from how far its mean rate is from the usual
    /// one, rad/s: at rest they differ by twice the Earth's at most, so less than that is no rate at all.
    #[must_use]
    pub fn of_axis(deviation: f64, force: f64, gravity: f64) -> Self {
        let beyond = (deviation.abs() - 2.0 * EARTH_RATE).max(0.0);
        Self { rate: -beyond, force: gravity - force }
    }

    /// Whether the vehicle stands, by both.
    #[must_use]
    pub fn is_rest(&self, limits: &Limits) -> bool {
        self.rate.abs() <= limits.rate && self.force.abs() <= limits.force
    }
}
