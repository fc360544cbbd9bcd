//! Linear least squares with non-negative coefficients. With five coefficients every choice of
//! positive ones can be tried: 31 small Cholesky solutions cost less flash than an active-set
//! method.

use heapless::Vec;

use crate::math::{cholesky, cholesky_solve};
use crate::noise::allan::{MOST_POINTS, Point, terms};

/// Number of coefficients: the squares of Q, N, B, K and R.
pub(crate) const COLUMNS: usize = 5;

/// Index of the column of N².
pub(crate) const WHITE: usize = 1;

/// Set of coefficients that take part, one bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Columns(pub u8);

impl Columns {
    /// Set of all five coefficients.
    pub(crate) const ALL: Self = Self(0b1_1111);

    /// Whether a coefficient takes part.
    pub(crate) fn has(self, column: usize) -> bool {
        self.0 >> column & 1 == 1
    }

    /// The set with one coefficient added.
    pub(crate) fn with(self, column: usize) -> Self {
        Self(self.0 | 1 << column)
    }

    /// Number of coefficients that take part.
    pub(crate) fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Indices of the coefficients that take part, in rising order.
    pub(crate) fn each(self) -> impl Iterator<Item = usize> {
        (0..COLUMNS).filter(move |&column| self.has(column))
    }

    /// Every non-empty subset.
    pub(crate) fn subsets(self) -> impl Iterator<Item = Self> {
        (1..=self.0).filter(move |subset| subset & !self.0 == 0).map(Self)
    }
}

/// Weighted normal equations of the points over some columns, which are scaled to norm 1; the
/// entries of other columns are zero.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// Columns that take part.
    columns: Columns,
    /// Matrix of the normal equations, lower triangle.
    normal: [[f64; COLUMNS]; COLUMNS],
    /// Right side of the normal equations.
    right: [f64; COLUMNS],
    /// Factors that scale the columns to norm 1.
    scales: [f64; COLUMNS],
}

impl Sums {
    /// Normal equations of points whose variances have the standard deviations `sigmas`.
    pub(crate) fn new(points: &[Point], sigmas: &[f64], columns: Columns) -> Self {
        let mut sums = Self { columns, ..Self::default() };
        for (point, sigma) in points.iter().zip(sigmas) {
            let weight = 1.0 / sigma;
            sums.add(&terms(point.seconds.0), point.variance * weight, weight);
        }
        sums.scale();
        sums
    }

    /// Adds one point; `left` is its variance times its weight, and the weight is the reciprocal of
    /// its σ.
    fn add(&mut self, terms: &[f64; COLUMNS], left: f64, weight: f64) {
        for i in self.columns.each() {
            let term = terms[i] * weight;
            let scaled = term * weight;
            for j in self.columns.each().take_while(|&j| j <= i) {
                self.normal[i][j] += scaled * terms[j];
            }
            self.right[i] += term * left;
        }
    }

    /// Scales the columns to norm 1, so that the Cholesky pivots can be judged.
    fn scale(&mut self) {
        for i in self.columns.each() {
            self.scales[i] = 1.0 / libm::sqrt(self.normal[i][i]);
        }
        for i in self.columns.each() {
            for j in self.columns.each().take_while(|&j| j <= i) {
                self.normal[i][j] *= self.scales[i] * self.scales[j];
            }
            self.right[i] *= self.scales[i];
        }
    }

    /// Lower Cholesky factor of the normal equations of some columns, packed to the front; `None`
    /// where they are dependent.
    fn factor(&self, columns: Columns) -> Option<[[f64; COLUMNS]; COLUMNS]> {
        let mut matrix = [[0.0; COLUMNS]; COLUMNS];
        for (i, row) in columns.each().enumerate() {
            for (j, column) in columns.each().enumerate().take(i + 1) {
                matrix[i][j] = self.normal[row][column];
            }
        }
        cholesky(&mut matrix, columns.count()).then_some(matrix)
    }

    /// Solution of the normal equations of some columns for a right side; the other coefficients
    /// are zero.
    fn solve(&self, columns: Columns, right: &[f64; COLUMNS]) -> Option<[f64; COLUMNS]> {
        let factor = self.factor(columns)?;
        let mut packed = [0.0; COLUMNS];
        for (to, from) in packed.iter_mut().zip(columns.each()) {
            *to = right[from];
        }
        cholesky_solve(&factor, columns.count(), &mut packed);
        let mut solution = [0.0; COLUMNS];
        for (to, from) in columns.each().zip(packed) {
            solution[to] = from;
        }
        Some(solution)
    }

    /// Column `column` of the inverse of the normal equations of some columns: the covariances with
    /// this squared coefficient if the points were independent.
    pub(crate) fn inverse(&self, columns: Columns, column: usize) -> Option<[f64; COLUMNS]> {
        let mut unit = [0.0; COLUMNS];
        unit[column] = self.scales[column];
        let scaled = self.solve(columns, &unit)?;
        Some(core::array::from_fn(|i| scaled[i] * self.scales[i]))
    }

    /// Best non-negative solution: of all subsets of columns with positive solutions, the one that
    /// explains most.
    pub(crate) fn positive(&self) -> (Columns, [f64; COLUMNS]) {
        let mut best = (Columns(0), [0.0; COLUMNS]);
        let mut most = 0.0;
        for subset in self.columns.subsets() {
            let Some(solution) = self.solve(subset, &self.right) else { continue };
            let explained = sum(&solution, &self.right);
            if explained > most && subset.each().all(|column| solution[column] > 0.0) {
                most = explained;
                best = (subset, core::array::from_fn(|i| solution[i] * self.scales[i]));
            }
        }
        best
    }
}

/// Scalar product Σ xᵢyᵢ.
pub(crate) fn sum(x: &[f64; COLUMNS], y: &[f64; COLUMNS]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// Weight of each point's variance in a squared coefficient, from that coefficient's column of the
/// inverse.
pub(crate) fn row(
    inverse: &[f64; COLUMNS],
    points: &[Point],
    sigmas: &[f64],
) -> Vec<f64, MOST_POINTS> {
    let count =
        |(point, sigma): (&Point, &f64)| sum(inverse, &terms(point.seconds.0)) / (sigma * sigma);
    points.iter().zip(sigmas).map(count).collect()
}
