//! The Earth as gyro and accelerometer measure it: rotation rate and normal gravity at a latitude
//! (WGS84).

use crate::units::{Metres, MetresPerSecondSquared, RadiansPerSecond, TURN};

/// Earth's rotation rate, rad/s (WGS84; 15.041067 °/h).
pub const EARTH_RATE: f64 = 7.292_115e-5;

/// Greatest latitude at which an azimuth is determined, rad (85°): beyond it the horizontal Earth
/// rate is below 9 % of the whole.
pub const HIGHEST_LATITUDE: f64 = 85.0 / 360.0 * TURN;

/// Equatorial radius of the ellipsoid, m (WGS84).
const SEMI_MAJOR_AXIS: f64 = 6_378_137.0;
/// Normal gravity at the equator, m/s² (WGS84).
const GRAVITY_EQUATOR: f64 = 9.780_325_335_9;
/// Somigliana's constant k (WGS84).
const SOMIGLIANA: f64 = 0.001_931_852_652_41;
/// First eccentricity squared of the ellipsoid (WGS84).
const ECCENTRICITY_SQUARED: f64 = 0.006_694_379_990_14;

/// A geodetic latitude, rad, always within ±90°.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Latitude(f64);

impl Latitude {
    /// Latitude of the equator.
    pub const EQUATOR: Self = Self(0.0);

    /// Latitude from degrees, north positive; `None` outside ±90° and for NaN.
    #[must_use]
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        (degrees.abs() <= 90.0).then_some(Self(degrees / 360.0 * TURN))
    }

    /// Latitude in radians, north positive.
    #[must_use]
    pub fn rad(self) -> f64 {
        self.0
    }

    /// Horizontal part of the Earth rate, Ω cos φ; points north.
    pub fn horizontal_rate(self) -> RadiansPerSecond {
        RadiansPerSecond(EARTH_RATE * libm::cos(self.0))
    }

    /// Vertical part of the Earth rate, Ω sin φ; points up where positive.
    pub fn vertical_rate(self) -> RadiansPerSecond {
        RadiansPerSecond(EARTH_RATE * libm::sin(self.0))
    }

    /// Normal gravity on the ellipsoid (Somigliana, WGS84).
    pub fn gravity(self) -> MetresPerSecondSquared {
        let sine = libm::sin(self.0);
        let squared = sine * sine;
        let part = libm::sqrt(1.0 - ECCENTRICITY_SQUARED * squared);
        MetresPerSecondSquared(GRAVITY_EQUATOR * (1.0 + SOMIGLIANA * squared) / part)
    }

    /// Radii of curvature of the ellipsoid along the meridian and along the parallel's normal
    /// section (WGS84), in this order.
    pub fn radii(self) -> [Metres; 2] {
        let sine = libm::sin(self.0);
        let part = 1.0 - ECCENTRICITY_SQUARED * sine * sine;
        let across = SEMI_MAJOR_AXIS / libm::sqrt(part);
        [Metres(across * (1.0 - ECCENTRICITY_SQUARED) / part), Metres(across)]
    }

    /// Whether an azimuth can be determined here: |φ| ≤ 85°.
    #[must_use]
    pub fn has_north(self) -> bool {
        self.0.abs() <= HIGHEST_LATITUDE
    }
}
