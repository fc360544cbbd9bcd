//! What a recording at rest says about its gyro: Allan deviation with limits, and the coefficients.
//!
//! The fit is the board's own ([`orientation::noise::fit`]), from points that use every window of the
//! record. A limit is that of 68.3 % (1σ of a normal distribution): the variance found times its
//! degrees of freedom over the true one is distributed as chi-square, with the degrees of freedom
//! that the fitted noise gives (NIST SP 1065, section 5.4).

use orientation::noise::allan::Point;
use orientation::noise::allan::covariance::degrees_of_freedom;
use orientation::noise::fit::{FitError, NoiseFit};
use orientation::noise::model::GyroNoise;
use orientation::units::{AngularRate, Seconds};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::Record;
use crate::recording::{Body, Header, Kind, Short, Spacing, StaticRow};
use thiserror::Error;

/// The part of a normal distribution below its mean less 1σ.
const BELOW: f64 = 0.158_655_253_931_457_05;

/// A rate column.
type Column = (&'static str, fn(&StaticRow) -> Option<f64>);

/// The columns that have rates; the first that a recording has is the default.
const COLUMNS: [Column; 4] = [
    ("g_rad_s", |row| row.rate_rad_s),
    ("gx_rad_s", |row| row.imu.map(|imu| imu.rates_rad_s[0])),
    ("gy_rad_s", |row| row.imu.map(|imu| imu.rates_rad_s[1])),
    ("gz_rad_s", |row| row.imu.map(|imu| imu.rates_rad_s[2])),
];

/// The rates of one column at rest.
#[derive(Clone, Debug)]
pub struct Rest {
    /// The column's name.
    pub column: &'static str,
    /// When the samples came.
    pub spacing: Spacing,
    /// The samples, rad/s, those of all segments.
    pub rates: Vec<f64>,
}

/// Why a recording that could be read has no rates at rest.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RestError {
    /// The recording is of another kind.
    #[error("kind `{0}` is no record at rest; record the gyro at rest as kind `static`")]
    Kind(Kind),
    /// The name of a column that is not there, and those that are.
    #[error("there is no rate column {0:?}; there is {there}", there = .1.join(", "))]
    Column(String, Vec<&'static str>),
    /// There is but one row.
    #[error("record too short: one row has no time between samples")]
    OneRow,
}

impl Rest {
    /// Takes a column of a recording; without a name the gyro's, else that of body x.
    pub fn take(header: &Header, body: &Body, column: Option<&str>) -> Result<Self, RestError> {
        let Body::Static(rows) = body else { return Err(RestError::Kind(body.kind())) };
        let spacing = Spacing::of(rows, header.rate_hz).ok_or(RestError::OneRow)?;
        let has = |(_, rate): &&Column| rows.first().is_some_and(|row| rate(row).is_some());
        let there = || COLUMNS.iter().filter(has);
        let named = |(name, _): &&Column| column.is_none_or(|column| column == *name);
        let (column, rate) = there().find(named).ok_or_else(|| {
            let names = there().map(|(name, _)| *name).collect();
            RestError::Column(column.unwrap_or_default().to_owned(), names)
        })?;
        Ok(Self { column, spacing, rates: rows.iter().filter_map(rate).collect() })
    }

    /// The samples between gaps, rad/s.
    pub fn segments(&self) -> impl Iterator<Item = &[f64]> {
        self.spacing.segments().map(|rows| &self.rates[rows])
    }

    /// The samples of the longest segment, rad/s.
    pub(crate) fn longest(&self) -> &[f64] {
        self.segments().max_by_key(|segment| segment.len()).unwrap_or_default()
    }

    /// Record of all segments for the estimators.
    pub(crate) fn record(&self) -> Record {
        Record::new(self.spacing.period_s, self.segments())
    }

    /// What a reader must know of the record: gaps, and a header's rate that is wrong.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let Spacing { period_s, gaps, contradicted_rate_hz, .. } = &self.spacing;
        let rate = contradicted_rate_hz.map(|stated| {
            let (stated, found) = (Short(stated), 1.0 / period_s);
            format!("the header's {stated} Hz contradicts the times, which have {found:.6} Hz: the times are believed")
        });
        let missing: f64 = gaps.iter().map(|gap| gap.seconds - period_s).sum();
        let gaps = gaps.first().map(|first| {
            let (count, line, from) = (gaps.len(), first.line, first.from_s);
            let gaps = if count == 1 { "gap" } else { "gaps" };
            format!("{count} {gaps}, {missing:.3} s in all, the first before line {line} after {from} s: no window crosses one")
        });
        rate.into_iter().chain(gaps).collect()
    }

    /// Why nothing can be said whatever the variances are.
    fn check(&self) -> Result<(), FitError> {
        if self.rates.iter().any(|rate| AngularRate::from_rad_per_s(*rate).is_saturated()) {
            return Err(FitError::Saturated);
        }
        let is_constant = self.rates.windows(2).all(|pair| pair[0] == pair[1]);
        if is_constant && self.rates.len() > 1 { Err(FitError::Constant) } else { Ok(()) }
    }

    /// The smallest change between neighbouring samples, rad/s: in a record of noise, the step of the
    /// numbers it came in.
    fn step(&self) -> f64 {
        let changes = self.rates.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        changes.filter(|change| *change > 0.0).fold(f64::INFINITY, f64::min)
    }
}

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
        let record = rest.record();
        let factors = record.factors().into_iter();
        let points: Vec<Point> = factors.filter_map(|m| record.strided(m, 1)).collect();
        let period = rest.spacing.period_s;
        let fit = NoiseFit::of_points(&points, Seconds(period))?;
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
