//! An azimuth that is stored by a gyro with a vertical axis, and how it ages.
//!
//! Source: Burov, section 2 (storage of the azimuth with the gyro in the vertical position). On a level
//! base `A(t) = A₀ + ∫(ω_z + Ω_v) dt`, `ω_z` being the rate about the downward axis, less the gyro's bias.
//! The bias is learnt at rest just before: a rest of `a` seconds and a storage of `b` seconds
//! leave it uncertain by the difference of the means of two adjacent intervals.

use crate::earth::Latitude;
use crate::noise::model::GyroNoise;
use crate::units::{AngularRate, wrapped};

/// The mean rate of a rest, which shows the bias and the vertical Earth rate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rest {
    sum: i64,
    samples: u32,
}

impl Rest {
    /// Adds a sample.
    pub fn push(&mut self, rate: AngularRate) {
        self.sum += i64::from(rate.0);
        self.samples += 1;
    }

    /// Mean rate, rad/s; `None` of nothing.
    fn mean(&self) -> Option<f64> {
        (self.samples > 0).then(|| self.sum as f64 * 1e-9 / f64::from(self.samples))
    }
}

/// An azimuth with its standard deviation, as it is handed over by an alignment or from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handover {
    /// Azimuth of body x, rad.
    pub azimuth: f64,
    /// Its 1σ, rad.
    pub sigma: f64,
}

/// What stores it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keeper {
    /// The gyro's noise.
    pub noise: GyroNoise,
    /// 1σ of its turn-on bias, rad/s: all that is known of it without a rest.
    pub bias_sigma: f64,
    /// Where the base is.
    pub latitude: Latitude,
    /// Sample period, s.
    pub sample_seconds: f64,
}

/// An azimuth under storage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredAzimuth {
    keeper: Keeper,
    handover: Handover,
    /// Rate that the gyro shows on a base at rest, rad/s.
    at_rest: f64,
    /// Length of the rest, s; zero without.
    rest: f64,
    /// Sum of the rates, nrad/s.
    sum: i64,
    samples: u32,
}

impl StoredAzimuth {
    /// Begins with what was handed over, after a rest that may be empty.
    #[must_use]
    pub fn begin(keeper: Keeper, handover: Handover, rest: &Rest) -> Self {
        let at_rest = rest.mean().unwrap_or(-keeper.latitude.vertical_rate());
        let rest = f64::from(rest.samples) * keeper.sample_seconds;
        Self { keeper, handover, at_rest, rest, sum: 0, samples: 0 }
    }

    /// Adds the next rate about the downward axis, clockwise from above positive.
    pub fn push(&mut self, rate: AngularRate) {
        self.sum += i64::from(rate.0);
        self.samples += 1;
    }

    /// Time of storage, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        f64::from(self.samples) * self.keeper.sample_seconds
    }

    /// The azimuth now, rad, [0, 2π).
    #[must_use]
    pub fn azimuth(&self) -> f64 {
        let turned = self.sum as f64 * 1e-9 * self.keeper.sample_seconds;
        wrapped(self.handover.azimuth + turned - self.at_rest * self.seconds())
    }

    /// Its standard deviation now, rad.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        libm::hypot(self.handover.sigma, self.drift())
    }

    /// 1σ of what storage has added, rad.
    #[must_use]
    pub fn drift(&self) -> f64 {
        let stored = self.seconds();
        let Keeper { noise, bias_sigma, .. } = &self.keeper;
        if stored <= 0.0 {
            return 0.0;
        }
        let variance = if self.rest > 0.0 {
            adjacent_variance(noise, self.rest, stored)
        } else {
            bias_sigma * bias_sigma + alone_variance(noise, stored)
        };
        stored * libm::sqrt(variance)
    }
}

/// Variance of the difference of two adjacent means, over `a` and over `b` seconds, (rad/s)².
///
/// N and Q of either; K²(a + b)/3; R²(a + b)²/4; and of flicker with S(f) = B²/(π f), whatever its
/// cut-offs, B²/π · (a + b)/(ab) · [(a + b) ln(a + b) − a ln a − b ln b], which for a = b is twice the
/// Allan variance (2 ln 2/π)B².
#[must_use]
pub fn adjacent_variance(noise: &GyroNoise, a: f64, b: f64) -> f64 {
    let whole = a + b;
    let (k, r) = (noise.rate_random_walk, noise.rate_ramp);
    // (a + b) ln(a + b) − a ln a − b ln b without the logarithms of units.
    let entropy = -a * libm::log(a / whole) - b * libm::log(b / whole);
    noise.own_variance(a)
        + noise.own_variance(b)
        + k * k * whole / 3.0
        + 0.25 * r * r * whole * whole
        + flicker_power(noise) * whole / (a * b) * entropy
}

/// Variance of a mean over `seconds` about the start, (rad/s)²; flicker as a constant of its own
/// size, since without a rest nothing is known of it.
fn alone_variance(noise: &GyroNoise, seconds: f64) -> f64 {
    let (k, r) = (noise.rate_random_walk, noise.rate_ramp);
    noise.own_variance(seconds)
        + k * k * seconds / 3.0
        + 0.25 * r * r * seconds * seconds
        + noise.bias_instability * noise.bias_instability
}

/// B²/π, (rad/s)².
fn flicker_power(noise: &GyroNoise) -> f64 {
    noise.bias_instability * noise.bias_instability / core::f64::consts::PI
}
