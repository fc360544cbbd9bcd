//! Configuration of a multi-position alignment: site, mount, and what is known beforehand.

use super::mount::Mount;
use crate::alignment::setup::{GREATEST, SetupError, check_ranges};
use crate::alignment::site::Site;
use crate::earth::Latitude;
use crate::signal::SwayNoise;
use crate::units::Radians;

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
    /// Whether an azimuth lies in this half.
    #[must_use]
    pub fn contains(self, azimuth: Radians) -> bool {
        (libm::sin(azimuth.0) >= 0.0) == (self == Self::East)
    }
}

/// Prior knowledge of ρ, the Earth rate found over the expected one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amplitude {
    /// No prior knowledge: A = atan2(·,·).
    Free,
    /// Expected value one with this standard deviation; zero means exactly one.
    Known(f64),
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

    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`].
    pub(crate) fn check(&self) -> Result<(), SetupError> {
        let (positive, sway) = ([0.0, GREATEST], &self.sway);
        self.site.check()?;
        check_ranges(&[
            ("angle_variance", sway.angle_variance, positive),
            ("correlation", sway.correlation.0, [0.0, f64::INFINITY]),
            ("residual_variance", sway.residual_variance, positive),
        ])
    }

    /// Prior knowledge of the horizontal Earth rate.
    pub(super) fn known_amplitude(&self) -> Amplitude {
        Amplitude::Known(self.site.amplitude_sigma())
    }
}
