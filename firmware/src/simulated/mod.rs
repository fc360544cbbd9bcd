//! The board as it is simulated: chips, stage and Earth of `hal-mock` behind the instrument's ports.
//!
//! Host and emulator run exactly this, so that their results can be compared bit for bit.

pub mod fault;
pub mod scenario;

use core::cell::RefCell;

use drivers::ads1262::Ads1262;
use drivers::adxl355::{self, Adxl355};
use drivers::mt6835::{self, Mt6835};
use drivers::tmc5160::{self, Tmc5160};
use embassy_time::{Delay, Instant};
use embedded_io_async::Write;
use hal_mock::ads1262::Ads1262 as SimulatedConverter;
use hal_mock::adxl355::Adxl355 as SimulatedAccelerometer;
use hal_mock::board::Board;
use hal_mock::chip::{Rig, Select};
use hal_mock::fault::{FaultyReady, FaultySpi};
use hal_mock::mt6835::Mt6835 as SimulatedEncoder;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{Plant, PlantConfiguration};
use hal_mock::spi::{ReadyPin, SpiPort};
use hal_mock::tmc5160::{Oscillator, Tmc5160 as SimulatedMotorDriver};
use hal_mock::violation::Violation;
use orientation::session::Session;

use self::fault::{FaultyRecorder, Plan};
use self::scenario::Scenario;
use crate::chips;
use crate::health::Health;
use crate::ports::{Observer, Ports, Recorder};

/// Bus clock of the gyro's converter, Hz; it allows 8 MHz.
const CONVERTER_HERTZ: u32 = 5_000_000;

/// The motor driver's oscillator, 2 % fast: positions do not depend on it, velocities do.
const OSCILLATOR: Oscillator = Oscillator::Internal { hertz: 12_240_000 };

/// The simulated chips around their plant.
pub type Chips<'a> =
    Board<'a, SimulatedConverter, SimulatedAccelerometer, SimulatedEncoder, SimulatedMotorDriver>;

/// The outside of the simulated board.
#[derive(Debug)]
pub struct Outside<L, R, O> {
    /// Where status lines go.
    pub link: L,
    /// Where raw samples go.
    pub recorder: R,
    /// Who is told what happens.
    pub observer: O,
}

/// The simulated board of a scenario with a plan of faults.
#[must_use]
pub fn board<'a>(scenario: &Scenario, plan: &'a Plan) -> Chips<'a> {
    let plant = scenario.plant();
    let [low, high] = plant.stage.travel_rad;
    let travel_rad = [low, plan.caught.unwrap_or(high)];
    let configuration = PlantConfiguration {
        stage: StageConfiguration { travel_rad, ..plant.stage },
        disturbances: &plan.disturbances,
        faults: &plan.stage,
        ..plant
    };
    Board {
        plant: Plant::new(&configuration, scenario.seed),
        gyro: SimulatedConverter::new(),
        accelerometer: SimulatedAccelerometer::new(Instant::MIN),
        encoder: SimulatedEncoder::new(Instant::MIN),
        actuator: SimulatedMotorDriver::new(OSCILLATOR, Instant::MIN),
        blackouts: &plan.blackouts,
    }
}

/// Runs the instrument on a simulated board, or on whatever stands around one.
pub async fn run<B: Rig, L: Write, R: Recorder, O: Observer>(
    board: &RefCell<B>,
    scenario: &Scenario,
    plan: &Plan,
    outside: Outside<L, R, O>,
    session: &mut Session,
) -> Health {
    let bus = |select, hertz| FaultySpi::new(SpiPort::new(board, select, hertz), plan.bus(select));
    let ready = FaultyReady::new(ReadyPin::new(board, Select::Gyro), plan.ready);
    let mut ports = Ports {
        gyro: chips::AnalogueGyro {
            converter: Ads1262::new(
                bus(Select::Gyro, CONVERTER_HERTZ),
                ready,
                Delay,
                scenario.converter(),
            ),
            scale: scenario::SCALE,
            limit: scenario::LIMIT,
        },
        accelerometer: chips::PlatformAccelerometer(Adxl355::new(
            bus(Select::Accelerometer, adxl355::BUS_HERTZ),
            Delay,
            scenario::accelerometer(),
        )),
        encoder: chips::StageEncoder(Mt6835::new(
            bus(Select::Encoder, mt6835::BUS_HERTZ),
            Delay,
            mt6835::Configuration::default(),
        )),
        actuator: chips::StageMotor(Tmc5160::new(
            bus(Select::Actuator, tmc5160::BUS_HERTZ),
            Delay,
            tmc5160::configuration::Configuration::default(),
        )),
        link: outside.link,
        recorder: FaultyRecorder::new(outside.recorder, plan.hang),
        observer: outside.observer,
    };
    crate::run::run(&mut ports, &scenario.configuration(), session).await
}

/// What the drivers did that a data sheet forbids, in words.
pub fn violations<'a>(board: &'a Chips) -> impl Iterator<Item = (Select, Violation)> + 'a {
    let chips = [Select::Gyro, Select::Accelerometer, Select::Encoder, Select::Actuator];
    chips.into_iter().flat_map(|select| {
        board.violations(select).first().iter().map(move |violation| (select, *violation))
    })
}
