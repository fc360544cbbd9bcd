//! A stage without ends: an hour of turning, many commands a second, the motor driver's own ramps.

use embassy_time::{Duration, Instant};
use hal_mock::chip::{Rig as _, Select, Single, Transaction};
use hal_mock::environment::Mechanics;
use hal_mock::noise::Generator;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{Plant, PlantConfiguration};
use hal_mock::tmc5160::{Oscillator, Tmc5160};

use super::{PER_RAD, assert_near, at};

const HOUR_S: u32 = 3600;

fn with_stage(stage: StageConfiguration) -> Plant<'static> {
    Plant::new(&PlantConfiguration { stage, ..PlantConfiguration::default() }, 1)
}

/// An hour at about 1.5 rad/s with a new velocity fifty times a second; the field then, microsteps.
fn hour(plant: &mut Plant, direction: f64) -> f64 {
    let mut draw = Generator::new(5);
    let mut field = 0.0;
    for k in 0..50 * HOUR_S {
        // Velocities of whole microsteps in 20 ms add up without rounding.
        let moved = direction * ((1.4 + 0.2 * draw.uniform()) * 0.02 * PER_RAD).round();
        plant.drive(at(f64::from(k) * 0.02), field, moved * 50.0);
        assert!(!plant.is_blocked());
        let shown = plant.truth().stage.angle_rad;
        let is_marked = (30.0..40.0).contains(&shown.to_degrees().rem_euclid(360.0));
        assert_eq!(plant.reference_switches(), [is_marked, false]);
        if plant.truth().stage.rate_rad_s == moved * 50.0 / PER_RAD {
            assert_near(shown, field / PER_RAD, 1e-9);
        }
        field += moved;
    }
    field
}

#[test]
fn a_rigid_stage_on_a_slip_ring_follows_its_motor_for_an_hour_both_ways() {
    for direction in [1.0, -1.0] {
        let mut plant = with_stage(StageConfiguration::endless());
        let field = hour(&mut plant, direction);
        assert!(field.abs() / PER_RAD > 5300.0);
        let end = f64::from(HOUR_S);
        plant.drive(at(end), field, 0.0);
        assert_near(plant.truth().stage.angle_rad, field / PER_RAD, 1e-9);
        assert_eq!(plant.truth().stage.rate_rad_s, 0.0);
    }
}

#[test]
fn an_elastic_stage_with_play_comes_to_rest_after_an_hour_where_its_motor_left_it() {
    let stage = StageConfiguration {
        backlash_rad: 2e-4,
        ringing_hz: 20.0,
        ringing_damping: 0.1,
        ..StageConfiguration::endless()
    };
    for direction in [1.0, -1.0] {
        let mut plant = with_stage(stage);
        let field = hour(&mut plant, direction);
        plant.drive(at(3600.0), field, 0.0);
        plant.advance(at(3610.0));
        assert_near(plant.truth().stage.angle_rad, field / PER_RAD - direction * 1e-4, 1e-9);
        assert_eq!(plant.truth().stage.rate_rad_s, 0.0);
    }
}

/// Ramp units of the chip at 12 MHz (data sheet, 12.1): microsteps/s and microsteps/s².
const VELOCITY: f64 = 12e6 / 16_777_216.0;
const ACCELERATION: f64 = 12e6 * 12e6 / 2_199_023_255_552.0;

const RAMPMODE: u8 = 0x20;
const AMAX: u8 = 0x26;
const VMAX: u8 = 0x27;

/// The motor driver with its stage.
struct Rig(Single<Tmc5160, Plant<'static>>);

impl Rig {
    fn write(&mut self, now: Instant, address: u8, data: u32) {
        let [a, b, c, d] = data.to_be_bytes();
        let sent = [address | 0x80, a, b, c, d];
        let transaction = Transaction { now, hertz: 2_000_000, sent: &sent };
        self.0.transact(Select::Actuator, &transaction, &mut [0; 5]);
    }

    fn angle(&mut self, now: Instant) -> f64 {
        self.0.ready_line(Select::Actuator, now);
        self.0.environment.advance(now);
        self.0.environment.truth().stage.angle_rad
    }
}

#[test]
fn the_motor_driver_turns_an_endless_stage_in_velocity_mode_as_its_ramps_say() {
    let chip = Tmc5160::new(Oscillator::Internal { hertz: 12_000_000 }, Instant::MIN);
    let environment = with_stage(StageConfiguration::endless());
    let mut rig = Rig(Single { chip, environment });
    let acceleration = 20_000_u32;
    let mut now = Instant::from_millis(1);
    rig.write(now, AMAX, acceleration);
    rig.write(now, RAMPMODE, 1);
    let mut draw = Generator::new(9);
    let (mut speed, mut field) = (0.0, 0.0);
    // An hour with a new velocity every 100 ms; XACTUAL wraps around nearly twice.
    for k in 0..10 * HOUR_S {
        let asked = (1.2e6 + 6e5 * draw.uniform()).round() as u32;
        rig.write(now, VMAX, asked);
        now += Duration::from_millis(100);
        let to = f64::from(asked) * VELOCITY;
        let slope = f64::from(acceleration) * ACCELERATION;
        // The ramp ends within the 100 ms, except for the first ones from rest.
        let ramp = ((to - speed).abs() / slope).min(0.1);
        let reached = speed + (to - speed).signum() * slope * ramp;
        field += 0.5 * (speed + reached) * ramp + reached * (0.1 - ramp);
        speed = reached;
        if k % 1000 == 999 {
            let angle = rig.angle(now);
            assert_near(angle, field / PER_RAD, 1e-6);
            let fraction_rad = 1.0 / PER_RAD;
            assert_near(angle, rig.0.chip.field() as f64 / PER_RAD, fraction_rad);
        }
    }
    assert!(field / PER_RAD > 4600.0);
    // And to a stop with the same slope.
    rig.write(now, VMAX, 0);
    now += Duration::from_secs(20);
    let slope = f64::from(acceleration) * ACCELERATION;
    let end = field + 0.5 * speed * speed / slope;
    assert_near(rig.angle(now), end / PER_RAD, 1e-6);
    assert_eq!(rig.0.environment.truth().stage.rate_rad_s, 0.0);
}
