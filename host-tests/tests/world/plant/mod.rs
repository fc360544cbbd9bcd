//! Holds the plant to closed forms: mechanics of the stage, sway of the base, noise at each rate; and
//! the board to the order of its chips' events.

mod board;
mod sensors;
mod sway;

use std::f64::consts::{PI, TAU};

use embassy_time::Instant;
use hal_mock::environment::{AnalogueInput, Mechanics, ShaftAngle};
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::{Instruments, InstrumentsConfiguration};
use hal_mock::plant::sway::SwayConfiguration;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{Plant, PlantConfiguration, StageFault};
use hal_mock::stage::{EncoderConfiguration, Harmonic, StageState};

use crate::support::{assert_near, at};

/// Microsteps in a radian of the stage.
const PER_RAD: f64 = 4_608_000.0 / TAU;

/// Rounding of microseconds and of 4 608 000 microsteps a turn in `f64`.
const EXACT: f64 = 1e-12;

/// A perfect plant with this stage.
fn with_stage(stage: StageConfiguration) -> Plant<'static> {
    Plant::new(&PlantConfiguration { stage, ..PlantConfiguration::default() }, 1)
}

/// Turns the field at a velocity from `from_s` on for a time, then stops it; all in rad.
fn rotate(plant: &mut Plant, from_s: f64, start_rad: f64, rate_rad_s: f64, seconds: f64) {
    plant.drive(at(from_s), start_rad * PER_RAD, rate_rad_s * PER_RAD);
    let end = start_rad + rate_rad_s * seconds;
    plant.drive(at(from_s + seconds), end * PER_RAD, 0.0);
}

fn angle(plant: &mut Plant, seconds: f64) -> f64 {
    plant.advance(at(seconds));
    plant.truth().stage.angle_rad
}

/// What the gyro shows, rad/s.
fn rate(plant: &mut Plant, seconds: f64) -> f64 {
    plant.volts(at(seconds)) / (0.05_f64 * 180.0 / PI)
}

/// A base that is not level, away from the equator.
fn tilted() -> InstrumentsConfiguration {
    InstrumentsConfiguration {
        latitude_deg: 55.0,
        azimuth_deg: 70.0,
        pitch_deg: 2.0,
        roll_deg: -1.0,
        ..InstrumentsConfiguration::default()
    }
}

// Motor and stage --------------------------------------------------------------------------------

#[test]
fn the_stage_follows_the_motor_from_its_start_angle() {
    let mut plant = with_stage(StageConfiguration { start_rad: 0.5, ..Default::default() });
    assert_eq!(plant.truth().stage, StageState { angle_rad: 0.5, rate_rad_s: 0.0 });
    plant.drive(at(1.0), 0.0, 460_800.0);
    assert_near(angle(&mut plant, 1.5), 0.5 + 0.05 * TAU, EXACT);
    assert_near(plant.truth().stage.rate_rad_s, 0.1 * TAU, EXACT);
    plant.drive(at(2.0), 460_800.0, -100.0);
    assert_near(angle(&mut plant, 2.0), 0.5 + 0.1 * TAU, EXACT);
    plant.drive(at(3.0), 460_700.0, 0.0);
    assert_near(angle(&mut plant, 9.0), 0.5 + 460_700.0 / PER_RAD, EXACT);
    assert_near(plant.shaft_turns(at(9.0)) * TAU, angle(&mut plant, 9.0), EXACT);
    assert_eq!(plant.truth().stage.rate_rad_s, 0.0);
}

#[test]
fn the_motion_does_not_depend_on_how_often_it_is_looked_at() {
    let stage = StageConfiguration { backlash_rad: 0.01, ..Default::default() };
    let (mut watched, mut alone) = (with_stage(stage), with_stage(stage));
    for plant in [&mut watched, &mut alone] {
        plant.drive(at(0.0), 0.0, 0.3 * PER_RAD);
    }
    for step in 1..3000 {
        watched.advance(at(f64::from(step) * 1e-3));
    }
    for plant in [&mut watched, &mut alone] {
        plant.drive(at(3.0), 0.9 * PER_RAD, -0.2 * PER_RAD);
    }
    assert_eq!(angle(&mut watched, 4.0), angle(&mut alone, 4.0));
}

#[test]
fn a_field_that_jumps_takes_the_rotor_to_the_nearest_of_its_equal_positions() {
    let mut plant = with_stage(StageConfiguration::default());
    rotate(&mut plant, 0.0, 0.0, 0.5, 2.0);
    // A driver that starts again counts from zero: the rotor moves by less than two full steps.
    let microsteps = PER_RAD.floor();
    plant.drive(at(3.0), microsteps, 0.0);
    plant.drive(at(4.0), 0.0, 0.0);
    let rest = microsteps.rem_euclid(1024.0);
    let moved = if rest < 512.0 { -rest } else { 1024.0 - rest };
    assert_near(angle(&mut plant, 5.0), (microsteps + moved) / PER_RAD, EXACT);
    // And counts on from there.
    rotate(&mut plant, 6.0, 0.0, 0.1, 1.0);
    assert_near(angle(&mut plant, 8.0), (microsteps + moved) / PER_RAD + 0.1, EXACT);
}

/// Takes the motor from one angle to another within a second, and tells where the stage is then.
fn carry(plant: &mut Plant, from_s: f64, from_rad: f64, to_rad: f64) -> f64 {
    rotate(plant, from_s, from_rad, to_rad - from_rad, 1.0);
    angle(plant, from_s + 1.0)
}

#[test]
fn backlash_is_a_hysteresis_as_wide_as_the_play() {
    let play = 2e-3;
    let mut plant = with_stage(StageConfiguration { backlash_rad: play, ..Default::default() });
    // Up, down, a turn within the play, up again: the stage trails by half the play on the way.
    let turns = [(0.5, 0.499), (1.0, 0.999), (0.9985, 0.999), (0.3, 0.301), (0.3015, 0.301)];
    let (mut seconds, mut motor) = (0.0, 0.0);
    for (to, expected) in turns {
        assert_near(carry(&mut plant, seconds, motor, to), expected, EXACT);
        (seconds, motor) = (seconds + 2.0, to);
    }
    assert_near(carry(&mut plant, seconds, motor, 0.5), 0.499, EXACT);
}

#[test]
fn the_stage_moves_when_the_play_is_used_up() {
    let mut plant = with_stage(StageConfiguration { backlash_rad: 2e-3, ..Default::default() });
    plant.drive(at(0.0), 0.0, 0.1 * PER_RAD);
    assert_eq!(angle(&mut plant, 0.0099), 0.0);
    assert_eq!(plant.truth().stage.rate_rad_s, 0.0);
    assert_near(angle(&mut plant, 0.0101), 1e-5, EXACT);
    assert_near(plant.truth().stage.rate_rad_s, 0.1, EXACT);
}

// Ringing ----------------------------------------------------------------------------------------

const RINGING_HZ: f64 = 20.0;
const DAMPING: f64 = 0.1;

fn elastic() -> StageConfiguration {
    StageConfiguration { ringing_hz: RINGING_HZ, ringing_damping: DAMPING, ..Default::default() }
}

#[test]
fn a_stage_whose_motor_stops_at_once_rings_as_a_damped_oscillator() {
    let mut plant = with_stage(elastic());
    // It has swung in after 3 s.
    rotate(&mut plant, 0.0, 0.0, 0.2, 3.0);
    let omega = TAU * RINGING_HZ;
    let (decay, damped) = (DAMPING * omega, omega * (1.0 - DAMPING * DAMPING).sqrt());
    for step in 0..400 {
        let t = f64::from(step) * 1e-3;
        let expected = 0.2 / damped * (-decay * t).exp() * (damped * t).sin();
        assert_near(angle(&mut plant, 3.0 + t) - 0.6, expected, 1e-9);
        let rate =
            0.2 * (-decay * t).exp() * ((damped * t).cos() - decay / damped * (damped * t).sin());
        assert_near(plant.truth().stage.rate_rad_s, rate, 1e-7);
    }
    // Half a second leaves 0.2 % of it; then it rests in the end.
    assert!((angle(&mut plant, 3.5) - 0.6).abs() < 0.002 * 0.2 / damped);
    assert_near(angle(&mut plant, 5.0), 0.6, EXACT);
    assert_eq!(plant.truth().stage.rate_rad_s, 0.0);
}

#[test]
fn a_stage_does_not_jump_where_its_motor_does() {
    let mut plant = with_stage(elastic());
    plant.drive(at(0.0), 0.0, 0.2 * PER_RAD);
    assert_eq!(plant.truth().stage, StageState::default());
    plant.advance(at(1.0));
    let before = plant.truth().stage;
    plant.drive(at(1.0), 0.2 * PER_RAD + 100.0, 0.0);
    assert_near(plant.truth().stage.angle_rad, before.angle_rad, EXACT);
    assert_near(plant.truth().stage.rate_rad_s, before.rate_rad_s, EXACT);
}

#[test]
fn a_steady_deceleration_in_small_steps_ends_with_a_over_omega_squared() {
    // 0.5 rad/s down to rest with 1 rad/s², commanded every millisecond at its mean velocity.
    let mut plant = with_stage(elastic());
    plant.drive(at(0.0), 0.0, 0.5 * PER_RAD);
    let mut motor = 1.0;
    for step in 0..500 {
        let mean = 0.5 - 1e-3 * (f64::from(step) + 0.5);
        plant.drive(at(2.0 + f64::from(step) * 1e-3), motor * PER_RAD, mean * PER_RAD);
        motor += mean * 1e-3;
    }
    plant.drive(at(2.5), motor * PER_RAD, 0.0);
    assert_near(motor, 1.125, EXACT);
    let omega = TAU * RINGING_HZ;
    let lead = 1.0 / (omega * omega);
    // The start of the deceleration still rings by exp(−2πζft) = 0.2 % when it ends.
    assert_near(angle(&mut plant, 2.5) - motor, lead, 0.01 * lead);
    let half = 0.5 / (RINGING_HZ * (1.0 - DAMPING * DAMPING).sqrt());
    let overshoot = (-DAMPING * omega * half).exp() * lead;
    assert_near(angle(&mut plant, 2.5 + half) - motor, -overshoot, 0.03 * lead);
}

// Ends, switches, faults -------------------------------------------------------------------------

#[test]
fn the_stage_stops_at_the_ends_of_its_travel_and_the_motor_loses_steps() {
    let stage = StageConfiguration { travel_rad: [-0.1, 0.5], ..Default::default() };
    let mut plant = with_stage(stage);
    plant.drive(at(0.0), 0.0, 0.1 * PER_RAD);
    plant.advance(at(4.999));
    assert!(!plant.is_blocked());
    assert_near(angle(&mut plant, 5.001), 0.5, EXACT);
    assert!(plant.is_blocked());
    assert_eq!(plant.truth().stage.rate_rad_s, 0.0);
    // Three seconds of steps are lost: the way back begins at once, and is too long by as much.
    plant.drive(at(8.0), 0.8 * PER_RAD, -0.1 * PER_RAD);
    assert!(!plant.is_blocked());
    assert_near(angle(&mut plant, 10.0), 0.3, EXACT);
    assert_near(angle(&mut plant, 13.9), -0.09, EXACT);
    assert_near(angle(&mut plant, 20.0), -0.1, EXACT);
    assert!(plant.is_blocked());
    plant.drive(at(20.0), -0.4 * PER_RAD, 0.0);
    assert!(!plant.is_blocked());
    // A field that jumps on against the end loses its steps too.
    plant.drive(at(21.0), -0.4 * PER_RAD - 300.0, 0.0);
    plant.drive(at(22.0), -0.4 * PER_RAD - 300.0, 0.1 * PER_RAD);
    assert_near(angle(&mut plant, 23.0), 0.0, EXACT);
}

#[test]
fn the_reference_switches_close_beyond_their_angles() {
    let stage = StageConfiguration { switches_rad: [-0.05, 0.4], ..Default::default() };
    let mut plant = with_stage(stage);
    assert_eq!(plant.reference_switches(), [false, false]);
    plant.drive(at(0.0), 0.0, -0.01 * PER_RAD);
    for (seconds, expected) in [(4.999, false), (5.001, true)] {
        plant.advance(at(seconds));
        assert_eq!(plant.reference_switches(), [expected, false]);
    }
    plant.drive(at(6.0), -0.06 * PER_RAD, 0.1 * PER_RAD);
    for (seconds, expected) in [(10.599, false), (10.601, true)] {
        plant.advance(at(seconds));
        assert_eq!(plant.reference_switches(), [false, expected]);
    }
}

#[test]
fn a_blocked_stage_stands_while_its_motor_turns_and_has_lost_the_steps_after_it() {
    let faults = [StageFault::Block { from: at(2.0), until: at(3.0) }];
    let configuration =
        PlantConfiguration { stage: elastic(), faults: &faults, ..PlantConfiguration::default() };
    let mut plant = Plant::new(&configuration, 1);
    plant.drive(at(0.0), 0.0, 0.1 * PER_RAD);
    plant.advance(at(1.999_999));
    assert!(!plant.is_blocked());
    for seconds in [2.0, 2.5, 2.999_999] {
        assert_near(angle(&mut plant, seconds), 0.2, 1e-9);
        assert!(plant.is_blocked());
        assert_eq!(plant.truth().stage.rate_rad_s, 0.0);
    }
    // Let go, it follows again, one second of steps behind.
    plant.advance(at(3.0));
    assert!(!plant.is_blocked());
    plant.drive(at(5.0), 0.5 * PER_RAD, 0.0);
    assert_near(angle(&mut plant, 8.0), 0.4, 1e-9);
}

#[test]
fn a_stage_may_be_blocked_from_the_beginning_and_for_good() {
    let faults = [StageFault::Block { from: Instant::MIN, until: Instant::MAX }];
    let configuration = PlantConfiguration { faults: &faults, ..PlantConfiguration::default() };
    let mut plant = Plant::new(&configuration, 1);
    assert!(plant.is_blocked());
    rotate(&mut plant, 0.0, 0.0, 1.0, 3.0);
    assert_eq!(angle(&mut plant, 100.0), 0.0);
}

#[test]
fn a_slipped_magnet_shows_another_angle_from_then_on_and_the_stage_is_where_it_was() {
    let faults = [StageFault::Slip { at: at(5.0), by_rad: 0.02 }];
    let first = Harmonic { amplitude_rad: 1e-4, phase_rad: 0.5 };
    let second = Harmonic { amplitude_rad: 3e-5, phase_rad: -1.0 };
    let encoder = EncoderConfiguration { step_rad: 0.0, first, second };
    let instruments = InstrumentsConfiguration { encoder, ..Default::default() };
    let configuration = PlantConfiguration { instruments, faults: &faults, ..Default::default() };
    let mut plant = Plant::new(&configuration, 1);
    rotate(&mut plant, 0.0, 0.0, 0.7, 1.0);
    let shown = 0.7 + 1e-4 * 1.2_f64.sin() + 3e-5 * 0.4_f64.sin();
    assert_near(plant.shaft_turns(at(4.999_999)) * TAU, shown, EXACT);
    assert_near(plant.shaft_turns(at(5.0)) * TAU, shown + 0.02, EXACT);
    assert_near(angle(&mut plant, 6.0), 0.7, EXACT);
}

// The whole -------------------------------------------------------------------------------------

#[test]
fn the_plant_fits_a_small_memory() {
    assert!(size_of::<Plant>() <= 2560, "{}", size_of::<Plant>());
    // The same on a chip of 32 bit, less its narrower pointers: what is left is f64 and u64.
    assert!(size_of::<Instruments>() <= 1280, "{}", size_of::<Instruments>());
}

#[test]
fn one_seed_gives_one_run_of_the_plant_bit_for_bit() {
    let gyro = GyroConfiguration { n_deg_sqrt_h: 0.02, b_deg_h: 1.0, ..Default::default() };
    let configuration = PlantConfiguration {
        instruments: InstrumentsConfiguration { gyro, ..tilted() },
        converter_noise_v: 1e-6,
        stage: StageConfiguration { backlash_rad: 1e-4, ..elastic() },
        sway: SwayConfiguration { components: sway::WILD },
        ..Default::default()
    };
    let run = |seed| {
        let mut plant = Plant::new(&configuration, seed);
        rotate(&mut plant, 0.1, 0.0, 0.3, 0.5);
        (0..1000).map(|tick| plant.volts(Instant::from_millis(600 + tick)).to_bits()).collect()
    };
    let (one, again, other): (Vec<u64>, Vec<u64>, Vec<u64>) = (run(7), run(7), run(8));
    assert_eq!(one, again);
    assert!(one.iter().zip(&other).all(|(one, other)| one != other));
}
