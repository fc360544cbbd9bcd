//! Tilt of the platform as a phasor, its rate of change, and the directions that follow from them.

use crate::units::Radians;

/// Tilt of the platform as a phasor in g: real part along body x, imaginary part in quadrature.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tilt {
    /// Real part of F, sin(pitch), at [`Self::time`].
    pub real: f64,
    /// Imaginary part of F, sin(roll)·cos(pitch), at [`Self::time`].
    pub imaginary: f64,
    /// Time at which F holds, s: the end of the last dwell.
    pub time: f64,
    /// Rate of change of F; zero unless the forces prove one.
    pub rate: TiltRate,
    /// Possible rate of change of F that the forces indicate but do not prove; it enters σ only.
    pub unproven: TiltRate,
    /// Covariance of the two parts of F, g².
    pub covariance: [[f64; 2]; 2],
    /// Accelerometer biases along its x and y, g, at [`Self::time`].
    pub bias: [f64; 2],
    /// Rate of change of the biases, 1/s; zero unless the forces prove one.
    pub bias_rate: [f64; 2],
    /// RMS of the dwells' mean forces about any tilt and any bias, g.
    pub scatter: f64,
    /// Magnitude of the phasor that rotates against the stage, g; zero where it may be chance, or a
    /// difference between the two axes.
    pub counter: f64,
    /// Time, s, after which F stepped, and size of the step, g; none without a significant step.
    pub step: Option<(f64, f64)>,
    /// RMS of the forces about this tilt and rate, g.
    pub left: f64,
    /// Whether the tilt was measured; otherwise the platform is taken as level.
    pub measured: bool,
}

/// Rate of change of a tilt phasor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TiltRate {
    /// Rate F′, 1/s.
    pub value: [f64; 2],
    /// Covariance of F′, 1/s².
    pub covariance: [[f64; 2]; 2],
}

impl Tilt {
    /// Tilt extrapolated to another time, s, with the proven rate.
    pub(crate) fn at(&self, time: f64) -> Self {
        let elapsed = time - self.time;
        let [real, imaginary] = self.rate.value.map(|rate| rate * elapsed);
        Self { real: self.real + real, imaginary: self.imaginary + imaginary, time, ..*self }
    }

    /// Rate of the base about its axes forward and right, rad/s, for a rate of F in 1/s.
    pub(super) fn turning(&self, [real, imaginary]: [f64; 2]) -> [f64; 2] {
        let upward = self.upward();
        [imaginary / upward, real / upward]
    }

    /// Magnitude |F|, the sine of the tilt angle.
    #[must_use]
    pub fn magnitude(&self) -> f64 {
        libm::hypot(self.real, self.imaginary)
    }

    /// Pitch of the body; positive nose up.
    pub fn pitch(&self) -> Radians {
        Radians(libm::asin(self.real.clamp(-1.0, 1.0)))
    }

    /// Roll of the body; positive right side down.
    pub fn roll(&self) -> Radians {
        let cosine = libm::sqrt((1.0 - self.real * self.real).max(1e-12));
        Radians(libm::asin((self.imaginary / cosine).clamp(-1.0, 1.0)))
    }

    /// Unit vector of the sensitive axis at stage angle `theta` (rad), in the levelled frame:
    /// forward, right, down.
    #[must_use]
    pub fn sensitive_axis(&self, theta: f64) -> [f64; 3] {
        let (sine, cosine) = libm::sincos(theta);
        let (sine_pitch, sine_roll) = (self.real, libm::sin(self.roll().0));
        let cosine_pitch = libm::sqrt((1.0 - sine_pitch * sine_pitch).max(0.0));
        let cosine_roll = libm::sqrt((1.0 - sine_roll * sine_roll).max(0.0));
        [
            cosine_pitch * cosine + sine_pitch * sine_roll * sine,
            cosine_roll * sine,
            -sine_pitch * cosine + cosine_pitch * sine_roll * sine,
        ]
    }

    /// Unit vector of the base's downward axis, in the levelled frame.
    pub(crate) fn down(&self) -> [f64; 3] {
        let (sine_roll, cosine_roll) = libm::sincos(self.roll().0);
        let cosine_pitch = libm::sqrt((1.0 - self.real * self.real).max(0.0));
        [self.real * cosine_roll, -sine_roll, cosine_pitch * cosine_roll]
    }

    /// Specific force perpendicular to the base plane, up positive, g.
    pub(super) fn upward(&self) -> f64 {
        let magnitude = self.magnitude();
        libm::sqrt((1.0 - magnitude * magnitude).max(0.0))
    }

    /// Accelerometer biases along its x and y, g, extrapolated to another time, s.
    pub(super) fn bias_at(&self, time: f64) -> [f64; 2] {
        let [x, y] = self.bias_rate.map(|rate| rate * (time - self.time));
        [self.bias[0] + x, self.bias[1] + y]
    }

    /// Specific force along the sensitive axis and 90° clockwise of it, g, without bias.
    pub(crate) fn force(&self, theta: f64) -> [f64; 2] {
        let (sine, cosine) = libm::sincos(theta);
        [self.real * cosine - self.imaginary * sine, -(self.real * sine + self.imaginary * cosine)]
    }
}
