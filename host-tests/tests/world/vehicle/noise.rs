//! The sensors' noise: as large as configured, each axis and each source by itself, one seed one run.

use hal_mock::gyro::GyroConfiguration;
use hal_mock::vehicle::scenario::{Scenario, silicon};
use hal_mock::vehicle::{Leg, Stop, VehicleConfiguration, VehicleSample};

use super::{assert_near, run};

fn standing(seconds: f64) -> [Leg; 1] {
    [Leg::Stop(Stop { seconds, ..Stop::default() })]
}

fn noisy(gyro: GyroConfiguration, legs: &[Leg]) -> VehicleConfiguration<'_> {
    VehicleConfiguration {
        latitude_deg: 50.0,
        gyros: [gyro; 3],
        accelerometer: silicon(),
        legs,
        ..VehicleConfiguration::default()
    }
}

/// What the sensors add to what perfect ones show.
fn errors(configuration: &VehicleConfiguration, seed: u64) -> Vec<VehicleSample> {
    let perfect = VehicleConfiguration {
        gyros: [GyroConfiguration::default(); 3],
        accelerometer: hal_mock::accelerometer::AccelerometerConfiguration::default(),
        ..*configuration
    };
    let (mut samples, _) = run(configuration, seed);
    for (sample, perfect) in samples.iter_mut().zip(run(&perfect, seed).0) {
        for axis in 0..3 {
            sample.turned_rad[axis] -= perfect.turned_rad[axis];
            sample.force_m_s2[axis] -= perfect.force_m_s2[axis];
        }
    }
    samples
}

/// Mean of the product of two columns.
fn product(
    samples: &[VehicleSample],
    a: impl Fn(&VehicleSample) -> f64,
    b: impl Fn(&VehicleSample) -> f64,
) -> f64 {
    samples.iter().map(|sample| a(sample) * b(sample)).sum::<f64>() / samples.len() as f64
}

#[test]
fn white_noise_has_the_stated_density_and_no_axis_shares_it() {
    let white = GyroConfiguration { n_deg_sqrt_h: 0.05, ..GyroConfiguration::default() };
    let samples = errors(&noisy(white, &standing(1000.0)), 5);
    // N·√h a sample is 0.05°/60·√0.01; 10⁵ samples tell a variance to 0.45 % (1σ).
    let variance = (0.05_f64.to_radians() / 60.0).powi(2) * 0.01;
    // 0.01 m/s² at 25 Hz is twice as much at 100 Hz.
    let force = 0.02_f64.powi(2);
    for a in 0..3 {
        for b in 0..3 {
            let expected = f64::from(u8::from(a == b));
            let turned = product(&samples, |s| s.turned_rad[a], |s| s.turned_rad[b]);
            assert_near(turned / variance, expected, 0.02);
            let shaken = product(&samples, |s| s.force_m_s2[a], |s| s.force_m_s2[b]);
            assert_near(shaken / force, expected, 0.02);
            let both = product(&samples, |s| s.turned_rad[a], |s| s.force_m_s2[b]);
            assert_near(both / (variance * force).sqrt(), 0.0, 0.02);
        }
    }
}

#[test]
fn drawn_biases_and_scales_are_those_of_the_truth_and_spread_as_stated() {
    let drawn = GyroConfiguration {
        bias_sigma_deg_h: 1.0,
        scale_sigma: 1e-3,
        ..GyroConfiguration::default()
    };
    let short = standing(0.02);
    let mut configuration = noisy(drawn, &short);
    configuration.accelerometer.bias_sigma_m_s2 = 0.01;
    configuration.accelerometer.noise_m_s2_sqrt_hz = 0.0;
    configuration.latitude_deg = 90.0 - 1e-9;
    let (mut square, mut scales, mut forces, mut crossed) = (0.0, 0.0, 0.0, 0.0);
    let count = 2000;
    for seed in 0..count {
        let (samples, truth) = run(&configuration, seed);
        let rate = samples[1].turned_rad.map(|angle| angle * 100.0);
        assert_near(rate[0], truth.gyro_bias_rad_s[0], 1e-12);
        let earth = -7.292_115e-5 * (1.0 + truth.gyro_scale_error[2]);
        assert_near(rate[2], truth.gyro_bias_rad_s[2] + earth, 1e-12);
        assert_near(samples[1].force_m_s2[1], truth.accelerometer_bias_m_s2[1], 1e-9);
        square += truth.gyro_bias_rad_s.map(|bias| bias * bias).iter().sum::<f64>();
        crossed += truth.gyro_bias_rad_s[0] * truth.gyro_bias_rad_s[1];
        scales += truth.gyro_scale_error.map(|scale| scale * scale).iter().sum::<f64>();
        forces += truth.accelerometer_bias_m_s2.map(|bias| bias * bias).iter().sum::<f64>();
    }
    let draws = 3.0 * count as f64;
    let bias = (1.0_f64.to_radians() / 3600.0).powi(2);
    // 6000 draws tell a variance to 1.8 % (1σ).
    assert_near(square / draws / bias, 1.0, 0.08);
    assert_near(3.0 * crossed / draws / bias, 0.0, 0.1);
    assert_near(scales / draws / 1e-6, 1.0, 0.08);
    assert_near(forces / draws / 1e-4, 1.0, 0.08);
}

#[test]
fn switching_one_noise_off_does_not_move_the_others() {
    let all = GyroConfiguration {
        n_deg_sqrt_h: 0.05,
        b_deg_h: 0.3,
        k_deg_h_sqrt_h: 1.0,
        bias_sigma_deg_h: 1.0,
        ..GyroConfiguration::default()
    };
    let short = standing(5.0);
    let with = |gyro| noisy(gyro, &short);
    let whole = errors(&with(all), 9);
    let parts = [
        GyroConfiguration { n_deg_sqrt_h: 0.0, ..all },
        GyroConfiguration { b_deg_h: 0.0, k_deg_h_sqrt_h: 0.0, bias_sigma_deg_h: 0.0, ..all },
    ]
    .map(|gyro| errors(&with(gyro), 9));
    for (index, sample) in whole.iter().enumerate() {
        for axis in 0..3 {
            let sum: f64 = parts.iter().map(|part| part[index].turned_rad[axis]).sum();
            assert_near(sum, sample.turned_rad[axis], 1e-15);
        }
        assert_eq!(parts[0][index].force_m_s2, sample.force_m_s2);
    }
    let mut one = with(all);
    one.gyros[1] = GyroConfiguration::default();
    for (sample, one) in whole.iter().zip(errors(&one, 9)) {
        assert_eq!(one.turned_rad[0], sample.turned_rad[0]);
        assert_eq!(one.turned_rad[1], 0.0);
        assert_eq!(one.turned_rad[2], sample.turned_rad[2]);
    }
}

#[test]
fn one_seed_is_one_run_and_another_seed_another() {
    let first = |seed| {
        let day = Scenario::siap(seed);
        run(&VehicleConfiguration { rate_hz: 25.0, ..day.configuration() }, seed)
    };
    assert_eq!(first(4), first(4));
    assert_ne!(first(4).0[100], first(5).0[100]);
}
