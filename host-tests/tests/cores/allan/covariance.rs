//! How sure an Allan variance is, against NIST's formulas, the double sum over all terms, and
//! simulated records.

use orientation::noise::allan::covariance::{Law, Window, degrees_of_freedom};
use orientation::noise::allan::{Point, variance};
use orientation::noise::model::GyroNoise;
use orientation::units::{
    Radians, RadiansPerRootSecond, RadiansPerSecond, RateRamp, RateRandomWalk, Seconds,
};
use std::f64::consts::TAU;

/// A noise of one law: Q, N, B, K or R, of 1.
fn pure(law: usize) -> GyroNoise {
    let [q, n, b, k, r] = std::array::from_fn(|index| f64::from(u8::from(index == law)));
    GyroNoise {
        quantisation: Radians(q),
        angle_random_walk: RadiansPerRootSecond(n),
        bias_instability: RadiansPerSecond(b),
        rate_random_walk: RateRandomWalk(k),
        rate_ramp: RateRamp(r),
    }
}

/// A point of a record of `samples` at 1 Hz.
fn point(samples: u32, span: u32, stride: u32) -> Point {
    let terms = u64::from((samples - 2 * span) / stride + 1);
    Point {
        seconds: Seconds(f64::from(span)),
        variance: 0.0,
        stride: Seconds(f64::from(stride)),
        terms,
    }
}

/// NIST SP 1065, table 5 (overlapping Allan variance), `phases` = samples + 1.
fn published(law: usize, phases: f64, m: f64) -> f64 {
    let n = phases;
    match law {
        0 => (n + 1.0) * (n - 2.0 * m) / (2.0 * (n - m)),
        1 => {
            let rest = 3.0 * (n - 1.0) / (2.0 * m) - 2.0 * (n - 2.0) / n;
            rest * 4.0 * m * m / (4.0 * m * m + 5.0)
        }
        2 if m < 2.0 => 2.0 * (n - 2.0).powi(2) / (2.3 * n - 4.9),
        2 => 5.0 * n * n / (4.0 * m * (n + 3.0 * m)),
        _ => {
            let rest = (n - 1.0).powi(2) - 3.0 * m * (n - 1.0) + 4.0 * m * m;
            (n - 2.0) / m * rest / (n - 3.0).powi(2)
        }
    }
}

#[test]
fn degrees_of_freedom_are_nists() {
    // NIST's formulas are fits: flicker's is off by up to 9 %. That of the random walk counts steps
    // from sample to sample, so that it differs where m is small.
    for law in 0..4 {
        for m in [1, 2, 4, 8, 16, 64].into_iter().filter(|&m| law < 3 || m >= 4) {
            let found = degrees_of_freedom(&point(1024, m, 1), &pure(law), 1.0);
            let known = published(law, 1025.0, f64::from(m));
            let ratio = found / known;
            println!("law {law}, m {m}: {found:.1}, NIST {known:.1}");
            assert!((0.9..1.11).contains(&ratio), "law {law}, m {m}: {found}, not {known}");
        }
    }
}

/// Generalised autocovariance of the angle at 1 Hz (Greenhall), straight from the power law.
fn autocovariance(noise: &GyroNoise, lag: f64) -> f64 {
    let t = lag.abs();
    let [q, n, b, k, _] = noise.coefficients().map(|coefficient| coefficient * coefficient);
    let flicker = if t > 0.0 { t * t * t.ln() } else { 0.0 };
    q * f64::from(u8::from(t == 0.0)) - n * t / 2.0 + b / TAU * flicker + k * t.powi(3) / 12.0
}

/// Covariance of two terms from `starts` over `spans`: nine autocovariances.
fn of_terms(noise: &GyroNoise, starts: [f64; 2], spans: [f64; 2]) -> f64 {
    let weights = [(0.0, 1.0), (1.0, -2.0), (2.0, 1.0)];
    let mut sum = 0.0;
    for (i, a) in weights {
        for (j, b) in weights {
            let lag = starts[0] + i * spans[0] - starts[1] - j * spans[1];
            sum += a * b * autocovariance(noise, lag);
        }
    }
    sum / (2.0 * spans[0] * spans[1])
}

/// The double sum over all pairs of terms.
fn exhaustive(noise: &GyroNoise, [one, other]: [&Point; 2]) -> f64 {
    let ramp = |point: &Point| noise.rate_ramp.0 * point.seconds.0 * 0.5_f64.sqrt();
    let means = ramp(one) * ramp(other);
    let mut sum = 0.0;
    for i in 0..one.terms {
        for j in 0..other.terms {
            let starts = [i as f64 * one.stride.0, j as f64 * other.stride.0];
            let c = of_terms(noise, starts, [one.seconds.0, other.seconds.0]);
            sum += c * c + 2.0 * means * c;
        }
    }
    2.0 * sum / (one.terms * other.terms) as f64
}

/// Spans and strides from a few samples to a third of the record.
const WINDOWS: [(u32, u32); 7] =
    [(1, 1), (6, 2), (32, 8), (48, 8), (128, 32), (384, 64), (512, 128)];

/// The greatest error of a covariance, in the two points' standard deviations.
fn greatest_error(noise: &GyroNoise) -> f64 {
    let law = Law::new(noise, 1.0);
    let points = WINDOWS.map(|(span, stride)| point(1100, span, stride));
    let sigmas = points.map(|point| exhaustive(noise, [&point, &point]).sqrt());
    let mut greatest: f64 = 0.0;
    for i in 0..points.len() {
        for j in 0..=i {
            let pair = [points[i], points[j]];
            let [one, other] = pair.map(|point| Window::new(&point, noise, 1.0));
            let error = law.covariance(&one, &other) - exhaustive(noise, [&pair[0], &pair[1]]);
            greatest = greatest.max(error.abs() / (sigmas[i] * sigmas[j]));
        }
    }
    greatest
}

#[test]
fn thinned_lags_give_the_double_sum_within_one_per_cent() {
    let mixed =
        GyroNoise { rate_ramp: RateRamp(2e-3), rate_random_walk: RateRandomWalk(0.03), ..pure(1) };
    for noise in [pure(0), pure(1), pure(2), pure(3), mixed] {
        let error = greatest_error(&noise);
        println!("{noise:?}: {error:.5}");
        assert!(error < 0.01, "{noise:?}: {error}");
    }
}

#[test]
fn the_variance_of_a_term_is_the_models() {
    for law in 0..4 {
        for m in [1.0, 3.0, 40.0] {
            let known = of_terms(&pure(law), [0.0; 2], [m; 2]);
            let found = variance(&pure(law), m);
            assert!((found / known - 1.0).abs() < 1e-9, "law {law}, m {m}: {found}, not {known}");
        }
    }
}
