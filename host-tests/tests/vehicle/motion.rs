//! A vehicle under way: attitude, position, force, coning.

use std::f64::consts::TAU;

use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Drive, Event, Leg, Stop, Vehicle, VehicleConfiguration, VehicleSample};

use super::{
    EARTH, Quaternion, assert_near, assert_vector, attitude_in_space, integrated, run, sway, wave,
};

/// Half an hour with everything in it, without noise.
fn hard() -> Scenario {
    let mut day = Scenario::stops(7, 3, 60.0, 810.0);
    day.vehicle = VehicleConfiguration {
        latitude_deg: 52.0,
        azimuth_deg: 213.0,
        lever_m: [0.3, -0.2, -1.0],
        ..VehicleConfiguration::default()
    };
    let events = [12.3, 700.0, 1790.0].map(Event::door_slam);
    day.events.extend_from_slice(&events).unwrap();
    day.events.push(Event::person_boards(30.0)).unwrap();
    day
}

/// Angle between the attitude that the increments lead to and the true one, rad.
fn attitude_error(configuration: &VehicleConfiguration) -> f64 {
    let start = attitude_in_space(&Vehicle::new(configuration, 0).truth(), 0.0);
    let (samples, truth) = run(configuration, 0);
    let end = start * integrated(&samples);
    let seconds = samples.last().unwrap().time_s;
    (end.inverse() * attitude_in_space(&truth, seconds)).angle()
}

#[test]
fn increments_at_a_high_rate_lead_from_the_true_attitude_at_the_start_to_that_at_the_end() {
    let day = hard();
    let at = |rate_hz| attitude_error(&VehicleConfiguration { rate_hz, ..day.configuration() });
    // The two-sample coning of the oracle leaves a part that falls with the fourth power of the rate.
    let (coarse, fine) = (at(200.0), at(2000.0));
    println!("{coarse:e} {fine:e}");
    assert!(fine < 1e-8, "{fine:e} rad");
    assert!(coarse < 1e-5, "{coarse:e} rad");
}

#[test]
fn increments_of_a_slow_sample_are_sums_of_those_of_quick_ones() {
    let day = hard();
    let configuration = day.configuration();
    let slow = VehicleConfiguration { rate_hz: 100.0, ..configuration };
    let quick = VehicleConfiguration { rate_hz: 1000.0, ..configuration };
    let (slow, _) = run(&slow, 0);
    let (quick, _) = run(&quick, 0);
    let mut accumulated = [0.0; 3];
    for (slow, quick) in slow.iter().zip(quick.chunks_exact(10)) {
        for axis in 0..3 {
            let turned: f64 = quick.iter().map(|sample| sample.turned_rad[axis]).sum();
            accumulated[axis] += slow.turned_rad[axis] - turned;
            let force: f64 = quick.iter().map(|sample| sample.force_m_s2[axis]).sum();
            assert_near(slow.force_m_s2[axis], force / 10.0, 1e-4);
        }
        assert_vector(accumulated, [0.0; 3], 1e-6);
    }
}
