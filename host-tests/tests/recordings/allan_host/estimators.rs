//! The Allan variance of a record reproduces NIST SP 1065 and allantools, and takes no difference across a gap.

use std::path::Path;

use host::allan::{Overlapping, factors};
use orientation::noise::allan::{Allan, Point};
use orientation::units::{AngularRate, Seconds};
use proptest::prelude::*;
use serde_json::Value;

/// Relative agreement that is asked for with the published values.
const AGREEMENT: f64 = 1e-4;
/// Relative agreement that is asked for with allantools, which uses every window of every length.
const WITH_ALLANTOOLS: f64 = 0.01;
/// Numbers that an estimator may hold: 8 MB.
const HELD: usize = 1 << 20;

fn vectors(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/vectors").join(name);
    let text = std::fs::read_to_string(path).expect("it is stored");
    serde_json::from_str(&text).expect("it is JSON")
}

/// The 1000 numbers of NIST SP 1065, from their recurrence.
fn thousand() -> Vec<f64> {
    const MODULUS: u64 = 2_147_483_647;
    let start = Some(1_234_567_890_u64);
    let numbers = std::iter::successors(start, |n| Some(16_807 * n % MODULUS));
    numbers.take(1000).map(|n| n as f64 / MODULUS as f64).collect()
}

/// What samples come to at 1 Hz; some are missing.
fn points_of(
    samples: impl IntoIterator<Item = Option<f64>>,
    factors: impl IntoIterator<Item = u64>,
) -> Vec<Point> {
    let mut sums = Overlapping::new(factors);
    for sample in samples {
        match sample {
            Some(rate) => sums.push(rate),
            None => sums.part(),
        }
    }
    sums.points(1.0)
}

/// What whole records come to at 1 Hz.
fn points(rates: &[f64], factors: impl IntoIterator<Item = u64>) -> Vec<Point> {
    points_of(rates.iter().copied().map(Some), factors)
}

fn deviation(rates: &[f64], factor: u64) -> f64 {
    let points = points(rates, [factor]);
    points.first().expect("the record is long enough").variance.sqrt()
}

/// Holds every value of a table `{"factor": {"oadev": value}}`; how many there were.
fn hold(rates: &[f64], table: &Value) -> usize {
    let table = table.as_object().expect("a table");
    for (factor, row) in table {
        let (factor, expected) = (factor.parse().expect("a factor"), row["oadev"].as_f64());
        let error = deviation(rates, factor) / expected.expect("a number") - 1.0;
        assert!(error.abs() < AGREEMENT, "at {factor}: {error}");
    }
    table.len()
}

#[test]
fn the_thousand_numbers_of_nist_give_its_deviations() {
    assert_eq!(hold(&thousand(), &vectors("allan.json")["sp1065"]), 3);
}

#[test]
fn the_nine_numbers_of_nbs_14_give_its_deviations() {
    let vectors = vectors("allan.json");
    let values = vectors["nbs14"]["values"].as_array().expect("nine values");
    let values: Vec<f64> = values.iter().map(|value| value.as_f64().expect("a number")).collect();
    assert_eq!(hold(&values, &vectors["nbs14"]["results"]), 2);
}

/// The series of `data/vectors/allan-long.py`.
fn long(samples: u64) -> impl Iterator<Item = i64> {
    let (mut state, mut walk) = (1_u64, 1_i64 << 30);
    (0..samples).map(move |_| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        walk += 1024 * (2 * (state >> 36 & 1).cast_signed() - 1);
        walk + (state >> 40).cast_signed() - (1 << 23)
    })
}

#[test]
fn eight_million_samples_give_what_allantools_finds_within_one_per_cent_in_bounded_memory() {
    let vectors = vectors("allan-long.json");
    let samples = vectors["samples"].as_u64().expect("a number");
    let (mut sums, mut last, mut most) = (Overlapping::default(), 0, 0);
    for (index, rate) in long(samples).enumerate() {
        sums.push(rate as f64);
        last = rate;
        if index % (1 << 16) == 0 {
            most = most.max(sums.held());
        }
    }
    assert_eq!(vectors["last"], last, "both series are the same");
    assert!(most.max(sums.held()) <= HELD, "{most} numbers were held");
    let points = sums.points(1.0);
    let expected = vectors["oadev"].as_object().expect("a table");
    assert_eq!(points.len(), expected.len());
    for point in points {
        let known = expected[&format!("{:.0}", point.seconds.0)].as_f64().expect("a number");
        let error = point.variance.sqrt() / known - 1.0;
        assert!(error.abs() < WITH_ALLANTOOLS, "at {}: {error}", point.seconds.0);
        let within = if point.stride.0 > 1.0 { 2e-3 } else { 1e-8 };
        assert!(error.abs() < within, "at {}: {error}", point.seconds.0);
    }
}

#[test]
fn a_constant_rate_has_no_variance_and_a_ramp_that_of_its_slope() {
    let ramp: Vec<f64> = (0..100).map(|i| 0.5 * f64::from(i)).collect();
    let expected = 0.5 * 7.0 / 2.0_f64.sqrt();
    assert!(deviation(&[0.3; 100], 7) < 1e-12);
    assert!((deviation(&ramp, 7) / expected - 1.0).abs() < 1e-9);
}

#[test]
fn the_averaging_time_is_in_seconds_and_the_terms_are_counted() {
    let mut sums = Overlapping::new([30, 512]);
    (0..3000).for_each(|index| sums.push(f64::from(index % 7)));
    let points = sums.points(0.1);
    let [short, long] = points.as_slice() else { panic!("{points:?}") };
    assert!((short.seconds.0 - 3.0).abs() < 1e-12 && (short.stride.0 - 0.1).abs() < 1e-12);
    assert_eq!(short.terms, 3000 - 2 * 30 + 1);
    assert!((long.seconds.0 - 51.2).abs() < 1e-12 && (long.stride.0 - 0.2).abs() < 1e-12);
    assert_eq!(long.terms, (3000 - 2 * 512) / 2 + 1);
}

#[test]
fn what_the_record_is_too_short_for_is_no_point() {
    for factor in [0, 6, 100, u64::MAX] {
        assert_eq!(points(&thousand()[..10], [factor]), [], "at {factor}");
    }
    assert_eq!(points(&thousand()[..10], [5]).len(), 1);
    for empty in [&[][..], &[1.0]] {
        assert_eq!(points(empty, factors()), []);
    }
}

#[test]
fn averaging_times_rise_without_a_hole_to_half_of_the_longest_segment() {
    let times: Vec<u64> =
        points(&thousand(), factors()).iter().map(|point| point.seconds.0 as u64).collect();
    assert_eq!(times[..10], [1, 2, 3, 4, 6, 8, 12, 16, 24, 32]);
    assert_eq!(times.last(), Some(&384));
    let all: Vec<u64> = factors().collect();
    assert!(all.windows(2).all(|pair| pair[0] < pair[1] && 2 * pair[0] >= pair[1]));
}

#[test]
fn windows_are_a_whole_number_of_their_steps_and_step_by_less_than_their_64th_part() {
    let (mut sums, mut last) = (Overlapping::default(), 0.0);
    long(1 << 20).for_each(|rate| sums.push(rate as f64));
    for Point { seconds, stride, .. } in sums.points(1.0) {
        assert!(seconds.0 % stride.0 == 0.0 && seconds.0 / stride.0 >= stride.0.min(64.0));
        assert!(stride.0 >= last, "the longer steps are whole numbers of the shorter");
        last = stride.0;
    }
}

#[test]
fn a_bias_of_a_million_times_the_noise_costs_no_digits_that_matter() {
    let noise: Vec<f64> = long(200_000).map(|rate| (rate - (1 << 30)) as f64).collect();
    let biased: Vec<f64> = noise.iter().map(|rate| rate + 1e13).collect();
    for (with, without) in points(&biased, factors()).iter().zip(points(&noise, factors())) {
        let error = with.variance / without.variance - 1.0;
        assert!(error.abs() < 1e-6, "at {}: {error}", with.seconds.0);
    }
}

#[test]
fn the_boards_estimator_agrees_where_it_takes_every_window_too() {
    let (mut board, mut host) = (Allan::new(), Overlapping::default());
    for rate in long(20_000).filter_map(|rate| i32::try_from(rate - (1 << 30)).ok()) {
        board.push(AngularRate(rate));
        host.push(f64::from(rate) * 1e-9);
    }
    let host = host.points(0.1);
    for point in board.points(Seconds(0.1)).filter(|point| point.stride.0 < 0.15) {
        let is_it = |other: &&Point| (other.seconds.0 / point.seconds.0 - 1.0).abs() < 1e-9;
        let other = host.iter().find(is_it).expect("both have it");
        assert_eq!(other.terms, point.terms);
        assert!((other.variance / point.variance - 1.0).abs() < 1e-9, "{point:?}, {other:?}");
    }
}

/// The overlapping Allan variance from its definition: pairs of adjacent windows of sums, in whole numbers, that begin
/// at every `stride`-th place of a segment.
fn by_definition(samples: &[Option<i64>], factor: usize, stride: usize) -> Option<(f64, u64)> {
    let (mut sum, mut terms) = (0.0, 0);
    for segment in samples.split(Option::is_none) {
        let total = segment.iter().flatten().scan(0_i64, |total, rate| {
            *total += rate;
            Some(*total)
        });
        let phases: Vec<i64> = std::iter::once(0).chain(total).collect();
        for start in (0..phases.len().saturating_sub(2 * factor)).step_by(stride) {
            let [begin, middle, end] = [0, 1, 2].map(|i| phases[start + i * factor]);
            sum += ((end - 2 * middle + begin) as f64).powi(2);
            terms += 1;
        }
    }
    (terms > 0).then(|| (sum / terms as f64 / 2.0 / (factor * factor) as f64, terms))
}

/// Holds what an estimator finds to the definition.
fn hold_to_definition(samples: &[Option<i64>], factor: usize, stride: usize) {
    let rates = samples.iter().map(|sample| sample.map(|rate| rate as f64));
    let found = points_of(rates, [factor as u64]);
    let expected = by_definition(samples, factor, stride);
    let terms = |found: &Point| found.terms;
    assert_eq!(found.first().map(terms), expected.map(|(_, terms)| terms), "at {factor}");
    if let (Some(found), Some((variance, _))) = (found.first(), expected) {
        assert!((found.variance - variance).abs() <= 1e-9 * (variance + 1.0), "at {factor}");
    }
}

#[test]
fn long_windows_of_a_long_record_with_gaps_are_those_of_the_definition() {
    let is_there = |index: usize| ![5, 9000, 9001, 30_000, 32_000].contains(&index);
    let samples: Vec<Option<i64>> =
        long(60_000).enumerate().map(|(i, rate)| is_there(i).then_some(rate)).collect();
    for (factor, stride) in [
        (1, 1),
        (256, 1),
        (384, 1),
        (500, 1),
        (512, 2),
        (768, 2),
        (1000, 2),
        (8192, 32),
        (12_288, 32),
    ] {
        hold_to_definition(&samples, factor, stride);
    }
}

proptest! {
    #[test]
    fn every_window_that_no_gap_touches_is_used_and_no_other(
        samples in prop::collection::vec(prop::option::weighted(0.9, -1000..1000_i64), 1..120),
        factor in 1_usize..12,
    ) {
        hold_to_definition(&samples, factor, 1);
    }

    #[test]
    fn a_constant_added_to_the_rates_changes_nothing(
        rates in prop::collection::vec(-1.0..1.0_f64, 40..200),
        constant in -1e3..1e3_f64,
    ) {
        let moved: Vec<f64> = rates.iter().map(|rate| rate + constant).collect();
        prop_assert!((deviation(&rates, 4) - deviation(&moved, 4)).abs() < 1e-9);
    }
}
