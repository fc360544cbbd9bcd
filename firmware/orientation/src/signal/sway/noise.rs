//! What a subtraction of the base's sway leaves: an angle error, of which a dwell sees the change.

/// The error of an estimated sway angle along the sensitive axis: a first-order Gauss–Markov process
/// and, beside it, an error that keeps no memory from one end of a dwell to the other. Zero: nothing
/// is subtracted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SwayNoise {
    /// Variance σ² of the Gauss–Markov part, rad².
    pub angle_variance: f64,
    /// Its correlation time τ, s.
    pub correlation: f64,
    /// Variance of the part without memory, rad².
    pub residual_variance: f64,
}

impl SwayNoise {
    /// Nothing is subtracted.
    pub const NONE: Self = Self { angle_variance: 0.0, correlation: 0.0, residual_variance: 0.0 };

    /// Variance that a mean rate over so many seconds (> 0) gets, (rad/s)²: that of the change of
    /// the angle error over the time, 2σ²(1 − e^{−T/τ})/T² and 2σᵣ²/T².
    #[must_use]
    pub fn mean_variance(&self, seconds: f64) -> f64 {
        self.angle_mean_variance(seconds) + self.residual_mean_variance(seconds)
    }

    /// The Gauss–Markov part of it, which neighbouring dwells share.
    #[must_use]
    pub fn angle_mean_variance(&self, seconds: f64) -> f64 {
        if self.angle_variance <= 0.0 {
            return 0.0;
        }
        let forgotten = -libm::expm1(-seconds / self.correlation);
        2.0 * self.angle_variance * forgotten / (seconds * seconds)
    }

    /// The part without memory.
    #[must_use]
    pub fn residual_mean_variance(&self, seconds: f64) -> f64 {
        2.0 * self.residual_variance / (seconds * seconds)
    }

    /// Standard deviation of the angle, rad.
    #[must_use]
    pub fn angle_sigma(&self) -> f64 {
        libm::sqrt(self.angle_variance + self.residual_variance)
    }
}
