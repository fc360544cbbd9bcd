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
mod coefficients;
mod regression;
mod search;
mod spread;

pub use coefficients::{Coefficient, Estimate, NoiseFit};

use crate::units::{RateRamp, Seconds};
use heapless::Vec;

use self::search::Search;
use super::allan::{Allan, MOST_POINTS, Point};

/// Variance of the slope of a random walk, in K² over its length: 6/5 (least-squares line through
/// the walk).
const WALK_SLOPE: f64 = 1.2;
/// Fewest samples for a fit: they give eight averaging times τ, three more than there are
/// coefficients.
const LEAST_SAMPLES: u64 = 64;

impl NoiseFit {
    /// Fits the noise of a gyro at rest that was sampled every `sample_seconds`.
    ///
    /// # Errors
    /// [`FitError`] if a sample was saturated, all samples are equal, the record is too short, or
    /// its noise is below the resolution of the samples (a variance of step²/12).
    pub fn of(allan: &Allan, sample_seconds: Seconds) -> Result<Self, FitError> {
        if allan.is_saturated {
            return Err(FitError::Saturated);
        }
        if allan.is_constant() && allan.samples > 1 {
            return Err(FitError::Constant);
        }
        let points: Vec<Point, MOST_POINTS> = allan.points(sample_seconds).collect();
        let fit = Self::of_points(&points, sample_seconds)?;
        let step = allan.resolution().0;
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
    pub fn of_points(points: &[Point], sample_seconds: Seconds) -> Result<Self, FitError> {
        if !(sample_seconds.0 > 0.0 && sample_seconds.0.is_finite()) {
            return Err(FitError::Period);
        }
        let samples = points.first().map_or(0, |point| point.terms + 1);
        if samples < LEAST_SAMPLES {
            return Err(FitError::TooShort { samples, needed: LEAST_SAMPLES });
        }
        let fit = Search::begin(points, sample_seconds.0).finish();
        let fit = fit.with_slope_of_walk(samples as f64 * sample_seconds.0);
        if fit.is_finite() { Ok(fit) } else { Err(FitError::NotNoise) }
    }

    /// Adds to the σ of a ramp the slope that the random walk found shows over `seconds`, of
    /// variance 6K²/(5T). A random walk that was not found may still contribute:
    /// [`Self::hidden_slope`] gives its bound.
    fn with_slope_of_walk(mut self, seconds: f64) -> Self {
        let [.., walk, ramp] = &mut self.estimates;
        if let (Estimate::Found { value, sigma }, Some(walk)) = (*ramp, walk.value()) {
            let sigma = libm::sqrt(sigma * sigma + WALK_SLOPE * walk * walk / seconds);
            *ramp = if value > 2.0 * sigma {
                Estimate::Found { value, sigma }
            } else {
                Estimate::NotObservable { at_most: value + 2.0 * sigma }
            };
        }
        self
    }

    /// Slope over `seconds`, 1σ, rad/s², that a random walk at its upper limit would show; `None`
    /// where the walk was found, and its slope is part of the ramp's σ.
    #[must_use]
    pub fn hidden_slope(&self, seconds: Seconds) -> Option<RateRamp> {
        let [.., Estimate::NotObservable { at_most }, _] = self.estimates else { return None };
        Some(RateRamp(at_most * libm::sqrt(WALK_SLOPE / seconds.0)))
    }
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
