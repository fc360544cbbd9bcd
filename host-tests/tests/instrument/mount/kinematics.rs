//! Where the two angles point the axis, and which angles point it where it is wanted.

use orientation::alignment::stepwise::mount::{
    FrameAngles, LIMIT, MountError, Station, TwoFrame, azimuth_sigma,
};
use orientation::earth::Latitude;
use orientation::units::Radians;
use proptest::prelude::*;

use super::oracle::{self, X, Y, Z, dot};

/// Half a degree, rad: more than a calibration should find.
const HALF: f64 = 0.5 * core::f64::consts::PI / 180.0;

pub fn calibration() -> impl Strategy<Value = TwoFrame> {
    let angle = || -HALF..HALF;
    (angle(), angle(), angle(), angle(), angle(), angle()).prop_map(
        |(azimuth, pitch, frames, gyro, outer_zero, inner_zero)| TwoFrame {
            azimuth: Radians(azimuth),
            pitch: Radians(pitch),
            frames: Radians(frames),
            gyro: Radians(gyro),
            outer_zero: Radians(outer_zero),
            inner_zero: Radians(inner_zero),
        },
    )
}

pub fn frames() -> impl Strategy<Value = FrameAngles> {
    (-LIMIT.0..LIMIT.0, -LIMIT.0..LIMIT.0)
        .prop_map(|(outer, inner)| FrameAngles { outer: Radians(outer), inner: Radians(inner) })
}

const STATIONS: [(Station, f64); 4] = [
    (Station::Forward, 0.0),
    (Station::Right, 90.0),
    (Station::Backward, 180.0),
    (Station::Left, 270.0),
];

fn near(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14)
}

#[test]
fn a_perfect_mount_points_down_forward_right_backward_and_left() {
    let mount = TwoFrame::default();
    for (outer, inner, axis) in [
        (0.0, 0.0, Z),
        (0.0, 90.0, X),
        (0.0, -90.0, X.map(|x: f64| -x)),
        (-90.0, 0.0, Y),
        (90.0, 0.0, Y.map(|y: f64| -y)),
        (33.0, 90.0, X),
        (-90.0, 90.0, X),
    ] {
        let [outer, inner] = [outer, inner].map(f64::to_radians);
        let found =
            mount.sensitive_axis(FrameAngles { outer: Radians(outer), inner: Radians(inner) });
        assert!(near(found, axis), "{outer} {inner}: {found:?} is not {axis:?}");
    }
}

#[test]
fn each_calibration_angle_has_the_sign_that_its_words_say() {
    let small = 1e-3;
    let at = |mount: TwoFrame, outer: f64, inner: f64| {
        let [outer, inner] = [outer, inner].map(f64::to_radians);
        let pointing = mount.pointing(FrameAngles { outer: Radians(outer), inner: Radians(inner) });
        [(pointing.heading.0 + 1.0).rem_euclid(core::f64::consts::TAU) - 1.0, pointing.elevation.0]
    };
    let perfect = TwoFrame::default();
    let assert_turns = |mount, outer, inner, [heading, elevation]: [f64; 2]| {
        let (with, without) = (at(mount, outer, inner), at(perfect, outer, inner));
        assert!((with[0] - without[0] - heading).abs() < 2e-6, "{mount:?} at {outer} {inner}");
        assert!((with[1] - without[1] - elevation).abs() < 2e-6, "{mount:?} at {outer} {inner}");
    };
    // The outer axis to the right takes all headings with it, its front raised only the axis along it.
    let azimuth = TwoFrame { azimuth: Radians(small), ..perfect };
    assert_turns(azimuth, 0.0, 90.0, [small, 0.0]);
    assert_turns(azimuth, -90.0, 0.0, [small, 0.0]);
    let pitch = TwoFrame { pitch: Radians(small), ..perfect };
    assert_turns(pitch, 0.0, 90.0, [0.0, small]);
    assert_turns(pitch, -90.0, 0.0, [0.0, 0.0]);
    // The inner axis' right end goes back: the axis in front goes to the right.
    let frames = TwoFrame { frames: Radians(small), ..perfect };
    assert_turns(frames, 0.0, 90.0, [small, 0.0]);
    assert_turns(frames, -90.0, 0.0, [0.0, 0.0]);
    // The axis leans to the inner axis' right end, which is up when the axis points to the right.
    let gyro = TwoFrame { gyro: Radians(small), ..perfect };
    assert_turns(gyro, 0.0, 90.0, [small, 0.0]);
    assert_turns(gyro, -90.0, 0.0, [0.0, small]);
    // An encoder that shows more: the frame stands that much lower.
    assert_turns(TwoFrame { inner_zero: Radians(small), ..perfect }, 0.0, 90.0, [0.0, -small]);
    assert_turns(TwoFrame { outer_zero: Radians(small), ..perfect }, -90.0, 0.0, [0.0, small]);
}

#[test]
fn headings_are_distinguished_from_their_stations() {
    for (station, heading) in STATIONS {
        for off in [-0.9, 0.0, 0.9, 360.0, -360.0] {
            assert_eq!(Station::at_heading(Radians((heading + off).to_radians())), Ok(station));
        }
        let beside = (heading + 45.0).to_radians();
        assert_eq!(
            Station::at_heading(Radians(beside)),
            Err(MountError::NoStation(Radians(beside)))
        );
    }
}

#[test]
fn a_calibration_beyond_the_frames_travel_is_refused() {
    let degrees = |angle: f64| angle.to_radians();
    let mount = TwoFrame { inner_zero: Radians(degrees(2.5)), ..TwoFrame::default() };
    let refused = mount.angles(Station::Forward).expect_err("92.5° is beyond the limit");
    assert!(
        matches!(refused, MountError::BeyondLimit(angle) if (angle.0 - degrees(92.5)).abs() < 1e-9)
    );
    assert!(mount.angles(Station::Backward).is_ok());
    let skew = TwoFrame {
        frames: Radians(degrees(60.0)),
        gyro: Radians(degrees(60.0)),
        ..TwoFrame::default()
    };
    assert_eq!(skew.angles(Station::Storage), Err(MountError::Unreachable(Station::Storage)));
    let nothing = TwoFrame { gyro: Radians(f64::NAN), ..TwoFrame::default() };
    assert_eq!(nothing.angles(Station::Right), Err(MountError::Unreachable(Station::Right)));
}

#[test]
fn what_calibration_leaves_turns_the_azimuth_more_at_high_latitudes() {
    let at = |degrees| Latitude::from_degrees(degrees).expect("it is one");
    assert!((azimuth_sigma(Radians(1e-4), Radians(0.0), at(0.0)).0 - 1e-4).abs() < 1e-18);
    assert!((azimuth_sigma(Radians(1e-4), Radians(0.0), at(-60.0)).0 - 2e-4).abs() < 1e-15);
    assert!((azimuth_sigma(Radians(0.0), Radians(1e-4), at(45.0)).0 - 1e-4).abs() < 1e-15);
}

proptest! {
    #[test]
    fn the_sensitive_axis_is_that_of_rotation_matrices(
        mount in calibration(),
        angles in frames(),
    ) {
        let [_, _, expected] = oracle::axes(&mount, angles);
        let found = mount.sensitive_axis(angles);
        prop_assert!(near(found, expected), "{found:?} is not {expected:?}");
        let pointing = mount.pointing(angles);
        let (sine, cosine) = pointing.elevation.0.sin_cos();
        let again = [
            cosine * pointing.heading.0.cos(),
            cosine * pointing.heading.0.sin(),
            -sine,
        ];
        prop_assert!(near(again, expected), "{pointing:?}");
    }

    #[test]
    fn the_angles_of_a_station_put_the_axis_there(mount in calibration()) {
        for (station, heading) in STATIONS {
            let angles = mount.angles(station).expect("it is within the limits");
            prop_assert!(angles.outer.0.abs() <= LIMIT.0 && angles.inner.0.abs() <= LIMIT.0);
            let [.., axis] = oracle::axes(&mount, angles);
            prop_assert!(axis[2].abs() < 1e-12, "{station:?} is not level: {axis:?}");
            let nominal = heading.to_radians();
            let wanted = [nominal.cos(), nominal.sin(), 0.0];
            // Along body x no frame can turn the heading; all angles of the calibration do.
            let exact = matches!(station, Station::Right | Station::Left);
            let least = if exact { 1.0 - 1e-15 } else { (4.0 * HALF).cos() };
            prop_assert!(dot(axis, wanted) >= least, "{station:?}: {axis:?}");
        }
        let angles = mount.angles(Station::Storage).expect("it is within the limits");
        let [.., axis] = oracle::axes(&mount, angles);
        prop_assert!(axis[0].hypot(axis[1]) < 1e-12 && axis[2] > 0.0, "{axis:?}");
    }
}
