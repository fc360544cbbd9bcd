//! Sway of the base, against its definition by rotation matrices.

use std::f64::consts::{FRAC_PI_2, TAU};

use hal_mock::earth::{Attitude, EARTH_RATE_RAD_S, Site};
use hal_mock::environment::ForceInput;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::{BaseMotion, InstrumentsConfiguration};
use hal_mock::plant::sway::{SwayComponent, SwayConfiguration};
use hal_mock::plant::{Plant, PlantConfiguration};

use super::{EXACT, assert_near, at, rate, rotate, tilted};

fn swaying(components: &[SwayComponent], instruments: &InstrumentsConfiguration) -> Plant<'static> {
    let mut sway = SwayConfiguration::default();
    sway.components[..components.len()].copy_from_slice(components);
    let instruments = *instruments;
    Plant::new(&PlantConfiguration { instruments, sway, ..PlantConfiguration::default() }, 1)
}

#[test]
fn the_rate_of_a_sway_integrates_to_its_amplitude() {
    // Of pitch with the axis to the right, of roll with the axis forward: a half period swings by
    // twice the amplitude. At the pole Earth does not turn a level axis.
    let pole = InstrumentsConfiguration { latitude_deg: 90.0, ..Default::default() };
    let pitch = SwayComponent { pitch_deg: 0.1, frequency_hz: 0.5, ..Default::default() };
    let roll = SwayComponent { roll_deg: 0.1, frequency_hz: 0.5, ..Default::default() };
    for (component, stage_rad) in [(pitch, FRAC_PI_2), (roll, 0.0)] {
        let mut plant = swaying(&[component], &pole);
        rotate(&mut plant, 0.0, 0.0, stage_rad, 1.0);
        // From 1.5 s, the trough, to 2.5 s, the crest; by the rule of the mid-points.
        let swung: f64 =
            (0..1000).map(|k| rate(&mut plant, 1.5 + (f64::from(k) + 0.5) * 1e-3) * 1e-3).sum();
        let earth = EARTH_RATE_RAD_S * 0.1_f64.to_radians();
        assert_near(swung, 0.2_f64.to_radians(), 1e-6 * swung + earth);
    }
}

#[test]
fn a_swaying_base_leans_in_the_specific_force() {
    let pitch = SwayComponent {
        pitch_deg: 3.0,
        frequency_hz: 0.1,
        phase_rad: FRAC_PI_2,
        ..Default::default()
    };
    let mut plant = swaying(&[pitch], &InstrumentsConfiguration::default());
    for step in 0..100 {
        let seconds = f64::from(step) * 0.1;
        let lean = 3.0_f64.to_radians() * (TAU * 0.1 * seconds).cos();
        let [x, y, z] = plant.force_g(at(seconds));
        // Uphill reads positive.
        assert_near(x.atan2(-z), lean, EXACT);
        assert_near(y, 0.0, EXACT);
    }
}

/// Attitude of a base with these components at a time, from the definition.
fn attitude(base: &Attitude, components: &[SwayComponent], seconds: f64) -> Attitude {
    let shape = |c: &SwayComponent| (TAU * c.frequency_hz * seconds + c.phase_rad).sin();
    let sum = |angle: fn(&SwayComponent) -> f64| {
        components.iter().map(|c| angle(c).to_radians() * shape(c)).sum::<f64>()
    };
    Attitude {
        azimuth_rad: base.azimuth_rad + sum(|c| c.azimuth_deg),
        pitch_rad: base.pitch_rad + sum(|c| c.pitch_deg),
        roll_rad: base.roll_rad + sum(|c| c.roll_deg),
    }
}

pub const WILD: [SwayComponent; 3] = [
    SwayComponent {
        azimuth_deg: 2.0,
        pitch_deg: 5.0,
        roll_deg: -4.0,
        frequency_hz: 0.3,
        phase_rad: 0.2,
    },
    SwayComponent {
        azimuth_deg: -1.0,
        pitch_deg: 0.5,
        roll_deg: 3.0,
        frequency_hz: 1.1,
        phase_rad: 2.0,
    },
    SwayComponent {
        azimuth_deg: 0.3,
        pitch_deg: 0.0,
        roll_deg: 0.0,
        frequency_hz: 4.0,
        phase_rad: -1.0,
    },
];

#[test]
fn a_wild_sway_turns_the_axis_as_the_derivative_of_its_rotation_matrix_says() {
    let gyro = GyroConfiguration { axis_elevation_rad: 0.2, ..GyroConfiguration::default() };
    let instruments = InstrumentsConfiguration { gyro, ..tilted() };
    let mut plant = swaying(&WILD, &instruments);
    rotate(&mut plant, 0.0, 0.0, 1.0, 0.7);
    let latitude = 55.0_f64.to_radians();
    let site = |seconds| Site::new(latitude, &attitude(&tilted().attitude(), &WILD, seconds));
    for step in 0..50 {
        let seconds = 1.0 + f64::from(step) * 0.137;
        let platform = |seconds| site(seconds).platform_to_navigation(0.7);
        let (before, matrix, after) =
            (platform(seconds - 1e-5), platform(seconds), platform(seconds + 1e-5));
        // Cᵀ Ċ is the skew matrix of the rate on the platform's axes.
        let skew = |i: usize, j: usize| {
            (0..3).map(|k| matrix[k][i] * (after[k][j] - before[k][j]) / 2e-5).sum::<f64>()
        };
        let [x, _, z] = site(seconds).on_platform(0.7).rate_rad_s;
        let expected = 0.2_f64.cos() * (x + skew(2, 1)) - 0.2_f64.sin() * (z + skew(1, 0));
        // The difference quotient is good to h²/6 of the third derivative and 1e-16/h.
        assert_near(rate(&mut plant, seconds), expected, 1e-7);
        let force = site(seconds).on_platform(0.7).force_m_s2;
        for (shown, expected) in plant.force_g(at(seconds)).iter().zip(force) {
            assert_near(*shown, expected / 9.806_65, 1e-11);
        }
    }
    assert_eq!(plant.truth().attitude, tilted().attitude());
}

#[test]
fn body_rates_of_single_turns_are_about_their_axes() {
    let level = Attitude::default();
    let turned = |rates_rad_s| BaseMotion { lean: level, rates_rad_s }.body_rad_s(&level);
    assert_eq!(turned([1.0, 0.0, 0.0]), [0.0, 0.0, 1.0]);
    assert_eq!(turned([0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]);
    assert_eq!(turned([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
}
