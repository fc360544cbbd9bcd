//! What goes wrong with a turning platform, and that the plant shows what the turntable does.

use std::f64::consts::TAU;

use embassy_time::Instant;
use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::disturbance::Disturbance;
use hal_mock::environment::{AnalogueInput, ForceInput, Mechanics, ShaftAngle};
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{Plant, PlantConfiguration, StageFault};
use hal_mock::turntable::{EncoderSlip, Segment, TurntableConfiguration};

use super::{PER_RAD, assert_near, at, run};

const RATE_RAD_S: f64 = 0.86;

fn endless(faults: &[StageFault]) -> Plant<'_> {
    let stage = StageConfiguration::endless();
    Plant::new(&PlantConfiguration { stage, faults, ..Default::default() }, 1)
}

/// What the encoder shows more than the truth, rad.
fn slipped(plant: &mut Plant, seconds: f64) -> f64 {
    let shown = plant.shaft_turns(at(seconds)) * TAU;
    shown - plant.truth().stage.angle_rad
}

#[test]
fn a_creeping_magnet_shows_more_for_every_second_of_turning_and_keeps_it_at_rest() {
    let faults = [
        StageFault::Creep { from: at(5.0), rad_per_s: 1e-3 },
        StageFault::Slip { at: at(8.0), by_rad: 0.02 },
    ];
    let mut plant = endless(&faults);
    plant.drive(at(0.0), 0.0, RATE_RAD_S * PER_RAD);
    for (seconds, expected) in [(3.0, 0.0), (5.0, 0.0), (6.0, 1e-3), (7.5, 2.5e-3), (8.0, 0.023)] {
        assert_near(slipped(&mut plant, seconds), expected, 1e-12);
    }
    plant.drive(at(10.0), 10.0 * RATE_RAD_S * PER_RAD, 0.0);
    for seconds in [10.0, 20.0, 30.0] {
        assert_near(slipped(&mut plant, seconds), 0.025, 1e-12);
    }
    // The other way it goes on in the same direction.
    plant.drive(at(30.0), 10.0 * RATE_RAD_S * PER_RAD, -RATE_RAD_S * PER_RAD);
    assert_near(slipped(&mut plant, 32.0), 0.027, 1e-12);
}

#[test]
fn creeping_does_not_depend_on_how_often_the_motor_is_given_the_same() {
    let faults = [StageFault::Creep { from: Instant::MIN, rad_per_s: -2e-3 }];
    let (mut often, mut once) = (endless(&faults), endless(&faults));
    once.drive(at(0.0), 0.0, RATE_RAD_S * PER_RAD);
    for k in 0..10_000 {
        let seconds = f64::from(k) * 1e-3;
        often.drive(at(seconds), RATE_RAD_S * seconds * PER_RAD, RATE_RAD_S * PER_RAD);
    }
    assert_near(slipped(&mut once, 10.0), -0.02, 1e-12);
    assert_near(slipped(&mut often, 10.0), -0.02, 1e-12);
}

#[test]
fn the_turntables_encoder_slips_and_creeps_too() {
    let segments = [Segment::steady(RATE_RAD_S, 10.0), Segment::steady(0.0, 5.0)];
    let slip = EncoderSlip { from_s: 4.0, by_rad: 0.1, rad_per_s: 0.01 };
    let clean = TurntableConfiguration { segments: &segments, ..Default::default() };
    let samples = run(&TurntableConfiguration { slip, ..clean }, 1);
    for (sample, clean) in samples.iter().zip(run(&clean, 1)) {
        let expected = match sample.time_s {
            ..4.0 => 0.0,
            time_s => 0.1 + 0.01 * (time_s.min(10.0) - 4.0),
        };
        assert_near(sample.stage_rad - clean.stage_rad, expected, 1e-12);
        assert_eq!(sample.rate_rad_s, clean.rate_rad_s);
    }
}

#[test]
fn a_platform_that_is_caught_stops_and_its_gyro_no_longer_feels_the_turning() {
    let faults = [StageFault::Block { from: at(4.0), until: at(6.0) }];
    let gyro = GyroConfiguration { axis_elevation_rad: 0.01, ..GyroConfiguration::default() };
    let configuration = PlantConfiguration {
        instruments: InstrumentsConfiguration { gyro, ..Default::default() },
        gyro_volts_per_rad_s: 1.0,
        stage: StageConfiguration::endless(),
        faults: &faults,
        ..Default::default()
    };
    let mut plant = Plant::new(&configuration, 1);
    plant.drive(at(0.0), 0.0, RATE_RAD_S * PER_RAD);
    for (seconds, turned, rate) in [(3.0, 3.0, RATE_RAD_S), (5.0, 4.0, 0.0), (7.0, 5.0, RATE_RAD_S)]
    {
        let shown = plant.volts(at(seconds));
        assert_near(plant.truth().stage.angle_rad, turned * RATE_RAD_S, 2e-3);
        assert_near(shown, -0.01_f64.sin() * rate, 8e-5);
        assert_eq!(plant.is_blocked(), rate == 0.0);
    }
}

#[test]
fn a_push_takes_the_accelerometer_beyond_its_range_and_leaves_the_gyro_alone() {
    let disturbances = [Disturbance::force_overload(1.0, 0.5)];
    let configuration = PlantConfiguration { disturbances: &disturbances, ..Default::default() };
    let mut plant = Plant::new(&configuration, 1);
    let segments = [Segment::steady(0.0, 3.0)];
    let mut clipping = TurntableConfiguration {
        segments: &segments,
        disturbances: &disturbances,
        ..Default::default()
    };
    clipping.instruments.accelerometer.full_scale_m_s2 = Some(20.08);
    let (level, still) = (plant.force_g(at(0.0)), plant.volts(at(0.0)));
    for sample in run(&clipping, 1) {
        let pushed = (1.0..1.5).contains(&sample.time_s);
        let force = plant.force_g(at(sample.time_s));
        assert_eq!([force[1], force[2]], [level[1], level[2]]);
        assert_eq!(force[0].abs() > 2.5, pushed);
        assert_eq!(plant.volts(at(sample.time_s)), still);
        assert_near(sample.force_m_s2[0], if pushed { 20.08 } else { 0.0 }, 1e-12);
    }
}

#[test]
fn an_accelerometer_off_the_axis_feels_the_turning_and_its_changes() {
    let lever = [0.05, -0.02];
    let wave = Segment::steady(RATE_RAD_S, 20.0).modulated(0.25, 0.1);
    let segments = [wave];
    let instruments = InstrumentsConfiguration { rate_hz: 1000.0, ..Default::default() };
    let configuration = TurntableConfiguration {
        instruments,
        accelerometer_lever_m: lever,
        segments: &segments,
        ..Default::default()
    };
    for sample in run(&configuration, 1).iter().skip(1) {
        // The mean over the sample before is the acceleration half a sample ago.
        let cosine = (TAU * 0.1 * (sample.time_s - 0.5e-3)).cos();
        let angular = RATE_RAD_S * 0.25 * TAU * 0.1 * cosine;
        let square = sample.stage_rate_rad_s * sample.stage_rate_rad_s;
        let [x, y, _] = sample.force_m_s2;
        assert_near(x, -square * lever[0] - angular * lever[1], 1e-9);
        assert_near(y, -square * lever[1] + angular * lever[0], 1e-9);
    }
    let stage = StageConfiguration::endless();
    let plant = PlantConfiguration { stage, accelerometer_lever_m: lever, ..Default::default() };
    let mut plant = Plant::new(&plant, 1);
    plant.drive(at(0.0), 0.0, RATE_RAD_S * PER_RAD);
    plant.force_g(at(0.5));
    let steady = plant.force_g(at(1.0))[0] * 9.806_65;
    assert_near(steady, -RATE_RAD_S * RATE_RAD_S * lever[0], 1e-12);
}

#[test]
fn a_molecular_sensor_on_the_plant_gives_the_converter_what_the_turntable_shows() {
    let gyro = GyroConfiguration {
        n_deg_sqrt_h: 0.02,
        b_deg_h: 0.5,
        bias_sigma_deg_h: 3.0,
        axis_elevation_rad: 0.01,
        molecular: Some(MolecularConfiguration {
            force_rad_s2_g: [1e-3, -2e-3],
            high_pass_hz: 0.03,
            lag_s: 0.1,
        }),
        ..GyroConfiguration::default()
    };
    let accelerometer =
        AccelerometerConfiguration { noise_m_s2_sqrt_hz: 2e-4, ..Default::default() };
    let site =
        InstrumentsConfiguration { latitude_deg: 50.0, gyro, accelerometer, ..Default::default() };
    let instruments = site.leaning(0.3, 70.0);
    let segments = [Segment::steady(RATE_RAD_S, 60.0)];
    let table = TurntableConfiguration { instruments, segments: &segments, ..Default::default() };
    let configuration = PlantConfiguration {
        instruments,
        gyro_volts_per_rad_s: 2.0,
        accelerometer_hz: 100.0,
        stage: StageConfiguration::endless(),
        ..Default::default()
    };
    let mut plant = Plant::new(&configuration, 3);
    plant.drive(at(0.0), 0.0, RATE_RAD_S * PER_RAD);
    for sample in run(&table, 3) {
        let now = at(sample.time_s);
        assert_near(plant.volts(now) / 2.0, sample.rate_rad_s, 1e-13);
        assert_near(plant.force_g(now)[0] * 9.806_65, sample.force_m_s2[0], 1e-10);
        assert_near(plant.shaft_turns(now) * TAU, sample.stage_rad, 1e-10);
    }
}
