//! The filter that weighs everything that stops tell: gravity seen from inertial space, rest rates, what is
//! known of the sensors.
//!
//! The carried frame errs by a small rotation φ that grows from an error at the start, from the gyros'
//! biases b and scale errors s, and from their noise: φ' = ∂φ/∂b b' + ∂φ/∂s s' + w. At rest two things are
//! measured: the specific force turned into the start frame is g up + φ × g up + accelerometer bias; and
//! between the beginning and the end of a stop the body turned with the Earth alone, so φ there differs by
//! nothing but the sway. All is linear once the start is nearly known; repetition makes it known.

use crate::math::rotation::{Matrix, Vector, cross, dot};
use crate::signal::strapdown::Rough;

/// States: φ now, φ at the start, φ when the stop began, b, s, accelerometer biases, displacement beyond
/// the stated one, latitude.
pub const STATES: usize = 21;
/// φ now, rad.
pub const NOW: usize = 0;
/// φ at the start, rad.
pub const START: usize = 3;
/// φ when the stop began, rad.
const ANCHOR: usize = 6;
/// Biases, rad/s.
pub const BIAS: usize = 9;
/// Relative scale errors.
pub const SCALE: usize = 12;
/// Accelerometer biases, m/s².
pub const FORCE: usize = 15;
/// Displacement north and east beyond the stated one, m.
pub const PLACE: usize = 18;
/// Latitude beyond the stated one, rad.
pub const LATITUDE: usize = 20;

/// A row that says which combination of the states is measured.
pub type Row = [f64; STATES];

/// Something measured.
#[derive(Clone, Copy, Debug)]
pub struct Measurement {
    /// Of which combination.
    pub row: Row,
    /// What it is beyond what the nominal frame predicts.
    pub value: f64,
    /// Its variance.
    pub variance: f64,
}

/// Estimates with their covariance.
#[derive(Clone, Debug)]
pub struct Filter {
    /// Estimates.
    pub state: Row,
    /// Covariance.
    pub covariance: [Row; STATES],
}

impl Filter {
    /// Nothing measured: φ at the start has this covariance, the others these 1σ; all are zero.
    #[must_use]
    #[inline(never)]
    pub fn new(start: &Matrix, bias: f64, scale: f64, force: f64, latitude: f64) -> Self {
        let mut filter = Self { state: [0.0; STATES], covariance: [[0.0; STATES]; STATES] };
        for (row, values) in start.iter().enumerate() {
            for (column, value) in values.iter().enumerate() {
                for (a, b) in [(NOW, NOW), (NOW, START), (START, NOW), (START, START)] {
                    filter.covariance[a + row][b + column] = *value;
                }
            }
        }
        for (first, sigma) in [(BIAS, bias), (SCALE, scale), (FORCE, force)] {
            for state in first..first + 3 {
                filter.covariance[state][state] = sigma * sigma;
            }
        }
        filter.covariance[LATITUDE][LATITUDE] = latitude * latitude;
        filter
    }

    /// Carries φ on over a time in which it came to depend so much more on biases and scale errors, and
    /// by which noise widens it, rad².
    #[inline(never)]
    pub fn carry(&mut self, bias: &Matrix, scale: &Matrix, noise: f64) {
        for axis in 0..3 {
            self.state[NOW + axis] +=
                self.gain(bias, scale, axis, |filter, state| filter.state[state]);
        }
        for column in 0..STATES {
            let gains: Vector = core::array::from_fn(|axis| {
                self.gain(bias, scale, axis, |filter, state| filter.covariance[state][column])
            });
            for (axis, gain) in gains.into_iter().enumerate() {
                self.covariance[NOW + axis][column] += gain;
            }
        }
        for row in 0..STATES {
            let gains: Vector = core::array::from_fn(|axis| {
                self.gain(bias, scale, axis, |filter, state| filter.covariance[row][state])
            });
            for (axis, gain) in gains.into_iter().enumerate() {
                self.covariance[row][NOW + axis] += gain;
            }
        }
        for axis in NOW..NOW + 3 {
            self.covariance[axis][axis] += noise;
        }
    }

    fn gain(
        &self,
        bias: &Matrix,
        scale: &Matrix,
        axis: usize,
        of: impl Fn(&Self, usize) -> f64,
    ) -> f64 {
        let part = |matrix: &Matrix, first: usize| {
            dot(&matrix[axis], &[of(self, first), of(self, first + 1), of(self, first + 2)])
        };
        part(bias, BIAS) + part(scale, SCALE)
    }

    /// Lets the biases walk by this variance, (rad/s)².
    pub fn walk(&mut self, variance: f64) {
        for axis in BIAS..BIAS + 3 {
            self.covariance[axis][axis] += variance;
        }
    }

    /// Remembers φ as it is when a stop begins.
    #[inline(never)]
    pub fn anchor(&mut self) {
        for axis in 0..3 {
            self.state[ANCHOR + axis] = self.state[NOW + axis];
        }
        for axis in 0..3 {
            self.covariance[ANCHOR + axis] = self.covariance[NOW + axis];
        }
        for row in 0..STATES {
            for axis in 0..3 {
                self.covariance[row][ANCHOR + axis] = self.covariance[row][NOW + axis];
            }
        }
    }

    /// Forgets what is known of the displacement, whose 1σ, m, is this from now on.
    pub fn displace(&mut self, sigma: f64) {
        for state in PLACE..PLACE + 2 {
            self.state[state] = 0.0;
            for other in 0..STATES {
                self.covariance[state][other] = 0.0;
                self.covariance[other][state] = 0.0;
            }
            self.covariance[state][state] = sigma * sigma;
        }
    }

    /// Lets the displacement be off by so much more, 1σ, m.
    pub fn stray(&mut self, sigma: f64) {
        for state in PLACE..PLACE + 2 {
            self.covariance[state][state] += sigma * sigma;
        }
    }

    /// Takes measurements in turn; the sum of the squares of what they bring beyond the expected, over their
    /// variances: chi-square of as many degrees of freedom.
    #[inline(never)]
    pub fn measure(&mut self, measurements: &[Measurement]) -> f64 {
        measurements.iter().map(|measurement| self.take(measurement)).sum()
    }

    fn take(&mut self, measurement: &Measurement) -> f64 {
        let Measurement { row, value, variance } = measurement;
        let mut spread = [0.0; STATES];
        for (spread, line) in spread.iter_mut().zip(&self.covariance) {
            *spread = product(line, row);
        }
        let whole = product(&spread, row) + variance;
        let surprise = value - product(&self.state, row);
        for (state, spread) in self.state.iter_mut().zip(&spread) {
            *state += spread * surprise / whole;
        }
        for (line, a) in self.covariance.iter_mut().zip(&spread) {
            let gain = a / whole;
            for (entry, b) in line.iter_mut().zip(&spread) {
                *entry -= gain * b;
            }
        }
        surprise * surprise / whole
    }

    /// Variance of a combination of the states.
    #[must_use]
    pub fn variance(&self, row: &Row) -> f64 {
        row.iter().zip(&self.covariance).map(|(part, line)| part * product(line, row)).sum()
    }

    /// Covariance of a combination with each of the states.
    #[must_use]
    pub fn covariances(&self, row: &Row) -> Row {
        core::array::from_fn(|state| product(&self.covariance[state], row))
    }

    /// Three states from one on.
    #[must_use]
    pub fn three(&self, first: usize) -> Vector {
        core::array::from_fn(|axis| self.state[first + axis])
    }
}

/// Sum of products; most rows are mostly zero, and a soft product costs more than a look.
fn product(a: &Row, b: &Row) -> f64 {
    a.iter().zip(b).filter(|(_, b)| **b != 0.0).map(|(a, b)| a * b).sum()
}

/// A measurement of the specific force along a direction across the predicted one, both on the start frame;
/// `attitude` is that of the body.
#[must_use]
pub fn force_row(predicted: &Vector, direction: &Vector, attitude: &Rough) -> Row {
    let mut row = [0.0; STATES];
    // (φ × f)·p = φ·(f × p).
    row[NOW..NOW + 3].copy_from_slice(&cross(predicted, direction));
    let columns: Vector = core::array::from_fn(|axis| {
        (0..3).map(|part| direction[part] * f64::from(attitude[part][axis])).sum()
    });
    row[FORCE..FORCE + 3].copy_from_slice(&columns);
    row
}

/// A measurement of what φ gained over a stop in which the Earth turned by `earth`, on one axis.
#[must_use]
pub fn rest_row(earth: &Matrix, axis: usize) -> Row {
    let mut row = [0.0; STATES];
    row[NOW + axis] = 1.0;
    for column in 0..3 {
        row[ANCHOR + column] = -earth[axis][column];
    }
    row
}
