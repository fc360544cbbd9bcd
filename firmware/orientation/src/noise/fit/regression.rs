//! Linear least squares with coefficients that are not negative.

use heapless::Vec;

use crate::math::{cholesky, cholesky_solve};
use crate::noise::allan::{MOST_POINTS, Point, terms};

/// Coefficients: the squares of Q, N, B, K and R.
pub const COLUMNS: usize = 5;

/// The column of N.
pub const WHITE: usize = 1;

/// Which coefficients take part, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns(pub u8);

impl Columns {
    /// All five.
    pub const ALL: Self = Self(0b1_1111);

    /// Whether this one takes part.
    pub fn has(self, column: usize) -> bool {
        self.0 >> column & 1 == 1
    }

    /// With this one.
    pub fn with(self, column: usize) -> Self {
        Self(self.0 | 1 << column)
    }

    /// How many take part.
    pub fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Those that take part, rising.
    pub fn each(self) -> impl Iterator<Item = usize> {
        (0..COLUMNS).filter(move |&column| self.has(column))
    }

    /// Every choice of them that is not empty.
    pub fn subsets(self) -> impl Iterator<Item = Self> {
        (1..=self.0).filter(move |subset| subset & !self.0 == 0).map(Self)
    }
}

/// Weighted sums of the points over some columns, which are scaled to norm 1; others are zero.
#[derive(Clone, Copy, Debug)]
pub struct Sums {
    columns: Columns,
    normal: [[f64; COLUMNS]; COLUMNS],
    right: [f64; COLUMNS],
    scales: [f64; COLUMNS],
}

impl Sums {
    /// Of points whose variances have the standard deviations `sigmas`.
    pub fn new(points: &[Point], sigmas: &[f64], columns: Columns) -> Self {
        let mut sums = Self {
            columns,
            normal: [[0.0; COLUMNS]; COLUMNS],
            right: [0.0; COLUMNS],
            scales: [0.0; COLUMNS],
        };
        for (point, sigma) in points.iter().zip(sigmas) {
            let weight = 1.0 / sigma;
            sums.add(&terms(point.seconds), point.variance * weight, weight);
        }
        sums.scale();
        sums
    }

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

    /// Lower factor of the normal equations of some columns, packed to the front.
    fn factor(&self, columns: Columns) -> Option<[[f64; COLUMNS]; COLUMNS]> {
        let mut matrix = [[0.0; COLUMNS]; COLUMNS];
        for (i, row) in columns.each().enumerate() {
            for (j, column) in columns.each().enumerate().take(i + 1) {
                matrix[i][j] = self.normal[row][column];
            }
        }
        cholesky(&mut matrix, columns.count()).then_some(matrix)
    }

    /// Solves the normal equations of some columns for a right side; others are zero.
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

    /// Column `column` of the inverse of the normal equations of some columns: covariances with this
    /// coefficient's square if the points were independent.
    pub fn inverse(&self, columns: Columns, column: usize) -> Option<[f64; COLUMNS]> {
        let mut unit = [0.0; COLUMNS];
        unit[column] = self.scales[column];
        let scaled = self.solve(columns, &unit)?;
        Some(core::array::from_fn(|i| scaled[i] * self.scales[i]))
    }

    /// The best of all solutions that are not negative: of every choice of columns that gives
    /// positive ones, that which explains most.
    pub fn positive(&self) -> (Columns, [f64; COLUMNS]) {
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

/// Σ xᵢyᵢ.
pub fn sum(x: &[f64; COLUMNS], y: &[f64; COLUMNS]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// What each point's variance counts in a coefficient's square, from that coefficient's column of the
/// inverse.
pub fn row(inverse: &[f64; COLUMNS], points: &[Point], sigmas: &[f64]) -> Vec<f64, MOST_POINTS> {
    let count =
        |(point, sigma): (&Point, &f64)| sum(inverse, &terms(point.seconds)) / (sigma * sigma);
    points.iter().zip(sigmas).map(count).collect()
}
