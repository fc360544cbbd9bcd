//! What is known is kept: pitch, roll and azimuth through the time after the alignment.
//!
//! ```text
//!  coarse IMU, or three precise gyros ─▶ vertical ─pitch, roll, σ──────────┐
//!  precise gyro, vertical ─────────────▲    └─turn about the vertical─▶ azimuth ± σ(t) ─▶ link
//!                     alignment, or azimuth from outside ─hand over─▲   └─at rest─▶ remembered
//! ```

pub mod attitude;
pub mod heading;
pub mod keeper;
pub mod restart;
pub mod spin;
pub mod vertical;

pub use heading::{Handover, Realigned};
pub use keeper::{Azimuth, Keeper, Report, State};

use crate::earth::Latitude;
use crate::noise::model::GyroNoise;
use crate::units::DEGREE;
use vertical::Expected;

/// A gyro as it is known beforehand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gyro {
    /// Its noise.
    pub noise: GyroNoise,
    /// 1σ of its bias when it is switched on, rad/s.
    pub bias_sigma: f64,
    /// 1σ of its scale factor, and of the direction of its axis, rad.
    pub scale_sigma: f64,
}

/// Three gyros and accelerometers on a body, and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Where.
    pub latitude: Latitude,
    /// The gyros forward, right, down.
    pub gyros: [Gyro; 3],
    /// 1σ of the accelerometers' biases, m/s².
    pub force_bias_sigma: f64,
    /// Sample period, s.
    pub sample_seconds: f64,
}

/// Time over which flicker noise is taken for a walk of the rate, s: what it does in a half hour after a rest of
/// some minutes.
const FLICKER_SECONDS: f64 = 600.0;

impl Gyro {
    /// An uncalibrated micromechanical gyro of the class of LSM6DSL: N 2.5 °/√h in motion (0.3 to 2 at rest), B 10 °/h,
    /// K 10 °/h/√h, turn-on bias 0.5 °/s, scale factor and axis alignment 0.5 %; each 1σ.
    #[must_use]
    pub fn coarse() -> Self {
        let noise = GyroNoise::from_field_units(2.5, 10.0, 10.0, 0.0);
        Self { noise, bias_sigma: 0.5 * DEGREE, scale_sigma: 5e-3 }
    }

    /// Variance that a bias gains in a second, (rad/s)².
    fn drift(&self) -> f64 {
        let (k, b) = (self.noise.rate_random_walk, self.noise.bias_instability);
        k * k + b * b / FLICKER_SECONDS
    }
}

impl Setting {
    /// A coarse IMU, its accelerometers calibrated to 2 mg.
    #[must_use]
    pub fn coarse(latitude: Latitude, sample_seconds: f64) -> Self {
        Self { latitude, gyros: [Gyro::coarse(); 3], force_bias_sigma: 0.02, sample_seconds }
    }

    /// Three equal gyros, accelerometers calibrated to 0.1 mg.
    #[must_use]
    pub fn precise(latitude: Latitude, sample_seconds: f64, gyro: Gyro) -> Self {
        Self { latitude, gyros: [gyro; 3], force_bias_sigma: 1e-3, sample_seconds }
    }

    /// The same with this gyro about the axis down.
    #[must_use]
    pub fn with_down(self, gyro: Gyro) -> Self {
        let [forward, right, _] = self.gyros;
        Self { gyros: [forward, right, gyro], ..self }
    }

    /// What the filter expects of the gyros.
    fn expected(&self) -> Expected {
        Expected {
            walk: self.gyros.map(|gyro| {
                let walk = gyro.noise.angle_random_walk as f32;
                walk * walk
            }),
            drift: self.gyros.map(|gyro| gyro.drift() as f32),
            scale: self.gyros.map(|gyro| {
                let scale = gyro.scale_sigma as f32;
                scale * scale
            }),
        }
    }
}
