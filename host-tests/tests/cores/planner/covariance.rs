//! The covariance of dwell means in full, inverted by Gauss and Jordan: what the whitener never forms.
//!
//! `C_ij` = N²δ/T + K²·(i = j: a + T/3, else the earlier middle) + R² t t′ + flicker as Gauss–Markov
//! processes of correlation times in the ratio of four, each averaged over both dwells.

use std::f64::consts::PI;

use orientation::noise::model::GyroNoise;
use orientation::planner::prediction::Visit;

/// 1σ of a component of the Earth rate by generalised least squares, RMS over the two, rad/s.
pub fn rate_sigma(noise: &GyroNoise, visits: &[Visit]) -> f64 {
    let covariance: Vec<Vec<f64>> = visits
        .iter()
        .map(|a| visits.iter().map(|b| shared(noise, visits, a, b)).collect())
        .collect();
    let information = inverse(covariance);
    let columns: Vec<[f64; 3]> =
        visits.iter().map(|visit| [visit.unit[0].into(), -f64::from(visit.unit[1]), 1.0]).collect();
    let normal: Vec<Vec<f64>> =
        (0..3).map(|p| (0..3).map(|q| quadratic(&columns, &information, p, q)).collect()).collect();
    let solution = inverse(normal);
    (0.5 * (solution[0][0] + solution[1][1])).sqrt()
}

fn quadratic(columns: &[[f64; 3]], information: &[Vec<f64>], p: usize, q: usize) -> f64 {
    let mut sum = 0.0;
    for (row, left) in information.iter().zip(columns) {
        for (weight, right) in row.iter().zip(columns) {
            sum += left[p] * weight * right[q];
        }
    }
    sum
}

fn shared(noise: &GyroNoise, visits: &[Visit], a: &Visit, b: &Visit) -> f64 {
    let begin = visits[0].start;
    let middle = |visit: &Visit| visit.start - begin + 0.5 * visit.seconds;
    let walk = noise.rate_random_walk.0.powi(2);
    let same = a.start == b.start;
    let walked = if same {
        walk * (a.start - begin + a.seconds / 3.0)
    } else {
        walk * middle(a).min(middle(b))
    };
    let from = |visit: &Visit| visit.start - begin;
    let ramp = noise.rate_ramp.0.powi(2) * from(a) * from(b);
    let white = if same { noise.angle_random_walk.0.powi(2) / a.seconds } else { 0.0 };
    white + walked + ramp + flicker(noise, a, b, same)
}

fn flicker(noise: &GyroNoise, a: &Visit, b: &Visit, same: bool) -> f64 {
    let power = noise.bias_instability.0.powi(2) / PI;
    let (variance, length) = (power * 4.0_f64.ln(), a.seconds);
    let mut correlation = length / 3.0;
    let mut sum = if same { 2.0 * variance * correlation / 3.0 / length } else { 0.0 };
    for _ in 0..7 {
        let x = length / correlation;
        let apart = (a.start - b.start).abs() - length;
        sum += variance
            * if same {
                2.0 * (x + (-x).exp_m1()) / (x * x)
            } else {
                (-apart / correlation).exp() * ((-x).exp_m1() / x).powi(2)
            };
        correlation *= 4.0;
    }
    sum
}

/// The inverse by Gauss and Jordan with pivots.
fn inverse(mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let size = matrix.len();
    for (index, row) in matrix.iter_mut().enumerate() {
        row.extend((0..size).map(|column| f64::from(u8::from(column == index))));
    }
    for column in 0..size {
        let pivot = (column..size)
            .max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))
            .unwrap_or(column);
        matrix.swap(column, pivot);
        let scale = matrix[column][column];
        for value in &mut matrix[column] {
            *value /= scale;
        }
        let source = matrix[column].clone();
        let others = matrix.iter_mut().enumerate().filter(|(index, _)| *index != column);
        for (_, row) in others {
            let factor = row[column];
            for (value, subtracted) in row.iter_mut().zip(&source) {
                *value -= factor * subtracted;
            }
        }
    }
    matrix.into_iter().map(|row| row[size..].to_vec()).collect()
}
