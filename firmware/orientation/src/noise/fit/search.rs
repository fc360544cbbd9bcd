//! What every choice of coefficients makes of a record.
//!
//! Allan variances are nearly gamma distributed, and with few degrees of freedom far from normal. So
//! choices are compared by their gamma deviance Σ ν (r − 1 − ln r), r = V̂/V, with ν the equivalent
//! degrees of freedom, and a price for each coefficient. No choice is taken alone: the module
//! `average` weighs them all.
//!
//! The points are weighted as if they were independent, and the deviations come from their full
//! covariance. Weighting by the full covariance too would lessen the deviation of N by 11 %, of B and
//! K by 1 to 8 % (an hour at 10 Hz), would tell a walk from the bias instability no better, and would
//! make every value hang on the model's finest errors.

use heapless::Vec;

use super::average::average;
use super::regression::{COLUMNS, Columns, Sums, WHITE, sum};
use super::{Estimate, NoiseFit};
use crate::noise::allan::covariance::degrees_of_freedom;
use crate::noise::allan::{MOST_POINTS, Point, terms, variance};
use crate::noise::model::GyroNoise;

/// What a coefficient must lessen the deviance by: 4, two standard deviations, for each of about two
/// points that tell the same.
const PRICE: f64 = 8.0;
/// What a ramp must besides: it is rare, and a random walk over one record looks like it.
const RAMP_PRICE: f64 = 6.0;
/// Most rounds of one fit: each draws its weights from the model that the one before has found.
const ROUNDS: usize = 10;
/// Relative change of the squares at which the rounds end, a tenth of what an hour can tell.
const SETTLED: f64 = 1e-3;
/// Rounds of degrees of freedom, which hardly depend on the model.
const DEGREE_ROUNDS: usize = 3;
/// Choices of coefficients: N belongs to every gyro, each of the others may be there or not.
pub const CHOICES: usize = 1 << (COLUMNS - 1);

/// Squares of coefficients and how well they fit.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// Those that are not zero.
    pub columns: Columns,
    squares: [f64; COLUMNS],
    deviance: f64,
}

impl Model {
    /// Its noise.
    pub fn noise(&self) -> GyroNoise {
        let [q, n, b, k, r] = self.squares.map(libm::sqrt);
        GyroNoise {
            quantisation: q,
            angle_random_walk: n,
            bias_instability: b,
            rate_random_walk: k,
            rate_ramp: r,
        }
    }
}

/// A choice of coefficients, fitted.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// Those that may be more than zero.
    pub columns: Columns,
    /// The squares of the coefficients.
    pub squares: [f64; COLUMNS],
    /// Standard deviations of the squares, if the points did not repeat each other.
    pub spreads: [f64; COLUMNS],
    /// The deviance and the prices of the coefficients.
    pub cost: f64,
}

/// A fit under way.
pub struct Search<'p> {
    /// The points that are used.
    pub points: &'p [Point],
    /// Time from sample to sample, s.
    pub sample_seconds: f64,
    /// Equivalent degrees of freedom of the points.
    degrees: Vec<f64, MOST_POINTS>,
    /// Their expected variances, from which the next fit starts.
    variances: Vec<f64, MOST_POINTS>,
}

impl<'p> Search<'p> {
    /// With the points that average over a τ more than once, as if they themselves were right.
    pub fn begin(points: &'p [Point], sample_seconds: f64) -> Self {
        let advance = |point: &Point| point.terms as f64 * point.stride / point.seconds;
        let count = points.iter().take_while(|point| advance(point) >= 1.0).count();
        let points = &points[..count.min(MOST_POINTS)];
        Self {
            points,
            sample_seconds,
            degrees: points.iter().map(advance).collect(),
            variances: points.iter().map(|point| point.variance).collect(),
        }
    }

    /// The coefficients that stand out, and limits of the others.
    pub fn finish(mut self) -> NoiseFit {
        self.settle();
        let (best, choices) = self.choices();
        self.expect(&best.noise());
        let inflations = self.inflations(&best);
        self.conclude(average(&choices, &inflations))
    }

    /// Every choice, and the model of the one that costs least.
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
            // There is room for all of them.
            let _ = choices.push(choice);
        }
        (best, choices)
    }

    fn choice(&self, columns: Columns, model: &Model, variances: &[f64]) -> Choice {
        let ramp = if columns.has(COLUMNS - 1) { RAMP_PRICE } else { 0.0 };
        Choice {
            columns,
            squares: model.squares,
            spreads: self.spreads(columns, model, variances),
            cost: model.deviance + PRICE * columns.count() as f64 + ramp,
        }
    }

    /// Brings the degrees of freedom to agree with the model of all coefficients.
    fn settle(&mut self) {
        for _ in 0..DEGREE_ROUNDS {
            let noise = self.fit(Columns::ALL).0.noise();
            for (degrees, point) in self.degrees.iter_mut().zip(self.points) {
                *degrees = degrees_of_freedom(point, &noise, self.sample_seconds);
            }
            self.expect(&noise);
        }
    }

    /// Takes the variances from a noise.
    fn expect(&mut self, noise: &GyroNoise) {
        for (expected, point) in self.variances.iter_mut().zip(self.points) {
            *expected = variance(noise, point.seconds);
        }
    }

    /// The model of the least deviance, to which weights that follow the model lead, and the
    /// variances that it expects.
    fn fit(&self, columns: Columns) -> (Model, Vec<f64, MOST_POINTS>) {
        let mut variances = self.variances.clone();
        let mut model = Model { columns, squares: [0.0; COLUMNS], deviance: 0.0 };
        for _ in 0..ROUNDS {
            let before = model.squares;
            let sums = Sums::new(self.points, &self.sigmas(&variances), columns);
            (model.columns, model.squares) = sums.positive();
            for (variance, point) in variances.iter_mut().zip(self.points) {
                *variance = sum(&model.squares, &terms(point.seconds));
            }
            let moved = |(now, then): (f64, f64)| (now - then).abs() > SETTLED * now;
            if !model.squares.into_iter().zip(before).any(moved) {
                break;
            }
        }
        model.deviance = self.deviance(&variances);
        (model, variances)
    }

    /// Standard deviations of the points where these are their variances, (rad/s)².
    pub fn sigmas(&self, variances: &[f64]) -> Vec<f64, MOST_POINTS> {
        let sigma = |(variance, degrees): (&f64, &f64)| variance * libm::sqrt(2.0 / degrees);
        variances.iter().zip(&self.degrees).map(sigma).collect()
    }

    /// Expected variances of the points, (rad/s)².
    pub fn variances(&self) -> &[f64] {
        &self.variances
    }

    fn deviance(&self, variances: &[f64]) -> f64 {
        let part = |((point, variance), degrees): ((&Point, &f64), &f64)| {
            let ratio = point.variance / variance;
            degrees * (ratio - 1.0 - libm::log(ratio))
        };
        self.points.iter().zip(variances).zip(&self.degrees).map(part).sum()
    }

    fn conclude(mut self, estimates: [Estimate; COLUMNS]) -> NoiseFit {
        let found = estimates.iter().filter(|estimate| estimate.value().is_some()).count();
        let [quantisation, angle_random_walk, bias_instability, rate_random_walk, rate_ramp] =
            estimates;
        let mut fit = NoiseFit {
            quantisation,
            angle_random_walk,
            bias_instability,
            rate_random_walk,
            rate_ramp,
            chi_square: 0.0,
            degrees: self.points.len().saturating_sub(found),
        };
        self.expect(&fit.noise());
        fit.chi_square = self.chi_square();
        fit
    }

    /// Squared deviations of the points from what is expected, over their variances.
    fn chi_square(&self) -> f64 {
        let deviation = |((point, variance), sigma): ((&Point, &f64), &f64)| {
            let deviation = (point.variance - variance) / sigma;
            deviation * deviation
        };
        let sigmas = self.sigmas(&self.variances);
        self.points.iter().zip(&self.variances).zip(&sigmas).map(deviation).sum()
    }
}
