//! The streaming estimator against an exhaustive one in wide integers, and against closed forms.

use orientation::noise::allan::{Allan, Point};
use orientation::units::{AngularRate, Seconds};
use proptest::prelude::*;

/// The grid that the estimator promises: samples in τ, and samples from term to term.
fn grid() -> impl Iterator<Item = (usize, usize)> {
    let levels = (0..24).flat_map(|level| [(4 << level, 1 << level), (6 << level, 1 << level)]);
    [(1, 1), (2, 1), (3, 1)].into_iter().chain(levels)
}

/// Sum of the squared second differences of the running sum, and their number, by definition.
fn exhaustive(samples: &[i32], span: usize, stride: usize) -> (i128, usize) {
    let sum = |from: usize| samples[from..from + span].iter().map(|&x| i128::from(x)).sum::<i128>();
    let starts = (0..(samples.len() + 1).saturating_sub(2 * span)).step_by(stride);
    let squares = starts.map(|start| (sum(start + span) - sum(start)).pow(2));
    squares.fold((0, 0), |(total, terms), square| (total + square, terms + 1))
}

/// What the estimator must give for these samples.
fn expected(samples: &[i32], seconds: f64) -> Vec<Point> {
    let point = |(span, stride)| {
        let (sum, terms) = exhaustive(samples, span, stride);
        let scale = 2.0 * (span * span * terms) as f64;
        Point {
            seconds: Seconds(span as f64 * seconds),
            variance: sum as f64 * 1e-18 / scale,
            stride: Seconds(stride as f64 * seconds),
            terms: terms as u64,
        }
    };
    grid().map(point).filter(|point| point.terms > 0).collect()
}

fn streamed(samples: &[i32]) -> Allan {
    let mut allan = Allan::new();
    for &rate in samples {
        allan.push(AngularRate(rate));
    }
    allan
}

/// Rates of a few kinds: anything, the extremes, and small numbers.
fn samples() -> impl Strategy<Value = Vec<i32>> {
    let extreme = prop_oneof![Just(i32::MIN), Just(i32::MAX), Just(0)];
    let rate = prop_oneof![any::<i32>(), extreme, -3_i32..3];
    prop::collection::vec(rate, 0..700)
}

proptest! {
    #[test]
    fn the_stream_equals_the_exhaustive_sum_bit_for_bit(samples in samples()) {
        let points: Vec<_> = streamed(&samples).points(Seconds(0.1)).collect();
        prop_assert_eq!(points, expected(&samples, 0.1));
    }

    #[test]
    fn long_swings_between_the_extremes_stay_exact(half in 1_usize..400, count in 1000_usize..6000) {
        let swing = |index: usize| if (index / half).is_multiple_of(2) { i32::MIN } else { i32::MAX };
        let samples: Vec<_> = (0..count).map(swing).collect();
        let points: Vec<_> = streamed(&samples).points(Seconds(1.0)).collect();
        prop_assert_eq!(points, expected(&samples, 1.0));
    }

    #[test]
    fn the_estimator_tells_saturated_and_constant_records(samples in samples()) {
        let allan = streamed(&samples);
        let limits = [i32::MIN, i32::MAX];
        prop_assert_eq!(allan.is_saturated, samples.iter().any(|rate| limits.contains(rate)));
        let changes = samples.windows(2).map(|pair| pair[0].abs_diff(pair[1]));
        let step = changes.filter(|&change| change > 0).min();
        prop_assert_eq!(allan.is_constant(), step.is_none());
        prop_assert_eq!(allan.resolution().0, f64::from(step.unwrap_or(0)) * 1e-9);
    }
}

#[test]
fn it_takes_no_more_than_4096_bytes() {
    assert!(size_of::<Allan>() <= 4096, "{} bytes", size_of::<Allan>());
}

#[test]
fn a_ramp_gives_half_of_its_square_times_tau_squared() {
    // 5 nrad/s a sample; R²τ²/2 at 10 Hz.
    let samples: Vec<_> = (0..20_000).map(|index| 5 * index - 40_000).collect();
    let slope = 5e-9 / 0.1;
    for point in streamed(&samples).points(Seconds(0.1)) {
        let known = 0.5 * (slope * point.seconds.0).powi(2);
        assert!((point.variance / known - 1.0).abs() < 1e-12, "{point:?}, not {known}");
    }
}

#[test]
fn the_nist_set_of_a_thousand_numbers_gives_its_published_deviations() {
    // NIST SP 1065, section 12.4: n ← 16807 n mod 2³¹ − 1 from 1234567890, over 2³¹ − 1.
    let next = |n: &u64| Some(n * 16_807 % 2_147_483_647);
    let set = std::iter::successors(Some(1_234_567_890_u64), next).take(1000);
    let rates: Vec<_> = set.map(|n| i32::try_from(n).expect("below 2³¹")).collect();
    let points: Vec<_> = streamed(&rates).points(Seconds(1.0)).collect();
    let deviation = points[0].variance.sqrt() * 1e9 / 2_147_483_647.0;
    assert!((deviation - 2.922_319e-1).abs() < 1e-7, "{deviation}");
}
