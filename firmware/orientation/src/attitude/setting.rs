//! Configuration of the attitude: gyros and accelerometers of a body, and its site.

use crate::earth::Latitude;
use crate::noise::GyroNoise;
use crate::units::{DEGREE, MetresPerSecondSquared, RadiansPerSecond, Seconds};

/// Configured properties of a gyro.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gyro {
    /// Noise model of the gyro.
    pub noise: GyroNoise,
    /// Standard deviation of the switch-on bias, 1σ.
    pub bias_sigma: RadiansPerSecond,
    /// Standard deviation of the scale factor (relative), and of the direction of the axis, rad,
    /// 1σ.
    pub scale_sigma: f64,
}

/// Configuration of three gyros and accelerometers on a body, and its site.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Setting {
    /// Geodetic latitude.
    pub latitude: Latitude,
    /// Gyros about forward, right, down.
    pub gyros: [Gyro; 3],
    /// Standard deviation of the accelerometers' biases, 1σ.
    pub force_bias_sigma: MetresPerSecondSquared,
    /// Sample period.
    pub sample_seconds: Seconds,
}

/// Time over which flicker noise is represented by a random walk of the rate, s: equivalent over
/// half an hour after a rest of some minutes.
const FLICKER_SECONDS: f64 = 600.0;

impl Gyro {
    /// An uncalibrated micromechanical gyro of the class of LSM6DSL: N 2.5 °/√h in motion (0.3 to 2 at rest), B 10 °/h,
    /// K 10 °/h/√h, turn-on bias 0.5 °/s, scale factor and axis alignment 0.5 %; each 1σ.
    #[must_use]
    pub fn coarse() -> Self {
        let noise = GyroNoise::from_field_units(2.5, 10.0, 10.0, 0.0);
        Self { noise, bias_sigma: RadiansPerSecond(0.5 * DEGREE), scale_sigma: 5e-3 }
    }

    /// Variance that a bias gains per second, (rad/s)²/s.
    pub(super) fn drift(&self) -> f64 {
        let (k, b) = (self.noise.rate_random_walk.0, self.noise.bias_instability.0);
        k * k + b * b / FLICKER_SECONDS
    }
}

impl Setting {
    /// Configuration of a coarse IMU whose accelerometers are calibrated to 2 mg.
    pub fn coarse(latitude: Latitude, sample_seconds: Seconds) -> Self {
        let force_bias_sigma = MetresPerSecondSquared(0.02);
        Self { latitude, gyros: [Gyro::coarse(); 3], force_bias_sigma, sample_seconds }
    }

    /// Configuration of three equal gyros, with accelerometers calibrated to 0.1 mg.
    pub fn precise(latitude: Latitude, sample_seconds: Seconds, gyro: Gyro) -> Self {
        let force_bias_sigma = MetresPerSecondSquared(1e-3);
        Self { latitude, gyros: [gyro; 3], force_bias_sigma, sample_seconds }
    }

    /// Configuration with another gyro about the down axis.
    pub fn with_down(self, gyro: Gyro) -> Self {
        let [forward, right, _] = self.gyros;
        Self { gyros: [forward, right, gyro], ..self }
    }
}
