//! Azimuth on the horizon from the phasor in the platform's plane, exact for any tilt.
//!
//! The plane's axes are body x and y. With pitch p, roll r and azimuth A, the horizontal Earth rate turns
//! with the platform as `Ω_h` (a cos A + j b sin A), a = cos p − j sin r sin p, b = cos r, and the
//! specific force, in g, as F = sin p + j sin r cos p (rotations azimuth, pitch, roll in this order).

use crate::math::Complex;
use crate::units::Radians;

/// Inclination of the platform.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lean {
    /// Pitch of body x, up positive.
    pub pitch: Radians,
    /// Roll about body x, positive right side down.
    pub roll: Radians,
}

impl Lean {
    /// Inclination from the phasor of the specific force in the plane, g.
    #[must_use]
    pub fn of(force: Complex) -> Self {
        let pitch = libm::asin(force.re.clamp(-1.0, 1.0));
        let roll = libm::asin((force.im / libm::cos(pitch).max(1e-6)).clamp(-1.0, 1.0));
        Self { pitch: Radians(pitch), roll: Radians(roll) }
    }

    /// Rate of the base that a rate of the force's phasor, g/s, implies, as a phasor in the plane,
    /// rad/s: pitch about the axis to the right, roll about the axis forward.
    pub(crate) fn turning(&self, rate: Complex) -> Complex {
        let (sine_pitch, cosine_pitch) = libm::sincos(self.pitch.0);
        let (sine_roll, cosine_roll) = libm::sincos(self.roll.0);
        let pitching = rate.re / cosine_pitch;
        let rolling = (rate.im + pitching * sine_pitch * sine_roll) / (cosine_roll * cosine_pitch);
        Complex::new(rolling, -pitching * cosine_roll)
    }

    /// Coefficients a and b: the contributions of cosine and sine of the azimuth.
    fn parts(&self) -> (Complex, f64) {
        let (sine, cosine) = libm::sincos(self.pitch.0);
        (Complex::new(cosine, -libm::sin(self.roll.0) * sine), libm::cos(self.roll.0))
    }

    /// Azimuth, rad, and magnitude of the horizontal rate with this phasor in the plane.
    #[must_use]
    pub fn azimuth(&self, horizontal: Complex) -> (f64, f64) {
        let (a, b) = self.parts();
        let north = horizontal.re / a.re;
        let east = (horizontal.im - a.im * north) / b;
        (libm::atan2(east, north), libm::hypot(north, east))
    }

    /// Azimuth near `angle`, rad, at which the horizontal rate of size one and `others`, the
    /// further rotating terms in the plane, sum to the direction `angle`; and its derivative with
    /// respect to that angle. `None` where there is no solution.
    #[must_use]
    pub fn azimuth_towards(&self, angle: f64, others: Complex) -> Option<(f64, f64)> {
        let (a, b) = self.parts();
        let back = Complex::unit(-angle);
        // The sum has no component across the angle: p cos A + q sin A = c.
        let (p, q) = ((a * back).im, b * back.re);
        let (size, turned) = (libm::hypot(p, q), libm::atan2(q, p));
        let cosine = -(others * back).im / size;
        if cosine.is_nan() || cosine.abs() >= 1.0 {
            return None;
        }
        let azimuth = turned - libm::acos(cosine);
        let (sine, cosine) = libm::sincos(azimuth);
        let sum = a.scaled(cosine) + Complex::new(0.0, b * sine) + others;
        let moves = a.scaled(-sine) + Complex::new(0.0, b * cosine);
        Some((azimuth, (sum * back).re / (moves * back).im))
    }
}
