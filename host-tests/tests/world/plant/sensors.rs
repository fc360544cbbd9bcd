//! What the instruments show: the geometry, their noise at their own rates, their limits.

use std::f64::consts::PI;

use embassy_time::Instant;
use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::disturbance::{Disturbance, Effect};
use hal_mock::earth::Site;
use hal_mock::environment::{AnalogueInput, ForceInput};
use hal_mock::gyro::{DEGREE_PER_HOUR, GyroConfiguration};
use hal_mock::instruments::{Instruments, InstrumentsConfiguration};
use hal_mock::plant::{Plant, PlantConfiguration};
use hal_mock::stage::minimum_jerk;
use hal_mock::temperature::TemperatureConfiguration;

use super::{EXACT, assert_near, at, rate, rotate, tilted};

#[test]
fn a_standing_plant_shows_earth_and_gravity_at_its_stage_angle() {
    let configuration = PlantConfiguration { instruments: tilted(), ..Default::default() };
    let mut plant = Plant::new(&configuration, 1);
    rotate(&mut plant, 0.0, 0.0, 0.5, 2.0);
    let input = Site::new(55.0_f64.to_radians(), &tilted().attitude()).on_platform(1.0);
    assert_near(rate(&mut plant, 3.0), input.rate_rad_s[0], 1e-16);
    for (shown, expected) in plant.force_g(at(3.0)).iter().zip(input.force_m_s2) {
        assert_near(*shown, expected / 9.806_65, 1e-13);
    }
    assert_eq!(plant.temperature_c(at(3.0)), 25.0);
    let truth = plant.truth();
    assert_eq!(truth.attitude, tilted().attitude());
    assert_near(truth.axis_rad_s, input.rate_rad_s[0], 1e-16);
}

#[test]
fn a_standing_plant_reads_bit_for_bit_what_its_instruments_read() {
    let gyro = GyroConfiguration {
        n_deg_sqrt_h: 0.02,
        b_deg_h: 0.1,
        bias_sigma_deg_h: 3.0,
        scale_sigma: 0.01,
        ..GyroConfiguration::default()
    };
    let accelerometer =
        AccelerometerConfiguration { noise_m_s2_sqrt_hz: 2e-4, ..Default::default() };
    let temperature = TemperatureConfiguration { rise_c: 4.0, noise_c: 0.1, ..Default::default() };
    let instruments = InstrumentsConfiguration { gyro, accelerometer, temperature, ..tilted() };
    let configuration =
        PlantConfiguration { instruments, gyro_volts_per_rad_s: 1.0, ..Default::default() };
    let mut plant = Plant::new(&configuration, 9);
    let mut alone = Instruments::with_accelerometer_at(&instruments, 125.0, 9);
    for step in 0..1000 {
        let now = Instant::from_micros(step * 10_000);
        let sample = alone.sample(now.as_micros() as f64 * 1e-6, &Effect::default());
        assert_eq!(plant.volts(now), sample.rate_rad_s);
        assert_eq!(plant.force_g(now), sample.force_m_s2.map(|force| force / 9.806_65));
        assert_eq!(plant.temperature_c(now), sample.temperature_c);
    }
    let (one, other) = (plant.truth(), alone.truth());
    assert_eq!(one, other);
    assert!(one.gyro_bias_rad_s != 0.0 && one.gyro_scale_error != 0.0);
}

#[test]
fn the_parts_of_the_instruments_read_apart_are_those_read_together() {
    let gyro = GyroConfiguration { n_deg_sqrt_h: 0.02, ..GyroConfiguration::default() };
    let accelerometer =
        AccelerometerConfiguration { noise_m_s2_sqrt_hz: 2e-4, ..Default::default() };
    let temperature = TemperatureConfiguration { rise_c: 4.0, noise_c: 0.1, ..Default::default() };
    let configuration = InstrumentsConfiguration { gyro, accelerometer, temperature, ..tilted() };
    let mut together = Instruments::new(&configuration, 3);
    let mut apart = Instruments::new(&configuration, 3);
    let effect = Effect { rate_rad_s: 1e-4, force_m_s2: [0.1, 0.2, 0.3] };
    for step in 0..500 {
        let seconds = f64::from(step) * 0.01;
        let stage = minimum_jerk(0.0, 1.0, 3.0, seconds);
        together.turn(stage);
        apart.turn(stage);
        let sample = together.sample(seconds, &effect);
        // In another order than the sample reads them.
        assert_eq!(apart.temperature(seconds), sample.temperature_c);
        assert_eq!(apart.force(&effect), sample.force_m_s2);
        assert_eq!(apart.rate(seconds, &effect), sample.rate_rad_s);
        assert_eq!(apart.shown_rad(), sample.stage_rad);
    }
}

/// Mean and variance.
fn moments(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (mean, values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count)
}

/// Means over so many values each.
fn means(values: &[f64], of: usize) -> Vec<f64> {
    values.chunks_exact(of).map(|chunk| moments(chunk).0).collect()
}

#[test]
fn gyro_and_accelerometer_keep_their_densities_at_their_own_rates() {
    let gyro = GyroConfiguration { n_deg_sqrt_h: 0.02, ..GyroConfiguration::default() };
    let accelerometer =
        AccelerometerConfiguration { noise_m_s2_sqrt_hz: 2e-4, ..Default::default() };
    let seconds = 400_u64;
    for (gyro_hz, force_hz) in [(100_u64, 250_u64), (1000, 125)] {
        let instruments = InstrumentsConfiguration {
            rate_hz: gyro_hz as f64,
            gyro,
            accelerometer,
            ..Default::default()
        };
        let configuration = PlantConfiguration {
            instruments,
            accelerometer_hz: force_hz as f64,
            ..Default::default()
        };
        let mut plant = Plant::new(&configuration, 4);
        let (mut rates, mut forces) = (Vec::new(), Vec::new());
        // Milliseconds, on which both kinds of readings fall.
        for tick in 1..=1000 * seconds {
            let now = Instant::from_millis(tick);
            if tick % (1000 / gyro_hz) == 0 {
                rates.push(plant.volts(now) / (0.05 * 180.0 / PI) / DEGREE_PER_HOUR);
            }
            if tick % (1000 / force_hz) == 0 {
                forces.push(plant.force_g(now)[1] * 9.806_65);
            }
        }
        assert_eq!(rates.len() as u64, gyro_hz * seconds);
        // N = 0.02 °/√h is 1.2 °/h/√Hz (two-sided); the relative error of a variance of n is √(2/n).
        let (white, force) = (1.44 * gyro_hz as f64, 4e-8 * 0.5 * force_hz as f64);
        assert_near(moments(&rates).1 / white, 1.0, 4.0 * (2.0 / rates.len() as f64).sqrt());
        assert_near(moments(&forces).1 / force, 1.0, 4.0 * (2.0 / forces.len() as f64).sqrt());
        // A mean over one second has the same noise at any rate.
        let (rates, forces) = (means(&rates, gyro_hz as usize), means(&forces, force_hz as usize));
        let tolerance = 4.0 * (2.0 / seconds as f64).sqrt();
        assert_near(moments(&rates).1 / 1.44, 1.0, tolerance);
        assert_near(moments(&forces).1 / 2e-8, 1.0, tolerance);
    }
}

#[test]
fn the_converter_adds_its_own_noise_and_moves_no_other() {
    let gyro = GyroConfiguration { n_deg_sqrt_h: 0.02, ..GyroConfiguration::default() };
    let instruments = InstrumentsConfiguration { gyro, ..Default::default() };
    let quiet = PlantConfiguration { instruments, ..Default::default() };
    let mut noisy = Plant::new(&PlantConfiguration { converter_noise_v: 3e-6, ..quiet }, 5);
    let mut quiet = Plant::new(&quiet, 5);
    let differences: Vec<f64> = (0..100_000)
        .map(Instant::from_millis)
        .map(|now| noisy.volts(now) - quiet.volts(now))
        .collect();
    let (mean, variance) = moments(&differences);
    assert_near(mean, 0.0, 4.0 * 3e-6 / 1e5_f64.sqrt());
    assert_near(variance / 9e-12, 1.0, 4.0 * 2e-5_f64.sqrt());
}

#[test]
fn a_rate_beyond_its_range_clips_the_gyro_and_a_slammed_door_shakes_it_for_a_moment() {
    let disturbances = [Disturbance::overload(1.0, 0.5), Disturbance::door_slam(3.0)];
    let configuration = PlantConfiguration { disturbances: &disturbances, ..Default::default() };
    let mut plant = Plant::new(&configuration, 1);
    let still = plant.volts(at(0.0));
    let level = plant.force_g(at(0.0));
    let mut shaken: f64 = 0.0;
    for tick in 1..5000 {
        let now = Instant::from_millis(tick);
        let volts = plant.volts(now);
        match tick {
            1000..1500 => assert_near(volts, 2.0, EXACT),
            3000..=3400 => shaken = shaken.max((plant.force_g(now)[2] - level[2]).abs()),
            _ => assert_eq!((volts, plant.force_g(now)), (still, level)),
        }
    }
    assert_near(shaken, 0.08 / 9.81, 0.001);
}
