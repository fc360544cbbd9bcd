//! What the host makes of a vehicle's rows: period, samples, noise, averages, sensors at their limit.

use std::f64::consts::TAU;

use hal_mock::noise::Generator;
use host::methods::stops::averaging::Averages;
use host::methods::stops::noise::{self, White};
use host::methods::stops::samples::{rows, samples};
use host::recording::period::period_s;
use host::recording::{Body, ImuRow, ImuSample, StaticRow};
use proptest::prelude::*;

const EARTH_RATE: f64 = 7.292_115e-5;

/// Rows at these times with these rates.
fn at(times: impl Iterator<Item = f64>, rates: impl Fn(usize) -> [f64; 3]) -> Vec<ImuRow> {
    let row = |(index, time_s)| ImuRow {
        line: index as u64 + 1,
        time_s,
        sample: ImuSample { rates_rad_s: rates(index), force_m_s2: [0.0, 0.0, -9.81] },
        force_is_new: true,
    };
    times.enumerate().map(row).collect()
}

/// Times at a rate, rounded to so many parts of a second.
fn times(rate: f64, parts: f64, count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(move |index| (f64::from(index) / rate * parts).round() / parts)
}

#[test]
fn rounded_times_leave_the_nominal_period() {
    let still = |_| [0.0; 3];
    let rounded = at(times(285.714_286, 1e4, 20_000), still);
    assert_eq!(period_s(Some(285.714_286), &rounded, |row| row.time_s), 1.0 / 285.714_286);
    // Without a rate in the header their mean counts, to a last digit in all of them together.
    let own = period_s(None, &rounded, |row| row.time_s);
    assert!((own * 285.714_286 - 1.0).abs() < 1e-5, "{own}");
}

#[test]
fn a_rate_that_the_times_leave_behind_is_not_believed() {
    let rows = at(times(100.3, 1e9, 10_000), |_| [0.0; 3]);
    // Thirty samples in a hundred seconds.
    let found = period_s(Some(100.0), &rows, |row| row.time_s);
    assert!((found * 100.3 - 1.0).abs() < 1e-6, "{found}");
}

#[test]
fn a_missing_sample_does_not_stretch_the_period() {
    let mut rows = at(times(50.0, 1e9, 1000), |_| [0.0; 3]);
    rows.remove(500);
    assert_eq!(period_s(Some(50.0), &rows, |row| row.time_s), 0.02);
    let own = period_s(None, &rows, |row| row.time_s);
    assert!((own / 0.02 - 1.0).abs() < 1e-9, "{own}");
}

#[test]
fn the_first_sample_begins_at_the_sessions_zero() {
    let rows = at(times(25.0, 1e9, 3).map(|time| time + 100.0), |_| [0.0; 3]);
    let ends: Vec<u64> = samples(&rows, 0.04).map(|sample| sample.time.0).collect();
    assert_eq!(ends, [40_000, 80_000, 120_000]);
}

#[test]
fn a_record_at_rest_with_all_columns_is_taken_too() {
    let imu = ImuSample { rates_rad_s: [1e-5; 3], force_m_s2: [0.0, 0.0, -9.8] };
    let full = StaticRow { line: 3, time_s: 0.5, rate_rad_s: None, imu: Some(imu) };
    let body = Body::Static(vec![full]);
    let taken = rows(&body).expect("it has three gyros").into_owned();
    assert_eq!(taken, [ImuRow { line: 3, time_s: 0.5, sample: imu, force_is_new: true }]);
    let one_gyro = StaticRow { rate_rad_s: Some(1e-5), imu: None, ..full };
    assert!(rows(&Body::Static(vec![full, one_gyro])).is_none());
}

/// White noise on a slow sway, at 25 Hz: N in rad/√s, accelerometers in m/s²/√Hz.
fn noisy(walk: f64, density: f64, sway: f64, seconds: u32) -> Vec<ImuRow> {
    let mut chance = Generator::new(7);
    let sigma = [walk * 5.0, density * 12.5_f64.sqrt()];
    let mut three = |sigma: f64, slow: f64| [0; 3].map(|_: i32| slow + sigma * chance.gaussian());
    let row = |index: u32| {
        let time_s = f64::from(index + 1) / 25.0;
        let slow = sway * (TAU * 0.4 * time_s).sin();
        let sample = ImuSample {
            rates_rad_s: three(sigma[0], slow),
            force_m_s2: three(sigma[1], 9.8 * slow),
        };
        ImuRow { line: u64::from(index) + 1, time_s, sample, force_is_new: true }
    };
    (0..25 * seconds).map(row).collect()
}

/// The noise that rows show; zero where there is nothing to find it from.
fn estimate(rows: &[ImuRow], stops_s: Option<&[[f64; 2]]>, period_s: f64) -> White {
    noise::at_rest(rows, stops_s, period_s).unwrap_or_default()
}

#[test]
fn noise_that_is_not_stated_is_found_within_a_tenth_also_under_sway() {
    let [walk, density] = [1.5e-5, 2.8e-3];
    for sway in [0.0, 0.01] {
        let found = estimate(&noisy(walk, density, sway, 1000), None, 0.04);
        let ratios = [found.angle_random_walk / walk, found.force / density];
        println!("{ratios:?}");
        assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() < 0.1), "{ratios:?}");
    }
}

#[test]
fn noise_is_taken_where_the_vehicle_stood() {
    let mut rows = noisy(1.5e-5, 2.8e-3, 0.0, 300);
    for (index, row) in rows.iter_mut().enumerate().filter(|(_, row)| row.time_s > 60.0) {
        row.sample.rates_rad_s[0] += if index % 2 == 0 { 0.1 } else { -0.1 };
    }
    let found = estimate(&rows, Some(&[[0.0, 60.0]]), 0.04);
    assert!((found.angle_random_walk / 1.5e-5 - 1.0).abs() < 0.1, "{found:?}");
    // Sensors without noise have none.
    let silent = estimate(&at(times(25.0, 1e9, 5000), |_| [1e-5; 3]), None, 0.04);
    assert_eq!((silent.angle_random_walk, silent.force), (0.0, 0.0));
}

#[test]
fn few_rows_are_no_reason_to_panic() {
    for count in 0..9 {
        let rows = at(times(25.0, 1e9, count), |_| [1e-5; 3]);
        let found = estimate(&rows, None, period_s(None, &rows, |row| row.time_s));
        assert!(found.angle_random_walk >= 0.0 && found.force >= 0.0);
        assert_eq!(samples(&rows, 0.04).count(), count as usize);
    }
}

/// What a body at rest feels of the Earth's rotation and of its own weight.
fn at_rest(azimuth: f64, pitch: f64, roll: f64, latitude: f64) -> [[f64; 3]; 2] {
    let turned = |[north, east, down]: [f64; 3]| {
        let (sine, cosine) = azimuth.sin_cos();
        let (along, across) = (cosine * north + sine * east, cosine * east - sine * north);
        let (sine, cosine) = pitch.sin_cos();
        let (forward, below) = (cosine * along - sine * down, sine * along + cosine * down);
        let (sine, cosine) = roll.sin_cos();
        [forward, cosine * across + sine * below, cosine * below - sine * across]
    };
    let rate = [EARTH_RATE * latitude.cos(), 0.0, -EARTH_RATE * latitude.sin()];
    [turned(rate), turned([0.0, 0.0, -9.81])]
}

proptest! {
    #[test]
    fn averaging_finds_the_azimuth_of_a_body_at_rest(
        azimuth in 0.0..TAU, pitch in -1.0..1.0_f64, roll in -3.0..3.0_f64, latitude in -1.4..1.4_f64,
    ) {
        let [rate, force] = at_rest(azimuth, pitch, roll, latitude);
        let mut averages = Averages::default();
        for _ in 0..3 {
            averages.push(rate, force);
        }
        let error = (averages.azimuth() - azimuth).rem_euclid(TAU);
        prop_assert!(error.min(TAU - error) < 1e-9, "{error}");
    }

    #[test]
    fn no_rotation_is_lost_between_rows_and_samples(
        rates in prop::collection::vec(prop::array::uniform3(-40.0..40.0_f64), 1..200),
    ) {
        let rows = at(times(250.0, 1e9, rates.len() as u32), |index| rates[index]);
        let mut sums = [0.0; 3];
        for sample in samples(&rows, 0.004) {
            for (sum, turned) in sums.iter_mut().zip(sample.turned) {
                *sum += turned.rad();
            }
        }
        for (axis, sum) in sums.iter().enumerate() {
            let expected: f64 = rates.iter().map(|rate| rate[axis] * 0.004).sum();
            prop_assert!((sum - expected).abs() < 5e-9, "{sum} {expected}");
        }
    }
}

/// Whether a gyro or an accelerometer is reported to stand at its limit in any sample.
fn is_clipped(rows: &[ImuRow]) -> bool {
    samples(rows, 0.04).any(|sample| {
        sample.force.is_none() || sample.turned.iter().any(|turned| turned.is_saturated())
    })
}

#[test]
fn a_gyro_at_its_limit_is_reported_and_a_steady_one_is_not() {
    let wave = |index: usize| 0.6 * (TAU * 0.05 * index as f64 * 0.04).sin();
    let cut = |limit: f64| {
        at(times(25.0, 1e9, 5000), |index| [0.0, wave(index).clamp(-limit, limit), 0.0])
    };
    assert!(is_clipped(&cut(0.5)));
    assert!(!is_clipped(&cut(1.0)));
    // A constant rate of ideal gyros, and one that is coarsely written.
    assert!(!is_clipped(&at(times(25.0, 1e9, 500), |_| [0.3; 3])));
    let coarse = at(times(25.0, 1e9, 5000), |index| [(wave(index) * 50.0).round() / 50.0; 3]);
    assert!(!is_clipped(&coarse));
    // More than the increments hold: 8.59 rad.
    let rows = at((1..9).map(f64::from), |index| [9.0 + index as f64, 0.0, 0.0]);
    assert!(samples(&rows, 1.0).all(|sample| sample.turned[0].is_saturated()));
}

#[test]
fn an_accelerometer_at_its_limit_is_reported_and_gravity_is_not() {
    let mut rows = at(times(25.0, 1e9, 5000), |_| [0.0; 3]);
    assert!(!is_clipped(&rows));
    for (index, row) in rows.iter_mut().enumerate() {
        let shaken = 12.0 * (0.02 * index as f64).sin();
        row.sample.force_m_s2[2] = (-9.81 - shaken).max(-19.6);
    }
    assert!(is_clipped(&rows));
}
