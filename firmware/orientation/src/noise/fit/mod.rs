//! The gyro's noise coefficients from its Allan variance.
//!
//! σ²(τ) = 3Q²/τ² + N²/τ + (2 ln 2/π)B² + K²τ/3 + R²τ²/2 (IEEE Std 952-1997, annex C), fitted with
//! coefficients that are not negative. What is found has its standard deviation; what does not stand
//! out has a limit.
//!
//! Two laws that rise alike over one record are hard to tell apart. What is told is therefore the
//! mean of all choices of coefficients, and its deviation holds how far they lie apart. In simulated
//! records a coefficient that is not there is mostly found in one of thirty, but:
//!
//! - K in one of thirteen beside B that hardly rises above the white noise;
//! - B in one of eight beside a walk alone that hardly rises above the white noise;
//! - K in one of five beside B and a ramp that hardly rises above it, often in the ramp's stead;
//! - a ramp beside a walk holds the slope that the walk had in this record, and its deviation does
//!   not: it is four times too small where the walk is not found.
//!
//! A walk that is seldom above the bias instability (N 0.02 °/√h, B 0.3 °/h, K 2 °/h/√h, one hour) is
//! found in three records of four; in one of twenty it is above its stated limit, and beside a
//! quantisation in one of eleven. The value of what is seldom found lies too high, for only high ones
//! are found. Record longer, or at an even temperature.

mod average;
mod regression;
mod search;
mod spread;

use heapless::Vec;

use self::search::Search;
use super::allan::{Allan, MOST_POINTS, Point, variance};
use super::model::GyroNoise;
use crate::units::{ARCSECOND, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR};
use crate::words;
use crate::words::Rounded;

/// Variance of the slope of a random walk, in K² over its length: 6/5.
const WALK_SLOPE: f64 = 1.2;
/// Fewest samples of which anything is said: eight τ, as many as the coefficients and three.
const LEAST_SAMPLES: u64 = 64;

/// One coefficient as the record knows it, in the unit its place states. It is told with five decimal
/// places, which suit the field's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Estimate {
    /// It stands out.
    Found {
        /// The coefficient.
        value: f64,
        /// Its standard deviation.
        sigma: f64,
    },
    /// It does not stand out of the other noise of this record.
    NotObservable {
        /// What it does not exceed, at two standard deviations.
        at_most: f64,
    },
}

impl Estimate {
    /// The same in a unit that is so great in the present one.
    #[must_use]
    pub fn in_unit(self, unit: f64) -> Self {
        match self {
            Self::Found { value, sigma } => {
                Self::Found { value: value / unit, sigma: sigma / unit }
            }
            Self::NotObservable { at_most } => Self::NotObservable { at_most: at_most / unit },
        }
    }

    /// The coefficient where it was found.
    #[must_use]
    pub fn value(self) -> Option<f64> {
        match self {
            Self::Found { value, .. } => Some(value),
            Self::NotObservable { .. } => None,
        }
    }
}

words! { Estimate:
    Self::Found { value, sigma } => "{} ± {}", Rounded::<6>(value), Rounded::<6>(sigma);
    Self::NotObservable { at_most } => "not observable, at most {}", Rounded::<6>(at_most);
}

/// What a record says of its gyro's noise.
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
    /// Squared deviations of the points from the model over their variances.
    pub chi_square: f64,
    /// Points less coefficients found.
    pub degrees: usize,
}

impl NoiseFit {
    /// The noise of a gyro that stood still while it was sampled every `sample_seconds`.
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

    /// The same from points, rising in τ, that were estimated elsewhere.
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

    /// Adds to the σ of a ramp what the random walk over so many seconds looks like one: a slope of
    /// variance 6K²/(5T). A walk that was not found may still hide beside a ramp:
    /// [`Self::hidden_slope`] says how much.
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

    /// What a random walk that was not found, but may be there, would make of the slope over so many
    /// seconds, 1σ, rad/s².
    #[must_use]
    pub fn hidden_slope(&self, seconds: f64) -> Option<f64> {
        match self.rate_random_walk {
            Estimate::Found { .. } => None,
            Estimate::NotObservable { at_most } => Some(at_most * libm::sqrt(WALK_SLOPE / seconds)),
        }
    }

    /// Whether every coefficient is a number.
    fn is_finite(&self) -> bool {
        let is_finite = |estimate: &Estimate| match *estimate {
            Estimate::Found { value, sigma } => value.is_finite() && sigma.is_finite(),
            Estimate::NotObservable { at_most } => at_most.is_finite(),
        };
        self.estimates().iter().all(is_finite)
    }

    /// Q, N, B, K and R, in SI units.
    #[must_use]
    pub fn estimates(&self) -> [Estimate; 5] {
        let Self { quantisation: q, angle_random_walk: n, bias_instability: b, .. } = *self;
        [q, n, b, self.rate_random_walk, self.rate_ramp]
    }

    /// The fitted Allan variance at τ = `seconds`, (rad/s)².
    #[must_use]
    pub fn variance(&self, seconds: f64) -> f64 {
        variance(&self.noise(), seconds)
    }

    /// The coefficients found; what is not observable is zero.
    #[must_use]
    pub fn noise(&self) -> GyroNoise {
        GyroNoise {
            quantisation: self.quantisation.value().unwrap_or(0.0),
            angle_random_walk: self.angle_random_walk.value().unwrap_or(0.0),
            bias_instability: self.bias_instability.value().unwrap_or(0.0),
            rate_random_walk: self.rate_random_walk.value().unwrap_or(0.0),
            rate_ramp: self.rate_ramp.value().unwrap_or(0.0),
        }
    }

    /// All of them in the field's units.
    #[must_use]
    pub fn in_field_units(&self) -> [(Coefficient, Estimate); 5] {
        [
            (Coefficient::Quantisation, self.arcseconds()),
            (Coefficient::AngleRandomWalk, self.degrees_per_sqrt_hour()),
            (Coefficient::BiasInstability, self.degrees_per_hour()),
            (Coefficient::RateRandomWalk, self.degrees_per_hour_per_sqrt_hour()),
            (Coefficient::RateRamp, self.degrees_per_hour_squared()),
        ]
    }

    /// Q, arc seconds.
    #[must_use]
    pub fn arcseconds(&self) -> Estimate {
        self.quantisation.in_unit(ARCSECOND)
    }

    /// N, °/√h.
    #[must_use]
    pub fn degrees_per_sqrt_hour(&self) -> Estimate {
        self.angle_random_walk.in_unit(DEGREE_PER_SQRT_HOUR)
    }

    /// B, °/h.
    #[must_use]
    pub fn degrees_per_hour(&self) -> Estimate {
        self.bias_instability.in_unit(DEGREE_PER_HOUR)
    }

    /// K, °/h/√h.
    #[must_use]
    pub fn degrees_per_hour_per_sqrt_hour(&self) -> Estimate {
        self.rate_random_walk.in_unit(DEGREE_PER_HOUR / 60.0)
    }

    /// R, °/h².
    #[must_use]
    pub fn degrees_per_hour_squared(&self) -> Estimate {
        self.rate_ramp.in_unit(DEGREE_PER_HOUR / 3600.0)
    }
}

/// A coefficient of the noise model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coefficient {
    /// Q, arc seconds.
    Quantisation,
    /// N, °/√h.
    AngleRandomWalk,
    /// B, °/h.
    BiasInstability,
    /// K, °/h/√h.
    RateRandomWalk,
    /// R, °/h².
    RateRamp,
}

words! { Coefficient:
    Self::Quantisation => "quantisation Q, arc seconds";
    Self::AngleRandomWalk => "angle random walk N, °/√h";
    Self::BiasInstability => "bias instability B, °/h";
    Self::RateRandomWalk => "rate random walk K, °/h/√h";
    Self::RateRamp => "rate ramp R, °/h²";
}

words! { NoiseFit:
    fit => "Q {}″; N {} °/√h; B {} °/h; K {} °/h/√h; R {} °/h²",
        fit.arcseconds(), fit.degrees_per_sqrt_hour(), fit.degrees_per_hour(),
        fit.degrees_per_hour_per_sqrt_hour(), fit.degrees_per_hour_squared();
}

/// Why a record says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitError {
    /// Too few samples for a fit.
    TooShort {
        /// Samples there are.
        samples: u64,
        /// Samples needed.
        needed: u64,
    },
    /// All samples are equal.
    Constant,
    /// A sample stood at a limit of its range.
    Saturated,
    /// The noise is smaller than what the rounding of its numbers adds.
    Unresolved,
    /// The variances are zero, infinite or those of a disturbance without noise.
    NotNoise,
    /// The time between samples is not a positive number.
    Period,
}

words! { FitError:
    Self::TooShort { samples, needed } =>
        "record too short: {} samples, {} needed", samples, needed;
    Self::Constant => "all samples are equal: the gyro or its bus is stuck";
    Self::Saturated => "a sample stood at the limit of its range";
    Self::Unresolved => "the noise is smaller than the step of the samples";
    Self::NotNoise => "the record is not one of noise";
    Self::Period => "the time between samples is not a positive number of seconds";
}
