//! Noise model of a gyro in the field's terms: Q, N, B, K, R (IEEE Std 952-1997).

use crate::units::{
    ARCSECOND, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, Radians, RadiansPerRootSecond,
    RadiansPerSecond, RateRamp, RateRandomWalk, TURN,
};

/// Noise coefficients of a gyro in SI units, for the Allan variance 3Q²/τ² + N²/τ + (2 ln 2/π)B² +
/// K²τ/3 + R²τ²/2. A coefficient of zero is absent.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GyroNoise {
    /// Quantisation Q: 1σ of the angle's rounding.
    pub quantisation: Radians,
    /// Angle random walk N.
    pub angle_random_walk: RadiansPerRootSecond,
    /// Bias instability B; one-sided spectral density B²/(π f).
    pub bias_instability: RadiansPerSecond,
    /// Rate random walk K, rad/s/√s.
    pub rate_random_walk: RateRandomWalk,
    /// Rate ramp R, rad/s², as the 1σ of an unknown constant slope.
    pub rate_ramp: RateRamp,
}

/// What is stated of a gyro's noise before an alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StatedNoise {
    /// The whole model.
    Whole(GyroNoise),
    /// All but the angle random walk N, which is estimated from the data.
    ExceptWhite(GyroNoise),
}

impl StatedNoise {
    /// The coefficients; N is without meaning where it is not stated.
    pub const fn model(&self) -> &GyroNoise {
        match self {
            Self::Whole(model) | Self::ExceptWhite(model) => model,
        }
    }

    /// The coefficients, to be changed.
    pub const fn model_mut(&mut self) -> &mut GyroNoise {
        match self {
            Self::Whole(model) | Self::ExceptWhite(model) => model,
        }
    }

    /// Whether N is stated.
    #[must_use]
    pub const fn is_white_known(&self) -> bool {
        matches!(self, Self::Whole(_))
    }
}

impl GyroNoise {
    /// Model from N in °/√h, B in °/h, K in °/h/√h and R in °/h²; the quantisation is zero.
    pub fn from_field_units(n: f64, b: f64, k: f64, r: f64) -> Self {
        Self {
            angle_random_walk: RadiansPerRootSecond(n * DEGREE_PER_SQRT_HOUR),
            bias_instability: RadiansPerSecond::from_degrees_per_hour(b),
            rate_random_walk: RateRandomWalk(k * DEGREE_PER_HOUR / 60.0),
            rate_ramp: RateRamp(r * DEGREE_PER_HOUR / 3600.0),
            ..Self::default()
        }
    }

    /// The model with a quantisation of Q arc seconds.
    pub fn with_quantisation(self, q: f64) -> Self {
        Self { quantisation: Radians(q * ARCSECOND), ..self }
    }

    /// Model of the coefficients Q, N, B, K and R in SI units, in that order.
    pub(crate) fn of(coefficients: [f64; 5]) -> Self {
        let [q, n, b, k, r] = coefficients;
        Self {
            quantisation: Radians(q),
            angle_random_walk: RadiansPerRootSecond(n),
            bias_instability: RadiansPerSecond(b),
            rate_random_walk: RateRandomWalk(k),
            rate_ramp: RateRamp(r),
        }
    }

    /// Coefficients Q, N, B, K and R in SI units, in that order.
    #[must_use]
    pub fn coefficients(&self) -> [f64; 5] {
        let Self { quantisation: q, angle_random_walk: n, bias_instability: b, .. } = *self;
        [q.0, n.0, b.0, self.rate_random_walk.0, self.rate_ramp.0]
    }

    /// Variance of a mean over `seconds` due to white noise, N²/T, (rad/s)².
    #[must_use]
    pub fn white_variance(&self, seconds: f64) -> f64 {
        self.angle_random_walk.0 * self.angle_random_walk.0 / seconds
    }

    /// Variance of a mean over `seconds` due to rounding of the angle at either end, 2Q²/T²,
    /// (rad/s)².
    pub(crate) fn rounding_variance(&self, seconds: f64) -> f64 {
        let rounding = self.quantisation.0 / seconds;
        2.0 * rounding * rounding
    }

    /// Variance of a mean over `seconds` that is independent of other means, (rad/s)²: N and Q.
    #[must_use]
    pub fn own_variance(&self, seconds: f64) -> f64 {
        self.white_variance(seconds) + self.rounding_variance(seconds)
    }

    /// Two-sided spectral density at a frequency in Hz, (rad/s)²/Hz: N² + B²/(2πf) + K²/(2πf)².
    pub(crate) fn density_at(&self, frequency: f64) -> f64 {
        let (n, b) = (self.angle_random_walk.0, self.bias_instability.0);
        let k = self.rate_random_walk.0 / (TURN * frequency);
        n * n + b * b / (TURN * frequency) + k * k
    }

    /// Two-sided density as it scatters the phasors of single periods about those of others,
    /// (rad/s)²/Hz. The random walk counts twice there, because its slope within a period is not
    /// removed.
    pub(crate) fn density_of_period(&self, frequency: f64) -> f64 {
        let k = self.rate_random_walk.0 / (TURN * frequency);
        self.density_at(frequency) + k * k
    }

    /// Whether successive dwells share noise other than a ramp: B or K is present.
    pub(crate) fn is_coloured(&self) -> bool {
        self.bias_instability.0 > 0.0 || self.rate_random_walk.0 > 0.0
    }

    /// The model without drift: N alone remains.
    pub fn white_part(&self) -> Self {
        Self { angle_random_walk: self.angle_random_walk, ..Self::default() }
    }
}
