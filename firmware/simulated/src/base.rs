//! The coarse IMU on the simulated base, on an I²C bus of its own.
//!
//! What it feels depends on time alone, so it needs no place among the chips of the board.

use core::cell::RefCell;

use drivers::lsm6dsl::registers::{ADDRESS_LOW, OutputRate};
use drivers::lsm6dsl::{self, Lsm6dsl};
use embassy_time::{Delay, Instant};
use hal_mock::chip::Single;
use hal_mock::i2c::{I2cChip, I2cPort};
use hal_mock::lsm6dsl::Lsm6dsl as SimulatedImu;
use hal_mock::plant::base::{Base, CoarseConfiguration};
use hal_mock::plant::journey::JourneyConfiguration;
use hal_mock::violation::Violation;
use orientation::attitude as keep;
use orientation::noise::model::GyroNoise;
use orientation::signal::sway::CoarseSensors;
use orientation::units::{DEGREE, RadiansPerSecond};

use super::coarse::CoarseClass;
use super::fault::PortWrapper;
use super::scenario::{Scenario, sway};
use firmware::chips::BaseImu;
use firmware::output_clock::LEAST_READINGS;

/// Greatest rate at which the base IMU is read, Hz.
const READ_HERTZ: f64 = 200.0;
/// Output rates of the chip, the fastest first.
const OUTPUTS: [OutputRate; 4] =
    [OutputRate::Hz104, OutputRate::Hz52, OutputRate::Hz26, OutputRate::Hz12];
/// Ratio of the chip's oscillator to the nominal one.
const CLOCK: f64 = 1.015;
/// 1σ of the gyros' zero-rate level, °/s: ±3 °/s (data sheet, `G_TyOff`).
const RATE_BIAS: f64 = 3.0;
/// 1σ of the accelerometers' offset, mg: ±40 mg (data sheet, `LA_TyOff`) at two σ.
const FORCE_BIAS: f64 = 20.0;
/// 1σ of the accelerometers' biases once they are calibrated, as where the sensors keep pitch and roll, mg.
const CALIBRATED: f64 = 2.0;
/// 1σ of the scale of each axis: ±1 % at two σ, as later chips of the family state it.
const SCALE: f64 = 0.005;
/// From the point that the base sways about to the chip, body axes, m: it stands above it.
const LEVER: [f64; 3] = [0.1, 0.0, -0.4];

/// What the board takes for the noise of the sensors over what their data sheets call typical: the
/// oscillator is off by some per cent, and as the axis turns its angle error shares
/// less with that of the dwell before than the whitening believes (4 % of σ on a circle of 24).
const STATED: f64 = 1.05;

/// A base IMU and the base under it.
pub type Rig<'a> = Single<SimulatedImu, Base<'a>>;

/// The base IMU of a scenario, which gets its supply when the clock begins.
#[must_use]
pub fn rig<'a>(scenario: &Scenario, journey: Option<&JourneyConfiguration<'a>>) -> Rig<'a> {
    let coarse = CoarseConfiguration {
        rate_hz: f64::from(output(scenario).hertz()) * CLOCK,
        rate_noise_mdps_sqrt_hz: scenario.coarse.rate_mdps_sqrt_hz,
        rate_bias_sigma_deg_s: RATE_BIAS,
        force_noise_ug_sqrt_hz: scenario.coarse.force_ug_sqrt_hz,
        force_bias_sigma_mg: if journey.is_some() { CALIBRATED } else { FORCE_BIAS },
        scale_sigma: SCALE,
        lever_m: LEVER,
    };
    let instruments = scenario.instruments();
    let environment = Base::new(&instruments, &sway(scenario), &coarse, journey, scenario.seed);
    Single { chip: SimulatedImu::new(Instant::MIN, ADDRESS_LOW, CLOCK), environment }
}

/// A base IMU behind a simulated bus with a wrapper around it.
pub type SimulatedBase<'r, 'a, A> =
    BaseImu<<A as PortWrapper>::I2c<I2cPort<'r, SimulatedImu, Base<'a>>>, Delay>;

/// The port of a base IMU with a wrapper around its bus.
pub fn imu<'r, 'a, A: PortWrapper>(
    rig: &'r RefCell<Rig<'a>>,
    scenario: &Scenario,
    wrapper: &A,
) -> SimulatedBase<'r, 'a, A> {
    let bus = wrapper.i2c(I2cPort::new(rig, lsm6dsl::BUS_HERTZ));
    let configuration =
        lsm6dsl::Configuration { output: output(scenario), ..lsm6dsl::Configuration::default() };
    BaseImu {
        chip: Lsm6dsl::new(bus, Delay, ADDRESS_LOW, configuration),
        sensors: sensors(scenario),
        divider: divider(scenario),
    }
}

/// What the driver did that the data sheet forbids.
#[must_use]
pub fn violations<'r>(rig: &'r Rig<'_>) -> &'r [Violation] {
    &I2cChip::<Base>::violations(&rig.chip).first
}

fn divider(scenario: &Scenario) -> u32 {
    (libm::round(scenario.sample_rate_hz / READ_HERTZ) as u32).max(1)
}

/// The fastest output rate of which every output is read, or the slowest there is.
fn output(scenario: &Scenario) -> OutputRate {
    let read = scenario.sample_rate_hz / f64::from(divider(scenario));
    let is_read = |output: &OutputRate| read >= LEAST_READINGS * f64::from(output.hertz());
    OUTPUTS.into_iter().find(is_read).unwrap_or(OutputRate::Hz12)
}

/// What the board is given: the class, and the times of its readings.
fn sensors(scenario: &Scenario) -> CoarseSensors {
    let CoarseClass { rate_mdps_sqrt_hz, force_ug_sqrt_hz } = scenario.coarse;
    let sample = 1.0 / scenario.sample_rate_hz;
    let read = f64::from(divider(scenario)) * sample;
    CoarseSensors {
        mismatch: SCALE as f32,
        lever: 0.4,
        ..CoarseSensors::of_densities(rate_mdps_sqrt_hz * STATED, force_ug_sqrt_hz * STATED)
            .read_in_periods(period(scenario), read, sample)
    }
}

/// Seconds between two outputs, as the keeper is given them.
#[must_use]
pub(super) fn period(scenario: &Scenario) -> f64 {
    1.0 / f64::from(output(scenario).hertz())
}

/// The coarse gyros as the keeper is given them, and 1σ of the accelerometers' offsets, m/s².
pub(super) fn gyros(scenario: &Scenario) -> ([keep::Gyro; 3], f64) {
    let walk = STATED * scenario.coarse.rate_mdps_sqrt_hz * 1e-3 * 60.0;
    let class = keep::Gyro::coarse();
    let noise = GyroNoise::from_field_units(walk, 0.0, 0.0, 0.0);
    let gyro = keep::Gyro {
        noise: GyroNoise { angle_random_walk: noise.angle_random_walk, ..class.noise },
        bias_sigma: RadiansPerSecond(RATE_BIAS * DEGREE),
        scale_sigma: SCALE,
    };
    ([gyro; 3], CALIBRATED * 1e-3 * 9.80665)
}
