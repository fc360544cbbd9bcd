//! The simulated spinning body against closed forms, and against the integration of its equations by
//! scipy's DOP853 (tolerance 10⁻¹³, from corner to corner of the profiles).

mod board;
mod faults;

use std::f64::consts::{PI, TAU};

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::spin::profile::Profile;
use hal_mock::spin::trajectory::Forces;
use hal_mock::spin::{SpinConfiguration, SpinSample, SpinTruth, SpinWorld};
use proptest::prelude::*;

/// Standard gravity, m/s².
const G: f64 = 9.806_65;

/// All samples of a body, each with its truth.
fn flown(configuration: &SpinConfiguration, seed: u64) -> Vec<(SpinSample, SpinTruth)> {
    let mut world = SpinWorld::new(configuration, seed);
    std::iter::from_fn(|| Some((world.next()?, world.truth()))).collect()
}

/// The sample at a time in s, which is one of the body's.
fn at(samples: &[(SpinSample, SpinTruth)], time_s: f64) -> (SpinSample, SpinTruth) {
    let found = samples.iter().find(|(sample, _)| (sample.time_s - time_s).abs() < 1e-9);
    *found.unwrap_or_else(|| panic!("no sample at {time_s} s"))
}

fn assert_near(value: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((value - expected).abs() <= tolerance, "{what}: {value}, expected {expected}");
}

/// A flight with everything in it, whose accelerometers sit on the axis.
fn crooked() -> SpinConfiguration<'static> {
    SpinConfiguration {
        rate_hz: 1000.0,
        seconds: 1.0,
        speed_m_s: 250.0,
        pitch_deg: 10.0,
        course_deg: 30.0,
        roll_rad: 0.3,
        forces: Forces {
            gravity_m_s2: G,
            drag_per_s: 0.05,
            lift_m_s2: Profile(&[(0.0, 14.0), (0.5, 14.0), (0.6, 0.0), (0.8, -5.0), (1.2, 20.0)]),
            side_m_s2: Profile(&[(0.0, 2.0), (1.0, -1.0)]),
        },
        spin_rad_s: Profile(&[(0.0, 500.0), (0.4, 500.0), (0.7, 200.0), (1.0, 0.0)]),
        radius_m: [0.0; 2],
        ..SpinConfiguration::default()
    }
}

/// Time, then speed, pitch, course, north, up, east of [`crooked`] by scipy.
const SCIPY: [[f64; 7]; 4] = [
    [
        0.25,
        246.466_126_292_275,
        0.178_910_075_966_70,
        0.525_260_322_424_25,
        52.879_225_616_958,
        10.909_229_673_288,
        30.592_656_681_135,
    ],
    [
        0.55,
        242.269_524_707_697,
        0.183_534_506_515_46,
        0.526_257_204_175_62,
        115.242_283_653_897,
        24.143_848_271_530,
        66.785_367_115_490,
    ],
    [
        0.75,
        239.509_707_796_230,
        0.175_075_797_029_39,
        0.526_298_983_104_59,
        156.226_701_656_381,
        32.765_009_232_909,
        90.596_681_884_256,
    ],
    [
        0.99,
        236.259_129_859_251,
        0.165_166_407_268_89,
        0.525_673_899_355_12,
        204.894_591_122_168,
        42.372_075_464_171,
        118.854_329_413_430,
    ],
];

#[test]
fn the_flight_is_that_of_an_independent_integration() {
    let samples = flown(&crooked(), 1);
    for [time_s, speed, pitch, course, north, up, east] in SCIPY {
        let (_, truth) = at(&samples, time_s);
        let flight = truth.flight;
        assert_near(flight.speed_m_s, speed, 1e-9, "speed");
        assert_near(flight.pitch_rad, pitch, 1e-11, "pitch");
        assert_near(flight.course_rad, course, 1e-11, "course");
        for (value, expected) in flight.position_m.into_iter().zip([north, up, east]) {
            assert_near(value, expected, 1e-9, "position");
        }
    }
}

/// Time, then roll; rates about x, y, z; forces along y, z of [`crooked`]: numpy, with the attitude as a
/// matrix, its derivative by differences, and the force as the acceleration less gravity in body axes.
const NUMPY: [[f64; 7]; 4] = [
    [0.25, 125.3, 499.999_082_81, -0.011_018_39, 0.014_690_29, 12.639_512_02, 6.148_596_26],
    [0.55, 264.05, 349.999_731_83, -0.003_123_70, -0.010_547_43, 6.969_214_19, -0.743_339_43],
    [
        0.75,
        314.466_666_666_667,
        166.666_851_30,
        -0.015_942_43,
        -0.053_667_63,
        -3.649_857_35,
        0.896_404_68,
    ],
    [
        0.99,
        335.266_666_666_667,
        6.667_351_02,
        -0.011_760_69,
        0.004_337_82,
        -5.110_454_68,
        -4.699_976_38,
    ],
];

#[test]
fn rates_and_forces_are_those_of_the_turning_axes() {
    let samples = flown(&crooked(), 1);
    for [time_s, roll, x, y, z, up, right] in NUMPY {
        let (sample, truth) = at(&samples, time_s);
        assert_near(truth.roll_rad, roll, 1e-10, "roll");
        for (value, expected) in sample.rate_rad_s.into_iter().zip([x, y, z]) {
            assert_near(value, expected, 5e-8, "rate");
        }
        for (value, expected) in sample.force_m_s2.into_iter().zip([up, right]) {
            assert_near(value, expected, 2e-8, "force");
        }
    }
}

#[test]
fn accelerometers_off_the_axis_feel_the_square_of_the_rate_as_well() {
    let on_axis = flown(&crooked(), 1);
    let off = flown(&SpinConfiguration { radius_m: [0.02, -0.01], ..crooked() }, 1);
    for ((centred, _), (sample, _)) in on_axis.iter().zip(&off) {
        let square = sample.rate_rad_s[0] * sample.rate_rad_s[0];
        assert_near(sample.force_m_s2[0] - centred.force_m_s2[0], -0.02 * square, 1e-9, "y");
        assert_near(sample.force_m_s2[1] - centred.force_m_s2[1], 0.01 * square, 1e-9, "z");
    }
}

#[test]
fn a_body_that_its_lift_holds_up_stays_level_and_slows_down_as_its_drag_says() {
    let forces = Forces { drag_per_s: 0.2, ..SpinConfiguration::default().forces };
    let configuration =
        SpinConfiguration { rate_hz: 100.0, seconds: 3.0, forces, ..SpinConfiguration::default() };
    for (sample, truth) in flown(&configuration, 1) {
        let part = (-0.2 * sample.time_s).exp();
        assert_near(truth.flight.pitch_rad, 0.0, 1e-15, "pitch");
        assert_near(truth.flight.speed_m_s, 300.0 * part, 1e-10, "speed");
        assert_near(truth.flight.position_m[0], 300.0 / 0.2 * (1.0 - part), 1e-9, "way");
    }
}

#[test]
fn without_lift_and_drag_it_falls_on_a_parabola_and_feels_nothing_across() {
    let forces = Forces { gravity_m_s2: G, ..Forces::default() };
    let configuration = SpinConfiguration {
        rate_hz: 100.0,
        seconds: 3.0,
        pitch_deg: 30.0,
        radius_m: [0.0; 2],
        forces,
        ..SpinConfiguration::default()
    };
    for (sample, truth) in flown(&configuration, 1) {
        let (level, time_s) = (300.0 * (PI / 6.0).cos(), sample.time_s);
        let climb = 150.0 - G * time_s;
        let flight = truth.flight;
        assert_near(flight.position_m[0], level * time_s, 1e-8, "north");
        assert_near(flight.position_m[1], 150.0 * time_s - 0.5 * G * time_s * time_s, 1e-8, "up");
        assert_near(flight.pitch_rad, climb.atan2(level), 1e-11, "pitch");
        assert_eq!(sample.force_m_s2, [0.0; 2]);
    }
}

#[test]
fn the_papers_body_turns_four_times_through_each_extremum_in_a_hundredth_of_a_second() {
    let samples = flown(&SpinConfiguration::default(), 1);
    assert_eq!(samples.len(), 10_000);
    // One turn takes 100 samples; its y is greatest at γ = 0 and least at π, its z at 3π/2 and π/2.
    let extremum = |axis: usize, sign: f64| {
        let turn = samples[..100].iter();
        let force = |pair: &&(SpinSample, SpinTruth)| sign * pair.0.force_m_s2[axis];
        let found = turn.max_by(|a, b| force(a).total_cmp(&force(b))).expect("has samples");
        found.1.roll_rad
    };
    let rolls = [extremum(0, 1.0), extremum(0, -1.0), extremum(1, 1.0), extremum(1, -1.0)];
    for (roll, expected) in rolls.into_iter().zip([0.0, PI, 1.5 * PI, 0.5 * PI]) {
        assert_near(roll, expected, 1e-9, "roll");
    }
    assert_near(samples[9_999].1.roll_rad, 0.9999 * 100.0 * TAU, 1e-9, "roll at the end");
}

#[test]
fn a_gyro_with_a_scale_error_runs_36_degrees_ahead_in_the_papers_second() {
    let mut configuration = SpinConfiguration::default();
    configuration.gyros[0].scale_error = 1e-3;
    let samples = flown(&configuration, 1);
    let turned: f64 = samples.iter().map(|(sample, _)| sample.rate_rad_s[0] * 1e-4).sum();
    let ahead = (turned - 100.0 * TAU).to_degrees();
    assert_near(ahead, 36.0, 1e-6, "the paper's line without correction");
    assert_eq!(samples[0].1.gyro_scale_error, [1e-3, 0.0, 0.0]);
}

#[test]
fn noise_has_the_deviation_that_is_stated_and_every_sensor_its_own() {
    let noisy = SpinConfiguration {
        seconds: 2.0,
        // 0.6 °/√h at 10 kHz: 0.6 °/60 · 100 = 1 °/s a sample.
        gyros: [GyroConfiguration { n_deg_sqrt_h: 0.6, ..GyroConfiguration::default() }; 3],
        // 1.5 m/s² a sample.
        accelerometer: AccelerometerConfiguration {
            noise_m_s2_sqrt_hz: 1.5 / 5000.0_f64.sqrt(),
            ..AccelerometerConfiguration::default()
        },
        ..SpinConfiguration::default()
    };
    let quiet = flown(&SpinConfiguration { seconds: 2.0, ..SpinConfiguration::default() }, 7);
    let noise: Vec<[f64; 5]> = flown(&noisy, 7)
        .iter()
        .zip(&quiet)
        .map(|((sample, _), (clean, _))| {
            let rate = |axis: usize| sample.rate_rad_s[axis] - clean.rate_rad_s[axis];
            let force = |axis: usize| sample.force_m_s2[axis] - clean.force_m_s2[axis];
            [rate(0), rate(1), rate(2), force(0), force(1)]
        })
        .collect();
    let mean =
        |of: &dyn Fn(&[f64; 5]) -> f64| noise.iter().map(of).sum::<f64>() / noise.len() as f64;
    let sigmas = [1.0_f64.to_radians(); 3].into_iter().chain([1.5; 2]);
    for (channel, sigma) in sigmas.enumerate() {
        // 20 000 samples: the deviation is good to 0.5 % (1σ), the mean to 0.7 % of it.
        let deviation = mean(&|row| row[channel] * row[channel]).sqrt();
        assert_near(deviation / sigma, 1.0, 0.02, "deviation");
        assert_near(mean(&|row| row[channel]) / sigma, 0.0, 0.03, "mean");
        for other in 0..channel {
            let product = mean(&|row| row[channel] * row[other]);
            assert_near(product / (sigma * sigma), 0.0, 0.1 * sigma.max(1.0), "correlation");
        }
    }
}

#[test]
fn one_seed_gives_one_flight_and_another_seed_another() {
    let mut configuration = SpinConfiguration { seconds: 0.1, ..SpinConfiguration::default() };
    configuration.gyros[0].n_deg_sqrt_h = 1.0;
    configuration.gyros[0].scale_sigma = 1e-3;
    let first = flown(&configuration, 3);
    assert_eq!(first, flown(&configuration, 3));
    let other = flown(&configuration, 4);
    assert_ne!(first[0].1.gyro_scale_error, other[0].1.gyro_scale_error);
    // What is not random stays.
    assert!(first.iter().zip(&other).all(|(a, b)| a.1.roll_rad == b.1.roll_rad));
}

proptest! {
    #[test]
    fn the_integral_of_a_profile_is_that_of_many_small_steps(
        points in prop::collection::vec((-1.0..3.0_f64, -10.0..10.0_f64), 0..6),
        until in 0.0..4.0_f64,
    ) {
        let mut points = points;
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let profile = Profile(&points);
        let step = until / 40_000.0;
        let steps = (0..40_000).map(|i| profile.value((f64::from(i) + 0.5) * step) * step);
        let sum: f64 = steps.sum();
        prop_assert!((profile.integral(until) - sum).abs() < 0.01, "{sum}");
    }
}
