//! How sure the coefficients are: their variances from the covariance of all points.

use heapless::Vec;

use super::Estimate;
use super::regression::{COLUMNS, Columns, Sums, row};
use super::search::{Model, Search};
use crate::noise::allan::MOST_POINTS;
use crate::noise::allan::covariance::{Law, Window};

/// The square of a coefficient.
#[derive(Clone, Copy, Debug, Default)]
pub struct Square {
    value: f64,
    sigma: f64,
    /// Its variance over that from points which do not repeat each other.
    pub inflation: f64,
}

impl Square {
    /// The coefficient over its standard deviation; zero where it is not positive.
    pub fn ratio(&self) -> f64 {
        2.0 * self.value.max(0.0) / self.sigma
    }

    /// The coefficient.
    pub fn estimate(&self) -> Estimate {
        let value = libm::sqrt(self.value);
        Estimate::Found { value, sigma: 0.5 * self.sigma / value }
    }

    /// The square at two standard deviations above the estimate.
    pub fn limit(&self) -> f64 {
        self.value.max(0.0) + 2.0 * self.sigma
    }
}

/// One number a point.
type Row = Vec<f64, MOST_POINTS>;

impl Search<'_> {
    /// Every coefficient's square; those outside the model as if each alone were taken in, with the
    /// deviation that it has if it is zero.
    pub fn squares(&self, model: &Model) -> [Square; COLUMNS] {
        let sigmas = self.sigmas(self.variances());
        let sums = Sums::new(self.points, &sigmas, Columns::ALL, &[0.0; COLUMNS]);
        let mut squares = [Square::default(); COLUMNS];
        let rows: [Row; COLUMNS] = core::array::from_fn(|column| {
            let inverse = sums.inverse(model.columns.with(column), column).unwrap_or_default();
            squares[column].inflation = 1.0 / inverse[column];
            row(&inverse, self.points, &sigmas)
        });
        let variances = self.variances_of(&rows, model);
        for ((square, counts), variance) in squares.iter_mut().zip(&rows).zip(variances) {
            square.value =
                counts.iter().zip(self.points).map(|(count, point)| count * point.variance).sum();
            square.sigma = libm::sqrt(variance);
            square.inflation *= variance;
        }
        squares
    }

    /// Variances of sums over the points.
    fn variances_of(&self, rows: &[Row; COLUMNS], model: &Model) -> [f64; COLUMNS] {
        let noise = model.noise();
        let law = Law::new(&noise, self.sample_seconds);
        let window = |point| Window::new(point, &noise, self.sample_seconds);
        let windows: Vec<Window, MOST_POINTS> = self.points.iter().map(window).collect();
        let mut variances = [0.0; COLUMNS];
        for (i, one) in windows.iter().enumerate() {
            for (j, other) in windows.iter().enumerate().take(i + 1) {
                let times = if i == j { 1.0 } else { 2.0 };
                let covariance = times * law.covariance(one, other);
                for (variance, row) in variances.iter_mut().zip(rows) {
                    *variance += covariance * row[i] * row[j];
                }
            }
        }
        variances
    }
}
