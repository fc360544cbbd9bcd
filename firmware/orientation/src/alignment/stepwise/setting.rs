//! Configuration of an alignment: site, gyro, platform and requirements.

use super::direction::Amplitude;
use super::level::Tilt;
use crate::earth::Latitude;
use crate::noise::model::GyroNoise;
use crate::signal::dwell::Dwell;
use crate::signal::sway::SwayNoise;
use crate::units::{DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, TURN};

/// Half circle in which the azimuth is known to lie: the ambiguity that two opposite positions
/// leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Half {
    /// Eastern half: 0° to 180°.
    East,
    /// Western half: 180° to 360°.
    West,
}

impl Half {
    /// Whether an azimuth, rad, lies in this half.
    #[must_use]
    pub fn contains(self, azimuth: f64) -> bool {
        (libm::sin(azimuth) >= 0.0) == (self == Self::East)
    }
}

/// Mechanism that carries the gyro, and the place of its accelerometer. A mount brings its own
/// geometry as functions, so that firmware for one mount contains no code for another.
#[derive(Clone, Copy, Debug)]
pub struct Mount {
    /// Name of the mount, by which mounts are compared.
    pub name: &'static str,
    /// Whether the accelerometer is fixed to the base, so that its biases act as tilt; otherwise it
    /// rides beside the gyro, and they average out over a circle.
    pub is_on_base: bool,
    /// Function for the sensitive axis in a dwell: unit vector in the levelled frame, forward,
    /// right, down.
    pub axis: fn(&Tilt, &Dwell) -> [f64; 3],
    /// Function for the specific force that κ multiplies in a dwell, g.
    pub force: fn(&Tilt, &Dwell) -> [f64; 2],
}

impl Mount {
    /// Single-axis stage: the sensitive axis stays in the stage's plane, and the accelerometer
    /// rides on the stage.
    pub const STAGE: Self = Self {
        name: "stage",
        is_on_base: false,
        axis: |tilt, dwell| tilt.sensitive_axis(dwell.stage.rad()),
        force: |tilt, dwell| tilt.force(dwell.stage.rad()),
    };

    /// Angle by which a dwell has turned the accelerometer from the base's axes, rad.
    #[must_use]
    pub fn accelerometer_turn(&self, dwell: &Dwell) -> f64 {
        if self.is_on_base { 0.0 } else { dwell.stage.rad() }
    }
}

impl Default for Mount {
    fn default() -> Self {
        Self::STAGE
    }
}

impl PartialEq for Mount {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Site, instrument and requirements. A standard deviation of zero means exact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Setting {
    /// Mechanism that carries the gyro; text does not hold it, because it is code.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub mount: Mount,
    /// Geodetic latitude.
    pub latitude: Latitude,
    /// Standard deviation of the latitude, 1σ, rad.
    pub latitude_sigma: f64,
    /// Drift of the gyro and, where [`Self::white_known`], its white noise.
    pub noise: GyroNoise,
    /// Whether N is known; otherwise it is estimated from the dwells.
    pub white_known: bool,
    /// Noise that sway compensation leaves in the rates.
    pub sway: SwayNoise,
    /// Standard deviation of the gyro's scale factor, 1σ, relative.
    pub scale_sigma: f64,
    /// g-sensitivity κ along the sensitive axis and 90° clockwise of it, rad/s per g; on a
    /// two-frame mount along the inner frame's axis instead.
    pub g_sensitivity: [f64; 2],
    /// Standard deviation of either part of κ, 1σ, rad/s per g; on a two-frame mount also of the
    /// third part, which is taken as zero.
    pub g_sensitivity_sigma: f64,
    /// Whether κ and its σ are known; otherwise κ is taken as zero and its σ follows from the
    /// gyro's noise ([`Self::kappa_sigma`]).
    pub g_sensitivity_known: bool,
    /// Standard deviation of each accelerometer bias, 1σ, m/s².
    pub accelerometer_bias_sigma: f64,
    /// Standard deviation of the azimuth due to the encoder's zero and harmonics, 1σ, rad; on a
    /// two-frame mount including the residual of its calibration ([`super::mount::azimuth_sigma`]).
    pub encoder_sigma: f64,
    /// Half circle in which the azimuth is known to lie, if that is known. Two positions require
    /// it, and no azimuth of the other half is returned.
    pub half: Option<Half>,
    /// Greatest standard deviation of the azimuth that is accepted, rad.
    pub required_sigma: f64,
    /// Greatest tilt of the platform that is accepted, rad.
    pub allowed_tilt: f64,
}

/// Relative uncertainty of the Earth rate below which it counts as exact: it has no effect on the
/// azimuth.
const EXACT_AMPLITUDE: f64 = 1e-9;

/// Standard deviation of an unknown g-sensitivity, rad/s per g for each (rad/√s)² of N²: 50 000
/// °/h/g for each (°/√h)², which is 0.05 °/h/g for a fibre-optic gyro of 0.001 °/√h and 20 °/h/g
/// for a micromachined one of 0.02 °/√h.
const KAPPA_OF_NOISE: f64 =
    50_000.0 * DEGREE_PER_HOUR / (DEGREE_PER_SQRT_HOUR * DEGREE_PER_SQRT_HOUR);
/// Upper limit of that standard deviation, rad/s per g: 100 °/h/g, half of the greatest value in
/// data sheets of micromachined gyros.
const GREATEST_KAPPA: f64 = 100.0 * DEGREE_PER_HOUR;

impl Setting {
    /// Ideal instrument at a latitude: nothing is uncertain, N is estimated, an azimuth of 10° (1σ)
    /// and a tilt of 15° are accepted.
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

    /// Prior knowledge of the horizontal Earth rate.
    #[must_use]
    pub fn known_amplitude(&self) -> Amplitude {
        Amplitude::Known(self.amplitude_sigma())
    }

    /// Standard deviation of either part of κ, 1σ, rad/s per g, for a gyro with this N, rad/√s.
    #[must_use]
    pub fn kappa_sigma(&self, angle_random_walk: f64) -> f64 {
        if self.g_sensitivity_known {
            self.g_sensitivity_sigma
        } else {
            (KAPPA_OF_NOISE * angle_random_walk * angle_random_walk).min(GREATEST_KAPPA)
        }
    }

    /// Relative 1σ of the horizontal Earth rate as the gyro measures it: scale factor and latitude.
    #[must_use]
    pub fn amplitude_sigma(&self) -> f64 {
        let latitude = libm::tan(self.latitude.rad()) * self.latitude_sigma;
        let sigma = libm::hypot(self.scale_sigma, latitude);
        if sigma < EXACT_AMPLITUDE { 0.0 } else { sigma }
    }
}
