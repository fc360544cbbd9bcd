//! The simulated gimbal against the oracle: axes, rates, forces, encoders, faults.

use hal_mock::chip::{Rig, Select, Transaction};
use hal_mock::environment::{AnalogueInput, ForceInput, Mechanics, ShaftAngle};
use hal_mock::gimbal::board::GimbalBoard;
use hal_mock::gimbal::{FrameConfiguration, Gimbal, GimbalConfiguration, Misalignment};
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{PlantConfiguration, StageFault};
use hal_mock::tmc5160::Oscillator;
use orientation::alignment::stepwise::mount::{FrameAngles, TwoFrame};
use orientation::units::Radians;
use proptest::prelude::*;

use super::kinematics::{calibration, frames};
use super::oracle::{self, X, Y, Z, about, apply, dot, times};

use crate::support::at;

const OMEGA: f64 = 7.292_115e-5;
const STANDARD_GRAVITY: f64 = 9.806_65;
/// Volts of the plant's gyro for one rad/s.
const VOLTS: f64 = 0.05 * 180.0 / core::f64::consts::PI;
const PER_RAD: f64 = 4_608_000.0 / core::f64::consts::TAU;

/// A gimbal without noise whose frames stand at these angles.
fn gimbal(mount: &TwoFrame, angles: FrameAngles, kappa: [f64; 3]) -> GimbalConfiguration<'static> {
    let frame = |shown: f64, zero_rad: f64| {
        let perfect = FrameConfiguration::default();
        let stage = StageConfiguration { start_rad: shown - zero_rad, ..perfect.stage };
        FrameConfiguration { stage, zero_rad, ..perfect }
    };
    let gyro = GyroConfiguration {
        g_sensitivity_deg_h_g: [kappa[0], kappa[1]],
        ..GyroConfiguration::default()
    };
    GimbalConfiguration {
        plant: PlantConfiguration {
            instruments: InstrumentsConfiguration {
                latitude_deg: 60.0,
                azimuth_deg: 130.0,
                pitch_deg: 3.0,
                roll_deg: -2.0,
                gyro,
                ..InstrumentsConfiguration::default()
            },
            ..PlantConfiguration::default()
        },
        outer: frame(angles.outer.0, mount.outer_zero.0),
        inner: frame(angles.inner.0, mount.inner_zero.0),
        misalignment: Misalignment {
            azimuth_rad: mount.azimuth.0,
            pitch_rad: mount.pitch.0,
            frames_rad: mount.frames.0,
            gyro_rad: mount.gyro.0,
        },
        third_g_sensitivity_deg_h_g: kappa[2],
    }
}

/// Earth rate, rad/s, and specific force, g, of that base.
fn base() -> [[f64; 3]; 2] {
    let degrees = [130.0_f64, 3.0, -2.0].map(f64::to_radians);
    let tilt = times(&about(Y, degrees[1]), &about(X, degrees[2]));
    let body = times(&about(Z, degrees[0]), &tilt);
    let transposed = core::array::from_fn(|i| core::array::from_fn(|j| body[j][i]));
    let latitude = 60.0_f64.to_radians();
    let rate = [OMEGA * latitude.cos(), 0.0, -OMEGA * latitude.sin()];
    [apply(&transposed, rate), apply(&transposed, [0.0, 0.0, -1.0])]
}

proptest! {
    #[test]
    fn the_gyro_feels_the_earth_along_the_oracles_axis(mount in calibration(), angles in frames()) {
        let mut plant = Gimbal::new(&gimbal(&mount, angles, [0.0; 3]), 1);
        let [.., sensitive] = oracle::axes(&mount, angles);
        let rate = plant.volts(at(1.0)) / VOLTS;
        let expected = dot(sensitive, base()[0]);
        prop_assert!((rate - expected).abs() < 1e-17, "{rate} is not {expected}");
        let shown = plant.outer.shaft_turns(at(1.0)) * core::f64::consts::TAU;
        prop_assert!((shown - angles.outer.0).abs() < 1e-12);
        let shown = plant.inner.shaft_turns(at(1.0)) * core::f64::consts::TAU;
        prop_assert!((shown - angles.inner.0).abs() < 1e-12);
    }

    #[test]
    fn each_part_of_the_g_sensitivity_meets_the_force_along_its_axis(
        mount in calibration(),
        angles in frames(),
    ) {
        let rate = |kappa| Gimbal::new(&gimbal(&mount, angles, kappa), 1).volts(at(1.0)) / VOLTS;
        let unit = core::f64::consts::PI / 180.0 / 3600.0;
        let [_, inner, sensitive] = oracle::axes(&mount, angles);
        let across = normalised(cross(inner, sensitive));
        let force = base()[1];
        for (kappa, axis) in
            [([1.0, 0.0, 0.0], sensitive), ([0.0, 1.0, 0.0], inner), ([0.0, 0.0, 1.0], across)]
        {
            let felt = (rate(kappa) - rate([0.0; 3])) / unit;
            let expected = dot(axis, force);
            prop_assert!((felt - expected).abs() < 1e-9, "{kappa:?}: {felt} is not {expected}");
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalised(a: [f64; 3]) -> [f64; 3] {
    a.map(|x| x / dot(a, a).sqrt())
}

#[test]
fn a_turning_frame_turns_the_gyro_about_its_own_axis() {
    let mount = TwoFrame { frames: Radians(0.01), gyro: Radians(-0.02), ..TwoFrame::default() };
    let (outer, inner) = (-0.4, 0.7);
    let start = FrameAngles { outer: Radians(outer), inner: Radians(inner) };
    let rate = 0.2;
    for is_inner in [false, true] {
        let mut plant = Gimbal::new(&gimbal(&mount, start, [0.0; 3]), 1);
        let side = if is_inner { &mut plant.inner } else { &mut plant.outer };
        side.drive.drive(at(1.0), 0.0, rate * PER_RAD);
        let now = if is_inner {
            FrameAngles { inner: Radians(inner + 2.0 * rate), ..start }
        } else {
            FrameAngles { outer: Radians(outer + 2.0 * rate), ..start }
        };
        let [outer_axis, inner_axis, sensitive] = oracle::axes(&mount, now);
        let axis = if is_inner { inner_axis } else { outer_axis };
        let expected = rate * dot(axis, sensitive) + dot(sensitive, base()[0]);
        let felt = plant.volts(at(3.0)) / VOLTS;
        assert!((felt - expected).abs() < 1e-12, "{felt} is not {expected}");
        assert!((plant.frames()[usize::from(is_inner)].rate_rad_s - rate).abs() < 1e-12);
    }
}

#[test]
fn the_accelerometer_sits_on_the_base_whatever_the_frames_do() {
    let mount = TwoFrame::default();
    let gravity = hal_mock::earth::normal_gravity_m_s2(60.0_f64.to_radians());
    for (outer, inner) in [(0.0, 0.0), (1.0, -1.2), (-1.5, 0.3)] {
        let angles = FrameAngles { outer: Radians(outer), inner: Radians(inner) };
        let felt = Gimbal::new(&gimbal(&mount, angles, [0.0; 3]), 1).force_g(at(1.0));
        for (felt, expected) in felt.into_iter().zip(base()[1]) {
            assert!((felt - expected * gravity / STANDARD_GRAVITY).abs() < 1e-12);
        }
    }
}

#[test]
fn one_frame_is_held_and_slips_and_meets_its_end_without_the_other() {
    let held = StageFault::Block { from: at(1.0), until: at(5.0) };
    let faults = [held, StageFault::Slip { at: at(2.0), by_rad: 0.01 }];
    let angles = FrameAngles { outer: Radians(0.0), inner: Radians(0.0) };
    let mut configuration = gimbal(&TwoFrame::default(), angles, [0.0; 3]);
    configuration.inner.faults = &faults;
    let mut plant = Gimbal::new(&configuration, 1);
    plant.outer.drive.drive(at(1.5), 0.0, 0.2 * PER_RAD);
    plant.inner.drive.drive(at(1.5), 0.0, 0.2 * PER_RAD);
    plant.advance(at(3.0));
    let [outer, inner] = plant.frames();
    assert!((outer.angle_rad - 0.3).abs() < 1e-9 && inner.angle_rad == 0.0);
    assert!(plant.inner.drive.is_blocked() && !plant.outer.drive.is_blocked());
    let shown = plant.inner.shaft_turns(at(3.0)) * core::f64::consts::TAU;
    assert!((shown - 0.01).abs() < 1e-12);
    assert!(plant.outer.shaft_turns(at(3.0)) > 0.0);
    // The outer frame goes on to its hard end at 100°, past the switch at 95°.
    plant.advance(at(30.0));
    assert!((plant.frames()[0].angle_rad.to_degrees() - 100.0).abs() < 1e-9);
    assert!(plant.outer.drive.is_blocked());
    assert_eq!(plant.outer.drive.reference_switches(), [false, true]);
}

#[test]
fn a_driver_that_loses_its_supply_stops_its_own_frame_alone() {
    let angles = FrameAngles { outer: Radians(0.0), inner: Radians(0.0) };
    let gimbal = Gimbal::new(&gimbal(&TwoFrame::default(), angles, [0.0; 3]), 1);
    let oscillator = Oscillator::Internal { hertz: 12_000_000 };
    let mut board = GimbalBoard::new(gimbal, oscillator);
    board.plant.outer.drive.drive(at(1.0), 0.0, 0.1 * PER_RAD);
    board.plant.inner.drive.drive(at(1.0), 0.0, 0.1 * PER_RAD);
    board.power_cycle(Select::InnerActuator, at(2.0));
    board.advance(at(3.0));
    let [outer, inner] = board.plant.frames().map(|frame| frame.angle_rad);
    assert!((outer - 0.2).abs() < 1e-9 && (inner - 0.1).abs() < 1e-9, "{outer} {inner}");
    // Each encoder answers on its own select line; 64 ms after its supply came back, not before.
    let mut angle = |select, now| {
        let mut reply = [0; 6];
        let sent = [0xA0, 0x03, 0, 0, 0, 0];
        board.transact(select, &Transaction { now, hertz: 5_000_000, sent: &sent }, &mut reply);
        let [_, _, high, middle, low, _] = reply;
        let steps = u32::from_be_bytes([0, high, middle, low]) >> 3;
        f64::from(steps) / 2_097_152.0 * core::f64::consts::TAU
    };
    assert!((angle(Select::Encoder, at(3.0)) - 0.2).abs() < 3e-6);
    assert!((angle(Select::InnerEncoder, at(3.0)) - 0.1).abs() < 3e-6);
    board.power_cycle(Select::InnerEncoder, at(4.0));
    assert_eq!(board.violations(Select::InnerEncoder).map(|found| found.count), Some(0));
    let transaction = Transaction { now: at(4.01), hertz: 5_000_000, sent: &[0x31, 0x00, 0] };
    board.transact(Select::InnerEncoder, &transaction, &mut [0; 3]);
    assert_eq!(board.violations(Select::InnerEncoder).map(|found| found.count), Some(1));
    assert_eq!(board.violations(Select::Encoder).map(|found| found.count), Some(0));
}
