//! An uneven gear and a rate-modulated motor.

use std::f64::consts::TAU;

use hal_mock::earth::{Attitude, EARTH_RATE_RAD_S, Site};
use hal_mock::environment::{Mechanics, ShaftAngle};
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{Plant, PlantConfiguration};
use hal_mock::stage::{Ripple, StageState, Unevenness};
use hal_mock::turntable::{Segment, TurntableConfiguration};

use super::{Complex, PER_RAD, assert_complex, assert_near, at, fit, phasor, run};

const ONCE: Ripple = Ripple { relative: 0.002, phase_rad: 0.7 };
const TWICE: Ripple = Ripple { relative: 0.0008, phase_rad: -1.1 };
const GEAR: Unevenness = Unevenness { first: ONCE, second: TWICE };

/// Five turns in 40 s.
const RATE_RAD_S: f64 = TAU / 8.0;

fn even(angle_rad: f64, rate_rad_s: f64) -> StageState {
    StageState { angle_rad, rate_rad_s }
}

#[test]
fn an_even_gear_changes_no_bit() {
    for angle in [0.0, 0.1, -7.0, 1e4] {
        assert_eq!(Unevenness::default().stage(even(angle, 0.86)), even(angle, 0.86));
    }
}

#[test]
fn the_rate_behind_an_uneven_gear_is_the_slope_of_its_angle() {
    let strong = Unevenness {
        first: Ripple { relative: 0.2, ..ONCE },
        second: Ripple { relative: 0.1, ..TWICE },
    };
    let step = 1e-4;
    for k in 0..100 {
        let angle = f64::from(k) * 0.13 - 5.0;
        let [before, here, after] =
            [-step, 0.0, step].map(|off| strong.stage(even(angle + off, 2.0)));
        let slope = (after.angle_rad - before.angle_rad) / (2.0 * step);
        // Third derivative ≤ ε₁ + 4ε₂.
        assert_near(here.rate_rad_s, 2.0 * slope, 2.0 * 0.6 / 6.0 * step * step + 1e-11);
        let formula = 1.0
            + 0.2 * (angle - ONCE.phase_rad).cos()
            + 0.1 * (2.0 * (angle - TWICE.phase_rad)).cos();
        assert_near(here.rate_rad_s, 2.0 * formula, 1e-14);
        // A turn of the rotor is a turn of the stage.
        let turned = strong.stage(even(angle + TAU, 2.0));
        assert_near(turned.angle_rad - here.angle_rad, TAU, 1e-13);
    }
}

#[test]
fn the_spectrum_of_the_rate_has_the_gears_lines_once_and_twice_a_turn_and_no_other() {
    let segments = [Segment::steady(RATE_RAD_S, 40.0)];
    let configuration =
        TurntableConfiguration { unevenness: GEAR, segments: &segments, ..Default::default() };
    let samples = run(&configuration, 1);
    // Lines over the stage's own angle differ from those over the rotor's by products of two ε.
    let products = RATE_RAD_S * 1e-5;
    let expected = [
        Complex::turned(0.002 * RATE_RAD_S, -ONCE.phase_rad),
        Complex::turned(0.0008 * RATE_RAD_S, -2.0 * TWICE.phase_rad),
        Complex(0.0, 0.0),
    ];
    let rows = samples.iter().map(|sample| {
        let [(s, c), (s2, c2), (s3, c3)] =
            [1.0, 2.0, 3.0].map(|k| (k * sample.stage_rad).sin_cos());
        ([1.0, c, s, c2, s2, c3, s3], sample.stage_rate_rad_s)
    });
    let [constant, lines @ ..] = fit(rows);
    assert_near(constant, RATE_RAD_S, products);
    for (line, expected) in lines.chunks_exact(2).zip(expected) {
        assert_complex(Complex(line[0], -line[1]), expected, products);
    }
}

#[test]
fn a_tilted_axis_takes_the_unevenness_for_north() {
    // §4: −sin α·θ̇ at the turn is −sin α·ε·w, here as large as the wanted signal.
    let alpha = 0.8_f64.to_radians();
    let gyro = GyroConfiguration { axis_elevation_rad: alpha, ..GyroConfiguration::default() };
    let instruments = InstrumentsConfiguration { latitude_deg: 55.75, gyro, ..Default::default() };
    let unevenness = Unevenness { first: ONCE, ..Unevenness::default() };
    let segments = [Segment::steady(RATE_RAD_S, 40.0)];
    let configuration = TurntableConfiguration {
        instruments,
        unevenness,
        segments: &segments,
        ..Default::default()
    };
    let (shown, _) = phasor(&run(&configuration, 1), |sample| sample.rate_rad_s);
    let north = Complex(alpha.cos() * EARTH_RATE_RAD_S * 55.75_f64.to_radians().cos(), 0.0);
    let parasite = Complex::turned(-alpha.sin() * 0.002 * RATE_RAD_S, -ONCE.phase_rad);
    assert_complex(shown, north + parasite, 1e-3 * parasite.size());
    assert!(parasite.size() > 0.5 * north.size());
}

#[test]
fn the_raw_azimuth_is_wrong_by_as_much_as_the_equations_say() {
    // §4's table: 55.75°, 0.137 Hz, α 0.8°, tilt 0.3°, 0.2 % once a turn: up to ±36°.
    let gyro = GyroConfiguration {
        axis_elevation_rad: 0.8_f64.to_radians(),
        ..GyroConfiguration::default()
    };
    let site = InstrumentsConfiguration {
        latitude_deg: 55.75,
        azimuth_deg: 30.0,
        gyro,
        ..InstrumentsConfiguration::default()
    };
    let segments = [Segment::steady(TAU * 0.137, 20.0 / 0.137)];
    let errors = (0..36).map(|step| {
        let phase_rad = f64::from(step) * TAU / 36.0;
        let first = Ripple { relative: 0.002, phase_rad };
        let configuration = TurntableConfiguration {
            instruments: site.leaning(0.3, 100.0),
            unevenness: Unevenness { first, ..Unevenness::default() },
            segments: &segments,
            ..Default::default()
        };
        let (shown, _) = phasor(&run(&configuration, 1), |sample| sample.rate_rad_s);
        shown.1.atan2(shown.0).to_degrees() - 30.0
    });
    let (least, most) =
        errors.fold((0.0_f64, 0.0_f64), |(a, b), error| (a.min(error), b.max(error)));
    assert_near(most, 36.0, 0.7);
    assert_near(least, -36.0, 0.7);
}

#[test]
fn the_plants_stage_is_as_uneven_and_its_encoder_sees_it() {
    let stage = StageConfiguration { unevenness: GEAR, ..StageConfiguration::endless() };
    let mut plant = Plant::new(&PlantConfiguration { stage, ..Default::default() }, 1);
    plant.drive(at(0.0), 0.0, 0.86 * PER_RAD);
    for k in 1..2000 {
        let seconds = f64::from(k) * 0.01;
        plant.advance(at(seconds));
        let (angle, state) = (0.86 * seconds, plant.truth().stage);
        let first = angle - ONCE.phase_rad;
        let second = 2.0 * (angle - TWICE.phase_rad);
        let expected = angle + 0.002 * first.sin() + 0.0004 * second.sin();
        assert_near(state.angle_rad, expected, 1e-12);
        let rate = 0.86 * (1.0 + 0.002 * first.cos() + 0.0008 * second.cos());
        assert_near(state.rate_rad_s, rate, 1e-12);
        assert_near(plant.shaft_turns(at(seconds)) * TAU, expected, 1e-12);
    }
}

#[test]
fn a_motor_goes_through_ramps_and_waves_without_a_jump_and_its_rate_is_the_slope_of_its_angle() {
    let segments = [
        Segment::steady(0.0, 1.0),
        Segment::steady(0.86, 12.0).after(0.5).modulated(0.25, 0.114),
        Segment::steady(-1.7, 7.3).after(1.2),
        Segment::steady(0.0, 2.0).after(0.7),
    ];
    let instruments = InstrumentsConfiguration { rate_hz: 1000.0, ..Default::default() };
    let configuration =
        TurntableConfiguration { instruments, segments: &segments, ..Default::default() };
    let samples = run(&configuration, 1);
    assert_eq!(samples.len(), 24_700);
    for pair in samples.windows(2) {
        let mean = 0.5 * (pair[0].stage_rate_rad_s + pair[1].stage_rate_rad_s);
        // Trapezoids of a rate of slope ≤ 1.7/0.7 rad/s² with a corner between the samples, and bends.
        assert_near(pair[1].stage_rad - pair[0].stage_rad, mean * 1e-3, 4e-7);
        assert!((pair[1].stage_rate_rad_s - pair[0].stage_rate_rad_s).abs() < 2.5e-3);
    }
    let wave = 0.86 * (1.0 + 0.25 * (TAU * 0.114 * 5.0).sin());
    let rates = [(500, 0.0), (1250, 0.43), (6500, wave), (15_000, -1.7), (24_699, 0.0)];
    for (k, expected) in rates {
        assert_near(samples[k].stage_rate_rad_s, expected, 1e-12);
    }
}

#[test]
fn a_leaning_base_points_uphill_where_it_is_stated_to_point() {
    let attitude = Attitude::tilted(0.4, 0.2, 2.5);
    let site = Site::new(0.9, &attitude);
    for k in 0..12 {
        let stage = f64::from(k) * TAU / 12.0;
        let along = site.on_platform(stage).force_m_s2[0] / site.gravity_m_s2;
        assert_near(along, 0.2_f64.sin() * (stage - 2.5).cos(), 1e-15);
    }
}
