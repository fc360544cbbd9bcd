//! A vehicle that stands: closed forms, sway above an axis, people.

use std::f64::consts::TAU;

use hal_mock::sensor_fault::{SensorFailure, SensorFault};
use hal_mock::vehicle::{Event, Leg, Stop, Vehicle, VehicleConfiguration};

use super::{EARTH, assert_near, assert_vector, run, sway, wave};

/// Normal gravity at 45°, m/s² (WGS 84; H. Moritz, Geodetic Reference System, for WGS 84's constants).
const GRAVITY_45: f64 = 9.806_197_769_4;

fn still(seconds: f64, pitch_deg: f64, roll_deg: f64) -> Stop {
    Stop { seconds, pitch_deg, roll_deg, ..Stop::default() }
}

fn at_45<'a>(legs: &'a [Leg], events: &'a [Event]) -> VehicleConfiguration<'a> {
    VehicleConfiguration {
        latitude_deg: 45.0,
        azimuth_deg: 130.0,
        legs,
        events,
        ..Default::default()
    }
}

#[test]
fn at_rest_gyros_feel_earth_and_accelerometers_gravity() {
    let legs = [Leg::Stop(still(2.0, 3.0, -2.0))];
    let (samples, truth) = run(&at_45(&legs, &[]), 0);
    assert_eq!(samples.len(), 200);
    let [azimuth, pitch, roll] = [130.0_f64, 3.0, -2.0].map(f64::to_radians);
    let (north, up) = (EARTH * 0.5_f64.sqrt(), EARTH * 0.5_f64.sqrt());
    let (sp, cp, sr, cr) = (pitch.sin(), pitch.cos(), roll.sin(), roll.cos());
    let (sa, ca) = azimuth.sin_cos();
    let rate = [
        north * ca * cp + up * sp,
        north * (sr * sp * ca - cr * sa) - up * sr * cp,
        north * (cr * sp * ca + sr * sa) - up * cr * cp,
    ];
    for (index, sample) in samples.iter().enumerate() {
        assert_near(sample.time_s, (index + 1) as f64 * 0.01, 1e-12);
        assert_vector(sample.turned_rad.map(|angle| angle * 100.0), rate, 1e-15);
        let force = [GRAVITY_45 * sp, -GRAVITY_45 * sr * cp, -GRAVITY_45 * cr * cp];
        assert_vector(sample.force_m_s2, force, 1e-8);
    }
    assert_eq!(truth.displacement_m, [0.0; 2]);
    assert_near(truth.attitude.azimuth_rad, azimuth, 1e-15);
}

/// Roll a·sin Ωt about a level axis to the north, sensors h above it: rate aΩ cos Ωt and Earth's, to the
/// right the force g sin and h times the angular acceleration, down the centripetal one.
#[test]
fn sensors_above_the_axis_of_a_sway_are_thrown_to_the_side() {
    let (amplitude, angular, above) = (0.5_f64.to_radians(), TAU * 0.7, 1.2);
    let still_wave = wave([0.0; 3], 0.0, 0.0);
    let rolling = sway([wave([0.0, 0.0, 0.5], 0.7, 0.0), still_wave, still_wave]);
    let legs = [Leg::Stop(Stop { sway: rolling, ..still(20.0, 0.0, 0.0) })];
    let configuration = VehicleConfiguration {
        azimuth_deg: 0.0,
        rate_hz: 1000.0,
        lever_m: [0.0, 0.0, -above],
        ..at_45(&legs, &[])
    };
    for sample in Vehicle::new(&configuration, 0) {
        let (sine, cosine) = (angular * (sample.time_s - 0.0005)).sin_cos();
        let (roll, rate) = (amplitude * sine, amplitude * angular * cosine);
        let second = -amplitude * angular * angular * sine;
        assert_near(sample.turned_rad[0] * 1000.0, rate + EARTH * 0.5_f64.sqrt(), 1e-7);
        let right = -GRAVITY_45 * roll.sin() + above * second;
        assert_near(sample.force_m_s2[1], right, 2e-5);
        let down = -GRAVITY_45 * roll.cos() + above * rate * rate;
        assert_near(sample.force_m_s2[2], down, 2e-5);
    }
}

#[test]
fn a_slammed_door_leaves_nothing_behind_and_a_person_a_new_level() {
    let legs = [Leg::Stop(still(60.0, 1.0, 1.0))];
    let events = [Event::door_slam(10.0), Event::person_boards(30.0)];
    let configuration = at_45(&legs, &events);
    let mut vehicle = Vehicle::new(&configuration, 0);
    let mut shaken = 0;
    let mut levels = [0.0; 2];
    while let Some(sample) = vehicle.next() {
        let calm =
            (9.995..13.0).contains(&sample.time_s) || (29.995..32.0).contains(&sample.time_s);
        let rate =
            sample.turned_rad.map(|angle| angle.abs() * 100.0).into_iter().fold(0.0, f64::max);
        assert!(calm || rate < 1e-4, "{rate} rad/s at {} s", sample.time_s);
        shaken += usize::from(rate > 1e-3);
        let level = vehicle.truth().attitude.roll_rad.to_degrees();
        levels[usize::from(sample.time_s > 20.0)] = level;
    }
    assert!((10..100).contains(&shaken), "{shaken} samples");
    assert_near(levels[0], 1.0, 1e-6);
    assert_near(levels[1], 1.06, 1e-9);
}

#[test]
fn faults_are_where_they_are_asked_for() {
    let legs = [Leg::Stop(still(10.0, 1.0, 1.0))];
    let faults = [
        SensorFault { failure: SensorFailure::Gap, from_s: 2.0, until_s: 3.0 },
        SensorFault { failure: SensorFailure::Saturated(1), from_s: 4.0, until_s: 4.5 },
        SensorFault { failure: SensorFailure::Stuck(3), from_s: 6.0, until_s: 7.0 },
    ];
    let mut configuration =
        VehicleConfiguration { faults: &faults, gyro_full_scale_rad_s: 0.5, ..at_45(&legs, &[]) };
    configuration.accelerometer.noise_m_s2_sqrt_hz = 1e-3;
    configuration.accelerometer.full_scale_m_s2 = Some(20.0);
    let (samples, _) = run(&configuration, 1);
    assert_eq!(samples.len(), 900);
    let clipped: Vec<_> = samples.iter().filter(|sample| sample.is_clipped).collect();
    assert_eq!(clipped.len(), 50);
    assert!(clipped.iter().all(|sample| (sample.turned_rad[1] - 0.005).abs() < 1e-15));
    let stuck = samples.iter().filter(|sample| (6.0..7.0).contains(&sample.time_s));
    let stuck: Vec<_> = stuck.map(|sample| sample.force_m_s2).collect();
    assert!(stuck.iter().all(|force| force[0] == stuck[0][0] && stuck.len() == 100));
    assert!(stuck.iter().any(|force| force[1] != stuck[0][1]));
}
