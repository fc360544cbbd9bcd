//! Uncertainty of Allan variances, and correlation between them, under a noise model.
//!
//! The terms are Gaussian, so the covariance of two Allan variances is 2/(M₁M₂) ΣΣ c², c being the
//! covariance of a term of one with a term of the other (the module `kernel`), plus 4·D₁D₂·c where a
//! ramp adds D to every term. The double sum is one over lags, each with the number of pairs that lie
//! so far apart. Lags near the places where c has its corners are all taken; between them one stands
//! for a block of up to half of the distance to the next corner, so that a pair costs some
//! dozens of evaluations whatever its spans. On the estimator's grid the sum is right to 0.2 %, for
//! terms one sample apart to 3 % (host-tests/tests/cores/allan/covariance.rs). A span must be a whole number of its
//! stride, and the longer stride one of the shorter.

use core::num::NonZeroU32;

use super::kernel::Kernel;
use super::{Point, variance};
use crate::noise::GyroNoise;
use crate::units::RateRamp;

/// How far beyond the corners the flicker covariance is followed, in spans of the longer terms: the
/// tail falls as the fourth power, and the neglected part is below 0.1 %.
const TAIL: i32 = 2;
/// Divisor of the distance to the nearest corner: a block is twice its quotient plus one, about
/// half of the distance.
const BLOCK: i32 = 4;

/// Averaging of one Allan variance, in samples, with the predictions of the noise model for its
/// terms.
#[derive(Clone, Copy, Debug, Default)]
pub struct Window {
    /// Averaging time τ, samples.
    span: u32,
    /// Distance from term to term, samples.
    stride: u32,
    /// Number of terms.
    terms: u32,
    /// Standard deviation of a term under the noise, rad/s.
    sigma: f64,
    /// Contribution of the rate ramp to a term, in standard deviations.
    ramp: f32,
}

impl Window {
    /// Window of a point under a noise model; spans and strides are rounded to whole samples.
    #[must_use]
    pub fn new(point: &Point, noise: &GyroNoise, sample_seconds: f64) -> Self {
        let still = GyroNoise { rate_ramp: RateRamp(0.0), ..*noise };
        let sigma = libm::sqrt(variance(&still, point.seconds.0));
        let ramp = noise.rate_ramp.0 * point.seconds.0 * core::f64::consts::FRAC_1_SQRT_2;
        Self {
            span: libm::round(point.seconds.0 / sample_seconds) as u32,
            stride: libm::round(point.stride.0 / sample_seconds) as u32,
            terms: u32::try_from(point.terms).unwrap_or(u32::MAX),
            sigma,
            ramp: (ramp / sigma) as f32,
        }
    }
}

/// Power laws of a noise model, as the covariance needs them.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// Powers of Q, N, B and K at a lattice of one sample, (rad/s)².
    powers: [f64; 4],
}

impl Law {
    /// Power laws of a noise sampled every `sample_seconds`.
    #[must_use]
    pub fn new(noise: &GyroNoise, sample_seconds: f64) -> Self {
        let power = |coefficient: f64| coefficient * coefficient;
        Self {
            powers: [
                power(noise.quantisation.0 / sample_seconds),
                power(noise.angle_random_walk.0) / sample_seconds,
                power(noise.bias_instability.0) / core::f64::consts::TAU,
                power(noise.rate_random_walk.0) * sample_seconds,
            ],
        }
    }

    /// Covariance of the Allan variances of two windows, (rad/s)⁴.
    #[must_use]
    pub fn covariance(&self, one: &Window, other: &Window) -> f64 {
        let (short, long) = if one.span <= other.span { (one, other) } else { (other, one) };
        let scale = short.sigma * long.sigma;
        scale * scale * f64::from(self.pair(short, long, scale).covariance())
    }

    /// Normalised pair of windows, in units of the terms' standard deviations.
    fn pair(&self, short: &Window, long: &Window, scale: f64) -> Pair {
        let lattice = short.stride.min(long.stride).max(1);
        let [m, big] = [f64::from(short.span), f64::from(long.span)];
        let [q, n, b, k] = self.powers.map(|power| power / (2.0 * scale));
        let weights = [q / (m * big), n / big, b * m / big, k * m];
        Pair {
            kernel: Kernel {
                short: (short.span / lattice).cast_signed(),
                long: (long.span / lattice).cast_signed(),
                weights: weights.map(|weight| weight as f32),
            },
            strides: [short, long]
                .map(|w| NonZeroU32::new(w.stride / lattice).unwrap_or(NonZeroU32::MIN)),
            terms: [short.terms, long.terms],
            ramp: short.ramp * long.ramp,
        }
    }
}

/// Equivalent degrees of freedom 2V²/Var V of a point's Allan variance under a noise: V̂·edf/V is
/// Equivalent degrees of freedom, so that V̂·edf/V is distributed as chi-square (NIST SP 1065,
/// section 5.4).
#[must_use]
pub fn degrees_of_freedom(point: &Point, noise: &GyroNoise, sample_seconds: f64) -> f64 {
    let window = Window::new(point, noise, sample_seconds);
    let spread = Law::new(noise, sample_seconds).covariance(&window, &window);
    let expected = variance(noise, point.seconds.0);
    2.0 * expected * expected / spread
}

/// Two series of terms on a common lattice, the shorter first.
struct Pair {
    kernel: Kernel,
    strides: [NonZeroU32; 2],
    terms: [u32; 2],
    /// Product of the rate ramp's contributions to both terms.
    ramp: f32,
}

impl Pair {
    /// Normalised covariance 2/(M₁M₂) ΣΣ (c² + 2 D₁D₂ c).
    fn covariance(&self) -> f32 {
        let Kernel { short, long, .. } = self.kernel;
        let mut sum = self.block(0, 1);
        let mut lag = 1;
        let mut corner = 0;
        let corners = [short.min(long - short), short.max(long - short), long, long + short];
        for next in corners.into_iter().chain([short + (1 + TAIL) * long]) {
            while lag < next {
                let width = 2 * ((lag - corner).min(next - lag) / BLOCK) + 1;
                sum += self.block(lag + width / 2, width);
                lag += width;
            }
            if lag == next {
                sum += self.block(lag, 1);
                lag += 1;
            }
            corner = next;
        }
        let [short, long] = self.terms.map(|terms| terms as f32);
        2.0 * sum / short / long
    }

    /// Contribution of a block of `width` lags about `lag`, on both sides of zero.
    fn block(&self, lag: i32, width: i32) -> f32 {
        let pairs = if lag == 0 { self.pairs(0) } else { self.pairs(lag) + self.pairs(-lag) };
        if pairs == 0.0 {
            return 0.0;
        }
        let c = self.kernel.at(lag);
        pairs * width as f32 * (c * c + 2.0 * self.ramp * c)
    }

    /// Number of pairs of terms whose middles lie `lag` apart, the longer one later where positive.
    fn pairs(&self, lag: i32) -> f32 {
        let [step, stride] = self.strides;
        let shift = i64::from(lag) + i64::from(self.kernel.short) - i64::from(self.kernel.long);
        let last = i64::from(self.terms[0].saturating_sub(1)) * i64::from(step.get()) + shift;
        let Ok(last) = u32::try_from(last) else { return 0.0 };
        let first = u32::try_from(shift).unwrap_or(0).div_ceil(stride.get());
        let count = (last / stride + 1).min(self.terms[1]);
        count.saturating_sub(first) as f32
    }
}
