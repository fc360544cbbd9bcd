//! Holds the simulated platform that turns all the time to closed forms: what its gyro feels at the turn
//! (equations, §4), the dynamics of a molecular-electronic sensor, an uneven gear, a slip ring, faults.

mod faults;
mod molecular;
mod phasors;
mod slip_ring;
mod unevenness;

use std::f64::consts::TAU;

use hal_mock::turntable::{TurningSample, Turntable, TurntableConfiguration};

use crate::support::{assert_near, at};

/// Microsteps in a radian of the stage.
const PER_RAD: f64 = 4_608_000.0 / TAU;

fn run(configuration: &TurntableConfiguration, seed: u64) -> Vec<TurningSample> {
    Turntable::new(configuration, seed).collect()
}

/// Least squares of values on columns, by the normal equations and elimination with pivots.
fn fit<const N: usize>(rows: impl Iterator<Item = ([f64; N], f64)>) -> [f64; N] {
    let (mut matrix, mut right) = ([[0.0; N]; N], [0.0; N]);
    for (columns, value) in rows {
        for i in 0..N {
            (0..N).for_each(|j| matrix[i][j] += columns[i] * columns[j]);
            right[i] += columns[i] * value;
        }
    }
    for i in 0..N {
        let pivot = (i..N).max_by(|a, b| matrix[*a][i].abs().total_cmp(&matrix[*b][i].abs()));
        matrix.swap(i, pivot.unwrap_or(i));
        right.swap(i, pivot.unwrap_or(i));
        for below in i + 1..N {
            let factor = matrix[below][i] / matrix[i][i];
            (i..N).for_each(|j| matrix[below][j] -= factor * matrix[i][j]);
            right[below] -= factor * right[i];
        }
    }
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|j| matrix[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Complex(f64, f64);

impl Complex {
    fn turned(size: f64, angle: f64) -> Self {
        Self(size * angle.cos(), size * angle.sin())
    }

    fn over_j(self, divisor: f64) -> Self {
        Self(self.1 / divisor, -self.0 / divisor)
    }

    fn size(self) -> f64 {
        self.0.hypot(self.1)
    }
}

impl std::ops::Add for Complex {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl std::ops::Sub for Complex {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
}

impl std::ops::Mul for Complex {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }
}

impl std::ops::Div for Complex {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let square = other.0 * other.0 + other.1 * other.1;
        let product = self * Self(other.0, -other.1);
        Self(product.0 / square, product.1 / square)
    }
}

/// Phasor at the turn, `c_cos − j c_sin` of the fit on 1, t, cos θ, sin θ (§4), and the constant of the
/// fit.
fn phasor(samples: &[TurningSample], value: impl Fn(&TurningSample) -> f64) -> (Complex, f64) {
    // Counting time from the middle keeps it apart from the constant.
    let middle = 0.5 * (samples[0].time_s + samples[samples.len() - 1].time_s);
    let rows = samples.iter().map(|sample| {
        let (sine, cosine) = sample.stage_rad.sin_cos();
        ([1.0, sample.time_s - middle, cosine, sine], value(sample))
    });
    let [constant, _, cosine, sine] = fit(rows);
    (Complex(cosine, -sine), constant)
}

#[track_caller]
fn assert_complex(value: Complex, expected: Complex, tolerance: f64) {
    assert!((value - expected).size() <= tolerance, "{value:?} is not {expected:?} ± {tolerance}");
}
