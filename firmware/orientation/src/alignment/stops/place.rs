//! Direction of the vertical at a place that rotates with the Earth, seen from inertial space.
//!
//! The frame is north, east, down of the first place at the start, frozen: in it the vertical of
//! any later time and place is known without knowing any azimuth.

use crate::earth::{EARTH_RATE, Latitude};
use crate::math::rotation::{Matrix, Vector, product, scaled, transposed};

/// Place of the first stop on the ellipsoid.
#[must_use]
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Geodetic latitude, rad.
    latitude: f64,
    /// Rotation from the Earth's axes to north, east, down at the start.
    start: Matrix,
    /// Change of latitude and of longitude per metre, rad/m.
    per_metre: [f64; 2],
}

impl Place {
    /// Place at a latitude. Beyond 89.9° the longitude is not meaningful.
    pub fn new(latitude: Latitude) -> Self {
        Self::moved(latitude, 0.0)
    }

    /// Place displaced north by an angle, rad.
    pub fn moved(latitude: Latitude, by: f64) -> Self {
        let [along, across] = latitude.radii();
        let latitude = latitude.rad() + by;
        let start = transposed(&navigation(latitude, 0.0));
        Self { latitude, start, per_metre: [1.0 / along.0, 1.0 / (across.0 * libm::cos(latitude))] }
    }

    /// Rotation from north, east, down at a time, s from the start, and at a displacement north and
    /// east, m, to the frozen axes of the start.
    #[must_use]
    pub fn navigation(&self, seconds: f64, [north, east]: [f64; 2]) -> Matrix {
        let [per_north, per_east] = self.per_metre;
        let longitude = EARTH_RATE * seconds + east * per_east;
        product(&self.start, &navigation(self.latitude + north * per_north, longitude))
    }

    /// Unit vector of the Earth's axis, north positive.
    #[must_use]
    pub fn axis(&self) -> Vector {
        self.start.map(|row| row[2])
    }

    /// Rotation of the local level per metre north and per metre east, rad/m.
    #[must_use]
    pub fn per_metre(&self) -> [f64; 2] {
        let [north, east] = self.per_metre;
        [north, east * libm::cos(self.latitude)]
    }

    /// Convergence of the meridians: rotation of north per metre east, rad/m.
    #[must_use]
    pub fn convergence(&self) -> f64 {
        self.per_metre[1] * libm::sin(self.latitude)
    }
}

/// Up vector in a frame in which the columns are north, east and down.
#[must_use]
pub fn up(navigation: &Matrix) -> Vector {
    scaled(&navigation.map(|row| row[2]), -1.0)
}

/// Rotation from north, east, down at a place to axes through equator and zero meridian, equator
/// and 90° east, and the pole.
fn navigation(latitude: f64, longitude: f64) -> Matrix {
    let (sine, cosine) = libm::sincos(latitude);
    let (east, along) = libm::sincos(longitude);
    [
        [-sine * along, -east, -cosine * along],
        [-sine * east, along, -cosine * east],
        [cosine, 0.0, -sine],
    ]
}
