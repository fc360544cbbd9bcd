//! Molecular-electronic sensors drawn at random, at two speeds: σ is true and no bias is left.

use std::f64::consts::TAU;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::earth::earth_rate_rad_s;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::noise::Generator;
use hal_mock::stage::{Ripple, Unevenness};
use orientation::alignment::rotating::session::Procedure;
use orientation::units::{RadiansPerSecond, Seconds};

use super::rig::{Case, driven, molecular, over, rms};

/// ρ, the greatest at the slower speed, and what the sensor does to a rate.
#[derive(Clone, Copy, Debug)]
struct Draw {
    rho: f64,
    high_pass_hz: f64,
    n: f64,
    /// Non-orthogonality at most, °.
    alpha_deg: f64,
}

const SPEEDS: [f64; 2] = [0.6, 1.2];

fn case(seed: u64, draw: Draw) -> Case {
    let mut generator = Generator::new(seed + 500);
    let mut between = |low: f64, high: f64| low + (high - low) * generator.uniform();
    let latitude_deg = between(-65.0, 65.0);
    let [horizontal, ..] = earth_rate_rad_s(f64::to_radians(latitude_deg));
    let tilt_deg = between(0.05, 0.5);
    // G = κ_M F makes ρ = |G|/(w Ω_h).
    let size = between(0.0, draw.rho) * SPEEDS[0] * horizontal / f64::to_radians(tilt_deg).sin();
    let direction = between(0.0, TAU);
    let sensor = MolecularConfiguration {
        force_rad_s2_g: [size * direction.cos(), size * direction.sin()],
        high_pass_hz: draw.high_pass_hz,
        lag_s: between(0.05, 0.3),
    };
    let gyro = GyroConfiguration {
        n_deg_sqrt_h: draw.n,
        bias_sigma_deg_h: 3.0,
        axis_elevation_rad: between(-draw.alpha_deg, draw.alpha_deg).to_radians(),
        molecular: Some(sensor),
        ..GyroConfiguration::default()
    };
    let instruments = InstrumentsConfiguration {
        latitude_deg,
        azimuth_deg: between(0.0, 360.0),
        rate_hz: 50.0,
        gyro,
        accelerometer: AccelerometerConfiguration {
            noise_m_s2_sqrt_hz: 2.5e-5,
            ..AccelerometerConfiguration::default()
        },
        ..InstrumentsConfiguration::default()
    };
    let mut setting = molecular(latitude_deg, draw.n);
    // Ten time constants of the high-pass, which passes a part of every change of speed.
    setting.sensor.settle_seconds =
        if draw.high_pass_hz > 0.0 { Seconds(60.0) } else { Seconds(5.0) };
    let first = Ripple { relative: 0.002, phase_rad: between(0.0, TAU) };
    Case {
        instruments: instruments.leaning(tilt_deg, between(0.0, 360.0)),
        unevenness: Unevenness { first, ..Unevenness::default() },
        start_rad: 0.0,
        segments: Vec::new(),
        setting,
        is_by_encoder: true,
    }
}

/// Errors in °, and over σ; every run has an azimuth.
fn campaign(draw: Draw) -> (Vec<f64>, Vec<f64>) {
    over(0..60, |seed| {
        let case = case(seed, draw);
        let procedure =
            Procedure { turns: 8, ..Procedure::new(&SPEEDS.map(RadiansPerSecond), Seconds(0.02)) };
        let driven = driven(&case, procedure, seed, |_, _| {});
        let run = case.error(driven.session.conclusion().expect("it has ended"));
        let (error, sigma) = run.expect("a healthy sensor");
        (error.to_degrees(), error / sigma)
    })
    .into_iter()
    .unzip()
}

#[test]
fn two_speeds_free_a_lagging_sensor_within_a_true_sigma_and_without_bias() {
    for high_pass_hz in [0.0, 0.03] {
        let draw = Draw { rho: 0.3, high_pass_hz, n: 0.002, alpha_deg: 0.0 };
        let (errors, ratios) = campaign(draw);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        println!("{draw:?}: {:.3} of σ, mean {mean:.4}°", rms(&ratios));
        // 60 draws tell an RMS to 9 %, and the mean of 0.06° to 0.008°.
        assert!((0.75..1.25).contains(&rms(&ratios)) && mean.abs() < 0.02, "{draw:?}");
    }
}

#[test]
fn without_noise_two_speeds_leave_hundredths_of_a_degree() {
    // What an axis out of the plane makes of an unevenness of 0.2 % is learnt beside the turn's frequency.
    for (alpha_deg, allowed_deg) in [(0.0, 0.003), (0.5, 0.05)] {
        let draw = Draw { rho: 0.3, high_pass_hz: 0.03, n: 1e-5, alpha_deg };
        let (errors, _) = campaign(draw);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        println!("{draw:?}: RMS {:.4}°, mean {mean:.4}°", rms(&errors));
        assert!(rms(&errors) < allowed_deg && mean.abs() < 0.01, "{draw:?}");
    }
}

/// Two independent results A and B at the speeds a < b give (b² B − a² A)/(b² − a²): the variance of this for times
/// `slow` and `fast`, of results whose variance is one over the time.
fn variance([a, b]: [f64; 2], slow: f64, fast: f64) -> f64 {
    (b.powi(4) / fast + a.powi(4) / slow) / (b * b - a * a).powi(2)
}

#[test]
fn a_session_at_two_speeds_is_bounded_and_its_noise_near_the_least_of_its_length() {
    for ratio in [1.2, 1.5, 2.0, 2.5, 5.0, 10.0, 25.0] {
        let (a, b) = (0.02 * TAU, 0.02 * TAU * ratio);
        let speeds = [b, a].map(RadiansPerSecond);
        let given = Procedure { turns: 400, ..Procedure::new(&speeds, Seconds(0.02)) };
        let [fast, slow] =
            [0, 1].map(|index| f64::from(given.turns_at(index)) * TAU / speeds[index].0);
        assert!(fast < 4.001 * slow, "{ratio}: {fast} s and {slow} s");
        // The least over all ways to divide the same time.
        let parts = (1..10_000).map(|part| f64::from(part) * 1e-4 * (slow + fast));
        let least = parts.map(|part| variance([a, b], part, slow + fast - part));
        let least = least.fold(f64::INFINITY, f64::min);
        let excess = (variance([a, b], slow, fast) / least).sqrt();
        let most = if ratio <= 2.0 { 1.001 } else { 1.12 };
        assert!(excess < most, "{ratio}: {excess} times the least σ");
    }
}
