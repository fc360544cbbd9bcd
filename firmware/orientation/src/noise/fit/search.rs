//! Which coefficients a record shows.
//!
//! Allan variances are nearly gamma distributed, and with few degrees of freedom far from normal. So
//! models are compared by their gamma deviance Σ ν (r − 1 − ln r), r = V̂/V, with ν the equivalent
//! degrees of freedom: of every choice of coefficients the one is taken whose deviance, with a price
//! for each coefficient, is least. Neighbouring points repeat each other, which makes deviances too
//! great; by how much, a coefficient's variance from the full covariance tells, over that of
//! independent points. What it gains after division by this must pass the usual limit.
//! tests/allan/simulated.rs holds how often this errs.
//!
//! The points are weighted as if they were independent, and the deviations come from their full
//! covariance. Weighting by the full covariance too would lessen the deviation of N by 11 %, of B and
//! K by 1 to 8 % (an hour at 10 Hz), and would make every value hang on the model's finest errors.

use heapless::Vec;

use super::regression::{COLUMNS, Columns, Sums, WHITE, sum};
use super::spread::Square;
use super::{Estimate, NoiseFit};
use crate::noise::allan::covariance::degrees_of_freedom;
use crate::noise::allan::{MOST_POINTS, Point, terms, variance};
use crate::noise::model::GyroNoise;

/// What a coefficient must lessen the deviance by: 4, two standard deviations, for each of about two
/// points that tell the same.
const PRICE: f64 = 8.0;
/// What a ramp must besides: it is rare, and a random walk over one record looks like it.
const RAMP_PRICE: f64 = 4.0;
/// What it must gain at last, per point of its own: two standard deviations, squared.
const LEAST_GAIN: f64 = 4.0;
/// Least value of a coefficient, in its standard deviations.
const LEAST_RATIO: f64 = 2.0;
/// Most rounds of one fit: each draws its weights from the model that the one before has found.
const ROUNDS: usize = 10;
/// Relative change of the squares at which the rounds end, a tenth of what an hour can tell.
const SETTLED: f64 = 1e-3;
/// Rounds of degrees of freedom, which hardly depend on the model.
const DEGREE_ROUNDS: usize = 3;

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

    /// The deviance and the prices of the coefficients.
    fn cost(&self) -> f64 {
        let ramp = if self.columns.has(COLUMNS - 1) { RAMP_PRICE } else { 0.0 };
        self.deviance + PRICE * self.columns.count() as f64 + ramp
    }
}

/// Steps of the search for a limit: it grows twofold at first and ends within a tenth.
const LIMIT_STEPS: usize = 6;

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
        let mut allowed = self.choose();
        loop {
            let model = self.settle(allowed);
            let squares = self.squares(&model);
            match self.superfluous(&model, &squares) {
                Some(column) => allowed = allowed.without(column),
                None => return self.conclude(&model, &squares),
            }
        }
    }

    /// The columns of the least cost; N belongs to every gyro.
    fn choose(&mut self) -> Columns {
        let mut best = self.settle(Columns::ALL);
        for columns in Columns::ALL.subsets().filter(|columns| columns.has(WHITE)) {
            let model = self.fit(columns);
            if model.cost() < best.cost() {
                best = model;
            }
        }
        best.columns
    }

    /// Fits with degrees of freedom that agree with the model.
    fn settle(&mut self, allowed: Columns) -> Model {
        let mut model = self.fit(allowed);
        for _ in 0..DEGREE_ROUNDS {
            let noise = model.noise();
            for (index, point) in self.points.iter().enumerate() {
                self.degrees[index] = degrees_of_freedom(point, &noise, self.sample_seconds);
                self.variances[index] = variance(&noise, point.seconds);
            }
            model = self.fit(allowed);
        }
        model
    }

    /// The model of the least deviance.
    fn fit(&self, allowed: Columns) -> Model {
        self.fit_beside(allowed, [0.0; COLUMNS])
    }

    /// The model of the least deviance beside squares that are given: weights that follow the model
    /// lead there. Only the squares that were fitted are in it.
    fn fit_beside(&self, allowed: Columns, given: [f64; COLUMNS]) -> Model {
        let mut variances = self.variances.clone();
        let mut model = Model { columns: allowed, squares: [0.0; COLUMNS], deviance: 0.0 };
        for _ in 0..ROUNDS {
            let before = model.squares;
            let sums = Sums::new(self.points, &self.sigmas(&variances), allowed, &given);
            (model.columns, model.squares) = sums.positive();
            let all = core::array::from_fn(|i| model.squares[i] + given[i]);
            for (variance, point) in variances.iter_mut().zip(self.points) {
                *variance = sum(&all, &terms(point.seconds));
            }
            let moved = |(now, then): (f64, f64)| (now - then).abs() > SETTLED * now;
            if !model.squares.into_iter().zip(before).any(moved) {
                break;
            }
        }
        model.deviance = self.deviance(&variances);
        model
    }

    /// Standard deviations of the points where these are their variances, (rad/s)².
    pub fn sigmas(&self, variances: &[f64]) -> Vec<f64, MOST_POINTS> {
        let sigma = |(variance, degrees): (&f64, &f64)| variance * libm::sqrt(2.0 / degrees);
        variances.iter().zip(&self.degrees).map(sigma).collect()
    }

    /// Expected variances of the points under the model that was settled last, (rad/s)².
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

    /// The column that stands out least, where that is too little; N stays.
    fn superfluous(&self, model: &Model, squares: &[Square; COLUMNS]) -> Option<usize> {
        let gain = |column: usize| {
            let square = &squares[column];
            if square.ratio() < LEAST_RATIO {
                return 0.0;
            }
            let without = self.fit(model.columns.without(column));
            (without.deviance - model.deviance) / square.inflation
        };
        let gains = model.columns.without(WHITE).each().map(|column| (gain(column), column));
        let least = gains.reduce(|a, b| if b.0 < a.0 { b } else { a });
        least.filter(|&(gain, _)| gain < LEAST_GAIN).map(|(_, column)| column)
    }

    /// What the square of an absent coefficient does not exceed: beyond its two standard deviations
    /// as far as the others can make room for it.
    fn limit(&self, model: &Model, column: usize, square: &Square) -> f64 {
        let is_possible = |limit: f64| {
            let mut given = [0.0; COLUMNS];
            given[column] = limit;
            let loss = self.fit_beside(model.columns, given).deviance - model.deviance;
            loss < LEAST_GAIN * square.inflation
        };
        let mut limit = square.limit();
        let mut factor = 2.0;
        for _ in 0..LIMIT_STEPS {
            if is_possible(limit * factor) {
                limit *= factor;
            } else {
                factor = libm::sqrt(factor);
            }
        }
        limit
    }

    fn conclude(&self, model: &Model, squares: &[Square; COLUMNS]) -> NoiseFit {
        let deviation = |((point, variance), sigma): ((&Point, &f64), &f64)| {
            let deviation = (point.variance - variance) / sigma;
            deviation * deviation
        };
        let sigmas = self.sigmas(&self.variances);
        let estimate = |column: usize| {
            let square = &squares[column];
            if model.columns.has(column) {
                return square.estimate();
            }
            Estimate::NotObservable { at_most: libm::sqrt(self.limit(model, column, square)) }
        };
        NoiseFit {
            quantisation: estimate(0),
            angle_random_walk: estimate(1),
            bias_instability: estimate(2),
            rate_random_walk: estimate(3),
            rate_ramp: estimate(4),
            chi_square: self.points.iter().zip(&self.variances).zip(&sigmas).map(deviation).sum(),
            degrees: self.points.len().saturating_sub(model.columns.count()),
        }
    }
}
