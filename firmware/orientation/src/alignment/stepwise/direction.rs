//! Azimuth from the two horizontal components of the Earth rate.
//!
//! A regression gives β in units of the expected horizontal Earth rate `Ω_h`, with its covariance.
//! On a level stage β = ρ(cos A, sin A), ρ being `Ω̂_h/Ω_h`: free, known exactly, or known within the
//! gyro's scale tolerance. On a tilted one the vertical Earth rate f = `Ω_v`F/`Ω_h` is scaled alike,
//! and the regression has taken it away unscaled: β + f = ρ(cos A, sin A) + ρf.
//! J(A) is the least chi-square over ρ; on a short arc it may have two minima, so the whole circle
//! is scanned before the best is refined.

use core::f64::consts::PI;

use super::setting::{Amplitude, Half};
use crate::math::{Table, reference_table as table};
use crate::units::Radians;

/// The two components with their covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Components {
    /// β: north and east component along body x, in units of `Ω_h`.
    pub value: [f64; 2],
    /// Covariance of the components.
    pub covariance: [[f64; 2]; 2],
    /// Components f of the vertical Earth rate through the tilt, in units of `Ω_h`.
    pub vertical: [f64; 2],
    /// Half circle to which the azimuth is restricted; none for the whole circle.
    pub half: Option<Half>,
}

/// An azimuth with its linearised uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// Azimuth of body x, rad, [−π, π].
    pub azimuth: f64,
    /// Earth-rate ratio ρ of the solution.
    pub amplitude: f64,
    /// Variance of ρ.
    pub amplitude_variance: f64,
    /// Covariance of the azimuth, rad, and ρ.
    pub mixed_covariance: f64,
    /// Variance of the azimuth, rad².
    pub variance: f64,
    /// Least standard deviation, 1σ, rad, of an azimuth where the noise is not small against the
    /// Earth rate: its fivefold covers all azimuths about it that fit worse by hardly 5σ.
    pub covering: f64,
    /// Gain of the azimuth with respect to the components, ∂A/∂β, rad.
    pub gain: [f64; 2],
    /// Chi-square at the second minimum less that at the best; infinite without a second minimum.
    pub margin: f64,
}

impl Direction {
    /// Components of the Earth rate north and east along body x, in units of `Ω_h`.
    pub(crate) fn along(&self) -> [f64; 2] {
        let (sine, cosine) = libm::sincos(self.azimuth);
        [self.amplitude * cosine, self.amplitude * sine]
    }

    /// Variance of the azimuth, rad², that it would have at the Earth's own rate: a weaker one has a wide azimuth, which is
    /// no reason to prefer a strong one.
    pub(super) fn variance_at_earth_rate(&self) -> f64 {
        let part = self.amplitude.min(1.0);
        self.variance * part * part
    }

    /// Covariance of the components that the prior knowledge of ρ leaves, in units of `Ω_h`².
    pub(super) fn components_covariance(&self, vertical: [f64; 2]) -> [[f64; 2]; 2] {
        let (sine, cosine) = libm::sincos(self.azimuth);
        let across = across(self.amplitude, [cosine, sine]);
        let along = [cosine + vertical[0], sine + vertical[1]];
        [0, 1].map(|i| {
            [0, 1].map(|j| {
                self.variance * across[i] * across[j]
                    + self.amplitude_variance * along[i] * along[j]
                    + self.mixed_covariance * (across[i] * along[j] + along[i] * across[j])
            })
        })
    }

    /// Components β of this solution: ρ(e + f) − f, for the unit vector e of its azimuth.
    pub(crate) fn components(&self, unit: [f64; 2], vertical: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| self.amplitude * (unit[i] + vertical[i]) - vertical[i])
    }
}

/// Number of directions at which J is sampled before it is refined; two minima cannot fall between
/// them.
const SCAN: usize = 64;

/// Chi-square by which an azimuth of the configured half may fit worse than one of the other (5σ):
/// two opposite positions fit both alike, and noise moves an azimuth slightly across the axis
/// between the halves.
const OTHER_HALF: f64 = 25.0;

/// Significance, in σ, at which the width of J(A) is measured: where the noise is not small against
/// the Earth rate, J is no parabola, and its curvature says nothing of its width.
const REACH: f64 = 5.0;
/// Chi-square by which an azimuth of that width fits worse: a little less than of a parabola, whose width σ is.
const WORSE: f64 = 24.0;
/// Factor by which σ grows until it covers that width.
const WIDER: f64 = 1.02;

/// Chi-square profile J(A) and its parts.
struct Profile<'a> {
    /// The components, with the half circle to which the azimuth is restricted.
    components: &'a Components,
    /// Inverse of the components' covariance.
    information: [[f64; 2]; 2],
    /// Product of the information matrix and β + f.
    target: [f64; 2],
    /// Prior knowledge of ρ.
    amplitude: Amplitude,
}

impl Components {
    /// Direction of the components themselves, without prior knowledge of the Earth rate and the
    /// half; `None` where the covariance is not positive.
    pub(super) fn free(&self) -> Option<Direction> {
        Self { half: None, ..*self }.direction(Amplitude::Free)
    }

    /// Most likely azimuth; `None` where the covariance is not positive, where no minimum lies in
    /// the configured half, or where it fits much worse than the best of the other half.
    #[must_use]
    pub fn direction(&self, amplitude: Amplitude) -> Option<Direction> {
        let profile = Profile::new(self, amplitude)?;
        let (azimuth, margin) = profile.minimise()?;
        Some(profile.linearise(azimuth, margin))
    }
}

impl<'a> Profile<'a> {
    /// Prepares the profile; `None` where the covariance is not positive.
    fn new(components: &'a Components, amplitude: Amplitude) -> Option<Self> {
        let information = inverted(&components.covariance)?;
        let [north, east] = components.vertical;
        let target =
            product(&information, [components.value[0] + north, components.value[1] + east]);
        Some(Self { components, information, target, amplitude })
    }

    /// Vector that ρ multiplies: the unit vector of an azimuth plus the vertical Earth rate's part.
    fn along(&self, [cosine, sine]: [f64; 2]) -> [f64; 2] {
        let [north, east] = self.components.vertical;
        [cosine + north, sine + east]
    }

    /// Chi-square at an azimuth, rad, less that of β itself, and the best ρ there.
    fn at(&self, azimuth: f64) -> (f64, f64) {
        let (sine, cosine) = libm::sincos(azimuth);
        self.towards([cosine, sine])
    }

    /// Chi-square for the unit vector of an azimuth, less that of β itself, and the best ρ there.
    fn towards(&self, unit: [f64; 2]) -> (f64, f64) {
        let direction = self.along(unit);
        let power = quadratic(&self.information, direction);
        let along = dot(self.target, direction);
        match self.amplitude {
            Amplitude::Free if along > 0.0 => (-along * along / power, along / power),
            Amplitude::Free => (0.0, 0.0),
            Amplitude::Known(sigma) if sigma > 0.0 => {
                let prior = 1.0 / (sigma * sigma);
                let best = (along + prior) / (power + prior);
                (prior - best * (along + prior), best)
            }
            Amplitude::Known(_) => (power - 2.0 * along, 1.0),
        }
    }

    /// Azimuth of the least J, rad, and the excess of the second minimum.
    fn minimise(&self) -> Option<(f64, f64)> {
        let step = core::f64::consts::TAU / SCAN as f64;
        let sampled: [f64; SCAN] = core::array::from_fn(|k| self.towards(of_table(k)).0);
        let (mut best, mut second) = ((0.0, f64::INFINITY), f64::INFINITY);
        let mut least = f64::INFINITY;
        for k in 0..SCAN {
            let (before, after) = (sampled[(k + SCAN - 1) % SCAN], sampled[(k + 1) % SCAN]);
            if sampled[k] > before || sampled[k] >= after {
                continue;
            }
            let azimuth = self.refine(k as f64 * step, step);
            let value = self.at(azimuth).0;
            least = least.min(value);
            if self.components.half.is_some_and(|half| !half.contains(Radians(azimuth))) {
                continue;
            }
            if value < best.1 {
                second = best.1;
                best = (azimuth, value);
            } else {
                second = second.min(value);
            }
        }
        let margin = if second.is_finite() { second - best.1 } else { f64::INFINITY };
        let is_best = best.1.is_finite() && best.1 - least <= OTHER_HALF;
        is_best.then_some((best.0, margin))
    }

    /// Least 1σ of an azimuth, rad, that is no less than this one, and with which [`REACH`] σ cover
    /// all azimuths about it that fit worse by no more than [`WORSE`].
    fn covering(&self, azimuth: f64, mut sigma: f64) -> f64 {
        let worst = self.at(azimuth).0 + WORSE;
        for side in [REACH, -REACH] {
            while sigma < PI / REACH && self.at(azimuth + side * sigma).0 <= worst {
                sigma *= WIDER;
            }
        }
        sigma
    }

    /// Refines a minimum by the parabola through three points, halving its width, never moving
    /// further than `step` at once.
    fn refine(&self, start: f64, step: f64) -> f64 {
        let (mut azimuth, mut width) = (start, 0.5 * step);
        for _ in 0..24 {
            let [low, middle, high] =
                [azimuth - width, azimuth, azimuth + width].map(|angle| self.at(angle).0);
            let curvature = low - 2.0 * middle + high;
            let slope = 0.5 * (high - low);
            let shift = if curvature > 0.0 { -slope / curvature } else { -slope.signum() };
            azimuth += shift.clamp(-1.0, 1.0) * width;
            width = (0.5 * width).max(1e-5);
        }
        azimuth
    }

    /// Linearised covariance of (A, ρ) at the solution, from its inverted information.
    fn linearise(&self, azimuth: f64, margin: f64) -> Direction {
        let (sine, cosine) = libm::sincos(azimuth);
        let amplitude = self.at(azimuth).1;
        let across = across(amplitude, [cosine, sine]);
        let across_weighted = product(&self.information, across);
        let along = self.along([cosine, sine]);
        let along_weighted = product(&self.information, along);
        let across_power = dot(across, across_weighted);
        let mixed = dot(across, along_weighted);
        let along_power = dot(along, along_weighted);
        let freedom = match self.amplitude {
            Amplitude::Free => 1.0 / along_power,
            Amplitude::Known(sigma) if sigma > 0.0 => 1.0 / (along_power + 1.0 / (sigma * sigma)),
            Amplitude::Known(_) => 0.0,
        };
        let coupling = mixed * freedom;
        let variance = 1.0 / (across_power - coupling * mixed);
        let amplitude_variance = freedom * (1.0 + coupling * mixed * variance);
        let mixed_covariance = -coupling * variance;
        let gain = [0, 1].map(|i| variance * (across_weighted[i] - coupling * along_weighted[i]));
        let covering = self.covering(azimuth, libm::sqrt(variance));
        let azimuth = libm::atan2(sine, cosine);
        Direction {
            azimuth,
            amplitude,
            amplitude_variance,
            mixed_covariance,
            variance,
            covering,
            gain,
            margin,
        }
    }
}

/// Change of the components, in units of `Ω_h`, with the azimuth, rad, for its unit vector. A signal
/// that noise has made larger than the Earth's does not make σ smaller.
fn across(amplitude: f64, [cosine, sine]: [f64; 2]) -> [f64; 2] {
    [-sine, cosine].map(|part| amplitude.min(1.0) * part)
}

/// Unit vector of the scan's direction `k`, from the reference table (etalon).
fn of_table(k: usize) -> [f64; 2] {
    let index = (k * (table::TURN as usize / SCAN)) as u32;
    let index = index.cast_signed();
    [Table::built_in().cos(index), Table::built_in().sin(index)].map(|x| x as f64 / table::ONE)
}

/// Scalar product xᵀy.
pub(crate) fn dot(x: [f64; 2], y: [f64; 2]) -> f64 {
    x[0] * y[0] + x[1] * y[1]
}

/// Matrix–vector product M x.
pub(crate) fn product(matrix: &[[f64; 2]; 2], x: [f64; 2]) -> [f64; 2] {
    [dot(matrix[0], x), dot(matrix[1], x)]
}

/// Quadratic form xᵀM x.
pub(crate) fn quadratic(matrix: &[[f64; 2]; 2], x: [f64; 2]) -> f64 {
    dot(x, product(matrix, x))
}

/// Inverse of a symmetric matrix; `None` where it is not positive definite.
pub(crate) fn inverted([[a, b], [_, d]]: &[[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let determinant = a * d - b * b;
    let positive = determinant > 0.0 && *a > 0.0;
    positive.then(|| [[d / determinant, -b / determinant], [-b / determinant, a / determinant]])
}
