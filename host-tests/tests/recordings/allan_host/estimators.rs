//! The Allan variance of a record reproduces NIST SP 1065, and takes no difference across a gap.

use std::path::Path;

use host::allan::Record;
use orientation::noise::allan::Point;
use proptest::prelude::*;
use serde_json::Value;

/// A variance of a record for an averaging factor.
type Estimator = fn(&Record, usize) -> Option<Point>;

/// From windows that begin at every sample.
const OVERLAPPING: Estimator = |record, factor| record.strided(factor, 1);
/// From adjacent windows.
const ADJACENT: Estimator = |record, factor| record.strided(factor, factor);

const NAMES: [(&str, Estimator); 2] = [("adev", ADJACENT), ("oadev", OVERLAPPING)];

/// Relative agreement that is asked for with the published values.
const AGREEMENT: f64 = 1e-4;

fn vectors() -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/vectors/allan.json");
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

/// One segment of rates at 1 Hz.
fn whole(rates: &[f64]) -> Record {
    Record::new(1.0, [rates])
}

fn deviation(record: &Record, estimator: Estimator, factor: usize) -> f64 {
    estimator(record, factor).expect("the record is long enough").variance.sqrt()
}

/// Holds every value of a table `{"factor": {"name": value}}`; how many there were.
fn hold(record: &Record, table: &Value) -> usize {
    let mut held = 0;
    for (factor, row) in table.as_object().expect("a table") {
        let factor = factor.parse().expect("a factor");
        for (name, estimator) in NAMES {
            let Some(expected) = row[name].as_f64() else { continue };
            let found = deviation(record, estimator, factor);
            let error = found / expected - 1.0;
            assert!(error.abs() < AGREEMENT, "{name} at {factor}: {found} for {expected}");
            held += 1;
        }
    }
    held
}

#[test]
fn the_thousand_numbers_of_nist_give_its_deviations() {
    assert_eq!(hold(&whole(&thousand()), &vectors()["sp1065"]), 6);
}

#[test]
fn the_nine_numbers_of_nbs_14_give_its_deviations() {
    let vectors = vectors();
    let values = vectors["nbs14"]["values"].as_array().expect("nine values");
    let values: Vec<f64> = values.iter().map(|value| value.as_f64().expect("a number")).collect();
    assert_eq!(hold(&whole(&values), &vectors["nbs14"]["results"]), 4);
}

#[test]
fn a_constant_rate_has_no_variance_and_a_ramp_that_of_its_slope() {
    let constant = whole(&[0.3; 100]);
    let ramp: Vec<f64> = (0..100).map(|i| 0.5 * f64::from(i)).collect();
    let ramp = whole(&ramp);
    let expected = 0.5 * 7.0 / 2.0_f64.sqrt();
    for (name, estimator) in NAMES {
        assert!(deviation(&constant, estimator, 7) < 1e-12, "{name}");
        assert!((deviation(&ramp, estimator, 7) / expected - 1.0).abs() < 1e-9, "{name}");
    }
}

#[test]
fn the_averaging_time_is_in_seconds_and_the_terms_are_counted() {
    let record = Record::new(0.1, [thousand().as_slice()]);
    let found = OVERLAPPING(&record, 30).expect("it is long enough");
    assert!((found.seconds.0 - 3.0).abs() < 1e-12 && (found.stride.0 - 0.1).abs() < 1e-12);
    assert_eq!(found.terms, 1000 - 2 * 30 + 1);
    assert_eq!(ADJACENT(&record, 30).map(|found| found.terms), Some(32));
}

#[test]
fn what_the_record_is_too_short_for_is_no_number() {
    let record = whole(&thousand()[..10]);
    for (name, estimator) in NAMES {
        for factor in [0, 6, 100, usize::MAX] {
            assert_eq!(estimator(&record, factor), None, "{name} at {factor}");
        }
    }
    assert!(OVERLAPPING(&record, 5).is_some());
    for empty in [Record::new(1.0, []), whole(&[]), whole(&[1.0])] {
        assert_eq!(OVERLAPPING(&empty, 1), None);
        assert!(empty.factors().is_empty());
    }
}

#[test]
fn factors_rise_without_a_hole_to_half_of_the_longest_segment() {
    let record = whole(&thousand());
    let factors = record.factors();
    assert_eq!(factors[..10], [1, 2, 3, 4, 6, 8, 12, 16, 24, 32]);
    assert_eq!(factors.last(), Some(&384));
    assert!(factors.windows(2).all(|pair| pair[0] < pair[1] && 2 * pair[0] >= pair[1]));
}

/// The overlapping Allan variance from its definition: every pair of adjacent windows of averages
/// in which no sample is missing.
fn by_definition(samples: &[Option<f64>], factor: usize) -> Option<(f64, u64)> {
    let mean = |window: &[Option<f64>]| {
        let sum: Option<f64> = window.iter().copied().sum();
        sum.map(|sum| sum / factor as f64)
    };
    let squares: Vec<f64> = samples
        .windows(2 * factor)
        .filter_map(|pair| Some(mean(&pair[factor..])? - mean(&pair[..factor])?))
        .map(|difference| difference * difference)
        .collect();
    let count = squares.len() as u64;
    (count > 0).then(|| (squares.iter().sum::<f64>() / 2.0 / count as f64, count))
}

/// The record of samples of which some are missing.
fn with_gaps(samples: &[Option<f64>]) -> Record {
    let segments: Vec<Vec<f64>> = samples
        .split(Option::is_none)
        .map(|segment| segment.iter().copied().flatten().collect())
        .collect();
    Record::new(1.0, segments.iter().map(Vec::as_slice))
}

proptest! {
    #[test]
    fn every_window_that_no_gap_touches_is_used_and_no_other(
        samples in prop::collection::vec(prop::option::weighted(0.9, -1e3..1e3_f64), 1..120),
        factor in 1_usize..12,
    ) {
        let found = OVERLAPPING(&with_gaps(&samples), factor);
        let expected = by_definition(&samples, factor);
        prop_assert_eq!(found.map(|found| found.terms), expected.map(|(_, terms)| terms));
        if let (Some(found), Some((variance, _))) = (found, expected) {
            prop_assert!((found.variance - variance).abs() <= 1e-9 * (variance + 1.0));
        }
    }

    #[test]
    fn windows_begin_at_every_place_that_the_stride_comes_to(
        rates in prop::collection::vec(-1.0..1.0_f64, 40..200),
        factor in 1_usize..20,
    ) {
        let record = whole(&rates);
        let terms = |stride| record.strided(factor, stride).map_or(0, |found| found.terms);
        let places = (rates.len() + 1 - 2 * factor) as u64;
        prop_assert_eq!(terms(3), places.div_ceil(3));
    }

    #[test]
    fn a_constant_added_to_the_rates_changes_nothing(
        rates in prop::collection::vec(-1.0..1.0_f64, 40..200),
        constant in -1e3..1e3_f64,
    ) {
        let moved: Vec<f64> = rates.iter().map(|rate| rate + constant).collect();
        for (name, estimator) in NAMES {
            let [here, there] = [&rates, &moved].map(|rates| deviation(&whole(rates), estimator, 4));
            prop_assert!((here - there).abs() < 1e-9, "{}", name);
        }
    }
}
