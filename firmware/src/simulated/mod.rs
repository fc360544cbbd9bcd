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
use embedded_hal_async::digital::Wait;
use embedded_hal_async::spi::SpiDevice;
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

use self::fault::Plan;
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

/// The simulated board of a scenario with a plan of faults.
#[must_use]
pub fn board<'a>(scenario: &Scenario, plan: &'a Plan) -> Chips<'a> {
    board_around(&scenario.plant(), scenario.seed, plan)
}

/// The same on a base that drives off.
#[must_use]
pub fn board_riding<'a>(
    scenario: &Scenario,
    journey: JourneyConfiguration<'a>,
    plan: &'a Plan,
) -> Chips<'a> {
    let plant = PlantConfiguration { journey: Some(journey), ..scenario.plant() };
    board_around(&plant, scenario.seed, plan)
}

/// The same around any plant.
fn board_around<'a>(plant: &PlantConfiguration<'a>, seed: u64, plan: &'a Plan) -> Chips<'a> {
    let [low, high] = plant.stage.travel_rad;
    let travel_rad = [low, plan.caught.unwrap_or(high)];
    let configuration = PlantConfiguration {
        stage: StageConfiguration { travel_rad, ..plant.stage },
        disturbances: &plan.disturbances,
        faults: &plan.stage,
        ..*plant
    };
    Board {
        plant: Plant::new(&configuration, seed),
        gyro: SimulatedConverter::new(),
        accelerometer: SimulatedAccelerometer::new(Instant::MIN),
        encoder: SimulatedEncoder::new(Instant::MIN),
        actuator: SimulatedMotorDriver::new(OSCILLATOR, Instant::MIN),
        blackouts: &plan.blackouts,
    }
}

/// What is put around the simulated ports: a plan of faults, or a meter.
pub trait Around {
    /// A bus with it around.
    type Spi<S: SpiDevice>: SpiDevice;
    /// A line with it around.
    type Line<W: Wait>: Wait;

    /// Puts it around the bus of a chip.
    fn spi<S: SpiDevice>(&self, select: Select, bus: S) -> Self::Spi<S>;

    /// Puts it around the data-ready line of a converter.
    fn line<W: Wait>(&self, select: Select, line: W) -> Self::Line<W>;
}

/// A simulated bus with something around it.
type Bus<'a, B, A> = <A as Around>::Spi<SpiPort<'a, B>>;

/// The sensors of a simulated board.
pub type SimulatedSensors<'a, B, A> = Sensors<
    chips::AnalogueGyro<Bus<'a, B, A>, <A as Around>::Line<ReadyPin<'a, B>>, Delay>,
    chips::PlatformAccelerometer<Bus<'a, B, A>, Delay>,
    chips::StageEncoder<Bus<'a, B, A>, Delay>,
>;

/// The other ports of a simulated board.
pub type SimulatedPorts<'a, B, A, L, R> = Ports<chips::StageMotor<Bus<'a, B, A>, Delay>, L, R>;

/// The bus of one chip, with a clock of `hertz`.
fn bus<'a, B: Rig, A: Around>(
    board: &'a RefCell<B>,
    around: &A,
    select: Select,
    hertz: u32,
) -> Bus<'a, B, A> {
    around.spi(select, SpiPort::new(board, select, hertz))
}

/// The sensors of a simulated board.
pub fn sensors<'a, B: Rig, A: Around>(
    board: &'a RefCell<B>,
    scenario: &Scenario,
    around: &A,
) -> SimulatedSensors<'a, B, A> {
    sensors_with(board, scenario, scenario::accelerometer(), around)
}

/// The same with an accelerometer that is told something else.
fn sensors_with<'a, B: Rig, A: Around>(
    board: &'a RefCell<B>,
    scenario: &Scenario,
    force: adxl355::Configuration,
    around: &A,
) -> SimulatedSensors<'a, B, A> {
    let bus = |select, hertz| bus(board, around, select, hertz);
    let converter = bus(Select::Gyro, CONVERTER_HERTZ);
    let ready = around.line(Select::Gyro, ReadyPin::new(board, Select::Gyro));
    let accelerometer = bus(Select::Accelerometer, adxl355::BUS_HERTZ);
    let accelerometer = Adxl355::new(accelerometer, Delay, force);
    let encoder = bus(Select::Encoder, mt6835::BUS_HERTZ);
    let encoder = Mt6835::new(encoder, Delay, mt6835::Configuration::default());
    Sensors {
        gyro: chips::AnalogueGyro {
            converter: Ads1262::new(converter, ready, Delay, scenario.converter()),
            scale: scenario::SCALE,
            limit: scenario::LIMIT,
        },
        accelerometer: chips::PlatformAccelerometer(accelerometer),
        encoder: chips::StageEncoder(encoder),
        base: NoBase,
    }
}

/// The other ports of a simulated board.
pub fn ports<'a, B: Rig, A: Around, L, R>(
    board: &'a RefCell<B>,
    around: &A,
    link: L,
    recorder: R,
) -> SimulatedPorts<'a, B, A, L, R> {
    ports_with(board, around, Motor::default(), link, recorder)
}

/// The same with a motor driver that is told something else.
fn ports_with<'a, B: Rig, A: Around, L, R>(
    board: &'a RefCell<B>,
    around: &A,
    motor: Motor,
    link: L,
    recorder: R,
) -> SimulatedPorts<'a, B, A, L, R> {
    let bus = bus(board, around, Select::Actuator, tmc5160::BUS_HERTZ);
    Ports { actuator: chips::StageMotor(Tmc5160::new(bus, Delay, motor)), link, recorder }
}
