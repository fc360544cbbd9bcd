//! An azimuth that is stored: what is integrated, and how its standard deviation grows.
#![allow(clippy::expect_used, reason = "a test that cannot go on has failed")]

use std::f64::consts::{LN_2, PI};

use bench::campaign::statistics::rms;
use hal_mock::gyro::{Gyro, GyroConfiguration};
use orientation::earth::Latitude;
use orientation::keep::stored::{Handover, Keeper, Rest, StoredAzimuth, adjacent_variance};
use orientation::noise::model::GyroNoise;
use orientation::units::{AngularRate, DEGREE_PER_HOUR};
use proptest::prelude::*;

const RATE_HZ: f64 = 50.0;

fn keeper(noise: GyroNoise, latitude_deg: f64) -> Keeper {
    let latitude = Latitude::from_degrees(latitude_deg).expect("it is one");
    let bias_sigma = 2.0 * DEGREE_PER_HOUR;
    Keeper { noise, bias_sigma, latitude, sample_seconds: 1.0 / RATE_HZ }
}

/// Rests for so many seconds, then turns at a rate, rad/s, for so many.
fn kept(
    keeper: Keeper,
    rest_s: f64,
    stored_s: f64,
    mut shown: impl FnMut(f64) -> f64,
) -> StoredAzimuth {
    let earth = -keeper.latitude.vertical_rate();
    let rate = |value: f64| AngularRate::from_rad_per_s(value);
    let mut rest = Rest::default();
    for _ in 0..(rest_s * RATE_HZ) as u32 {
        rest.push(rate(shown(earth)));
    }
    let handover = Handover { azimuth: 1.0, sigma: 0.001 };
    let mut stored = StoredAzimuth::begin(keeper, handover, &rest);
    for _ in 0..(stored_s * RATE_HZ) as u32 {
        stored.push(rate(shown(earth)));
    }
    stored
}

#[test]
fn a_base_at_rest_keeps_its_azimuth_whatever_the_bias_and_the_latitude() {
    for latitude in [-70.0, 0.0, 48.0] {
        let keeper = keeper(GyroNoise::default(), latitude);
        let bias = 30.0 * DEGREE_PER_HOUR;
        let stored = kept(keeper, 60.0, 600.0, |earth| earth + bias);
        // A nanoradian a second is the step of a sample.
        assert!((stored.azimuth() - 1.0).abs() < 1e-9 * 600.0, "{}", stored.azimuth());
        // Without a rest the bias turns it, and σ says so.
        let unknown = kept(keeper, 0.0, 600.0, |earth| earth + bias);
        assert!((unknown.azimuth() - 1.0 - bias * 600.0).abs() < 1e-6);
        assert!((unknown.drift() - 2.0 * DEGREE_PER_HOUR * 600.0).abs() < 1e-9);
    }
}

#[test]
fn turns_are_followed_through_north() {
    let keeper = keeper(GyroNoise::default(), 48.0);
    let turning = 0.1;
    let stored = kept(keeper, 0.0, 100.0, |earth| earth + turning);
    let expected = (1.0 + turning * 100.0) % (2.0 * PI);
    assert!((stored.azimuth() - expected).abs() < 1e-6, "{} {expected}", stored.azimuth());
}

proptest! {
    #[test]
    fn the_drift_of_each_noise_is_its_closed_form(a in 1.0..500.0_f64, b in 1.0..2000.0_f64) {
        let of = |n, bias, k, r| adjacent_variance(&GyroNoise::from_field_units(n, bias, k, r), a, b);
        let unit = DEGREE_PER_HOUR * DEGREE_PER_HOUR;
        let [a_h, b_h] = [a / 3600.0, b / 3600.0];
        let close = |found: f64, expected: f64| (found / unit / expected - 1.0).abs() < 1e-9;
        prop_assert!(close(of(0.02, 0.0, 0.0, 0.0), 0.0004 * (1.0 / a_h + 1.0 / b_h)));
        prop_assert!(close(of(0.0, 0.0, 2.0, 0.0), 4.0 * (a_h + b_h) / 3.0));
        prop_assert!(close(of(0.0, 0.0, 0.0, 3.0), 9.0 * (a_h + b_h).powi(2) / 4.0));
        // Two adjacent means of the same length: twice the Allan variance.
        let flicker = adjacent_variance(&GyroNoise::from_field_units(0.0, 0.5, 0.0, 0.0), a, a);
        prop_assert!(close(flicker, 2.0 * 0.25 * 2.0 * LN_2 / PI));
    }
}

#[test]
fn sigma_covers_the_errors_of_a_gyro_with_every_noise() {
    let [n, b, k] = [0.05, 0.5, 1.0];
    let keeper = keeper(GyroNoise::from_field_units(n, b, k, 0.0), 48.0);
    let configuration = GyroConfiguration {
        n_deg_sqrt_h: n,
        b_deg_h: b,
        k_deg_h_sqrt_h: k,
        bias_sigma_deg_h: 10.0,
        ..GyroConfiguration::default()
    };
    for (rest_s, stored_s) in [(30.0, 300.0), (120.0, 120.0)] {
        let ratios: Vec<f64> = (1..=300)
            .map(|seed| {
                let mut gyro = Gyro::new(&configuration, RATE_HZ, seed);
                let shown = |earth| gyro.sample(gyro.steady(earth, [0.0; 2]), 0.0, 25.0);
                let stored = kept(keeper, rest_s, stored_s, shown);
                (stored.azimuth() - 1.0) / stored.drift()
            })
            .collect();
        assert!((0.88..1.12).contains(&rms(&ratios)), "{}", rms(&ratios));
    }
}
