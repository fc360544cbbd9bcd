//! Holds the simulated vehicle to independent oracles: its increments integrated anew, closed forms at
//! rest, Earth's rotation and displacement, coning, noise.

mod board;
mod motion;
mod navigation;
mod noise;
mod rest;
mod scenarios;

use hal_mock::plant::sway::{SwayComponent, SwayConfiguration};
use hal_mock::vehicle::{Vehicle, VehicleConfiguration, VehicleSample, VehicleTruth};

use crate::support::assert_near;

/// Earth's rotation rate, rad/s (WGS 84).
const EARTH: f64 = 7.292_115e-5;

#[track_caller]
fn assert_vector(value: [f64; 3], expected: [f64; 3], tolerance: f64) {
    for (value, expected) in value.into_iter().zip(expected) {
        assert_near(value, expected, tolerance);
    }
}

/// One sinusoid of azimuth, pitch and roll, °.
fn wave(angles_deg: [f64; 3], frequency_hz: f64, phase_rad: f64) -> SwayComponent {
    let [azimuth_deg, pitch_deg, roll_deg] = angles_deg;
    SwayComponent { azimuth_deg, pitch_deg, roll_deg, frequency_hz, phase_rad }
}

fn sway(components: [SwayComponent; 3]) -> SwayConfiguration {
    SwayConfiguration { components }
}

/// All samples and the truth behind the last.
fn run(configuration: &VehicleConfiguration, seed: u64) -> (Vec<VehicleSample>, VehicleTruth) {
    let mut vehicle = Vehicle::new(configuration, seed);
    let samples: Vec<_> = vehicle.by_ref().collect();
    (samples, vehicle.truth())
}

/// A quaternion w, x, y, z.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quaternion([f64; 4]);

impl Quaternion {
    const NONE: Self = Self([1.0, 0.0, 0.0, 0.0]);

    /// The rotation by a rotation vector, rad.
    fn of(vector: [f64; 3]) -> Self {
        let angle = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        let scale = if angle < 1e-9 { 0.5 } else { (0.5 * angle).sin() / angle };
        Self([(0.5 * angle).cos(), vector[0] * scale, vector[1] * scale, vector[2] * scale])
    }

    /// From north by azimuth about down, pitch about right, roll about forward, rad.
    fn euler(azimuth: f64, pitch: f64, roll: f64) -> Self {
        Self::of([0.0, 0.0, azimuth]) * Self::of([0.0, pitch, 0.0]) * Self::of([roll, 0.0, 0.0])
    }

    fn inverse(self) -> Self {
        let [w, x, y, z] = self.0;
        Self([w, -x, -y, -z])
    }

    /// The vector turned.
    fn turn(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let Self([_, x, y, z]) = self * Self([0.0, x, y, z]) * self.inverse();
        [x, y, z]
    }

    /// Its angle, rad, within [0, π].
    fn angle(self) -> f64 {
        let [w, x, y, z] = self.0;
        2.0 * (x * x + y * y + z * z).sqrt().atan2(w.abs())
    }
}

impl std::ops::Mul for Quaternion {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e,
        ])
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Body axes over inertial ones: north, east, down of a place that Earth has carried on for some
/// seconds; inertial x through the start meridian, z along Earth's axis.
fn attitude_in_space(truth: &VehicleTruth, seconds: f64) -> Quaternion {
    let longitude = truth.position.longitude_rad + EARTH * seconds;
    let latitude = truth.position.latitude_rad;
    let place = Quaternion::of([0.0, 0.0, longitude])
        * Quaternion::of([0.0, -latitude - std::f64::consts::FRAC_PI_2, 0.0]);
    let body = truth.attitude;
    place * Quaternion::euler(body.azimuth_rad, body.pitch_rad, body.roll_rad)
}

/// The rotation that the increments add up to: rotation vectors with the coning term of two samples,
/// cross products of each increment with the one before it (P. G. Savage 1998, eq. 48: a/12).
fn integrated(samples: &[VehicleSample]) -> Quaternion {
    let mut before = [0.0; 3];
    let mut attitude = Quaternion::NONE;
    for sample in samples {
        let coning = cross(before, sample.turned_rad).map(|x| x / 12.0);
        let turned = sample.turned_rad;
        let vector = [0, 1, 2].map(|axis| turned[axis] + coning[axis]);
        attitude = attitude * Quaternion::of(vector);
        before = turned;
    }
    attitude
}
