//! Model averaging: the estimate of each coefficient from all choices of coefficients.
//!
//! A record seldom decides which coefficients are present, and an uncertainty that holds for one
//! choice only is smaller than the record justifies. So each choice is weighted by exp(−c/2), c
//! being its deviance plus the prices of its coefficients, divided by the number of points that
//! repeat each other. A coefficient counts as found where the choices in which it is positive hold
//! most of the weight; its value is their weighted mean, and its standard deviation includes how
//! far they lie apart. A coefficient that is not found gets an upper limit from all choices that
//! allow it, also those in which it came out as zero. The error rates are asserted in
//! host-tests/tests/cores/allan/simulated.rs.

use super::coefficients::Estimate;
use super::regression::{COLUMNS, Columns};

/// Number of neighbouring points that carry the same information, about.
const REPEATS: f64 = 2.0;
/// Least part of the weight with which a coefficient counts as found.
const CERTAIN: f64 = 0.75;

/// Fit of one choice of coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    /// Coefficients that the choice allows to be positive.
    pub columns: Columns,
    /// Squares of the coefficients, SI units.
    pub squares: [f64; COLUMNS],
    /// Standard deviations of the squares, as if the points were independent.
    pub spreads: [f64; COLUMNS],
    /// Deviance plus the prices of the coefficients.
    pub cost: f64,
}

/// Weighted sums over choices: a mixture of normal distributions.
#[derive(Clone, Copy, Debug, Default)]
struct Mixture {
    /// Sum of the weights.
    weight: f64,
    /// Weighted sum of the means.
    values: f64,
    /// Weighted sum of the second moments about zero.
    squares: f64,
}

impl Mixture {
    /// Adds a component with this weight, mean and standard deviation.
    fn add(&mut self, weight: f64, value: f64, sigma: f64) {
        self.weight += weight;
        self.values += weight * value;
        self.squares += weight * (value * value + sigma * sigma);
    }

    /// Mean and standard deviation of the mixture.
    fn moments(&self) -> (f64, f64) {
        let mean = self.values / self.weight;
        (mean, libm::sqrt((self.squares / self.weight - mean * mean).max(0.0)))
    }
}

/// Estimate of each coefficient from all choices. `inflations` are the factors by which correlation
/// between the points raises the variances of the squared coefficients.
pub(crate) fn average(choices: &[Choice], inflations: &[f64; COLUMNS]) -> [Estimate; COLUMNS] {
    let least = choices.iter().map(|choice| choice.cost).fold(f64::INFINITY, f64::min);
    core::array::from_fn(|column| estimate(choices, least, column, inflations[column]))
}

/// Estimate of one coefficient; `least` is the cost of the best choice, which gets weight one.
fn estimate(choices: &[Choice], least: f64, column: usize, inflation: f64) -> Estimate {
    let (mut total, mut allowed, mut positive) = (0.0, Mixture::default(), Mixture::default());
    for choice in choices {
        let weight = libm::exp((least - choice.cost) / (2.0 * REPEATS));
        total += weight;
        if choice.columns.has(column) {
            let (value, sigma) = coefficient(choice, column, inflation);
            allowed.add(weight, value, sigma);
            positive.add(if value > 0.0 { weight } else { 0.0 }, value, sigma);
        }
    }
    if positive.weight > CERTAIN * total {
        let (value, sigma) = positive.moments();
        return Estimate::Found { value, sigma };
    }
    let (value, sigma) = allowed.moments();
    Estimate::NotObservable { at_most: value + 2.0 * sigma }
}

/// A coefficient and its standard deviation under one choice. The standard deviation never exceeds
/// the root of the square's, which holds for a coefficient near zero.
fn coefficient(choice: &Choice, column: usize, inflation: f64) -> (f64, f64) {
    let spread = choice.spreads[column] * libm::sqrt(inflation);
    let value = libm::sqrt(choice.squares[column]);
    let near = libm::sqrt(spread);
    (value, if 2.0 * value > near { 0.5 * spread / value } else { near })
}
