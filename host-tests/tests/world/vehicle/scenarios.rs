//! Days drawn from seeds are plausible and no two alike.

use std::f64::consts::TAU;

use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Leg, Vehicle, VehicleConfiguration};

use super::assert_near;

/// A fast run of a day: attitude and position do not depend on the sample rate.
fn slow(day: &Scenario) -> VehicleConfiguration<'_> {
    VehicleConfiguration { rate_hz: 10.0, ..day.configuration() }
}

#[test]
fn drives_go_some_kilometres_to_any_heading_between_tilted_stops() {
    let (mut far, mut headings) = (0, [0; 4]);
    for seed in 0..40 {
        let day = Scenario::siap(seed);
        let configuration = slow(&day);
        assert_near(configuration.seconds(), 1020.0, 1e-9);
        assert_eq!(configuration.stops().collect::<Vec<_>>(), [[0.0, 60.0], [960.0, 1020.0]]);
        let mut vehicle = Vehicle::new(&configuration, seed);
        let mut way = 0.0;
        while vehicle.next().is_some() {
            let truth = vehicle.truth();
            let speed = truth.velocity_m_s[0].hypot(truth.velocity_m_s[1]);
            assert!(speed < 20.0);
            assert!(truth.attitude.pitch_rad.abs().max(truth.attitude.roll_rad.abs()) < 0.15);
            way += 0.1 * speed;
        }
        let truth = vehicle.truth();
        assert_eq!(truth.velocity_m_s, [0.0; 3]);
        assert!((5_000.0..13_000.0).contains(&way), "{way} m");
        far += usize::from(truth.displacement_m[0].hypot(truth.displacement_m[1]) > 1000.0);
        let turn = (truth.attitude.azimuth_rad - configuration.azimuth_deg.to_radians()) / TAU;
        headings[(turn.rem_euclid(1.0) * 4.0) as usize] += 1;
        let Some(Leg::Stop(last)) = day.legs.last() else { panic!("it ends with a stop") };
        assert!(last.pitch_deg.abs() <= 3.0 && last.roll_deg.abs() <= 3.0);
        assert_near(truth.attitude.pitch_rad.to_degrees(), last.pitch_deg, 1e-6);
    }
    assert!(far > 30, "{far} of 40 are a kilometre away");
    assert!(headings.iter().all(|quarter| *quarter > 3), "{headings:?}");
}

#[test]
fn there_are_as_many_stops_as_are_asked_for() {
    for count in [1, 2, 3, 10] {
        let day = Scenario::stops(1, count, 60.0, 420.0);
        let stops: Vec<_> = day.configuration().stops().collect();
        assert_eq!(stops.len(), count);
        for (index, [from_s, to_s]) in stops.into_iter().enumerate() {
            assert_near(from_s, 480.0 * index as f64, 1e-9);
            assert_near(to_s - from_s, 60.0, 1e-9);
        }
    }
}

/// Vehicles turn, bend and weave; their gyros end at 40 °/s.
#[test]
fn however_short_a_drive_is_no_vehicle_turns_faster_than_its_gyros_measure() {
    const RATE_HZ: f64 = 20.0;
    let mut fastest: f64 = 0.0;
    for drive_s in [60.0, 120.0, 180.0, 300.0, 600.0] {
        for seed in 0..12 {
            let mut day = Scenario::stops(seed, 3, 10.0, drive_s);
            day.go_on(seed, drive_s, 0.5 * drive_s, 10.0);
            let day = VehicleConfiguration { rate_hz: RATE_HZ, ..day.configuration() };
            let mut vehicle = Vehicle::new(&day, seed);
            let mut before = vehicle.truth().attitude.azimuth_rad;
            while vehicle.next().is_some() {
                let azimuth_rad = vehicle.truth().attitude.azimuth_rad;
                let rate = (azimuth_rad - before).to_degrees() * RATE_HZ;
                assert!(rate.abs() < 40.0, "{rate} °/s, drive of {drive_s} s, seed {seed}");
                (fastest, before) = (fastest.max(rate.abs()), azimuth_rad);
            }
        }
    }
    assert!(fastest > 30.0, "they dare {fastest} °/s only");
}

#[test]
fn a_parked_vehicle_sways_by_half_a_degree_and_stays() {
    let day = Scenario::parked(8, 300.0);
    assert!((3..=10).contains(&day.events.len()));
    let configuration = VehicleConfiguration { rate_hz: 25.0, ..day.configuration() };
    let Some(Leg::Stop(ground)) = day.legs.first() else { panic!("it is parked") };
    let mut vehicle = Vehicle::new(&configuration, 8);
    let mut most: f64 = 0.0;
    while vehicle.next().is_some() {
        let truth = vehicle.truth();
        most = most.max((truth.attitude.roll_rad.to_degrees() - ground.roll_deg).abs());
        let turned = truth.attitude.azimuth_rad.to_degrees() - configuration.azimuth_deg;
        assert!(turned.abs() < 0.01, "{turned}");
    }
    assert!((0.4..0.55).contains(&most), "{most}");
    assert_eq!(vehicle.truth().displacement_m, [0.0; 2]);
}
