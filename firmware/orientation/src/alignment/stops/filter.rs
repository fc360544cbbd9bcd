//! Kalman filter that combines all information of the stops: gravity seen from inertial space, rest
//! rates, and prior knowledge of the sensors.
//!
//! The carried frame is wrong by a small rotation φ that grows from an error at the start, from the
//! gyros' biases b and scale errors s, and from their noise: φ' = ∂φ/∂b b' + ∂φ/∂s s' + w. Two
//! things are measured at rest. The specific force turned into the start frame is g up + φ × g up +
//! accelerometer bias. And between the beginning and the end of a stop the body turned with the
//! Earth alone, so φ differs only by the sway (zero-velocity update of the rotation). The equations
//! are linear once the start is nearly known, and iteration makes it known.

use crate::alignment::site::Site;
use crate::math::rotation::{Matrix, Vector, cross, dot};
use crate::math::{cholesky, cholesky_solve};
use crate::signal::strapdown::Rough;

/// Number of states: φ now, φ at the start, φ at the beginning of the stop, b, s, accelerometer
/// biases, displacement beyond the configured one, latitude, velocity.
pub(crate) const STATES: usize = 24;
/// Index of φ now, rad.
pub(crate) const NOW: usize = 0;
/// Index of φ at the start, rad.
pub(crate) const START: usize = 3;
/// Index of φ at the beginning of the stop, rad.
const ANCHOR: usize = 6;
/// Index of the gyro biases, rad/s.
pub(crate) const BIAS: usize = 9;
/// Index of the relative scale-factor errors of the gyros.
pub(crate) const SCALE: usize = 12;
/// Index of the accelerometer biases, m/s².
pub(crate) const FORCE: usize = 15;
/// Index of the displacement north and east beyond the configured one, m.
pub(crate) const PLACE: usize = 18;
/// Index of the latitude beyond the configured one, rad.
pub(crate) const LATITUDE: usize = 20;

/// Index of the velocity error that φ makes in the integral of a drive's forces, m/s.
pub(crate) const VELOCITY: usize = 21;

/// Coefficients of a linear combination of the states.
pub(crate) type Row = [f64; STATES];

/// A scalar measurement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measurement {
    /// Combination of the states that is measured.
    pub row: Row,
    /// Measured value less the one that the nominal frame predicts.
    pub value: f64,
    /// Variance of the measurement noise.
    pub variance: f64,
}

/// State estimates with their covariance.
#[derive(Clone, Debug)]
pub(crate) struct Filter {
    /// Estimates of the states, in the units of the indices above.
    pub state: Row,
    /// Covariance of the states.
    pub covariance: [Row; STATES],
}

impl Filter {
    /// Filter with all states and covariances zero.
    pub(crate) const EMPTY: Self =
        Self { state: [0.0; STATES], covariance: [[0.0; STATES]; STATES] };

    /// Initialises the filter: φ at the start gets this covariance, rad², the biases this 1σ, rad/s,
    /// and the other states those of the site; all estimates are zero.
    #[inline(never)]
    pub(crate) fn begin(&mut self, start: &Matrix, bias: f64, site: &Site) {
        let (scale, force) = (site.scale_sigma, site.accelerometer_bias_sigma);
        self.state = [0.0; STATES];
        self.covariance = [[0.0; STATES]; STATES];
        for (row, values) in start.iter().enumerate() {
            for (column, value) in values.iter().enumerate() {
                for (a, b) in [(NOW, NOW), (NOW, START), (START, NOW), (START, START)] {
                    self.covariance[a + row][b + column] = *value;
                }
            }
        }
        for (first, sigma) in [(BIAS, bias), (SCALE, scale), (FORCE, force.0)] {
            for state in first..first + 3 {
                self.covariance[state][state] = sigma * sigma;
            }
        }
        self.covariance[LATITUDE][LATITUDE] = site.latitude_sigma.0 * site.latitude_sigma.0;
    }

    /// Propagates φ over an interval: `bias` and `scale` are the changes of its sensitivities, and
    /// `noise` is the variance that the gyros' noise adds, rad².
    pub(super) fn carry(&mut self, bias: &Matrix, scale: &Matrix, noise: f64) {
        let rows = core::array::from_fn(|axis| {
            let mut row = placed(BIAS, &bias[axis]);
            row[SCALE..SCALE + 3].copy_from_slice(&scale[axis]);
            row
        });
        self.add(NOW, &rows);
        for axis in NOW..NOW + 3 {
            self.covariance[axis][axis] += noise;
        }
    }

    /// Removes a known rotation, rad, from φ now.
    pub(super) fn remove(&mut self, known: &Vector) {
        for (state, known) in self.state[NOW..].iter_mut().zip(known) {
            *state -= known;
        }
    }

    /// Adds linear combinations of the other states to three successive states.
    #[inline(never)]
    pub(crate) fn add(&mut self, first: usize, rows: &[Row; 3]) {
        for (axis, row) in rows.iter().enumerate() {
            self.state[first + axis] += product(&self.state, row);
        }
        let mut gains = [[0.0; STATES]; 3];
        for (gain, row) in gains.iter_mut().zip(rows) {
            for (part, line) in row.iter().zip(&self.covariance).filter(|(part, _)| **part != 0.0) {
                for (sum, entry) in gain.iter_mut().zip(line) {
                    *sum += part * entry;
                }
            }
        }
        for (axis, gain) in gains.iter().enumerate() {
            for (entry, part) in self.covariance[first + axis].iter_mut().zip(gain) {
                *entry += part;
            }
        }
        for line in &mut self.covariance {
            let gains: Vector = core::array::from_fn(|axis| product(line, &rows[axis]));
            for (entry, gain) in line[first..first + 3].iter_mut().zip(gains) {
                *entry += gain;
            }
        }
    }

    /// Adds a random walk of this variance, (rad/s)², to the biases.
    pub(super) fn walk(&mut self, variance: f64) {
        for axis in BIAS..BIAS + 3 {
            self.covariance[axis][axis] += variance;
        }
    }

    /// Stores φ at the beginning of a stop as the anchor.
    #[inline(never)]
    pub(crate) fn anchor(&mut self) {
        self.state.copy_within(NOW..NOW + 3, ANCHOR);
        self.covariance.copy_within(NOW..NOW + 3, ANCHOR);
        for line in &mut self.covariance {
            line.copy_within(NOW..NOW + 3, ANCHOR);
        }
    }

    /// Resets states to zero with this 1σ, and removes their correlations.
    pub(super) fn reset(&mut self, states: core::ops::Range<usize>, sigma: f64) {
        for state in states {
            self.state[state] = 0.0;
            self.covariance[state] = [0.0; STATES];
            for line in &mut self.covariance {
                line[state] = 0.0;
            }
            self.covariance[state][state] = sigma * sigma;
        }
    }

    /// Adds process noise of this 1σ, m, to the displacement.
    pub(super) fn add_process_noise(&mut self, sigma: f64) {
        for state in PLACE..PLACE + 2 {
            self.covariance[state][state] += sigma * sigma;
        }
    }

    /// Updates the filter with measurements in succession.
    #[inline(never)]
    pub(crate) fn measure(&mut self, measurements: &[Measurement]) {
        for measurement in measurements {
            self.take(measurement);
        }
    }

    /// Normalised innovation squared of at most three measurements: chi-square distributed with as
    /// many degrees of freedom. Infinite where the innovation covariance is not positive.
    #[inline(never)]
    pub(super) fn normalised_innovation_squared(&self, measurements: &[Measurement]) -> f64 {
        let mut whole = [[0.0; 3]; 3];
        let mut beyond = [0.0; 3];
        for (index, measurement) in measurements.iter().enumerate() {
            let spread = self.covariances(&measurement.row);
            for (entry, other) in whole[index].iter_mut().zip(measurements) {
                *entry = product(&spread, &other.row);
            }
            whole[index][index] += measurement.variance;
            beyond[index] = self.beyond(measurement);
        }
        let size = measurements.len();
        let mut weighted = beyond;
        if !cholesky(&mut whole, size) {
            return f64::INFINITY;
        }
        cholesky_solve(&whole, size, &mut weighted);
        dot(&beyond, &weighted)
    }

    /// Innovation of a measurement: measured less predicted value.
    pub(super) fn beyond(&self, measurement: &Measurement) -> f64 {
        measurement.value - product(&self.state, &measurement.row)
    }

    /// Updates the filter with one measurement.
    fn take(&mut self, measurement: &Measurement) {
        let Measurement { row, variance, .. } = measurement;
        let spread = self.covariances(row);
        let gain = 1.0 / (product(&spread, row) + variance);
        let normalised_innovation_squared = self.beyond(measurement) * gain;
        for (index, part) in spread.iter().enumerate().filter(|(_, part)| **part != 0.0) {
            self.state[index] += part * normalised_innovation_squared;
            let part = part * gain;
            for (other, entry) in spread[..=index].iter().zip(&mut self.covariance[index]) {
                if *other != 0.0 {
                    *entry -= part * other;
                }
            }
        }
        // The lower triangle was computed.
        for row in 1..STATES {
            for column in 0..row {
                self.covariance[column][row] = self.covariance[row][column];
            }
        }
    }

    /// Variance of a combination of the states.
    pub(super) fn variance(&self, row: &Row) -> f64 {
        row.iter().zip(&self.covariance).map(|(part, line)| part * product(line, row)).sum()
    }

    /// Covariance of a combination with each of the states.
    pub(super) fn covariances(&self, row: &Row) -> Row {
        core::array::from_fn(|state| product(&self.covariance[state], row))
    }

    /// Three successive states, beginning with `first`.
    pub(super) fn three(&self, first: usize) -> Vector {
        core::array::from_fn(|axis| self.state[first + axis])
    }
}

/// Sum of products; rows are mostly zero, and a software multiplication costs more than a test for
/// zero.
fn product(a: &Row, b: &Row) -> f64 {
    a.iter().zip(b).filter(|(_, b)| **b != 0.0).map(|(a, b)| a * b).sum()
}

/// Row of a measurement that shows three successive states, the first at this index, by these
/// factors.
pub(super) fn placed(first: usize, factors: &Vector) -> Row {
    let mut row = [0.0; STATES];
    row[first..first + 3].copy_from_slice(factors);
    row
}

/// Row of a measurement of the specific force along a direction perpendicular to the predicted one,
/// both on the start frame; `attitude` is that of the body.
pub(super) fn force_row(predicted: &Vector, direction: &Vector, attitude: &Rough) -> Row {
    // Identity used: (φ × f)·p = φ·(f × p).
    let mut row = placed(NOW, &cross(predicted, direction));
    let columns: Vector = core::array::from_fn(|axis| {
        (0..3).map(|part| direction[part] * f64::from(attitude[part][axis])).sum()
    });
    row[FORCE..FORCE + 3].copy_from_slice(&columns);
    row
}

/// Row by which the velocity integral of a drive comes to depend on φ and the accelerometer biases
/// on one axis, within `seconds` of a specific force; all on the start frame, `attitude` is that of
/// the body.
pub(super) fn velocity_row(force: &Vector, axis: usize, attitude: &Rough, seconds: f64) -> Row {
    let mut direction = [0.0; 3];
    direction[axis] = seconds;
    force_row(force, &direction, attitude)
}

/// Row of a measurement of the increase of φ over a stop during which the Earth turned by `earth`,
/// on one axis.
pub(super) fn rest_row(earth: &Matrix, axis: usize) -> Row {
    let mut row = placed(ANCHOR, &earth[axis].map(|part| -part));
    row[NOW + axis] = 1.0;
    row
}
