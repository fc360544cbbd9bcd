//! The board as it is simulated: chips, stage and Earth of `hal-mock` behind the instrument's ports.
//!
//! Host and emulator run exactly this, so that their results can be compared bit for bit.

pub mod base;
pub mod fault;
pub mod flash;
pub mod keep;
pub mod mount;
pub mod scenario;
pub mod spin;
pub mod turntable;
pub mod vehicle;

use core::cell::RefCell;

use drivers::ads1262::Ads1262;
use drivers::adxl355::{self, Adxl355};
use drivers::mt6835::{self, Mt6835};
use drivers::tmc5160::configuration::Configuration as Motor;
use drivers::tmc5160::{self, Tmc5160};
use embassy_time::{Delay, Instant};
use hal_mock::ads1262::Ads1262 as SimulatedConverter;
use hal_mock::adxl355::Adxl355 as SimulatedAccelerometer;
use hal_mock::board::Board;
use hal_mock::chip::{Rig, Select};
use hal_mock::mt6835::Mt6835 as SimulatedEncoder;
use hal_mock::plant::journey::JourneyConfiguration;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{Plant, PlantConfiguration};
use hal_mock::spi::{ReadyPin, SpiPort};
use hal_mock::tmc5160::{Oscillator, Tmc5160 as SimulatedMotorDriver};

use self::fault::{Injection, PortWrapper};
use self::scenario::Scenario;
use crate::chips;
use crate::ports::{NoBase, Ports, Sensors};

/// Bus clock of the gyro's converter, Hz; it allows 8 MHz.
const CONVERTER_HERTZ: u32 = 5_000_000;

/// The motor driver's oscillator, 2 % fast: positions do not depend on it, velocities do.
const OSCILLATOR: Oscillator = Oscillator::Internal { hertz: 12_240_000 };

/// The simulated chips around their plant.
pub type Chips<'a> =
    Board<'a, SimulatedConverter, SimulatedAccelerometer, SimulatedEncoder, SimulatedMotorDriver>;

/// The simulated board of a scenario with what goes wrong with it.
#[must_use]
pub fn board<'a>(scenario: &Scenario, injection: &'a Injection) -> Chips<'a> {
    board_around(&scenario.plant(), scenario.seed, injection)
}

/// The same on a base that drives off.
#[must_use]
pub fn board_riding<'a>(
    scenario: &Scenario,
    journey: JourneyConfiguration<'a>,
    injection: &'a Injection,
) -> Chips<'a> {
    let plant = PlantConfiguration { journey: Some(journey), ..scenario.plant() };
    board_around(&plant, scenario.seed, injection)
}

/// The same around any plant.
fn board_around<'a>(
    plant: &PlantConfiguration<'a>,
    seed: u64,
    injection: &'a Injection,
) -> Chips<'a> {
    let [low, high] = plant.stage.travel_rad;
    let travel_rad = [low, injection.caught.outer.unwrap_or(high)];
    let configuration = PlantConfiguration {
        stage: StageConfiguration { travel_rad, ..plant.stage },
        disturbances: &injection.disturbances,
        faults: &injection.axes.outer,
        ..*plant
    };
    Board {
        plant: Plant::new(&configuration, seed),
        gyro: SimulatedConverter::new(),
        accelerometer: SimulatedAccelerometer::new(Instant::MIN),
        encoder: SimulatedEncoder::new(Instant::MIN),
        actuator: SimulatedMotorDriver::new(OSCILLATOR, Instant::MIN),
        blackouts: &injection.blackouts,
    }
}

/// A simulated serial bus with a wrapper around it.
type Bus<'a, B, A> = <A as PortWrapper>::Spi<SpiPort<'a, B>>;

/// The sensors of a simulated board.
pub type SimulatedSensors<'a, B, A> = Sensors<
    chips::AnalogueGyro<Bus<'a, B, A>, <A as PortWrapper>::Line<ReadyPin<'a, B>>, Delay>,
    chips::PlatformAccelerometer<Bus<'a, B, A>, Delay>,
    chips::StageEncoder<Bus<'a, B, A>, Delay>,
>;

/// The other ports of a simulated board.
pub type SimulatedPorts<'a, B, A, L, R> = Ports<chips::StageMotor<Bus<'a, B, A>, Delay>, L, R>;

/// The bus of one chip, with a clock of `hertz`.
fn bus<'a, B: Rig, A: PortWrapper>(
    board: &'a RefCell<B>,
    wrapper: &A,
    select: Select,
    hertz: u32,
) -> Bus<'a, B, A> {
    wrapper.spi(select, SpiPort::new(board, select, hertz))
}

/// The sensors of a simulated board.
pub fn sensors<'a, B: Rig, A: PortWrapper>(
    board: &'a RefCell<B>,
    scenario: &Scenario,
    wrapper: &A,
) -> SimulatedSensors<'a, B, A> {
    sensors_with(board, scenario, scenario::accelerometer(), wrapper)
}

/// The same with an accelerometer that is told something else.
fn sensors_with<'a, B: Rig, A: PortWrapper>(
    board: &'a RefCell<B>,
    scenario: &Scenario,
    force: adxl355::Configuration,
    wrapper: &A,
) -> SimulatedSensors<'a, B, A> {
    let bus = |select, hertz| bus(board, wrapper, select, hertz);
    let converter = bus(Select::Gyro, CONVERTER_HERTZ);
    let ready = wrapper.line(Select::Gyro, ReadyPin::new(board, Select::Gyro));
    let accelerometer = bus(Select::Accelerometer, adxl355::BUS_HERTZ);
    let accelerometer = Adxl355::new(accelerometer, Delay, force);
    Sensors {
        gyro: chips::AnalogueGyro {
            converter: Ads1262::new(converter, ready, Delay, scenario.converter()),
            scale: scenario::SCALE,
            limit: scenario::LIMIT,
        },
        accelerometer: chips::PlatformAccelerometer(accelerometer),
        encoder: encoder(board, wrapper, Select::Encoder),
        base: NoBase,
    }
}

/// The encoder of a stage or of one of its frames.
fn encoder<'a, B: Rig, A: PortWrapper>(
    board: &'a RefCell<B>,
    wrapper: &A,
    select: Select,
) -> chips::StageEncoder<Bus<'a, B, A>, Delay> {
    let bus = bus(board, wrapper, select, mt6835::BUS_HERTZ);
    chips::StageEncoder(Mt6835::new(bus, Delay, mt6835::Configuration::default()))
}

/// The motor of a stage or of one of its frames.
fn motor<'a, B: Rig, A: PortWrapper>(
    board: &'a RefCell<B>,
    wrapper: &A,
    select: Select,
    told: Motor,
) -> chips::StageMotor<Bus<'a, B, A>, Delay> {
    let bus = bus(board, wrapper, select, tmc5160::BUS_HERTZ);
    chips::StageMotor(Tmc5160::new(bus, Delay, told))
}

/// The other ports of a simulated board.
pub fn ports<'a, B: Rig, A: PortWrapper, L, R>(
    board: &'a RefCell<B>,
    wrapper: &A,
    link: L,
    recorder: R,
) -> SimulatedPorts<'a, B, A, L, R> {
    ports_with(board, wrapper, Motor::default(), link, recorder)
}

/// The same with a motor driver that is told something else.
fn ports_with<'a, B: Rig, A: PortWrapper, L, R>(
    board: &'a RefCell<B>,
    wrapper: &A,
    motor: Motor,
    link: L,
    recorder: R,
) -> SimulatedPorts<'a, B, A, L, R> {
    let actuator = self::motor(board, wrapper, Select::Actuator, motor);
    Ports { actuator, link, recorder }
}
