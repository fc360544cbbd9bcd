//! Streaming normal equations, which every alignment method shares.
//!
//! Rows of unit noise arrive one at a time; only their products are kept. Columns are selected when
//! solving, so that one pass serves every model that is compared. A column may carry a prior of
//! zero mean and known standard deviation, entered as information on its diagonal.

use heapless::Vec;

use super::{Scalar, cholesky, cholesky_solve};

/// Number of columns of the regressions on a board: one size for all, so that one copy of the code
/// in flash serves them.
pub(crate) const COLUMNS: usize = 7;

/// Sums of products of `P` columns and the left side.
#[derive(Clone, Debug)]
pub struct Regression<const P: usize, T = f64> {
    /// Products of the columns, lower triangle.
    products: [[T; P]; P],
    /// Products of the columns with the left side.
    with_left: [T; P],
    /// Sum of squares of the left side.
    left_squared: T,
    /// Number of rows.
    rows: usize,
}

/// Use of a column in a solution, and prior knowledge of its coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Column {
    /// The column is left out and its coefficient is zero.
    Absent,
    /// The coefficient is estimated without prior knowledge.
    Free,
    /// The coefficient is estimated with a prior of zero mean and this standard deviation.
    Prior(f64),
}

/// A least-squares solution; coefficients of absent columns are zero.
#[derive(Clone, Debug)]
pub struct Solution<const P: usize> {
    /// Coefficients in the units of left side over column.
    pub coefficients: [f64; P],
    /// Covariance of the coefficients, for rows of unit noise.
    pub covariance: [[f64; P]; P],
    /// Sum of squared residuals and of squared priors, in units of the noise variance.
    pub chi_square: f64,
    /// Number of rows less number of freely estimated coefficients.
    pub degrees: usize,
}

impl<const P: usize, T: Scalar> Default for Regression<P, T> {
    fn default() -> Self {
        let zero = T::default();
        Self { products: [[zero; P]; P], with_left: [zero; P], left_squared: zero, rows: 0 }
    }
}

impl<const P: usize, T: Scalar> Regression<P, T> {
    /// Adds a row whose noise has variance one.
    pub fn push(&mut self, columns: &[T; P], left: T) {
        for i in 0..P {
            // The lower triangle is all that a Cholesky factor needs.
            for j in 0..=i {
                self.products[i][j] += columns[i] * columns[j];
            }
            self.with_left[i] += columns[i] * left;
        }
        self.left_squared += left * left;
        self.rows += 1;
    }

    /// Solves for the selected columns; `None` where they are linearly dependent or rows are too
    /// few.
    #[must_use]
    pub fn solve(&self, model: &[Column; P]) -> Option<Solution<P>> {
        let is_used = |&column: &usize| model[column] != Column::Absent;
        let used: Vec<usize, P> = (0..P).filter(is_used).collect();
        let size = used.len();
        let free = model.iter().filter(|&&column| column == Column::Free).count();
        let degrees = self.rows.checked_sub(free)?;
        let mut factor = [[0.0; P]; P];
        let mut coefficients = [0.0; P];
        for i in 0..size {
            for j in 0..=i {
                factor[i][j] = self.products[used[i]][used[j]].into();
            }
            if let Column::Prior(sigma) = model[used[i]] {
                factor[i][i] += 1.0 / (sigma * sigma);
            }
            coefficients[i] = self.with_left[used[i]].into();
        }
        if !cholesky(&mut factor, size) {
            return None;
        }
        cholesky_solve(&factor, size, &mut coefficients);
        let left = |i: usize| -> f64 { self.with_left[used[i]].into() };
        let explained: f64 = (0..size).map(|i| coefficients[i] * left(i)).sum();
        Some(Solution {
            coefficients: spread(&coefficients, &used),
            covariance: inverse(&factor, &used),
            chi_square: (self.left_squared.into() - explained).max(0.0),
            degrees,
        })
    }
}

impl<const P: usize> Regression<P> {
    /// Regression from sums that were gathered elsewhere: products of the columns, lower triangle,
    /// and of each with the left side. The square of the left side is missing, so chi-square is not
    /// valid.
    pub(crate) fn of_products(products: [[f64; P]; P], with_left: [f64; P], rows: usize) -> Self {
        Self { products, with_left, left_squared: 0.0, rows }
    }
}

/// Distributes packed values to the places of their columns.
fn spread<const P: usize>(packed: &[f64; P], used: &[usize]) -> [f64; P] {
    let mut full = [0.0; P];
    for (column, value) in used.iter().zip(packed) {
        full[*column] = *value;
    }
    full
}

/// Inverse of the factored matrix, at the places of its columns.
fn inverse<const P: usize>(factor: &[[f64; P]; P], used: &[usize]) -> [[f64; P]; P] {
    let mut full = [[0.0; P]; P];
    for (packed, column) in used.iter().enumerate() {
        let mut unit = [0.0; P];
        unit[packed] = 1.0;
        cholesky_solve(factor, used.len(), &mut unit);
        full[*column] = spread(&unit, used);
    }
    full
}
