//! A vehicle under way: its increments lead to its attitude; up-vectors; coning.

use std::f64::consts::TAU;

use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Event, Leg, Stop, Vehicle, VehicleConfiguration, VehicleSample};

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
    let slams = [12.345_6, 700.000_3, 1790.0].map(Event::door_slam);
    day.events.extend(slams);
    day.events.extend([Event::person_boards(30.0)]);
    day
}

/// Angle between the attitude that the increments lead to and the true one, rad.
fn attitude_error(configuration: &VehicleConfiguration) -> f64 {
    let start = attitude_in_space(&Vehicle::new(configuration, 0).truth(), 0.0);
    let (samples, truth) = run(configuration, 0);
    let end = start * integrated(&samples);
    let seconds = samples.len() as f64 / configuration.rate_hz;
    (end.inverse() * attitude_in_space(&truth, seconds)).angle()
}

#[test]
fn increments_lead_from_the_true_attitude_at_the_start_to_that_at_the_end() {
    let day = hard();
    let at = |rate_hz| attitude_error(&VehicleConfiguration { rate_hz, ..day.configuration() });
    // At 100 Hz what is left is the oracle's own coning term, which shrinks with its fourth power.
    let (coarse, fine) = (at(100.0), at(400.0));
    assert!(coarse < 1e-6, "{coarse:e} rad");
    assert!(fine < 2e-9, "{fine:e} rad");
}

#[test]
fn increments_of_a_slow_sample_are_sums_of_those_of_quick_ones() {
    let day = hard();
    let at = |rate_hz| run(&VehicleConfiguration { rate_hz, ..day.configuration() }, 0).0;
    let (slow, quick) = (at(25.0), at(500.0));
    let mut accumulated = [0.0; 3];
    for (slow, quick) in slow.iter().zip(quick.chunks_exact(20)) {
        for (axis, accumulated) in accumulated.iter_mut().enumerate() {
            let turned: f64 = quick.iter().map(|sample| sample.turned_rad[axis]).sum();
            *accumulated += slow.turned_rad[axis] - turned;
            let force: f64 = quick.iter().map(|sample| sample.force_m_s2[axis]).sum();
            assert_near(slow.force_m_s2[axis], force / 20.0, 2e-5);
        }
        // A door that slams in the middle of a panel costs most.
        assert_vector(accumulated, [0.0; 3], 2e-7);
    }
}

/// From one millisecond to the next neither rate nor force changes by more than what shakes the vehicle
/// asks for: brakes that come at once would give 1 m/s², weaving that does 0.1 rad/s.
#[test]
fn nothing_jumps() {
    let mut day = Scenario::stops(7, 3, 20.0, 180.0);
    day.vehicle = VehicleConfiguration { lever_m: [0.3, -0.2, -1.0], ..Default::default() };
    let quick = VehicleConfiguration { rate_hz: 1000.0, ..day.configuration() };
    let mut vehicle = Vehicle::new(&quick, 0);
    let mut before = vehicle.next().unwrap();
    for sample in vehicle {
        for axis in 0..3 {
            let rate = (sample.turned_rad[axis] - before.turned_rad[axis]) * 1000.0;
            assert!(rate.abs() < 0.008, "{rate} rad/s at {} s", sample.time_s);
            let force = sample.force_m_s2[axis] - before.force_m_s2[axis];
            assert!(force.abs() < 0.35, "{force} m/s² at {} s", sample.time_s);
        }
        before = sample;
    }
}

/// Up, of which only the direction is asked, over inertial axes as the mean of a second's forces.
fn up(samples: &[VehicleSample], from: Quaternion) -> [f64; 3] {
    let (mut attitude, mut sum) = (from, [0.0; 3]);
    for sample in samples {
        let half = Quaternion::of(sample.turned_rad.map(|angle| 0.5 * angle));
        let force = (attitude * half).turn(sample.force_m_s2);
        sum = [0, 1, 2].map(|axis| sum[axis] + force[axis]);
        attitude = attitude * Quaternion::of(sample.turned_rad);
    }
    sum
}

fn angle_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    let cross = super::cross(a, b);
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    length(cross).atan2((0..3).map(|axis| a[axis] * b[axis]).sum())
}

/// Radii of curvature of the WGS 84 ellipsoid, m, from its axes a and b.
fn radii(latitude: f64) -> [f64; 2] {
    let [a, b] = [6_378_137.0_f64, 6_356_752.314_245_179];
    let squared = (a * latitude.cos()).powi(2) + (b * latitude.sin()).powi(2);
    [(a * b).powi(2) / squared.powf(1.5), a * a / squared.sqrt()]
}

#[test]
fn up_turns_in_space_by_what_earth_and_displacement_make_of_it() {
    let mut day = Scenario::siap(3);
    day.vehicle = VehicleConfiguration { latitude_deg: 52.0, rate_hz: 200.0, ..Default::default() };
    let (samples, truth) = run(&day.configuration(), 0);
    let second = |at_s: usize| &samples[at_s * 200..(at_s + 1) * 200];
    let carried = integrated(&samples[..1010 * 200]);
    let turned = angle_between(up(second(0), Quaternion::NONE), up(second(1010), carried));

    let start = 52.0_f64.to_radians();
    let [north, east] = truth.displacement_m;
    let [meridian, _] = radii(start);
    let mean = start + 0.5 * north / meridian;
    let [meridian, transverse] = radii(mean);
    let (end, east) = (start + north / meridian, east / (transverse * mean.cos()));
    let longitude = east + EARTH * 1010.0;
    let above = |latitude: f64, longitude: f64| {
        let (sine, cosine) = latitude.sin_cos();
        [cosine * longitude.cos(), cosine * longitude.sin(), sine]
    };
    let expected = angle_between(above(start, 0.0), above(end, longitude));
    assert!(truth.displacement_m.iter().any(|way| way.abs() > 1000.0));
    assert_near(turned, expected, 2e-7);
}

/// Pitch a·cos Ωt and roll a·sin Ωt at one heading: a cone.
fn cone(amplitude_deg: f64, hertz: f64, rate_hz: f64) -> (Vec<VehicleSample>, f64) {
    let circle = [
        wave([0.0, amplitude_deg, 0.0], hertz, TAU / 4.0),
        wave([0.0, 0.0, amplitude_deg], hertz, 0.0),
        wave([0.0; 3], 0.0, 0.0),
    ];
    let stop = Stop { seconds: 60.0, sway: sway(circle), ..Stop::default() };
    let legs = [Leg::Stop(stop)];
    let configuration = VehicleConfiguration { rate_hz, legs: &legs, ..Default::default() };
    let (samples, _) = run(&configuration, 0);
    (samples, attitude_error(&configuration))
}

/// P. G. Savage 1998 and before him J. E. Bortz 1971: of the cone's a²Ω/2 a second, increments of h
/// seconds taken for rotation vectors lose the part sin(Ωh)/(Ωh).
#[test]
fn increments_of_a_cone_differ_from_rotation_vectors_as_the_closed_form_says() {
    let (amplitude, hertz) = (0.5_f64.to_radians(), 2.0);
    let speed = 0.5 * amplitude * amplitude * TAU * hertz;
    let (samples, corrected) = cone(0.5, hertz, 25.0);
    // On the equator, facing north, Earth turns about forward, which the cone spreads evenly.
    let down: f64 = samples.iter().map(|sample| sample.turned_rad[2]).sum();
    assert_near(down.abs(), speed * 60.0, speed * 60.0 * 1e-3);

    let naive = samples
        .iter()
        .fold(Quaternion::NONE, |attitude, sample| attitude * Quaternion::of(sample.turned_rad));
    let earth = Quaternion::of([EARTH * 60.0, 0.0, 0.0]);
    let start = Quaternion::euler(0.0, amplitude, 0.0);
    let error = ((earth * start).inverse() * (start * naive)).angle();
    let angle = TAU * hertz / 25.0;
    let expected = speed * 60.0 * (1.0 - angle.sin() / angle);
    assert_near(error, expected, expected * 0.01);
    // The oracle's own correction, cross products of neighbours over twelve, leaves 5 % of it here.
    let half = (0.5 * angle).sin().powi(2);
    let left = expected - speed * 60.0 * 2.0 / 3.0 * half * angle.sin() / angle;
    assert_near(corrected, left, 0.005 * expected);
}
