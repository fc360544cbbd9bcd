//! A vehicle that climbs a ramp quickly, or drives over bumps, and then drives as vehicles do: what accelerates it is not
//! taken for a tilt. What a change of pitch does to its speed is left out, 0.2 m/s² at most.

use core::f64::consts::{FRAC_PI_2, TAU};

use orientation::attitude::{Gyro, Setting};
use orientation::noise::model::GyroNoise;
use orientation::units::RadiansPerSecond;

use super::world::{Body, coarse, keep, precise};

/// When the body has its azimuth, 1 mrad, s.
const HANDED: f64 = 40.0;
/// Speed on the ramp and behind it, m/s, and its slope, rad.
const SLOW: f64 = 3.0;
const FAST: f64 = 12.0;
const RAMP: f64 = 0.25;

/// How much of a change that lasts from one time to another, s, is behind.
fn part(time: f64, from: f64, to: f64) -> f64 {
    ((time - from) / (to - from)).clamp(0.0, 1.0)
}

/// Rate of that change, 1/s.
fn rate(time: f64, from: f64, to: f64) -> f64 {
    if (from..to).contains(&time) { 1.0 / (to - from) } else { 0.0 }
}

/// Speed and what changes it, m/s and m/s²: 1 and 1.2 m/s².
fn speed(time: f64) -> [f64; 2] {
    [part, rate].map(|how| {
        SLOW * how(time, 55.0, 58.0) + (FAST - SLOW) * how(time, 70.0, 77.5)
            - FAST * how(time, 95.0, 105.0)
    })
}

/// Attitude: a second from the road onto the ramp, and from it; a bend of 90°.
fn attitude(time: f64) -> [f64; 3] {
    let pitch = RAMP * (part(time, 60.0, 61.0) - part(time, 66.0, 67.0));
    [0.5 + FRAC_PI_2 * part(time, 80.0, 88.0), pitch, 0.0]
}

/// Acceleration north, east, down, m/s².
fn acceleration(time: f64) -> [f64; 3] {
    let [course, pitch, _] = attitude(time);
    let [speed, along] = speed(time);
    let across = speed * FRAC_PI_2 * rate(time, 80.0, 88.0);
    let up = speed * RAMP * (rate(time, 60.0, 61.0) - rate(time, 66.0, 67.0));
    let (sine, cosine) = course.sin_cos();
    let level = along * pitch.cos();
    [level * cosine - across * sine, level * sine + across * cosine, -along * pitch.sin() - up]
}

/// Gyros between the two others: N 0.05 °/√h, B 1 °/h, as of a vehicle.
fn of_a_vehicle() -> Body {
    let noise = GyroNoise::from_field_units(0.05, 1.0, 0.0, 0.0);
    let bias_sigma = RadiansPerSecond::from_degrees_per_hour(1.0);
    let gyro = Gyro { noise, bias_sigma, scale_sigma: 3e-4 };
    let body = precise(130.0);
    Body { setting: Setting { gyros: [gyro; 3], ..body.setting }, ..body }
}

/// Attitude of a vehicle on bumps: 0.05 rad up and down, twice a second; and the bend.
fn on_bumps(time: f64) -> [f64; 3] {
    let [course, ..] = attitude(time);
    let size = part(time, 59.0, 60.0) - part(time, 68.0, 69.0);
    [course, 0.05 * size * (2.0 * TAU * time).sin(), 0.0]
}

#[test]
fn a_vehicle_that_was_tilted_quickly_keeps_azimuth_and_level_within_their_sigma() {
    let bodies = [precise(130.0), coarse(130.0), of_a_vehicle()];
    for attitude in [attitude, on_bumps] {
        for (body, seed) in bodies.iter().flat_map(|body| (1..=5).map(move |seed| (body, seed))) {
            let body = Body { attitude, acceleration, handed: Some(HANDED), seed, ..*body };
            for known in keep(&body, |_, _| true).iter().filter(|it| it.time > HANDED + 1.0) {
                let azimuth = known.report.azimuth.expect("it is held").sigma.0;
                let error = known.azimuth.expect("it is held").abs() / azimuth;
                let [time, tilt] = [known.time, known.in_sigmas()];
                assert!(error < 4.0 && tilt < 4.5, "{seed}, {time} s: {error} σ, level {tilt} σ");
            }
        }
    }
}
