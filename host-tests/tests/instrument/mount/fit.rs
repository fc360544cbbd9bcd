//! The fit with an axis that is not level and an accelerometer on the base: exact dwells in, azimuth
//! out.

use orientation::alignment::site::Site;
use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::criterion::Criterion;
use orientation::alignment::stepwise::mount::{FrameAngles, TWO_FRAMES, TwoFrame};
use orientation::alignment::stepwise::quality::Disturbance;
use orientation::alignment::stepwise::setting::Setting;
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::signal::dwell::Dwell;
use orientation::units::{
    Angle, DEGREE, DEGREE_PER_HOUR, GSensitivity, MetresPerSecondSquared, Radians,
    RadiansPerSecond, Seconds,
};

use super::oracle::{self, X, Y, Z, about, apply, dot, times};

const OMEGA: f64 = 7.292_115e-5;
const LATITUDE_DEG: f64 = 60.0;
const MINUTE: f64 = DEGREE / 60.0;

fn setting() -> Setting {
    let latitude = Latitude::from_degrees(LATITUDE_DEG).expect("it is one");
    let noise = StatedNoise::Whole(GyroNoise::from_field_units(1e-4, 0.0, 0.0, 0.0));
    Setting { mount: TWO_FRAMES, ..Setting::new(Site { noise, ..Site::at(latitude) }) }
}

/// What is true of the dwells.
#[derive(Clone, Copy, Default)]
struct World {
    mount: TwoFrame,
    azimuth_deg: f64,
    pitch_deg: f64,
    roll_deg: f64,
    /// °/h/g along the sensitive and the inner axis.
    kappa: [f64; 2],
    /// g on every axis of the accelerometer.
    bias: f64,
}

/// Two passes of exact dwells with the frames at their nominal angles: what the calibration would
/// correct shows as elevation and heading.
fn dwells(world: &World) -> Vec<Dwell> {
    let latitude = LATITUDE_DEG.to_radians();
    let [azimuth, pitch, roll] =
        [world.azimuth_deg, world.pitch_deg, world.roll_deg].map(f64::to_radians);
    let body = times(&about(Z, azimuth), &times(&about(Y, pitch), &about(X, roll)));
    let inverse = core::array::from_fn(|i| core::array::from_fn(|j| body[j][i]));
    let earth = apply(&inverse, [OMEGA * latitude.cos(), 0.0, -OMEGA * latitude.sin()]);
    let force = apply(&inverse, [0.0, 0.0, -1.0]);
    let gravity = setting().site.latitude.gravity();
    let frames = [[0.0, 90.0], [0.0, -90.0], [-90.0, 0.0], [90.0, 0.0]];
    let dwell = |(index, [outer, inner]): (usize, &[f64; 2])| {
        let [outer, inner] = [outer, inner].map(|angle| angle.to_radians());
        let [_, inner_axis, axis] = oracle::axes(
            &world.mount,
            FrameAngles { outer: Radians(outer), inner: Radians(inner) },
        );
        let g = world.kappa[0] * dot(axis, force) + world.kappa[1] * dot(inner_axis, force);
        Dwell {
            stage: Angle::from_rad(axis[1].atan2(axis[0])),
            elevation: -axis[2].asin() as f32,
            middle: Seconds(12.0 * index as f64),
            seconds: Seconds(10.0),
            rate: RadiansPerSecond(dot(axis, earth) + g * DEGREE_PER_HOUR),
            taper: 1.0,
            force: Some(force.map(|f| MetresPerSecondSquared((f + world.bias) * gravity.0))),
            ..Dwell::default()
        }
    };
    frames.iter().chain(&frames).enumerate().map(dwell).collect()
}

/// Azimuth's error and σ, °.
fn found(setting: &Setting, world: &World, dwells: &[Dwell]) -> [f64; 2] {
    let conclusion = Conclusion::of(setting, dwells, Criterion::MaximumLikelihood);
    let azimuth = conclusion.verdict.expect("nothing is wrong");
    let error = azimuth.angle.degrees() - world.azimuth_deg;
    [(error + 180.0).rem_euclid(360.0) - 180.0, azimuth.sigma.degrees()]
}

fn skewed() -> TwoFrame {
    TwoFrame {
        frames: Radians(12.0 * MINUTE),
        gyro: Radians(-10.0 * MINUTE),
        ..TwoFrame::default()
    }
}

#[test]
fn a_skewed_mount_on_a_tilted_base_gives_the_exact_azimuth() {
    for azimuth_deg in [0.0, 31.0, 117.0, 203.0, 290.0] {
        let world = World {
            mount: skewed(),
            azimuth_deg,
            pitch_deg: 4.0,
            roll_deg: -3.0,
            ..World::default()
        };
        let [error, _] = found(&setting(), &world, &dwells(&world));
        assert!(error.abs() < 1e-5, "{azimuth_deg}: {error}°");
    }
}

#[test]
fn a_minute_of_elevation_left_out_turns_the_azimuth_by_its_tangent_of_the_latitude() {
    // The axis leans by 1′ to the inner axis' end: up when it points to the right, down to the left.
    let mount = TwoFrame { gyro: Radians(MINUTE), ..TwoFrame::default() };
    let world = World { mount, azimuth_deg: 0.0, ..World::default() };
    let mut blind = dwells(&world);
    let [error, _] = found(&setting(), &world, &blind);
    assert!(error.abs() < 1e-6, "{error}°");
    for dwell in &mut blind {
        dwell.elevation = 0.0;
    }
    let [error, _] = found(&setting(), &world, &blind);
    // North: rates at the right and the left are −sin A of Ω_h, and the elevation adds to them.
    let expected = -(1.0 / 60.0) * LATITUDE_DEG.to_radians().tan();
    assert!((error - expected).abs() < 2e-5, "{error}° is not {expected}°");
}

#[test]
fn the_g_sensitivity_meets_the_force_along_the_gyros_own_axes() {
    let kappa = [3.0, -2.0];
    let mut reported = setting();
    reported.site.g_sensitivity = kappa.map(GSensitivity::from_degrees_per_hour);
    for azimuth_deg in [10.0, 100.0, 260.0] {
        let world = World { azimuth_deg, pitch_deg: 2.0, roll_deg: 5.0, kappa, ..World::default() };
        let [error, _] = found(&reported, &world, &dwells(&world));
        assert!(error.abs() < 1e-5, "{azimuth_deg}: {error}°");
    }
    // Left out, the part along the inner axis stands for an Earth rate along body y.
    let world = World { azimuth_deg: 0.0, kappa: [0.0, 0.01], ..World::default() };
    let [error, _] = found(&setting(), &world, &dwells(&world));
    let horizontal = OMEGA * LATITUDE_DEG.to_radians().cos() / DEGREE_PER_HOUR;
    let expected = -(0.01_f64 / horizontal).atan().to_degrees();
    assert!((error - expected).abs() < 1e-4, "{error}° is not {expected}°");
    // So its uncertainty costs that much on a level base already.
    let mut unsure = setting();
    unsure.site.g_sensitivity_sigma = GSensitivity::from_degrees_per_hour(0.01);
    let world = World::default();
    let [_, sigma] = found(&unsure, &world, &dwells(&world));
    let [_, alone] = found(&setting(), &world, &dwells(&world));
    let cost = (sigma * sigma - alone * alone).sqrt();
    assert!((cost / expected.abs() - 1.0).abs() < 1e-3, "{cost}° is not {expected}°");
}

#[test]
fn a_bias_of_the_accelerometer_on_the_base_is_tilt_and_stands_in_sigma() {
    let world = World { azimuth_deg: 40.0, bias: 1e-3, ..World::default() };
    let gravity = setting().site.latitude.gravity();
    let mut reported = setting();
    reported.site.accelerometer_bias_sigma = MetresPerSecondSquared(1e-3 * gravity.0);
    let [error, sigma] = found(&reported, &world, &dwells(&world));
    let expected = 1e-3 * LATITUDE_DEG.to_radians().tan().abs().to_degrees();
    assert!((sigma / expected - 1.0).abs() < 0.01, "σ {sigma}°, not {expected}°");
    assert!(error.abs() > 0.1 * sigma && error.abs() < 2.0 * sigma, "{error}° of σ {sigma}°");
}

#[test]
fn a_base_that_moves_once_is_noticed_and_frames_that_turn_are_not() {
    let world = World { pitch_deg: 3.0, roll_deg: 2.0, ..World::default() };
    let mut dwells = dwells(&world);
    let conclude = |dwells: &[Dwell]| {
        Conclusion::of(&setting(), dwells, Criterion::MaximumLikelihood).disturbances
    };
    assert!(conclude(&dwells).iter().all(Option::is_none));
    dwells[5].force = dwells[5].force.map(|[x, y, z]| [MetresPerSecondSquared(x.0 + 0.02), y, z]);
    let disturbances = conclude(&dwells);
    for (index, why) in disturbances.iter().enumerate() {
        assert_eq!(matches!(why, Some(Disturbance::Moved(_))), index == 5, "{disturbances:?}");
    }
}
