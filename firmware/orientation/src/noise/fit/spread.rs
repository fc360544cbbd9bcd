//! Standard deviations of the squared coefficients.

use heapless::Vec;

use super::regression::{COLUMNS, Columns, Sums, row};
use super::search::{Model, Search};
use crate::noise::allan::MOST_POINTS;
use crate::noise::allan::covariance::{Law, Window};

/// One number for each point.
type Row = Vec<f64, MOST_POINTS>;

impl Search<'_> {
    /// Standard deviations of the squares of some coefficients, as if the points were independent,
    /// for a model that expects these variances. A coefficient outside the model is treated as if
    /// it alone were added; others are zero.
    pub(crate) fn spreads(
        &self,
        columns: Columns,
        model: &Model,
        variances: &[f64],
    ) -> [f64; COLUMNS] {
        let sums = Sums::new(self.points, &self.sigmas(variances), columns);
        let mut spreads = [0.0; COLUMNS];
        for column in columns.each() {
            let inverse = sums.inverse(model.columns.with(column), column);
            spreads[column] = libm::sqrt(inverse.map_or(f64::NAN, |inverse| inverse[column]));
        }
        spreads
    }

    /// Factors by which correlation between the points raises the variances of the squares, under
    /// the expected model. A coefficient outside the model is treated as if it alone were added.
    pub(crate) fn inflations(&self, model: &Model) -> [f64; COLUMNS] {
        let sigmas = self.sigmas(&self.variances);
        let sums = Sums::new(self.points, &sigmas, Columns::ALL);
        let mut inflations = [0.0; COLUMNS];
        let rows: [Row; COLUMNS] = core::array::from_fn(|column| {
            let inverse = sums.inverse(model.columns.with(column), column).unwrap_or_default();
            inflations[column] = 1.0 / inverse[column];
            row(&inverse, self.points, &sigmas)
        });
        let variances = self.variances_of(&rows, model);
        core::array::from_fn(|column| inflations[column] * variances[column])
    }

    /// Variances of weighted sums over the points, with their full covariance.
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
