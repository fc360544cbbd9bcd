//! Tilt of the stage from the accelerometer that rides on it.
//!
//! Over the stage angle θ the readings are `f_x/g = Re(F e^{jθ}) + b_x` and
//! `f_y/g = −Im(F e^{jθ}) + b_y`. The tilt phasor F and both biases are fitted
//! together: over a full circle F comes out free of bias; over a short arc, or from an accelerometer
//! on the base, the bias's stated uncertainty goes into F's.

use super::regression::{COLUMNS, Column, Regression};
use super::setting::Mount;
use crate::signal::dwell::Dwell;

/// The tilt phasor in g: real part along body x, imaginary part to its quadrature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tilt {
    /// Real part of F, sin(pitch).
    pub real: f64,
    /// Imaginary part of F, sin(roll)·cos(pitch).
    pub imaginary: f64,
    /// Covariance of the two, g².
    pub covariance: [[f64; 2]; 2],
    /// Accelerometer biases along its x and y, g.
    pub bias: [f64; 2],
    /// RMS of the dwells' forces about any tilt and any bias, g.
    pub scatter: f64,
    /// Whether it was measured; else the platform is taken as level.
    pub measured: bool,
}

impl Tilt {
    /// |F|, the sine of the tilt angle.
    #[must_use]
    pub fn magnitude(&self) -> f64 {
        libm::hypot(self.real, self.imaginary)
    }

    /// Pitch of the body, rad; positive nose up.
    #[must_use]
    pub fn pitch(&self) -> f64 {
        libm::asin(self.real.clamp(-1.0, 1.0))
    }

    /// Roll of the body, rad; positive right side down.
    #[must_use]
    pub fn roll(&self) -> f64 {
        let cosine = libm::sqrt((1.0 - self.real * self.real).max(1e-12));
        libm::asin((self.imaginary / cosine).clamp(-1.0, 1.0))
    }

    /// The sensitive axis at stage angle `theta` (rad), in the levelled frame: forward, right, down.
    #[must_use]
    pub fn sensitive_axis(&self, theta: f64) -> [f64; 3] {
        let (sine, cosine) = libm::sincos(theta);
        let (sine_pitch, sine_roll) = (self.real, libm::sin(self.roll()));
        let cosine_pitch = libm::sqrt((1.0 - sine_pitch * sine_pitch).max(0.0));
        let cosine_roll = libm::sqrt((1.0 - sine_roll * sine_roll).max(0.0));
        [
            cosine_pitch * cosine + sine_pitch * sine_roll * sine,
            cosine_roll * sine,
            -sine_pitch * cosine + cosine_pitch * sine_roll * sine,
        ]
    }

    /// The base's downward axis, in the levelled frame.
    #[must_use]
    pub fn down(&self) -> [f64; 3] {
        let (sine_roll, cosine_roll) = libm::sincos(self.roll());
        let cosine_pitch = libm::sqrt((1.0 - self.real * self.real).max(0.0));
        [self.real * cosine_roll, -sine_roll, cosine_pitch * cosine_roll]
    }

    /// Specific force away from the base plane, up through it, in g.
    #[must_use]
    pub fn upward(&self) -> f64 {
        let magnitude = self.magnitude();
        libm::sqrt((1.0 - magnitude * magnitude).max(0.0))
    }

    /// Specific force along the sensitive axis and 90° clockwise of it, in g, free of bias.
    #[must_use]
    pub fn force(&self, theta: f64) -> [f64; 2] {
        let (sine, cosine) = libm::sincos(theta);
        [self.real * cosine - self.imaginary * sine, -(self.real * sine + self.imaginary * cosine)]
    }
}

/// Least uncertainty of a bias that is said to be exact, g.
const EXACT_BIAS: f64 = 1e-9;
/// Uncertainty of a bias of which nothing is known, g.
const ANY_BIAS: f64 = 1.0;
/// Scatter with which the first fit is weighted, and the least that the second believes, g.
const SCATTER: [f64; 2] = [1e-4, 1e-8];

/// Fits the tilt to the dwells' mean forces, for gravity in m/s² and the 1σ of each accelerometer
/// bias in m/s² (zero: taken as free of bias).
///
/// The accelerometer rides on a stage. The scatter of the dwells about a first fit is the noise of the
/// second. Dwells without force make the platform level and not measured.
#[must_use]
pub fn tilt<'a>(
    dwells: impl Iterator<Item = &'a Dwell> + Clone,
    gravity: f64,
    bias_sigma: f64,
) -> Tilt {
    tilt_in(&Mount::STAGE, dwells, gravity, bias_sigma)
}

/// The same from the accelerometer of any mount.
#[must_use]
pub fn tilt_in<'a>(
    mount: &Mount,
    dwells: impl Iterator<Item = &'a Dwell> + Clone,
    gravity: f64,
    bias_sigma: f64,
) -> Tilt {
    let bias = (bias_sigma / gravity).max(EXACT_BIAS);
    let first = fit(mount, dwells.clone(), gravity, bias, SCATTER[0]);
    let second = first
        .and_then(|(_, scatter)| fit(mount, dwells.clone(), gravity, bias, scatter.max(SCATTER[1])))
        .or(first);
    let any_bias = fit(mount, dwells, gravity, ANY_BIAS, SCATTER[0]);
    let scatter = any_bias.map_or(0.0, |(_, scatter)| scatter);
    second.map_or_else(Tilt::default, |(tilt, _)| Tilt { scatter, ..tilt })
}

/// Mean specific force over gravity, positive where it points up through the platform, as at rest;
/// `None` where no dwell has a force.
#[must_use]
pub fn gravity_ratio<'a>(dwells: impl Iterator<Item = &'a Dwell>, gravity: f64) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for [x, y, z] in dwells.filter_map(|dwell| dwell.force) {
        let size = libm::sqrt(x * x + y * y + z * z);
        sum += if z < 0.0 { size } else { -size };
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count / gravity)
}

/// One fit whose noise is `sigma` g; also the scatter found.
fn fit<'a>(
    mount: &Mount,
    dwells: impl Iterator<Item = &'a Dwell>,
    gravity: f64,
    bias_sigma: f64,
    sigma: f64,
) -> Option<(Tilt, f64)> {
    let mut regression = Regression::<COLUMNS>::default();
    let mut rows: f64 = 0.0;
    let weight = 1.0 / sigma;
    for dwell in dwells {
        let Some([x, y, _]) = dwell.force else { continue };
        let (sine, cosine) = libm::sincos(mount.accelerometer_turn(dwell));
        let [cosine, sine] = [cosine * weight, sine * weight];
        regression.push(&[cosine, -sine, weight, 0.0, 0.0], x / gravity * weight);
        regression.push(&[-sine, -cosine, 0.0, weight, 0.0], y / gravity * weight);
        rows += 2.0;
    }
    let bias = Column::Prior(bias_sigma);
    let solution = regression.solve(&[Column::Free, Column::Free, bias, bias, Column::Absent])?;
    let [real, imaginary, bias_x, bias_y, _] = solution.coefficients;
    let [[a, b, ..], [c, d, ..], ..] = solution.covariance;
    let covariance = [[a, b], [c, d]];
    let scatter = sigma * libm::sqrt(solution.chi_square / (rows - 4.0).max(1.0));
    let bias = [bias_x, bias_y];
    Some((Tilt { real, imaginary, covariance, bias, scatter, measured: true }, scatter))
}
