//! The whitening of dwells from which a sway was subtracted, against their covariance written out.

use orientation::noise::model::GyroNoise;
use orientation::noise::whitener::Whitener;
use orientation::signal::sway::SwayNoise;
use orientation::units::Seconds;

/// Begins and ends of dwells, s: of several lengths, with and without gaps.
const DWELLS: [[f64; 2]; 7] = [
    [3.0, 13.0],
    [14.4, 24.4],
    [24.4, 30.0],
    [45.0, 55.0],
    [56.0, 57.5],
    [60.0, 90.0],
    [91.4, 101.4],
];

const SWAY: SwayNoise =
    SwayNoise { angle_variance: 2.5e-8, correlation: Seconds(20.0), residual_variance: 0.0 };

/// Covariance of the changes of a Gauss–Markov angle over two dwells, each over its time.
fn shared([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    let of = |s: f64, t: f64| SWAY.angle_variance * (-(s - t).abs() / SWAY.correlation.0).exp();
    (of(b, d) - of(b, c) - of(a, d) + of(a, c)) / ((b - a) * (d - c))
}

/// Solves C·x = y by elimination; C is positive.
fn solve(mut c: Vec<Vec<f64>>, mut y: Vec<f64>) -> Vec<f64> {
    let n = y.len();
    for k in 0..n {
        for i in k + 1..n {
            let factor = c[i][k] / c[k][k];
            let row = c[k].clone();
            for (value, above) in c[i].iter_mut().zip(row) {
                *value -= factor * above;
            }
            y[i] -= factor * y[k];
        }
    }
    for k in (0..n).rev() {
        let rest: f64 = (k + 1..n).map(|j| c[k][j] * y[j]).sum();
        y[k] = (y[k] - rest) / c[k][k];
    }
    y
}

#[test]
fn sums_of_whitened_columns_are_those_of_the_inverse_covariance() {
    let white = 3e-11;
    let mut covariance: Vec<Vec<f64>> =
        DWELLS.iter().map(|a| DWELLS.iter().map(|b| shared(*a, *b)).collect()).collect();
    for (index, row) in covariance.iter_mut().enumerate() {
        row[index] += white;
    }
    let columns = [0.3_f64, 1.7]
        .map(|step| (0..DWELLS.len()).map(|i| (step * i as f64 + 0.2).cos()).collect::<Vec<f64>>());
    let mut whitener = Whitener::<2>::new(&GyroNoise::default(), 1.5).with_sway(&SWAY);
    let mut sums = [0.0; 3];
    for (index, [begin, end]) in DWELLS.into_iter().enumerate() {
        let mut row = [columns[0][index], columns[1][index]];
        whitener.whiten(begin, end, white, &mut row);
        let [x, y] = row;
        sums = [sums[0] + x * x, sums[1] + x * y, sums[2] + y * y];
    }
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let solved = solve(covariance.clone(), b.to_vec());
        a.iter().zip(solved).map(|(a, b)| a * b).sum()
    };
    let [x, y] = &columns;
    for (found, expected) in sums.into_iter().zip([product(x, x), product(x, y), product(y, y)]) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} instead of {expected}");
    }
}

#[test]
fn the_first_dwell_has_the_variance_that_its_mean_is_said_to_have() {
    let mut whitener = Whitener::<1>::new(&GyroNoise::default(), 10.0).with_sway(&SWAY);
    let mut row = [1.0];
    whitener.whiten(0.0, 10.0, 1e-11, &mut row);
    let variance = 1.0 / (row[0] * row[0]);
    assert!((variance / (1e-11 + SWAY.mean_variance(10.0)) - 1.0).abs() < 1e-12, "{variance}");
}

#[test]
fn without_a_sway_nothing_changes_by_a_bit() {
    let noise = GyroNoise::from_field_units(0.01, 0.1, 0.2, 0.0);
    let mut whiteners = [
        Whitener::<2>::new(&noise, 1.5),
        Whitener::<2>::new(&noise, 1.5).with_sway(&SwayNoise::NONE),
    ];
    for [begin, end] in DWELLS {
        let rows = whiteners.each_mut().map(|whitener| {
            let mut row = [1.0, begin.sin()];
            whitener.whiten(begin, end, 1e-12, &mut row);
            row.map(f64::to_bits)
        });
        assert_eq!(rows[0], rows[1]);
    }
}
