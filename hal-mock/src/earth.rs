//! Earth rate and normal gravity at a site, and how a platform on a tilted base sees them.
//!
//! Own reading, by full rotation matrices: no small-angle or linear formula is used.

/// A 3 × 3 matrix, rows first.
pub type Matrix = [[f64; 3]; 3];

/// Earth's rotation rate, rad/s (WGS 84, NIMA TR8350.2, table 3.1).
pub const EARTH_RATE_RAD_S: f64 = 7.292_115e-5;

/// Normal gravity at the equator, m/s² (WGS 84, NIMA TR8350.2, table 3.4).
const GRAVITY_EQUATOR_M_S2: f64 = 9.780_325_335_9;

/// Semi-major axis, m (WGS 84, NIMA TR8350.2, table 3.1).
const SEMI_MAJOR_M: f64 = 6_378_137.0;

/// Constant of Somigliana's formula (WGS 84, NIMA TR8350.2, table 3.4).
const SOMIGLIANA: f64 = 0.001_931_852_652_41;

/// First eccentricity squared (WGS 84, NIMA TR8350.2, table 3.3).
const ECCENTRICITY_SQUARED: f64 = 0.006_694_379_990_14;

/// Normal gravity on the ellipsoid, m/s², at a geodetic latitude in rad (Somigliana 1929).
#[must_use]
pub fn normal_gravity_m_s2(latitude_rad: f64) -> f64 {
    let sine = libm::sin(latitude_rad);
    let square = sine * sine;
    GRAVITY_EQUATOR_M_S2 * (1.0 + SOMIGLIANA * square)
        / libm::sqrt(1.0 - ECCENTRICITY_SQUARED * square)
}

/// Radii of curvature of the ellipsoid, m, along the meridian and across it, at a geodetic latitude in
/// rad: a(1 − e²)/(1 − e² sin²φ)^³ᐟ² and a/√(1 − e² sin²φ).
pub(crate) fn curvature_radii_m(latitude_rad: f64) -> [f64; 2] {
    let sine = libm::sin(latitude_rad);
    let square = 1.0 - ECCENTRICITY_SQUARED * sine * sine;
    let transverse_m = SEMI_MAJOR_M / libm::sqrt(square);
    [transverse_m * (1.0 - ECCENTRICITY_SQUARED) / square, transverse_m]
}

/// Earth rate in north, east, down, rad/s, at a geodetic latitude in rad.
#[must_use]
pub fn earth_rate_rad_s(latitude_rad: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(latitude_rad);
    [EARTH_RATE_RAD_S * cosine, 0.0, -EARTH_RATE_RAD_S * sine]
}

/// Attitude of the base: from north, turned by azimuth about down, pitch about right, roll about
/// forward, in this order.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Attitude {
    /// Azimuth of body x from true north, clockwise from above, rad.
    pub azimuth_rad: f64,
    /// Pitch, rad, nose up positive.
    pub pitch_rad: f64,
    /// Roll, rad, right side down positive.
    pub roll_rad: f64,
}

impl Attitude {
    /// A base that leans by `tilt_rad` so that its axis at stage angle `uphill_rad` points uphill most:
    /// the force along an axis at θ is g·sin(tilt)·cos(θ − uphill), exactly.
    pub fn tilted(azimuth_rad: f64, tilt_rad: f64, uphill_rad: f64) -> Self {
        let (rise, level) = libm::sincos(tilt_rad);
        let (across, along) = libm::sincos(uphill_rad);
        let pitch_rad = libm::asin(rise * along);
        Self { azimuth_rad, pitch_rad, roll_rad: libm::atan2(-rise * across, level) }
    }

    /// Matrix from body to navigation axes: Rz(azimuth)·Ry(pitch)·Rx(roll).
    pub(crate) fn body_to_navigation(&self) -> Matrix {
        let tilt = multiply(&about_y(self.pitch_rad), &about_x(self.roll_rad));
        multiply(&about_z(self.azimuth_rad), &tilt)
    }
}

/// A place on Earth and the attitude of the base that stands on it.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Matrix from body to navigation axes.
    body_to_navigation: Matrix,
    /// Earth rate in north, east, down, rad/s.
    earth_rate_rad_s: [f64; 3],
    /// Normal gravity there, m/s².
    pub gravity_m_s2: f64,
}

impl Site {
    /// A base at a geodetic latitude in rad.
    pub fn new(latitude_rad: f64, attitude: &Attitude) -> Self {
        Self {
            body_to_navigation: attitude.body_to_navigation(),
            earth_rate_rad_s: earth_rate_rad_s(latitude_rad),
            gravity_m_s2: normal_gravity_m_s2(latitude_rad),
        }
    }

    /// This place under a base of another attitude.
    pub fn with_attitude(&self, attitude: &Attitude) -> Self {
        Self { body_to_navigation: attitude.body_to_navigation(), ..*self }
    }

    /// Matrix from platform to navigation axes with the stage at `stage_rad`, clockwise from above
    /// (positive about body z, which points down).
    #[must_use]
    pub fn platform_to_navigation(&self, stage_rad: f64) -> Matrix {
        multiply(&self.body_to_navigation, &about_z(stage_rad))
    }

    /// What a platform at rest at `stage_rad` feels on its axes: x along the sensitive axis, y 90°
    /// clockwise of it, z down.
    #[must_use]
    pub fn on_platform(&self, stage_rad: f64) -> InertialInput {
        let to_navigation = self.platform_to_navigation(stage_rad);
        InertialInput {
            rate_rad_s: apply_transposed(&to_navigation, self.earth_rate_rad_s),
            force_m_s2: apply_transposed(&to_navigation, [0.0, 0.0, -self.gravity_m_s2]),
        }
    }
}

/// Inertial angular rate and specific force on three axes: what sensors on them feel, in one moment or in the
/// mean over a sample, and what they show of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InertialInput {
    /// Inertial angular rate, rad/s.
    pub rate_rad_s: [f64; 3],
    /// Specific force, m/s²; at rest −Cᵀ(0, 0, g), uphill reads positive.
    pub force_m_s2: [f64; 3],
}

/// Rotation about x (forward), rad.
pub(crate) fn about_x(angle: f64) -> Matrix {
    let (s, c) = libm::sincos(angle);
    [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]
}

/// Rotation about y (right), rad.
pub(crate) fn about_y(angle: f64) -> Matrix {
    let (s, c) = libm::sincos(angle);
    [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]
}

/// Rotation about z (down), rad.
pub(crate) fn about_z(angle: f64) -> Matrix {
    let (s, c) = libm::sincos(angle);
    [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
}

/// The product of two matrices.
pub(crate) fn multiply(left: &Matrix, right: &Matrix) -> Matrix {
    left.map(|row| apply_transposed(right, row))
}

/// The transposed matrix times a vector, which is the vector as a row times the matrix.
pub(crate) fn apply_transposed(matrix: &Matrix, vector: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|column| {
        vector[0] * matrix[0][column]
            + vector[1] * matrix[1][column]
            + vector[2] * matrix[2][column]
    })
}

/// The vector product a × b.
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
