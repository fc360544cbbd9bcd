//! A parked vehicle with three dithered laser gyros that count increments: what real recordings of north show.
//!
//! Their samples scatter by far more than their N: quantisation and dither are noise of the angle, which comes
//! back with the next sample. A bias of 0.01 °/h is 0.05° of azimuth, N of 0.002 °/√h another 0.07° in a minute.

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Event, Stop, Vehicle};
use host::methods::asked::Asked;
use host::methods::stops::{Replay, replay};
use host::output::azimuth_error;
use host::recording::{Body, Header, ImuRow, ImuSample};
use rayon::prelude::*;

use crate::support::campaign::{Extent, campaigns};

/// N, °/√h, and 1σ of the biases, °/h.
const GYRO: [f64; 2] = [0.002, 0.01];
const LATITUDE_DEG: f64 = 42.0;
const AZIMUTH_DEG: f64 = 90.6;
const RATE_HZ: f64 = 100.0;
const HALF_AN_HOUR_S: f64 = 1800.0;
const MINUTE_S: f64 = 60.0;
/// Seeds, each with four dithers.
const SEEDS: u64 = 8;

/// Gyros that show increments of 0.1″, dithered by so much of an angle, °, arcsec.
fn gyro(dither_arcsec: f64) -> GyroConfiguration {
    let [n_deg_sqrt_h, bias_sigma_deg_h] = GYRO;
    GyroConfiguration {
        n_deg_sqrt_h,
        bias_sigma_deg_h,
        q_arcsec: 0.1 / 12.0_f64.sqrt(),
        dither_arcsec,
        ..GyroConfiguration::default()
    }
}

/// A parked vehicle with doors that are slammed now and then.
fn parked(seconds: f64, dither_arcsec: f64) -> Scenario {
    let stop = Stop { seconds, pitch_deg: 0.6, roll_deg: -1.1, ..Stop::default() };
    let mut day = Scenario::standing(LATITUDE_DEG, AZIMUTH_DEG, stop);
    day.vehicle.rate_hz = RATE_HZ;
    day.vehicle.gyros = [gyro(dither_arcsec); 3];
    day.vehicle.accelerometer = AccelerometerConfiguration {
        noise_m_s2_sqrt_hz: 5e-4,
        bias_sigma_m_s2: 5e-4,
        ..AccelerometerConfiguration::default()
    };
    let slams = (0..8).map(|index| Event::door_slam(11.0 + 170.0 * f64::from(index)));
    day.events.extend(slams.filter(|_| seconds > MINUTE_S));
    day
}

fn replayed(day: &Scenario, seed: u64, n_deg_sqrt_h: Option<f64>) -> Replay {
    let rows = Vehicle::new(&day.configuration(), seed).enumerate().map(|(index, sample)| ImuRow {
        line: index as u64 + 1,
        time_s: sample.time_s,
        sample: ImuSample {
            rates_rad_s: sample.turned_rad.map(|angle| angle * RATE_HZ),
            force_m_s2: sample.force_m_s2,
        },
        force_is_new: true,
    });
    let header = Header {
        latitude_deg: Some(LATITUDE_DEG),
        rate_hz: Some(RATE_HZ),
        gyro_n_deg_sqrt_h: n_deg_sqrt_h,
        gyro_bias_deg_h: Some(GYRO[1]),
        ..Header::default()
    };
    let options = Asked { method: Some("static"), ..Asked::default() };
    replay(&header, &Body::Imu(rows.collect()), &options).expect("it replays")
}

/// Errors and σ, °, over seeds and dithers of 0 to 1″.
fn answers(seeds: u64, seconds: f64, n_deg_sqrt_h: Option<f64>) -> Vec<[f64; 2]> {
    let dithers = [0.0, 0.1, 0.3, 1.0];
    let all: Vec<(u64, f64)> =
        (1..=seeds).flat_map(|seed| dithers.map(|dither| (seed, dither))).collect();
    all.into_par_iter()
        .map(|(seed, dither)| {
            let replay = replayed(&parked(seconds, dither), seed, n_deg_sqrt_h);
            let verdict = replay.session.conclusion().expect("it has ended").verdict;
            let azimuth = verdict.unwrap_or_else(|why| panic!("{seed}, {dither}″: {why}"));
            let error = azimuth_error(azimuth.angle.degrees(), AZIMUTH_DEG);
            println!(
                "{seconds} s, {dither}″, {seed}: {error:+.3}° ± {:.3}°",
                azimuth.sigma.degrees()
            );
            [error, azimuth.sigma.degrees()]
        })
        .collect()
}

/// All within 3 σ, which is neither above the most nor below half of what the gyros can do.
fn check(answers: &[[f64; 2]], extent: Extent, least_deg: f64, most_deg: f64) {
    for [error, sigma] in answers {
        assert!(error.abs() <= 3.0 * sigma, "{error}° ± {sigma}°");
        assert!((least_deg..=most_deg).contains(sigma), "± {sigma}°");
    }
    let ratios: f64 = answers.iter().map(|[error, sigma]| (error / sigma).powi(2)).sum();
    let rms = (ratios / answers.len() as f64).sqrt();
    // Of eight, less than 0.25 or more than 1.8 comes once in ten thousand.
    let band = if extent == Extent::Whole { 0.4..1.5 } else { 0.25..1.8 };
    assert!(band.contains(&rms), "{rms}");
}

/// A tenth is two seeds: eight answers.
fn seeds(extent: Extent) -> u64 {
    if extent == Extent::Whole { SEEDS } else { 2 }
}

campaigns! {
    half_an_hour_gives_north_to_a_twentieth_of_a_degree_with_n_stated;
    half_an_hour_gives_north_to_a_twentieth_of_a_degree_with_n_from_the_recording;
}

fn half_an_hour_gives_north_to_a_twentieth_of_a_degree_with_n_stated(extent: Extent) {
    check(&answers(seeds(extent), HALF_AN_HOUR_S, Some(GYRO[0])), extent, 0.04, 0.15);
}

fn half_an_hour_gives_north_to_a_twentieth_of_a_degree_with_n_from_the_recording(extent: Extent) {
    check(&answers(seeds(extent), HALF_AN_HOUR_S, None), extent, 0.04, 0.15);
}

#[test]
fn a_minute_gives_north_to_a_tenth_of_a_degree_with_n_stated() {
    check(&answers(SEEDS, MINUTE_S, Some(GYRO[0])), Extent::Whole, 0.06, 0.3);
}

#[test]
fn a_minute_gives_north_to_a_tenth_of_a_degree_with_n_from_the_recording() {
    check(&answers(SEEDS, MINUTE_S, None), Extent::Whole, 0.06, 0.3);
}

#[test]
fn dither_and_increments_are_not_taken_for_angle_random_walk() {
    let replay = replayed(&parked(HALF_AN_HOUR_S, 1.0), 3, None);
    let walk = replay.session.setting.site.noise.model().angle_random_walk;
    let n = walk.0 / orientation::units::DEGREE_PER_SQRT_HOUR;
    println!("N {n:.5} °/√h");
    assert!((n / GYRO[0] - 1.0).abs() < 0.25, "{n} °/√h");
}
