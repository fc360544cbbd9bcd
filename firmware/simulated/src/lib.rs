//! The board as it is simulated: chips, stage and Earth of `hal-mock` behind the instrument's ports.
//!
//! A scenario says what is true and what the board is given: a stage ([`scenario`]), two frames ([`mount`]),
//! a [`turntable`], a [`vehicle`], a spinning body ([`spin`]). [`Wires`] connects the drivers to its chips,
//! [`flood`] is what a link brings that is no command, [`fault`] the catalogue of what may go wrong, [`hold`] how a run goes on after its alignment, and
//! [`trace`] what is compared. Host and emulator run exactly this, so that their results can be compared
//! bit for bit.
#![no_std]
#![forbid(unsafe_code)]

pub mod base;
pub mod coarse;
pub mod executed;
pub mod fault;
pub mod flash;
pub mod flood;
pub mod hold;
pub mod keep;
pub mod line;
pub mod mount;
pub mod scenario;
pub mod spin;
pub mod trace;
pub mod turntable;
pub mod vehicle;

use core::cell::RefCell;

use drivers::ads1262::Ads1262;
use drivers::ads1262::configuration::Configuration as Converter;
use drivers::adxl355::registers::OutputRate;
use drivers::adxl355::{self, Adxl355};
use drivers::mt6835::{self, Mt6835};
use drivers::tmc5160::configuration::Configuration as Motor;
use drivers::tmc5160::{self, Tmc5160};
use embassy_time::{Delay, Instant};
use hal_mock::ads1262::Ads1262 as ConverterChip;
use hal_mock::adxl355::Adxl355 as AccelerometerChip;
use hal_mock::board::{StageBoard, StageChips};
use hal_mock::chip::{Rig, Select};
use hal_mock::mt6835::Mt6835 as EncoderChip;
use hal_mock::plant::journey::JourneyConfiguration;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{Plant, PlantConfiguration};
use hal_mock::spi::{ReadyPin, SpiPort};
use hal_mock::tmc5160::{Oscillator, Tmc5160 as MotorDriverChip};

use self::fault::{Injection, PortWrapper};
use self::line::ObservedLine;
use self::scenario::Scenario;
use firmware::chips::AnalogueGyro;
use firmware::ports::Sensors;

/// Bus clock of the gyro's converter, Hz; it allows 8 MHz.
const CONVERTER_HERTZ: u32 = 5_000_000;

/// The motor driver's oscillator, 2 % fast: positions do not depend on it, velocities do.
const OSCILLATOR: Oscillator = Oscillator::Internal { hertz: 12_240_000 };

/// The simulated chips around their plant.
pub type Chips<'a> = StageBoard<'a, ConverterChip, AccelerometerChip, EncoderChip, MotorDriverChip>;

/// The simulated board of a scenario with what goes wrong with it, on a base that goes along a journey where
/// there is one.
pub fn board<'a>(
    scenario: &Scenario,
    journey: Option<JourneyConfiguration<'a>>,
    injection: &'a Injection,
) -> Chips<'a> {
    let plant = PlantConfiguration { journey, ..scenario.plant() };
    board_around(&plant, scenario.seed, injection)
}

/// The chips of a board around a plant.
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
    StageBoard {
        plant: Plant::new(&configuration, seed),
        chips: StageChips {
            gyro: ConverterChip::default(),
            accelerometer: AccelerometerChip::new(Instant::MIN),
            encoder: EncoderChip::new(Instant::MIN),
            actuator: MotorDriverChip::new(OSCILLATOR, Instant::MIN),
        },
        blackouts: &injection.blackouts,
    }
}

/// A simulated serial bus with a wrapper around it.
type Bus<'a, A> = <A as PortWrapper>::Spi<SpiPort<'a>>;

/// A simulated data-ready line with a wrapper around it.
type Line<'a, A> =
    <A as PortWrapper>::Ready<ObservedLine<'a, <A as PortWrapper>::Line<ReadyPin<'a>>>>;

/// A converter behind simulated ports.
type SimulatedConverter<'a, A> = Ads1262<Bus<'a, A>, Line<'a, A>, Delay>;

/// A gyro behind simulated ports.
type SimulatedGyro<'a, A> = AnalogueGyro<Bus<'a, A>, Line<'a, A>, Delay>;

/// An accelerometer behind a simulated port.
type SimulatedAccelerometer<'a, A> = Adxl355<Bus<'a, A>, Delay>;

/// An encoder behind a simulated port.
type SimulatedEncoder<'a, A> = Mt6835<Bus<'a, A>, Delay>;

/// The sensors of a simulated board with these encoders, and of its base.
type SimulatedSensors<'a, A, E, B> =
    Sensors<SimulatedGyro<'a, A>, SimulatedAccelerometer<'a, A>, E, B>;

/// The motor of an axis of a simulated board.
pub type SimulatedMotor<'a, A> = Tmc5160<Bus<'a, A>, Delay>;

/// The wires of a simulated board: its chips as the drivers reach them, with a wrapper around every port.
#[expect(missing_debug_implementations, reason = "a rig of any chips is none")]
pub struct Wires<'a, 'w, A>(pub &'a RefCell<dyn Rig + 'a>, pub &'w A);

impl<'a, A: PortWrapper> Wires<'a, '_, A> {
    /// The sensors of a stage or a turntable, whose accelerometer is given this, beside those of its base.
    #[must_use]
    pub fn sensors<B>(
        &self,
        scenario: &Scenario,
        force: OutputRate,
        base: B,
    ) -> SimulatedSensors<'a, A, SimulatedEncoder<'a, A>, B> {
        Sensors {
            gyro: self.gyro(Select::Gyro, scenario),
            accelerometer: self.accelerometer(force),
            encoder: self.encoder(Select::Encoder),
            base,
        }
    }

    /// The motor of a stage or a turntable, whose driver is given this.
    #[must_use]
    pub fn actuator(&self, configuration: Motor) -> SimulatedMotor<'a, A> {
        self.motor(Select::Actuator, configuration)
    }

    /// The bus of one chip, with a clock of `hertz`.
    fn bus(&self, select: Select, hertz: u32) -> Bus<'a, A> {
        self.1.spi(select, SpiPort::new(self.0, select, hertz))
    }

    /// A converter with its data-ready line, on a bus with a clock of `hertz`.
    fn converter(
        &self,
        select: Select,
        hertz: u32,
        configuration: Converter,
    ) -> SimulatedConverter<'a, A> {
        let line = self.1.line(select, ReadyPin::new(self.0, select));
        let ready = self.1.ready(ObservedLine::new(self.0, select, line));
        Ads1262::new(self.bus(select, hertz), ready, Delay, configuration)
    }

    /// A gyro with its converter.
    fn gyro(&self, select: Select, scenario: &Scenario) -> SimulatedGyro<'a, A> {
        let converter = self.converter(select, CONVERTER_HERTZ, scenario.converter());
        AnalogueGyro { converter, scale: scenario::SCALE, limit: scenario::LIMIT }
    }

    /// The accelerometer.
    fn accelerometer(&self, rate: OutputRate) -> SimulatedAccelerometer<'a, A> {
        let bus = self.bus(Select::Accelerometer, adxl355::BUS_HERTZ);
        Adxl355::new(bus, Delay, rate)
    }

    /// The encoder of a stage or of one of its frames.
    fn encoder(&self, select: Select) -> SimulatedEncoder<'a, A> {
        let bus = self.bus(select, mt6835::BUS_HERTZ);
        Mt6835::new(bus, Delay, mt6835::Configuration::default())
    }

    /// The motor of a stage or of one of its frames.
    fn motor(&self, select: Select, configuration: Motor) -> SimulatedMotor<'a, A> {
        let bus = self.bus(select, tmc5160::BUS_HERTZ);
        Tmc5160::new(bus, Delay, configuration)
    }
}
