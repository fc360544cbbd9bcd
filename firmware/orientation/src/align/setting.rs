//! What is known before an alignment begins: the place, the gyro, the platform, and what is asked.

use super::direction::Amplitude;
use super::level::Tilt;
use crate::earth::Latitude;
use crate::noise::model::GyroNoise;
use crate::signal::dwell::Dwell;
use crate::signal::sway::SwayNoise;
use crate::units::{DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, TURN};

/// The half of the circle in which an azimuth is known to lie, which is all that two opposite
/// positions cannot tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// 0° to 180°.
    East,
    /// 180° to 360°.
    West,
}

impl Half {
    /// Whether an azimuth, rad, lies in it.
    #[must_use]
    pub fn contains(self, azimuth: f64) -> bool {
        (libm::sin(azimuth) >= 0.0) == (self == Self::East)
    }
}

/// What carries the gyro, and where its accelerometer sits. A mount comes with its own geometry, so
/// that the firmware of one holds nothing of another's.
#[derive(Clone, Copy, Debug)]
pub struct Mount {
    /// Its name.
    pub name: &'static str,
    /// Whether the accelerometer sits on the base, so that its biases are tilt; else it rides beside
    /// the gyro, and they average out over a circle.
    pub is_on_base: bool,
    /// The sensitive axis in a dwell, in the levelled frame: forward, right, down.
    pub axis: fn(&Tilt, &Dwell) -> [f64; 3],
    /// Specific force that κ multiplies in a dwell, in g.
    pub force: fn(&Tilt, &Dwell) -> [f64; 2],
}

impl Mount {
    /// The single-axis stage: the sensitive axis stays in its plane, the accelerometer rides on it.
    pub const STAGE: Self = Self {
        name: "stage",
        is_on_base: false,
        axis: |tilt, dwell| tilt.sensitive_axis(dwell.stage.rad()),
        force: |tilt, dwell| tilt.force(dwell.stage.rad()),
    };

    /// By how much a dwell has turned the accelerometer from the base's axes, rad.
    #[must_use]
    pub fn accelerometer_turn(&self, dwell: &Dwell) -> f64 {
        if self.is_on_base { 0.0 } else { dwell.stage.rad() }
    }
}

impl PartialEq for Mount {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// The place, the instrument and the demands. A standard deviation of zero says: exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// What carries the gyro.
    pub mount: Mount,
    /// Geodetic latitude.
    pub latitude: Latitude,
    /// 1σ of the latitude, rad.
    pub latitude_sigma: f64,
    /// The gyro's drift and, where [`Self::white_known`], its white noise.
    pub noise: GyroNoise,
    /// Whether N is known; else it is estimated from the dwells.
    pub white_known: bool,
    /// What subtracting the base's sway leaves in the rates.
    pub sway: SwayNoise,
    /// 1σ of the gyro's scale factor, relative.
    pub scale_sigma: f64,
    /// g-sensitivity κ along the sensitive axis and 90° clockwise of it, rad/s per g; in two frames
    /// along the inner frame's axis instead.
    pub g_sensitivity: [f64; 2],
    /// 1σ of either part of κ, rad/s per g; in two frames of the third one too, which is taken as zero.
    pub g_sensitivity_sigma: f64,
    /// Whether κ and its σ are known; else κ is taken as zero and its σ by the gyro's noise.
    pub g_sensitivity_known: bool,
    /// 1σ of each accelerometer bias, m/s².
    pub accelerometer_bias_sigma: f64,
    /// 1σ of the encoder's zero and harmonics, as they turn the azimuth, rad; in two frames with what
    /// their calibration leaves ([`super::mount::azimuth_sigma`]).
    pub encoder_sigma: f64,
    /// The half of the circle in which the azimuth is known to lie, if that is known; two positions
    /// need it, and no answer comes from the other half.
    pub half: Option<Half>,
    /// Greatest standard deviation of the azimuth that is accepted, rad.
    pub required_sigma: f64,
    /// Greatest tilt of the platform that is accepted, rad.
    pub allowed_tilt: f64,
}

/// Relative uncertainty of the Earth rate below which it is exact: no azimuth shows it.
const EXACT_AMPLITUDE: f64 = 1e-9;

/// 1σ of a g-sensitivity of which nothing is known, rad/s per g for each (rad/√s)² of N²: 50 000 °/h/g for each
/// (°/√h)², which is 0.05 °/h/g for a fibre-optic gyro of 0.001 °/√h and 20 °/h/g for a micromachined one of 0.02.
const KAPPA_OF_NOISE: f64 =
    50_000.0 * DEGREE_PER_HOUR / (DEGREE_PER_SQRT_HOUR * DEGREE_PER_SQRT_HOUR);
/// The most of it, rad/s per g: 100 °/h/g, half of what data sheets of micromachined gyros allow at most.
const GREATEST_KAPPA: f64 = 100.0 * DEGREE_PER_HOUR;

impl Setting {
    /// An ideal instrument at a latitude: nothing is uncertain, N is to be estimated, an azimuth
    /// of 10° (1σ) and a tilt of 15° are accepted.
    #[must_use]
    pub fn at(latitude: Latitude) -> Self {
        Self {
            mount: Mount::STAGE,
            latitude,
            latitude_sigma: 0.0,
            noise: GyroNoise::default(),
            white_known: false,
            sway: SwayNoise::NONE,
            scale_sigma: 0.0,
            g_sensitivity: [0.0; 2],
            g_sensitivity_sigma: 0.0,
            g_sensitivity_known: true,
            accelerometer_bias_sigma: 0.0,
            encoder_sigma: 0.0,
            half: None,
            required_sigma: 10.0 / 360.0 * TURN,
            allowed_tilt: 15.0 / 360.0 * TURN,
        }
    }

    /// The horizontal Earth rate as it is known beforehand.
    #[must_use]
    pub fn known_amplitude(&self) -> Amplitude {
        Amplitude::Known(self.amplitude_sigma())
    }

    /// 1σ of either part of κ, rad/s per g, for a gyro of this N, rad/√s.
    #[must_use]
    pub fn kappa_sigma(&self, angle_random_walk: f64) -> f64 {
        if self.g_sensitivity_known {
            self.g_sensitivity_sigma
        } else {
            (KAPPA_OF_NOISE * angle_random_walk * angle_random_walk).min(GREATEST_KAPPA)
        }
    }

    /// Relative 1σ of the horizontal Earth rate as the gyro reads it: scale factor and latitude.
    #[must_use]
    pub fn amplitude_sigma(&self) -> f64 {
        let latitude = libm::tan(self.latitude.rad()) * self.latitude_sigma;
        let sigma = libm::hypot(self.scale_sigma, latitude);
        if sigma < EXACT_AMPLITUDE { 0.0 } else { sigma }
    }
}
