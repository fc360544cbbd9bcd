//! What the gyro and the accelerometer of a turning platform show at the turn, against §4:
//! `u = Re{[cos α·E + (Ω_v + κ)F + G/(jdw)] e^{jθ}} + sin α·(Ω_v − θ̇) + bias`.

use std::f64::consts::TAU;

use hal_mock::earth::{EARTH_RATE_RAD_S, normal_gravity_m_s2};
use hal_mock::gyro::{DEGREE_PER_HOUR, GyroConfiguration};
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::turntable::{Segment, TurningSample, TurntableConfiguration};

use super::{Complex, assert_complex, assert_near, phasor, run};

const LATITUDE_DEG: f64 = 55.75;
const AZIMUTH_DEG: f64 = 137.0;
const TILT_DEG: f64 = 0.1;
const UPHILL_DEG: f64 = 40.0;

/// Turns in 10 s: both speeds of the tests are whole numbers of them a run.
const SPEEDS: [f64; 2] = [1.4, 2.8];

/// What the tilt's square changes, rad/s: the closed forms are linear in it.
const SECOND_ORDER: f64 = 1.5 * EARTH_RATE_RAD_S * 3.05e-6;

/// The trapezoids of an integral over 10 ms, (wh)²/12, times the largest G/w of these tests.
const TRAPEZOIDS: f64 = 3e-5 * 4e-6;

fn site(gyro: GyroConfiguration) -> InstrumentsConfiguration {
    let site = InstrumentsConfiguration {
        latitude_deg: LATITUDE_DEG,
        azimuth_deg: AZIMUTH_DEG,
        gyro,
        ..InstrumentsConfiguration::default()
    };
    site.leaning(TILT_DEG, UPHILL_DEG)
}

/// Ten seconds and a multiple of whole turns: clockwise for positive `turns` in ten seconds.
fn turning(gyro: GyroConfiguration, turns: f64) -> Vec<TurningSample> {
    let segments = [Segment::steady(turns / 10.0 * TAU, 50.0)];
    let instruments = site(gyro);
    run(&TurntableConfiguration { instruments, segments: &segments, ..Default::default() }, 1)
}

/// E and F of §4, and the vertical Earth rate.
fn truth() -> (Complex, Complex, f64) {
    let latitude = LATITUDE_DEG.to_radians();
    let earth = Complex::turned(EARTH_RATE_RAD_S * latitude.cos(), AZIMUTH_DEG.to_radians());
    let tilt = Complex::turned(TILT_DEG.to_radians().sin(), -UPHILL_DEG.to_radians());
    (earth, tilt, EARTH_RATE_RAD_S * latitude.sin())
}

fn scaled(factor: f64, of: Complex) -> Complex {
    Complex(factor, 0.0) * of
}

fn rate(sample: &TurningSample) -> f64 {
    sample.rate_rad_s
}

/// All four ways of turning: w in rad/s and d.
fn all() -> impl Iterator<Item = (f64, f64, f64)> {
    let ways = SPEEDS.into_iter().flat_map(|turns| [turns, -turns]);
    ways.map(|turns| (turns, turns.abs() / 10.0 * TAU, turns.signum()))
}

#[test]
fn the_accelerometer_of_a_turning_platform_shows_the_tilt_phasor() {
    let (_, tilt, _) = truth();
    let gravity = normal_gravity_m_s2(LATITUDE_DEG.to_radians());
    for (turns, ..) in all() {
        let samples = turning(GyroConfiguration::default(), turns);
        let (along, constant) = phasor(&samples, |sample| sample.force_m_s2[0] / gravity);
        assert_complex(along, tilt, 1e-12);
        assert_near(constant, 0.0, 1e-12);
        // 90° clockwise of the axis it is −Im(F e^{jθ}) = Re(jF e^{jθ}).
        let (across, _) = phasor(&samples, |sample| sample.force_m_s2[1] / gravity);
        assert_complex(across, Complex(0.0, 1.0) * tilt, 1e-12);
    }
}

#[test]
fn a_perfect_gyro_shows_the_horizontal_earth_rate_and_the_vertical_one_through_the_tilt() {
    let (earth, tilt, vertical) = truth();
    for (turns, ..) in all() {
        let samples = turning(GyroConfiguration::default(), turns);
        let (shown, constant) = phasor(&samples, rate);
        assert_complex(shown, earth + scaled(vertical, tilt), SECOND_ORDER);
        assert_near(constant, 0.0, SECOND_ORDER);
        // The tilt's part is forty times what is left out.
        assert!((vertical * tilt.size()) > 40.0 * SECOND_ORDER / 1.5);
    }
}

#[test]
fn ordinary_g_sensitivity_turns_with_the_platform_and_is_the_same_in_both_directions() {
    let (earth, tilt, vertical) = truth();
    let [along, across] = [40.0, -25.0];
    let gyro = GyroConfiguration { g_sensitivity_deg_h_g: [along, across], ..Default::default() };
    let kappa = Complex(along * DEGREE_PER_HOUR, across * DEGREE_PER_HOUR);
    for (turns, ..) in all() {
        let (shown, _) = phasor(&turning(gyro, turns), rate);
        let expected = earth + (Complex(vertical, 0.0) + kappa) * tilt;
        assert_complex(shown, expected, SECOND_ORDER);
    }
}

/// `ρ = |G|/(wΩ_h)` of 0.13 at the slower speed.
const FORCE: [f64; 2] = [2.2e-3, -1.6e-3];

#[test]
fn molecular_g_sensitivity_is_odd_in_direction_and_falls_with_the_speed() {
    let (earth, tilt, vertical) = truth();
    let molecular = Some(MolecularConfiguration { force_rad_s2_g: FORCE, ..Default::default() });
    let gyro = GyroConfiguration { molecular, ..GyroConfiguration::default() };
    let g = Complex(FORCE[0], FORCE[1]) * tilt;
    for (turns, speed, direction) in all() {
        let (shown, _) = phasor(&turning(gyro, turns), rate);
        let expected = earth + scaled(vertical, tilt) + g.over_j(direction * speed);
        assert_complex(shown, expected, SECOND_ORDER + TRAPEZOIDS);
        assert!(g.size() / speed > 1000.0 * SECOND_ORDER);
    }
}

#[test]
fn an_axis_that_is_not_horizontal_feels_the_turning_itself() {
    let (earth, tilt, vertical) = truth();
    let alpha = 0.8_f64.to_radians();
    let gyro = GyroConfiguration { axis_elevation_rad: alpha, ..GyroConfiguration::default() };
    for (turns, speed, direction) in all() {
        let samples = turning(gyro, turns);
        let (shown, constant) = phasor(&samples, rate);
        // cos α on the tilt's part too; §4 has 1, which is 1e-4 of it.
        let expected = scaled(alpha.cos(), earth + scaled(vertical, tilt));
        assert_complex(shown, expected, 2.0 * SECOND_ORDER + alpha.sin() * 3.05e-6 * vertical);
        // The leaning axis of the stage takes its part of the horizontal rate beside Ω_v.
        let uphill = (AZIMUTH_DEG + UPHILL_DEG).to_radians().cos();
        let axis = vertical * TILT_DEG.to_radians().cos() - earth.size() * uphill * tilt.size();
        assert_near(constant, alpha.sin() * (axis - direction * speed), 1e-15);
    }
}

#[test]
fn all_of_it_together_is_the_signal_of_the_equations() {
    let (earth, tilt, vertical) = truth();
    let alpha = -0.3_f64.to_radians();
    let gyro = GyroConfiguration {
        axis_elevation_rad: alpha,
        bias_deg_h: 30.0,
        g_sensitivity_deg_h_g: [12.0, 7.0],
        molecular: Some(MolecularConfiguration {
            force_rad_s2_g: FORCE,
            high_pass_hz: 0.03,
            lag_s: 0.15,
        }),
        ..GyroConfiguration::default()
    };
    let kappa = Complex(12.0 * DEGREE_PER_HOUR, 7.0 * DEGREE_PER_HOUR);
    let g = Complex(FORCE[0], FORCE[1]) * tilt;
    for (turns, speed, direction) in all() {
        let segments = [Segment::steady(turns / 10.0 * TAU, 250.0)];
        let instruments = site(gyro);
        let configuration =
            TurntableConfiguration { instruments, segments: &segments, ..Default::default() };
        // Two hundred seconds are 38 time constants of the high-pass.
        let samples = run(&configuration, 1).split_off(20_000);
        let (shown, constant) = phasor(&samples, rate);
        let felt = scaled(alpha.cos(), earth)
            + (Complex(vertical, 0.0) + kappa) * tilt
            + g.over_j(direction * speed);
        let s = direction * speed;
        let high_pass = Complex(0.0, s) / Complex(TAU * 0.03, s);
        let dynamics = high_pass / Complex(1.0, 0.15 * s);
        // cos α of the tilt's part, and two filters with lines between samples.
        let tolerance = 2.0 * SECOND_ORDER + TRAPEZOIDS + 8e-5 * felt.size();
        assert_complex(shown, dynamics * felt, tolerance);
        // What is steady does not pass; the bias is the electronics' own.
        assert_near(constant, 30.0 * DEGREE_PER_HOUR, 1e-12);
    }
}
