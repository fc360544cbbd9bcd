//! Fits of a record for every choice of coefficients.
//!
//! Allan variances are nearly gamma distributed, and with few degrees of freedom far from normal.
//! So choices are compared by their gamma deviance Σ ν (r − 1 − ln r), r = V̂/V, with ν the
//! equivalent degrees of freedom, plus a price for each coefficient. The result is not taken from a
//! single choice: the module `average` weights them all.
//!
//! The points are weighted as if they were independent, and the standard deviations follow from
//! their full covariance. Weighting by the full covariance as well would reduce the standard
//! deviation of N by 11 %, of B and K by 1 to 8 % (an hour at 10 Hz), would separate a random walk
//! from the bias instability no better, and would make every value sensitive to the finest errors
//! of the model.

use heapless::Vec;

use super::average::{Choice, average};
use super::coefficients::{Estimate, NoiseFit};
use super::regression::{COLUMNS, Columns, Sums, WHITE, sum};
use crate::noise::GyroNoise;
use crate::noise::allan::covariance::degrees_of_freedom;
use crate::noise::allan::{MOST_POINTS, Point, terms, variance};

/// Price of a coefficient, in deviance: 4, two standard deviations squared, for each of about two
/// points that carry the same information.
const PRICE: f64 = 8.0;
/// Additional price of a ramp: it is rare, and a random walk over one record looks like it.
const RAMP_PRICE: f64 = 6.0;
/// Greatest number of reweighting rounds of one fit; each draws its weights from the model of the
/// previous round.
const ROUNDS: usize = 10;
/// Relative change of the squares at which the rounds end: a tenth of what an hour's record
/// resolves.
const SETTLED: f64 = 1e-3;
/// Number of rounds for the degrees of freedom, which hardly depend on the model.
const DEGREE_ROUNDS: usize = 3;
/// Number of choices of coefficients: N belongs to every gyro, each of the others may be present or
/// not.
pub(crate) const CHOICES: usize = 1 << (COLUMNS - 1);

/// A fitted model: squared coefficients and their deviance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Model {
    /// Coefficients that are not zero.
    pub columns: Columns,
    /// Squares of the coefficients, SI units.
    squares: [f64; COLUMNS],
    /// Gamma deviance of the points from the model.
    deviance: f64,
}

impl Model {
    /// Noise model with these coefficients.
    pub(crate) fn noise(&self) -> GyroNoise {
        GyroNoise::of(self.squares.map(libm::sqrt))
    }
}

/// State of the search over all choices.
pub(crate) struct Search<'p> {
    /// Points that are used.
    pub points: &'p [Point],
    /// Sample period, s.
    pub sample_seconds: f64,
    /// Equivalent degrees of freedom of the points.
    degrees: Vec<f64, MOST_POINTS>,
    /// Expected variances of the points, (rad/s)², from which the next fit starts.
    pub variances: Vec<f64, MOST_POINTS>,
}

impl<'p> Search<'p> {
    /// Begins with the points that average over a τ more than once, and takes their own values as
    /// the expected variances.
    pub(crate) fn begin(points: &'p [Point], sample_seconds: f64) -> Self {
        let advance = |point: &Point| point.terms as f64 * point.stride.0 / point.seconds.0;
        let count = points.iter().take_while(|point| advance(point) >= 1.0).count();
        let points = &points[..count.min(MOST_POINTS)];
        Self {
            points,
            sample_seconds,
            degrees: points.iter().map(advance).collect(),
            variances: points.iter().map(|point| point.variance).collect(),
        }
    }

    /// Fits every choice and returns the coefficients that stand out, with limits of the others.
    pub(crate) fn finish(mut self) -> NoiseFit {
        self.settle();
        let (best, choices) = self.choices();
        self.expect(&best.noise());
        let inflations = self.inflations(&best);
        self.conclude(average(&choices, &inflations))
    }

    /// Fits of every choice, and the model of the cheapest one.
    fn choices(&self) -> (Model, Vec<Choice, CHOICES>) {
        let mut least = f64::INFINITY;
        let mut best = Model { columns: Columns(0), squares: [0.0; COLUMNS], deviance: 0.0 };
        let mut choices = Vec::new();
        for columns in Columns::ALL.subsets().filter(|columns| columns.has(WHITE)) {
            let (model, variances) = self.fit(columns);
            let choice = self.choice(columns, &model, &variances);
            if choice.cost < least {
                (least, best) = (choice.cost, model);
            }
            // The vector has room for all choices, so the push cannot fail.
            let _ = choices.push(choice);
        }
        (best, choices)
    }

    /// Cost and spreads of one fitted choice.
    fn choice(&self, columns: Columns, model: &Model, variances: &[f64]) -> Choice {
        let ramp = if columns.has(COLUMNS - 1) { RAMP_PRICE } else { 0.0 };
        Choice {
            columns,
            squares: model.squares,
            spreads: self.spreads(columns, model, variances),
            cost: model.deviance + PRICE * columns.count() as f64 + ramp,
        }
    }

    /// Iterates the degrees of freedom to agree with the model of all coefficients.
    fn settle(&mut self) {
        for _ in 0..DEGREE_ROUNDS {
            let noise = self.fit(Columns::ALL).0.noise();
            for (degrees, point) in self.degrees.iter_mut().zip(self.points) {
                *degrees = degrees_of_freedom(point, &noise, self.sample_seconds);
            }
            self.expect(&noise);
        }
    }

    /// Takes the expected variances from a noise model.
    fn expect(&mut self, noise: &GyroNoise) {
        for (expected, point) in self.variances.iter_mut().zip(self.points) {
            *expected = variance(noise, point.seconds.0);
        }
    }

    /// Model with these columns by iteratively reweighted least squares, which converges to the
    /// least deviance, and the variances that it expects.
    fn fit(&self, columns: Columns) -> (Model, Vec<f64, MOST_POINTS>) {
        let mut variances = self.variances.clone();
        let mut model = Model { columns, squares: [0.0; COLUMNS], deviance: 0.0 };
        for _ in 0..ROUNDS {
            let before = model.squares;
            let sums = Sums::new(self.points, &self.sigmas(&variances), columns);
            (model.columns, model.squares) = sums.positive();
            for (variance, point) in variances.iter_mut().zip(self.points) {
                *variance = sum(&model.squares, &terms(point.seconds.0));
            }
            let moved = |(now, then): (f64, f64)| (now - then).abs() > SETTLED * now;
            if !model.squares.into_iter().zip(before).any(moved) {
                break;
            }
        }
        model.deviance = self.deviance(&variances);
        (model, variances)
    }

    /// Standard deviations of the points' variances, for these expected variances, (rad/s)².
    pub(crate) fn sigmas(&self, variances: &[f64]) -> Vec<f64, MOST_POINTS> {
        let sigma = |(variance, degrees): (&f64, &f64)| variance * libm::sqrt(2.0 / degrees);
        variances.iter().zip(&self.degrees).map(sigma).collect()
    }

    /// Gamma deviance Σ ν (r − 1 − ln r) of the points from these expected variances.
    fn deviance(&self, variances: &[f64]) -> f64 {
        let part = |((point, variance), degrees): ((&Point, &f64), &f64)| {
            let ratio = point.variance / variance;
            degrees * (ratio - 1.0 - libm::log(ratio))
        };
        self.points.iter().zip(variances).zip(&self.degrees).map(part).sum()
    }

    /// Assembles the result, with chi-square about the averaged model.
    fn conclude(mut self, estimates: [Estimate; COLUMNS]) -> NoiseFit {
        let found = estimates.iter().filter(|estimate| estimate.value().is_some()).count();
        let degrees = self.points.len().saturating_sub(found);
        let mut fit = NoiseFit { estimates, chi_square: 0.0, degrees };
        self.expect(&fit.noise());
        fit.chi_square = self.chi_square();
        fit
    }

    /// Chi-square of the points about their expected variances.
    fn chi_square(&self) -> f64 {
        let deviation = |((point, variance), sigma): ((&Point, &f64), &f64)| {
            let deviation = (point.variance - variance) / sigma;
            deviation * deviation
        };
        let sigmas = self.sigmas(&self.variances);
        self.points.iter().zip(&self.variances).zip(&sigmas).map(deviation).sum()
    }
}
