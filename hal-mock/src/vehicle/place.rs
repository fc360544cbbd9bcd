//! Where the vehicle is, and what Earth is like there.

use crate::earth::{curvature_radii_m, earth_rate_rad_s, normal_gravity_m_s2};

/// A place on the ellipsoid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Position {
    /// Geodetic latitude, rad.
    pub latitude_rad: f64,
    /// Longitude from the start, rad, east positive.
    pub longitude_rad: f64,
}

impl Position {
    /// North and east from another position, m: differences of coordinates times the radii of
    /// curvature at the mean latitude, as two position fixes give them.
    pub(crate) fn displacement_m(&self, from: &Self) -> [f64; 2] {
        let mean_rad = 0.5 * (self.latitude_rad + from.latitude_rad);
        let [meridian_m, transverse_m] = curvature_radii_m(mean_rad);
        let east_rad = (self.longitude_rad - from.longitude_rad) * libm::cos(mean_rad);
        [(self.latitude_rad - from.latitude_rad) * meridian_m, east_rad * transverse_m]
    }

    /// Moves on by these rates of latitude and longitude for some seconds.
    pub(super) fn travel(&mut self, rates_rad_s: [f64; 2], seconds: f64) {
        self.latitude_rad += rates_rad_s[0] * seconds;
        self.longitude_rad += rates_rad_s[1] * seconds;
    }
}

/// Earth at a latitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) latitude_rad: f64,
    /// Earth's rotation, north, east, down.
    pub(super) earth_rad_s: [f64; 3],
    pub(super) gravity_m_s2: f64,
    /// Radii of curvature along the meridian and across it.
    radii_m: [f64; 2],
    /// Tangent of the latitude, 1.
    tangent: f64,
    /// Cosine of the latitude, 1.
    cosine: f64,
}

impl Place {
    /// Earth at a geodetic latitude in rad.
    pub(super) fn at(latitude_rad: f64) -> Self {
        Self {
            latitude_rad,
            earth_rad_s: earth_rate_rad_s(latitude_rad),
            gravity_m_s2: normal_gravity_m_s2(latitude_rad),
            radii_m: curvature_radii_m(latitude_rad),
            tangent: libm::tan(latitude_rad),
            cosine: libm::cos(latitude_rad),
        }
    }

    /// Rate at which the local level turns under a velocity north, east, down, rad/s.
    pub(super) fn transport_rad_s(&self, [north, east, _]: [f64; 3]) -> [f64; 3] {
        let [meridian_m, transverse_m] = self.radii_m;
        let about_north = east / transverse_m;
        [about_north, -north / meridian_m, -about_north * self.tangent]
    }

    /// Rates of latitude and longitude at a velocity north, east, down, rad/s.
    pub(super) fn travel_rad_s(&self, [north, east, _]: [f64; 3]) -> [f64; 2] {
        let [meridian_m, transverse_m] = self.radii_m;
        [north / meridian_m, east / (transverse_m * self.cosine)]
    }
}
