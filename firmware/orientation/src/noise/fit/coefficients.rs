//! Noise coefficients as one record shows them, each found or limited.

use crate::noise::GyroNoise;
use crate::units::{ARCSECOND, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR};
use crate::words::Rounded;

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
    pub(crate) fn in_unit(self, unit: f64) -> Self {
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
    /// Estimates of the quantisation Q, rad, angle random walk N, rad/√s, bias instability B, rad/s,
    /// rate random walk K, rad/s/√s, and rate ramp R, rad/s².
    pub estimates: [Estimate; 5],
    /// Chi-square of the fit: squared deviations of the points from the model over their variances,
    /// summed. Neighbouring points correlate, so its expectation is not `degrees`.
    pub chi_square: f64,
    /// Number of points less number of coefficients found.
    pub degrees: usize,
}

impl NoiseFit {
    /// Whether every estimate is finite.
    pub(super) fn is_finite(&self) -> bool {
        let is_finite = |estimate: &Estimate| match *estimate {
            Estimate::Found { value, sigma } => value.is_finite() && sigma.is_finite(),
            Estimate::NotObservable { at_most } => at_most.is_finite(),
        };
        self.estimates.iter().all(is_finite)
    }

    /// Noise model of the coefficients found; a coefficient that is not observable is zero.
    pub fn noise(&self) -> GyroNoise {
        GyroNoise::of(self.estimates.map(|estimate| estimate.value().unwrap_or(0.0)))
    }

    /// All estimates in the field's units, as [`Coefficient`] states them.
    #[must_use]
    pub fn in_field_units(&self) -> [(Coefficient, Estimate); 5] {
        let [q, n, b, k, r] = self.estimates;
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
