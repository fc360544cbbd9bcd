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
use embedded_hal_async::digital::Wait;
use embedded_hal_async::spi::SpiDevice;
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

use self::fault::{FaultyRecorder, Plan};
use self::scenario::Scenario;
use crate::chips;
use crate::ports::{Ports, Sensors};

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

/// A chip's bus, which may fail.
type Bus<'a, B> = FaultySpi<SpiPort<'a, B>>;

/// The data-ready line of the gyro's converter, which may fail.
type Ready<'a, B> = FaultyReady<ReadyPin<'a, B>>;

/// What is put around each simulated port: nothing, or a meter.
pub trait Around {
    /// A bus with it around.
    type Spi<S: SpiDevice>: SpiDevice;
    /// A line with it around.
    type Line<W: Wait>: Wait;

    /// Puts it around a bus.
    fn spi<S: SpiDevice>(&self, bus: S) -> Self::Spi<S>;

    /// Puts it around a line.
    fn line<W: Wait>(&self, line: W) -> Self::Line<W>;
}

/// Nothing around the ports.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bare;

impl Around for Bare {
    type Spi<S: SpiDevice> = S;
    type Line<W: Wait> = W;

    fn spi<S: SpiDevice>(&self, bus: S) -> S {
        bus
    }

    fn line<W: Wait>(&self, line: W) -> W {
        line
    }
}

/// The sensors of a simulated board.
pub type SimulatedSensors<'a, B, A> = Sensors<
    chips::AnalogueGyro<<A as Around>::Spi<Bus<'a, B>>, <A as Around>::Line<Ready<'a, B>>, Delay>,
    chips::PlatformAccelerometer<<A as Around>::Spi<Bus<'a, B>>, Delay>,
    chips::StageEncoder<<A as Around>::Spi<Bus<'a, B>>, Delay>,
>;

/// The other ports of a simulated board.
pub type SimulatedPorts<'a, B, A, L, R> =
    Ports<chips::StageMotor<<A as Around>::Spi<Bus<'a, B>>, Delay>, L, FaultyRecorder<R>>;

/// A simulated board's select lines, with what is around them.
struct Wiring<'a, 'p, B, A> {
    board: &'a RefCell<B>,
    plan: &'p Plan,
    around: &'p A,
}

impl<'a, B: Rig, A: Around> Wiring<'a, '_, B, A> {
    fn bus(&self, select: Select, hertz: u32) -> A::Spi<Bus<'a, B>> {
        let port = SpiPort::new(self.board, select, hertz);
        self.around.spi(FaultySpi::new(port, self.plan.bus(select)))
    }

    fn ready(&self) -> A::Line<Ready<'a, B>> {
        let line = ReadyPin::new(self.board, Select::Gyro);
        self.around.line(FaultyReady::new(line, self.plan.ready))
    }
}

/// The sensors of a simulated board.
pub fn sensors<'a, B: Rig, A: Around>(
    board: &'a RefCell<B>,
    scenario: &Scenario,
    plan: &Plan,
    around: &A,
) -> SimulatedSensors<'a, B, A> {
    let wiring = Wiring { board, plan, around };
    let converter = wiring.bus(Select::Gyro, CONVERTER_HERTZ);
    let accelerometer = wiring.bus(Select::Accelerometer, adxl355::BUS_HERTZ);
    let encoder = wiring.bus(Select::Encoder, mt6835::BUS_HERTZ);
    let accelerometer = Adxl355::new(accelerometer, Delay, scenario::accelerometer());
    let encoder = Mt6835::new(encoder, Delay, mt6835::Configuration::default());
    Sensors {
        gyro: chips::AnalogueGyro {
            converter: Ads1262::new(converter, wiring.ready(), Delay, scenario.converter()),
            scale: scenario::SCALE,
            limit: scenario::LIMIT,
        },
        accelerometer: chips::PlatformAccelerometer(accelerometer),
        encoder: chips::StageEncoder(encoder),
    }
}

/// The other ports of a simulated board.
pub fn ports<'a, B: Rig, A: Around, L, R>(
    board: &'a RefCell<B>,
    plan: &Plan,
    around: &A,
    link: L,
    recorder: R,
) -> SimulatedPorts<'a, B, A, L, R> {
    let bus = Wiring { board, plan, around }.bus(Select::Actuator, tmc5160::BUS_HERTZ);
    let configuration = tmc5160::configuration::Configuration::default();
    Ports {
        actuator: chips::StageMotor(Tmc5160::new(bus, Delay, configuration)),
        link,
        recorder: FaultyRecorder::new(recorder, plan.hang),
    }
}

/// What the drivers did that a data sheet forbids, in words.
pub fn violations<'a>(board: &'a Chips) -> impl Iterator<Item = (Select, Violation)> + 'a {
    let chips = [Select::Gyro, Select::Accelerometer, Select::Encoder, Select::Actuator];
    chips.into_iter().flat_map(|select| {
        board.violations(select).first().iter().map(move |violation| (select, *violation))
    })
}
