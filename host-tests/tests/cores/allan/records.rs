//! The fit on a recording of an independent simulator, and on records that say nothing.

use flate2::read::GzDecoder;
use orientation::noise::allan::{Allan, Point};
use orientation::noise::fit::{Estimate, FitError, NoiseFit};
use orientation::units::{AngularRate, Seconds};
use std::fs::File;
use std::io::Read;

/// N in °/√h, B in °/h and K in °/h/√h, as the recording's header says.
const TRUTH: [f64; 3] = [0.02, 0.3, 2.0];

fn recording() -> Allan {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/recordings/static-gyro-1h.csv.gz");
    let mut text = String::new();
    let mut file = GzDecoder::new(File::open(path).expect("the recording is there"));
    file.read_to_string(&mut text).expect("the recording is gzip");
    let mut allan = Allan::new();
    for line in text.lines().filter(|line| !line.starts_with(['#', 't'])) {
        let rate = line.split(',').nth(1).and_then(|rate| rate.parse().ok());
        allan.push(AngularRate::from_rad_per_s(rate.expect("a rate in each row")));
    }
    allan
}

#[test]
fn an_hour_of_an_independent_simulator_gives_its_coefficients() {
    let fit = NoiseFit::of(&recording(), Seconds(0.1)).expect("an hour of noise");
    println!("{fit:?}; χ² {:.1} of {}", fit.chi_square, fit.degrees);
    let found = fit.in_field_units().map(|(_, estimate)| estimate);
    for (estimate, truth) in found.into_iter().skip(1).zip(TRUTH) {
        let Estimate::Found { value, sigma } = estimate else { panic!("{estimate}, not {truth}") };
        assert!((value - truth).abs() < 2.0 * sigma, "{value} ± {sigma}, not {truth}");
    }
    let n = found[1].value().expect("N was found");
    assert!((n / TRUTH[0] - 1.0).abs() < 0.02, "{n}");
    for absent in [fit.estimates[0], fit.estimates[4]] {
        assert!(matches!(absent, Estimate::NotObservable { .. }), "{absent}");
    }
}

fn fit(samples: impl IntoIterator<Item = i32>) -> Result<NoiseFit, FitError> {
    let mut allan = Allan::new();
    for rate in samples {
        allan.push(AngularRate(rate));
    }
    NoiseFit::of(&allan, Seconds(0.1))
}

/// Noise of about ± `size`, from a linear congruence.
fn noise(size: i64, count: usize) -> impl Iterator<Item = i32> {
    let next = |state: &u64| {
        Some(state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407))
    };
    let states = std::iter::successors(Some(1_u64), next).take(count);
    states.map(move |state| (((state >> 33).cast_signed() * 2 * size) >> 31) as i32 - size as i32)
}

#[test]
fn a_record_that_says_nothing_is_refused_with_the_reason() {
    let refusal = |samples: Vec<i32>| fit(samples).expect_err("it says nothing").to_string();
    assert_eq!(refusal(vec![]), "record too short: 0 samples, 64 needed");
    assert_eq!(refusal(noise(1000, 63).collect()), "record too short: 63 samples, 64 needed");
    assert_eq!(refusal(vec![7; 1000]), "all samples are equal: the gyro or its bus is stuck");
    let clipped = noise(1000, 500).chain([i32::MAX]).chain(noise(1000, 500));
    assert_eq!(refusal(clipped.collect()), "a sample stood at the limit of its range");
    let rounded = (0..10_000).map(|index| 500 * i32::from(index % 1000 == 0));
    assert_eq!(refusal(rounded.collect()), "the noise is smaller than the step of the samples");
    assert_eq!(
        refusal((0..10_000).map(|index| 5 * index).collect()),
        "the record is not one of noise"
    );
}

#[test]
fn a_period_that_is_none_is_refused() {
    let mut allan = Allan::new();
    noise(1000, 100).for_each(|rate| allan.push(AngularRate(rate)));
    for seconds in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(NoiseFit::of(&allan, Seconds(seconds)), Err(FitError::Period));
    }
}

#[test]
fn points_that_are_no_variances_are_refused() {
    for variance in [0.0, f64::NAN, f64::INFINITY, -1.0] {
        let point = |m: u32| Point {
            seconds: Seconds(f64::from(m)),
            variance,
            stride: Seconds(1.0),
            terms: u64::from(1001 - 2 * m),
        };
        let points: Vec<_> = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32].map(point).to_vec();
        assert_eq!(
            NoiseFit::of_points(&points, Seconds(1.0)),
            Err(FitError::NotNoise),
            "{variance}"
        );
    }
}

#[test]
fn the_shortest_record_of_white_noise_gives_n() {
    let fit = fit(noise(1_000_000, 64)).expect("64 samples are enough");
    // Uniform within ± a million: σ √(1/3) 1e-3 rad/s, N = σ √0.1 s.
    let known = 1e-3 / 3.0_f64.sqrt() * 0.1_f64.sqrt();
    let [_, Estimate::Found { value, sigma }, ..] = fit.estimates else { panic!("{fit:?}") };
    assert!((value - known).abs() < 4.0 * sigma && sigma < 0.3 * known, "{value} ± {sigma}");
}

#[test]
fn the_fit_says_its_units() {
    let found = fit(noise(1_000_000, 5000)).expect("white noise").in_field_units();
    let units = ["arc seconds", "°/√h", "°/h", "°/h/√h", "°/h²"];
    for ((coefficient, estimate), unit) in found.into_iter().zip(units) {
        let text = format!("{coefficient}: {estimate}");
        assert!(text.contains(&format!(", {unit}: ")), "{text}");
    }
}
