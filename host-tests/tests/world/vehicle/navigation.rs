//! Forces and increments navigate a free body in inertial space to where the vehicle says it is.

use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Vehicle, VehicleConfiguration, VehicleTruth};

use super::{EARTH, Quaternion, assert_near, attitude_in_space, cross};

const LEVER: [f64; 3] = [0.5, -0.3, -1.0];

fn sum(a: [f64; 3], b: [f64; 3], times: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] + b[axis] * times)
}

/// Place on the WGS 84 ellipsoid at a height, and up there, over inertial axes.
fn place(latitude: f64, longitude: f64, height: f64) -> ([f64; 3], [f64; 3]) {
    let [a, b] = [6_378_137.0_f64, 6_356_752.314_245_179];
    let squared = (a * latitude.cos()).powi(2) + (b * latitude.sin()).powi(2);
    let (sine, cosine) = latitude.sin_cos();
    let up = [cosine * longitude.cos(), cosine * longitude.sin(), sine];
    let across = a * a / squared.sqrt();
    let ground = [across * up[0], across * up[1], b * b / squared.sqrt() * up[2]];
    (sum(ground, up, height), up)
}

/// Gravitation at a place, m/s²: normal gravity by Somigliana's formula in its form with both ends
/// (9.7803253359 and 9.8321849379 m/s², WGS 84), less what Earth's rotation takes.
fn gravitation(latitude: f64, place: [f64; 3], up: [f64; 3]) -> [f64; 3] {
    let [a, b] = [6_378_137.0_f64, 6_356_752.314_245_179];
    let (sine, cosine) = (latitude.sin().powi(2), latitude.cos().powi(2));
    let gravity = (a * 9.780_325_335_9 * cosine + b * 9.832_184_937_9 * sine)
        / (a * a * cosine + b * b * sine).sqrt();
    let [x, y, _] = place;
    let square = EARTH * EARTH;
    sum([-square * x, -square * y, 0.0], up, -gravity)
}

/// The sensors' place: the vehicle's and the lever turned.
fn sensors(truth: &VehicleTruth, seconds: f64, height: f64) -> [f64; 3] {
    let position = truth.position;
    let (place, _) = place(position.latitude_rad, position.longitude_rad + EARTH * seconds, height);
    sum(place, attitude_in_space(truth, seconds).turn(LEVER), 1.0)
}

/// Five minutes from rest to rest. Earth rate, transport rate, Coriolis, gravity's direction, the lever
/// and the way are all in it: an error of 10⁻⁵ m/s² would be half a metre. What is left is the oracle's
/// own and falls with the square of the step: 0.43 m at 400 Hz, 2 mm at 6400 Hz.
#[test]
fn a_free_body_that_feels_the_forces_arrives_where_the_vehicle_does() {
    let mut day = Scenario::stops(11, 2, 20.0, 260.0);
    let rate_hz = 1600.0;
    day.vehicle = VehicleConfiguration {
        latitude_deg: 52.0,
        azimuth_deg: 100.0,
        rate_hz,
        lever_m: LEVER,
        ..VehicleConfiguration::default()
    };
    let configuration = day.configuration();
    let mut vehicle = Vehicle::new(&configuration, 0);
    let (step, mut truth, mut height) = (1.0 / rate_hz, vehicle.truth(), 0.0);
    let mut attitude = attitude_in_space(&truth, 0.0);
    let mut body = sensors(&truth, 0.0, 0.0);
    let mut velocity = cross([0.0, 0.0, EARTH], body);
    let (mut before, mut way) = ([0.0; 3], 0.0);
    while let Some(sample) = vehicle.next() {
        let turned = sample.turned_rad;
        let coned = sum(turned, cross(before, turned), 1.0 / 12.0);
        let half = attitude * Quaternion::of(coned.map(|angle| 0.5 * angle));
        let position = truth.position;
        let longitude = position.longitude_rad + EARTH * (sample.time_s - 0.5 * step);
        let (centre, up) = place(position.latitude_rad, longitude, height);
        let gravity = gravitation(position.latitude_rad, centre, up);
        let acceleration = sum(half.turn(sample.force_m_s2), gravity, 1.0);
        body = sum(sum(body, velocity, step), acceleration, 0.5 * step * step);
        velocity = sum(velocity, acceleration, step);
        attitude = attitude * Quaternion::of(coned);
        before = turned;
        let slow = truth.velocity_m_s[2];
        truth = vehicle.truth();
        height -= 0.5 * (slow + truth.velocity_m_s[2]) * step;
        way += truth.velocity_m_s[0].hypot(truth.velocity_m_s[1]) * step;
    }
    let arrived = sensors(&truth, configuration.seconds(), height);
    let miss: f64 = (0..3).map(|axis| (body[axis] - arrived[axis]).powi(2)).sum::<f64>().sqrt();
    assert!(way > 1500.0, "{way} m");
    assert_near(miss, 0.0, 0.05);
}
