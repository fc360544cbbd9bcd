//! What all choices of coefficients say together.
//!
//! A record seldom tells for sure which coefficients are there, and a value that holds for one choice
//! only is surer than the record is. So each choice counts by what it is worth: exp(−c/2), c being its
//! deviance and prices for each of the points that tell the same. A coefficient is found where the
//! choices in which it is positive hold most of the weight; its value is their mean, and its deviation
//! is theirs together with how far they lie apart. What is not found is limited by all choices that
//! allow it, also those in which it came out as zero. tests/allan/simulated.rs holds how often this
//! errs.

use super::Estimate;
use super::regression::COLUMNS;
use super::search::Choice;

/// Neighbouring points repeat each other: about so many tell the same.
const REPEATS: f64 = 2.0;
/// Part of the weight that makes a coefficient found.
const CERTAIN: f64 = 0.75;

/// Weighted sums over choices.
#[derive(Clone, Copy, Debug, Default)]
struct Mixture {
    weight: f64,
    values: f64,
    squares: f64,
}

impl Mixture {
    fn add(&mut self, weight: f64, value: f64, sigma: f64) {
        self.weight += weight;
        self.values += weight * value;
        self.squares += weight * (value * value + sigma * sigma);
    }

    /// Mean and standard deviation.
    fn moments(&self) -> (f64, f64) {
        let mean = self.values / self.weight;
        (mean, libm::sqrt((self.squares / self.weight - mean * mean).max(0.0)))
    }
}

/// Each coefficient from all choices; `inflations` says by how much the variances of the squares
/// exceed those from points that do not repeat each other.
pub fn average(choices: &[Choice], inflations: &[f64; COLUMNS]) -> [Estimate; COLUMNS] {
    let least = choices.iter().map(|choice| choice.cost).fold(f64::INFINITY, f64::min);
    core::array::from_fn(|column| estimate(choices, least, column, inflations[column]))
}

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

/// A coefficient and its standard deviation, which is no more than the root of the square's: that of
/// a coefficient near zero.
fn coefficient(choice: &Choice, column: usize, inflation: f64) -> (f64, f64) {
    let spread = choice.spreads[column] * libm::sqrt(inflation);
    let value = libm::sqrt(choice.squares[column]);
    let near = libm::sqrt(spread);
    (value, if 2.0 * value > near { 0.5 * spread / value } else { near })
}
