//! Configuration of a multi-position alignment: site, mount, and what is known beforehand.

use super::direction::Amplitude;
use super::level::Tilt;
use crate::alignment::site::Site;
use crate::earth::Latitude;
use crate::signal::dwell::Dwell;
use crate::signal::sway::SwayNoise;

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

/// Site, mount, and what is known beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Setting {
    /// Site, gyro, accelerometer and requirements.
    pub site: Site,
    /// Mechanism that carries the gyro; text does not hold it, because it is code.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub mount: Mount,
    /// Noise that sway compensation leaves in the rates.
    pub sway: SwayNoise,
    /// Half circle in which the azimuth is known to lie, if that is known. Two positions require
    /// it, and no azimuth of the other half is returned.
    pub half: Option<Half>,
}

impl Setting {
    /// Configuration of a stage whose base is at rest.
    #[must_use]
    pub fn new(site: Site) -> Self {
        Self { site, mount: Mount::STAGE, sway: SwayNoise::NONE, half: None }
    }

    /// Configuration of an ideal instrument at a latitude; see [`Site::at`].
    #[must_use]
    pub fn at(latitude: Latitude) -> Self {
        Self::new(Site::at(latitude))
    }

    /// Prior knowledge of the horizontal Earth rate.
    #[must_use]
    pub fn known_amplitude(&self) -> Amplitude {
        Amplitude::Known(self.site.amplitude_sigma())
    }
}
