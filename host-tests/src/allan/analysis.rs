//! What a recording at rest says about its gyro: Allan deviation with limits, and the coefficients.
//!
//! The fit is the board's own ([`orientation::noise::fit`]), from the points of [`super::Overlapping`]. A limit is that of
//! 68.3 % (1σ of a normal distribution): the variance found times its degrees of freedom over the true one is distributed
//! as chi-square, with the degrees of freedom that the fitted noise gives (NIST SP 1065, section 5.4).

use orientation::noise::allan::Point;
use orientation::noise::allan::covariance::degrees_of_freedom;
use orientation::noise::fit::{FitError, NoiseFit};
use orientation::noise::model::GyroNoise;
use orientation::units::Seconds;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::rest::Rest;

/// The part of a normal distribution below its mean less 1σ.
const BELOW: f64 = 0.158_655_253_931_457_05;

/// An Allan deviation with its limits, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Confident {
    /// Averaging time, s.
    pub seconds: f64,
    /// The deviation.
    pub deviation: f64,
    /// The limits that hold the true one with 68.3 %.
    pub limits: [f64; 2],
    /// Equivalent degrees of freedom.
    pub degrees: f64,
    /// How many squares were averaged.
    pub terms: u64,
}

/// What a record says.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// The noise.
    pub fit: NoiseFit,
    /// The deviations, rising in averaging time.
    pub points: Vec<Confident>,
}

impl Analysis {
    /// Analyses a record at rest.
    ///
    /// # Errors
    /// Why the record says nothing.
    pub fn of(rest: &Rest) -> Result<Self, FitError> {
        rest.check()?;
        let (points, period) = (&rest.points, rest.spacing.period_s);
        let fit = NoiseFit::of_points(points, Seconds(period))?;
        // What rounds like this in steps says the step and not the gyro.
        let rounding = rest.step() * rest.step() / 12.0;
        if points.first().is_some_and(|point| point.variance < rounding) {
            return Err(FitError::Unresolved);
        }
        let noise = fit.noise();
        let points = points.iter().map(|point| confident(point, &noise, period)).collect();
        Ok(Self { fit, points })
    }
}

/// A point with the limits that its degrees of freedom give.
fn confident(point: &Point, noise: &GyroNoise, period: f64) -> Confident {
    let degrees = degrees_of_freedom(point, noise, period);
    let deviation = point.variance.sqrt();
    let limits = factors(degrees).map(|factor| factor * deviation);
    Confident { seconds: point.seconds.0, deviation, limits, degrees, terms: point.terms }
}

/// By what a deviation with so many degrees of freedom is multiplied for its 68.3 % limits; for
/// what is no number of degrees nothing is known.
#[must_use]
pub fn factors(degrees: f64) -> [f64; 2] {
    let Ok(distribution) = ChiSquared::new(degrees) else { return [0.0, f64::INFINITY] };
    [1.0 - BELOW, BELOW].map(|part| (degrees / distribution.inverse_cdf(part)).sqrt())
}
