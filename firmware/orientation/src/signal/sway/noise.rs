//! Noise that remains after compensation of the base's sway: an angle error, of which a dwell sees
//! the change.

use crate::units::{Radians, Seconds};

/// Error of an estimated sway angle along the sensitive axis: a first-order Gauss–Markov process
/// and an error that is uncorrelated between both ends of a dwell. All zero where no compensation
/// is applied.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SwayNoise {
    /// Variance σ² of the Gauss–Markov part, rad².
    pub angle_variance: f64,
    /// Correlation time τ of the Gauss–Markov part.
    pub correlation: Seconds,
    /// Variance of the uncorrelated part σᵣ², rad².
    pub residual_variance: f64,
}

impl SwayNoise {
    /// Noise without compensation: zero.
    pub const NONE: Self =
        Self { angle_variance: 0.0, correlation: Seconds(0.0), residual_variance: 0.0 };

    /// Noise without compensation, zero, of a base whose sensors failed before they had observed
    /// its sway. The greatest correlation time distinguishes it from [`Self::NONE`].
    pub const UNMEASURED: Self = Self { correlation: Seconds(f64::MAX), ..Self::NONE };

    /// Whether the sensors failed that would have observed the sway.
    pub(crate) fn is_unmeasured(&self) -> bool {
        self.correlation.0 >= f64::MAX
    }

    /// Variance that the error adds to a mean rate over `seconds` (> 0), (rad/s)²: that of the
    /// change of the angle error over the time T, 2σ²(1 − e^{−T/τ})/T² + 2σᵣ²/T².
    #[must_use]
    pub fn mean_variance(&self, seconds: f64) -> f64 {
        self.angle_mean_variance(seconds) + self.residual_mean_variance(seconds)
    }

    /// Gauss–Markov part of [`Self::mean_variance`], (rad/s)², which neighbouring dwells share.
    pub(crate) fn angle_mean_variance(&self, seconds: f64) -> f64 {
        if self.angle_variance <= 0.0 {
            return 0.0;
        }
        let decorrelated = -libm::expm1(-seconds / self.correlation.0);
        2.0 * self.angle_variance * decorrelated / (seconds * seconds)
    }

    /// Uncorrelated part of [`Self::mean_variance`], (rad/s)².
    #[must_use]
    pub fn residual_mean_variance(&self, seconds: f64) -> f64 {
        2.0 * self.residual_variance / (seconds * seconds)
    }

    /// Standard deviation of the angle error, both parts.
    pub fn angle_sigma(&self) -> Radians {
        Radians(libm::sqrt(self.angle_variance + self.residual_variance))
    }
}
