//! Noise coefficients of a gyro from its Allan variance.
//!
//! The model is σ²(τ) = 3Q²/τ² + N²/τ + (2 ln 2/π)B² + K²τ/3 + R²τ²/2 (IEEE Std 952-1997, annex C),
//! fitted with non-negative coefficients. A coefficient that is found comes with its standard
//! deviation; one that does not stand out comes with an upper limit.
//!
//! Two laws that rise alike over one record are hard to separate. The result is therefore the mean
//! over all choices of coefficients, and its standard deviation includes how far they lie apart. In
//! simulated records a coefficient that is absent is found in one record of thirty or fewer,
//! except:
//!
//! - K in one of thirteen, beside a B that hardly rises above the white noise;
//! - B in one of eight, beside a random walk alone that hardly rises above the white noise;
//! - K in one of five, beside a B and a ramp that hardly rises above it, often in place of the
//!   ramp;
//! - a ramp beside a random walk takes up the slope that the walk had in this record, and its
//!   standard deviation does not include it: it is four times too small where the walk is not
//!   found.
//!
//! A random walk that is seldom above the bias instability (N 0.02 °/√h, B 0.3 °/h, K 2 °/h/√h, one
//! hour) is found in three records of four; in one of twenty it is above its stated limit, and
//! beside a quantisation in one of eleven. The value of a coefficient that is seldom found is
//! biased high, because only high values are found. The remedy is a longer record, or one at
//! constant temperature.

mod average;
mod regression;
mod search;
mod spread;

use heapless::Vec;

use self::search::Search;
use super::allan::{Allan, MOST_POINTS, Point, variance};
use super::model::GyroNoise;
use crate::units::{ARCSECOND, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR};
use crate::words::Rounded;

/// Variance of the slope of a random walk, in K² over its length: 6/5 (least-squares line through
/// the walk).
const WALK_SLOPE: f64 = 1.2;
/// Fewest samples for a fit: they give eight averaging times τ, three more than there are
/// coefficients.
const LEAST_SAMPLES: u64 = 64;

/// Estimate of one coefficient from a record, in the unit stated where it is used. It is printed
/// with six decimal places, which suit the field's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Estimate {
    /// The coefficient stands out of the other noise.
    Found {
        /// Estimate of the coefficient.
        value: f64,
        /// Standard deviation of the estimate, 1σ.
        sigma: f64,
    },
    /// The coefficient does not stand out of the other noise of this record.
    NotObservable {
        /// Upper limit of the coefficient, at two standard deviations.
        at_most: f64,
    },
}

impl Estimate {
    /// The estimate in another unit, which is `unit` in the present one.
    #[must_use]
    pub fn in_unit(self, unit: f64) -> Self {
        match self {
            Self::Found { value, sigma } => {
                Self::Found { value: value / unit, sigma: sigma / unit }
            }
            Self::NotObservable { at_most } => Self::NotObservable { at_most: at_most / unit },
        }
    }

    /// Estimated coefficient, where it was found.
    #[must_use]
    pub fn value(self) -> Option<f64> {
        match self {
            Self::Found { value, .. } => Some(value),
            Self::NotObservable { .. } => None,
        }
    }
}

crate::words! { Estimate:
    Self::Found { value, sigma } => "{} ± {}", Rounded::<6>(value), Rounded::<6>(sigma);
    Self::NotObservable { at_most } => "not observable, at most {}", Rounded::<6>(at_most);
}

/// Noise coefficients of a gyro as one record shows them, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseFit {
    /// Quantisation Q, rad.
    pub quantisation: Estimate,
    /// Angle random walk N, rad/√s.
    pub angle_random_walk: Estimate,
    /// Bias instability B, rad/s.
    pub bias_instability: Estimate,
    /// Rate random walk K, rad/s/√s.
    pub rate_random_walk: Estimate,
    /// Rate ramp R, rad/s².
    pub rate_ramp: Estimate,
    /// Chi-square of the fit: squared deviations of the points from the model over their variances,
    /// summed. Neighbouring points correlate, so its expectation is not `degrees`.
    pub chi_square: f64,
    /// Number of points less number of coefficients found.
    pub degrees: usize,
}

impl NoiseFit {
    /// Fits the noise of a gyro at rest that was sampled every `sample_seconds`.
    ///
    /// # Errors
    /// [`FitError`] if a sample was saturated, all samples are equal, the record is too short, or
    /// its noise is below the resolution of the samples (a variance of step²/12).
    pub fn of(allan: &Allan, sample_seconds: f64) -> Result<Self, FitError> {
        if allan.is_saturated() {
            return Err(FitError::Saturated);
        }
        if allan.is_constant() && allan.samples() > 1 {
            return Err(FitError::Constant);
        }
        let points: Vec<Point, MOST_POINTS> = allan.points(sample_seconds).collect();
        let fit = Self::of_points(&points, sample_seconds)?;
        let step = allan.resolution();
        if points[0].variance < step * step / 12.0 {
            return Err(FitError::Unresolved);
        }
        Ok(fit)
    }

    /// Fits points that were estimated elsewhere, in rising order of τ.
    ///
    /// # Errors
    /// [`FitError`] for a sample period that is not positive, for a short record, and for variances
    /// that no noise model fits.
    pub fn of_points(points: &[Point], sample_seconds: f64) -> Result<Self, FitError> {
        if !(sample_seconds > 0.0 && sample_seconds.is_finite()) {
            return Err(FitError::Period);
        }
        let samples = points.first().map_or(0, |point| point.terms + 1);
        if samples < LEAST_SAMPLES {
            return Err(FitError::TooShort { samples, needed: LEAST_SAMPLES });
        }
        let fit = Search::begin(points, sample_seconds).finish();
        let fit = fit.with_slope_of_walk(samples as f64 * sample_seconds);
        if fit.is_finite() { Ok(fit) } else { Err(FitError::NotNoise) }
    }

    /// Adds to the σ of a ramp the slope that the random walk found shows over `seconds`, of
    /// variance 6K²/(5T). A random walk that was not found may still contribute:
    /// [`Self::hidden_slope`] gives its bound.
    fn with_slope_of_walk(self, seconds: f64) -> Self {
        let (Estimate::Found { value, sigma }, Some(walk)) =
            (self.rate_ramp, self.rate_random_walk.value())
        else {
            return self;
        };
        let sigma = libm::sqrt(sigma * sigma + WALK_SLOPE * walk * walk / seconds);
        let rate_ramp = if value > 2.0 * sigma {
            Estimate::Found { value, sigma }
        } else {
            Estimate::NotObservable { at_most: value + 2.0 * sigma }
        };
        Self { rate_ramp, ..self }
    }

    /// Slope over `seconds`, 1σ, rad/s², that a random walk at its upper limit would show; `None`
    /// where the walk was found, and its slope is part of the ramp's σ.
    #[must_use]
    pub fn hidden_slope(&self, seconds: f64) -> Option<f64> {
        match self.rate_random_walk {
            Estimate::Found { .. } => None,
            Estimate::NotObservable { at_most } => Some(at_most * libm::sqrt(WALK_SLOPE / seconds)),
        }
    }

    /// Whether every estimate is finite.
    fn is_finite(&self) -> bool {
        let is_finite = |estimate: &Estimate| match *estimate {
            Estimate::Found { value, sigma } => value.is_finite() && sigma.is_finite(),
            Estimate::NotObservable { at_most } => at_most.is_finite(),
        };
        self.estimates().iter().all(is_finite)
    }

    /// Estimates of Q, N, B, K and R, in SI units.
    #[must_use]
    pub fn estimates(&self) -> [Estimate; 5] {
        let Self { quantisation: q, angle_random_walk: n, bias_instability: b, .. } = *self;
        [q, n, b, self.rate_random_walk, self.rate_ramp]
    }

    /// Fitted Allan variance at τ = `seconds`, (rad/s)².
    #[must_use]
    pub fn variance(&self, seconds: f64) -> f64 {
        variance(&self.noise(), seconds)
    }

    /// Noise model of the coefficients found; a coefficient that is not observable is zero.
    pub fn noise(&self) -> GyroNoise {
        let found = |estimate: Estimate| estimate.value().unwrap_or(0.0);
        GyroNoise {
            quantisation: found(self.quantisation),
            angle_random_walk: found(self.angle_random_walk),
            bias_instability: found(self.bias_instability),
            rate_random_walk: found(self.rate_random_walk),
            rate_ramp: found(self.rate_ramp),
        }
    }

    /// All estimates in the field's units, as [`Coefficient`] states them.
    #[must_use]
    pub fn in_field_units(&self) -> [(Coefficient, Estimate); 5] {
        let [q, n, b, k, r] = self.estimates();
        [
            (Coefficient::Quantisation, q.in_unit(ARCSECOND)),
            (Coefficient::AngleRandomWalk, n.in_unit(DEGREE_PER_SQRT_HOUR)),
            (Coefficient::BiasInstability, b.in_unit(DEGREE_PER_HOUR)),
            (Coefficient::RateRandomWalk, k.in_unit(DEGREE_PER_HOUR / 60.0)),
            (Coefficient::RateRamp, r.in_unit(DEGREE_PER_HOUR / 3600.0)),
        ]
    }
}

/// A coefficient of the noise model, with the field's unit (IEEE Std 952-1997).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coefficient {
    /// Quantisation Q, arc seconds.
    Quantisation,
    /// Angle random walk N, °/√h.
    AngleRandomWalk,
    /// Bias instability B, °/h.
    BiasInstability,
    /// Rate random walk K, °/h/√h.
    RateRandomWalk,
    /// Rate ramp R, °/h².
    RateRamp,
}

crate::words! { Coefficient:
    Self::Quantisation => "quantisation Q, arc seconds";
    Self::AngleRandomWalk => "angle random walk N, °/√h";
    Self::BiasInstability => "bias instability B, °/h";
    Self::RateRandomWalk => "rate random walk K, °/h/√h";
    Self::RateRamp => "rate ramp R, °/h²";
}

/// Reason for which a record determines no noise coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FitError {
    /// The record has too few samples for a fit.
    TooShort {
        /// Number of samples in the record.
        samples: u64,
        /// Number of samples needed.
        needed: u64,
    },
    /// All samples are equal, as from a stuck gyro or bus.
    Constant,
    /// A sample stood at a limit of its range.
    Saturated,
    /// The noise is smaller than the quantisation of the samples.
    Unresolved,
    /// The variances are zero or infinite, or those of a disturbance without noise.
    NotNoise,
    /// The sample period is not a positive number.
    Period,
}

crate::words! { FitError:
    Self::TooShort { samples, needed } =>
        "record too short: {} samples, {} needed", samples, needed;
    Self::Constant => "all samples are equal: the gyro or its bus is stuck";
    Self::Saturated => "a sample stood at the limit of its range";
    Self::Unresolved => "the noise is smaller than the step of the samples";
    Self::NotNoise => "the record is not one of noise";
    Self::Period => "the time between samples is not a positive number of seconds";
}
