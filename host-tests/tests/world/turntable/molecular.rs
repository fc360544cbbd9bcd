//! The dynamics of a molecular-electronic sensor against its frequency response, and its start.

use std::f64::consts::TAU;

use hal_mock::gyro::{DEGREE_PER_HOUR, Gyro, GyroConfiguration};
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::turntable::{Segment, Turntable, TurntableConfiguration};

use super::{Complex, assert_complex, assert_near, fit};

const RATE_HZ: f64 = 100.0;
const HIGH_PASS_HZ: f64 = 0.03;
const LAG_S: f64 = 0.2;

fn sensor(force_rad_s2_g: [f64; 2], high_pass_hz: f64, lag_s: f64) -> GyroConfiguration {
    let molecular = Some(MolecularConfiguration { force_rad_s2_g, high_pass_hz, lag_s });
    GyroConfiguration { molecular, ..GyroConfiguration::default() }
}

/// s/(s + ω)/(1 + τs) at s = jw.
fn response(angular: f64, high_pass_hz: f64, lag_s: f64) -> Complex {
    let high_pass = Complex(0.0, angular) / Complex(TAU * high_pass_hz, angular);
    high_pass / Complex(1.0, angular * lag_s)
}

/// What a sensor makes of cos wt, as a rate of 1 rad/s and a force of `force_g`, once it is settled.
fn measured(configuration: &GyroConfiguration, hertz: f64, rate: f64, force: [f64; 2]) -> Complex {
    let mut gyro = Gyro::new(configuration, RATE_HZ, 1);
    let settle = 12_000;
    let periods = (50.0 * hertz).ceil().max(2.0);
    let count = settle + (periods / hertz * RATE_HZ).round() as usize;
    let mut rows = Vec::new();
    for k in 0..count {
        let (sine, cosine) = (TAU * hertz * k as f64 / RATE_HZ).sin_cos();
        let felt = force.map(|force| force * cosine);
        let shown = gyro.sample_under(felt, rate * cosine, k as f64 / RATE_HZ, 25.0);
        if k >= settle {
            rows.push(([1.0, cosine, sine], shown));
        }
    }
    let [_, cosine, sine] = fit(rows.into_iter());
    Complex(cosine, -sine)
}

#[test]
fn gain_and_phase_are_those_of_a_high_pass_and_a_lag_within_the_bound_of_straight_lines() {
    let filters = [(HIGH_PASS_HZ, LAG_S), (HIGH_PASS_HZ, 0.0), (0.0, LAG_S), (0.1, 0.05)];
    for (high_pass_hz, lag_s) in filters {
        let gyro = sensor([0.0; 2], high_pass_hz, lag_s);
        for hertz in [0.01, 0.03, 0.137, 0.5, 1.0, 2.0] {
            let angular = TAU * hertz;
            let expected = response(angular, high_pass_hz, lag_s);
            let ratio = measured(&gyro, hertz, 1.0, [0.0; 2]) / expected;
            let square = angular * (angular + TAU * high_pass_hz) / (RATE_HZ * RATE_HZ);
            assert_complex(ratio, Complex(1.0, 0.0), square / 12.0 * 1.1 + 1e-9);
        }
    }
}

#[test]
fn a_force_shows_as_its_integral_behind_the_same_dynamics() {
    for (high_pass_hz, lag_s) in [(HIGH_PASS_HZ, LAG_S), (HIGH_PASS_HZ, 0.0), (0.0, 0.0)] {
        let gyro = sensor([2e-3, -3e-3], high_pass_hz, lag_s);
        for hertz in [0.03, 0.137, 0.5] {
            let angular = TAU * hertz;
            let integral = Complex(2e-3 * 0.7 - 3e-3 * 0.2, 0.0).over_j(angular);
            let expected = response(angular, high_pass_hz, lag_s) * integral;
            let ratio = measured(&gyro, hertz, 0.0, [0.7, 0.2]) / expected;
            let square = angular * angular / (RATE_HZ * RATE_HZ);
            assert_complex(ratio, Complex(1.0, 0.0), square / 6.0 * 1.1 + 1e-9);
        }
    }
}

/// An hour on a tilted platform that does not turn.
fn standing(gyro: GyroConfiguration) -> Vec<f64> {
    let instruments = InstrumentsConfiguration { latitude_deg: 50.0, gyro, ..Default::default() }
        .leaning(1.0, 0.0);
    let segments = [Segment::steady(0.0, 3600.0)];
    let configuration =
        TurntableConfiguration { instruments, segments: &segments, ..Default::default() };
    Turntable::new(&configuration, 1).map(|sample| sample.rate_rad_s).collect()
}

#[test]
fn a_sensor_that_stands_begins_settled_and_its_integral_stays_bounded() {
    let gyro = GyroConfiguration { bias_deg_h: 3.0, ..sensor([1e-3, 5e-3], HIGH_PASS_HZ, LAG_S) };
    // What is steady does not pass, but the high-pass holds the integral at κ·f/ω.
    let integral = 1e-3 * 1.0_f64.to_radians().sin() / (TAU * HIGH_PASS_HZ);
    for shown in standing(gyro) {
        assert_near(shown, integral + 3.0 * DEGREE_PER_HOUR, 1e-17);
    }
}

#[test]
fn a_step_of_the_rate_dies_away_with_both_time_constants() {
    let mut gyro = Gyro::new(&sensor([0.0; 2], HIGH_PASS_HZ, LAG_S), RATE_HZ, 1);
    let (slow, quick) = (TAU * HIGH_PASS_HZ, 1.0 / LAG_S);
    assert_eq!(gyro.sample(0.0, 0.0, 25.0), 0.0);
    for k in 1..3000 {
        // The line up to the step's first sample stands for a step half a period before it.
        let elapsed = (f64::from(k) - 0.5) / RATE_HZ;
        let expected =
            ((-slow * elapsed).exp() - (-quick * elapsed).exp()) * quick / (quick - slow);
        assert_near(gyro.sample(1.0, elapsed, 25.0), expected, if k == 1 { 0.01 } else { 2e-4 });
    }
}

#[test]
fn the_white_noise_of_a_molecular_sensor_is_that_of_its_input() {
    let n = GyroConfiguration { n_deg_sqrt_h: 0.02, ..GyroConfiguration::default() };
    // N = 0.02 °/√h is 1.2 °/h/√Hz, two-sided; a²/(2(a + ω)) is the band of the filter, a = 1/τ.
    let gyro =
        GyroConfiguration { molecular: sensor([0.0; 2], HIGH_PASS_HZ, LAG_S).molecular, ..n };
    let mut gyro = Gyro::new(&gyro, RATE_HZ, 7);
    let count = 4_000_000;
    let square: f64 = (0..count)
        .map(|k| gyro.sample(0.0, f64::from(k) / RATE_HZ, 25.0) / DEGREE_PER_HOUR)
        .map(|shown| shown * shown)
        .sum();
    let (slow, quick) = (TAU * HIGH_PASS_HZ, 1.0 / LAG_S);
    let expected = 1.44 * quick * quick / (2.0 * (quick + slow));
    // 4e4 s hold 2e5 independent values; straight lines between the samples cost h/(3τ).
    assert_near(square / f64::from(count) / expected, 1.0, 0.02 + 0.017);
}

#[test]
fn a_sensor_without_dynamics_shows_a_gyros_numbers() {
    let errors = GyroConfiguration {
        n_deg_sqrt_h: 0.02,
        b_deg_h: 0.5,
        k_deg_h_sqrt_h: 0.2,
        bias_sigma_deg_h: 5.0,
        r_deg_h2: 1.0,
        ..GyroConfiguration::default()
    };
    let molecular = Some(MolecularConfiguration::default());
    let mut plain = Gyro::new(&errors, RATE_HZ, 3);
    let mut flat = Gyro::new(&GyroConfiguration { molecular, ..errors }, RATE_HZ, 3);
    for k in 0..1000 {
        let elapsed = f64::from(k) / RATE_HZ;
        let bias = plain.bias_rad_s;
        let expected = plain.sample(1e-4 + bias, elapsed, 25.0);
        assert_near(flat.sample(1e-4 + bias, elapsed, 25.0), expected, 1e-18);
    }
}
