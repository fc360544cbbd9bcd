//! Each driver starts and reads over the wires as over its port.

use std::cell::RefCell;
use std::fmt::Debug;

use drivers::ads1262::configuration::Configuration as Converter;
use drivers::adxl355::registers::OutputRate;
use drivers::tmc5160::configuration::Configuration as Motor;
use drivers::{ads1262, adxl355, mt6835, tmc5160};
use embassy_time::{Delay, Instant, Timer};
use embedded_hal::spi::{MODE_0, MODE_1, MODE_3, Mode};
use embedded_hal_async::spi::{ErrorKind, SpiDevice};
use hal_mock::ads1262::Ads1262;
use hal_mock::adxl355::Adxl355;
use hal_mock::chip::{Select, Single, SpiChip};
use hal_mock::mt6835::Mt6835;
use hal_mock::spi::{ReadyPin, SpiPort};
use hal_mock::tmc5160::{Oscillator, Tmc5160};
use hal_mock::violation::Misuse;
use hal_mock::wires::SpiWires;
use simulated::line::ObservedLine;

use super::bench::{Bench, WirePort};
use crate::support::rig::{run, violations};

/// The line of the one chip.
const CHIP: Select = Select::Gyro;

type Rig<C> = RefCell<Single<C, Bench>>;

fn rig<C>(chip: C) -> Rig<C> {
    RefCell::new(Single { chip, environment: Bench::default() })
}

fn start() -> Instant {
    Instant::from_micros(0)
}

/// What a driver does with its chip.
trait Errand {
    type Chip: Clone + Debug + SpiChip<Bench>;
    type Outcome: Debug + PartialEq;

    async fn run(bus: impl SpiDevice<Error = ErrorKind>, rig: &Rig<Self::Chip>) -> Self::Outcome;
}

/// Does the same over a port and over the wires, which must find nothing wrong.
fn both<E: Errand>(chip: &E::Chip, mode: Mode, hertz: u32) {
    let (ported, wired) = (rig(chip.clone()), rig(chip.clone()));
    let wires = RefCell::new(SpiWires::new());
    let expected = run(E::run(SpiPort::new(&ported, CHIP, hertz), &ported));
    let port = WirePort { rig: &wired, wires: &wires, select: CHIP, mode, hertz };
    let found = run(E::run(port, &wired));
    assert_eq!(found, expected);
    assert_eq!(violations(&ported), []);
    assert_eq!(violations(&wired), []);
    assert_eq!(wires.borrow().faults().first, []);
}

struct Convert;

impl Errand for Convert {
    type Chip = Ads1262;
    type Outcome = Vec<bool>;

    async fn run(bus: impl SpiDevice<Error = ErrorKind>, rig: &Rig<Ads1262>) -> Vec<bool> {
        let ready = ObservedLine::new(rig, CHIP, ReadyPin::new(rig, CHIP));
        let mut driver = ads1262::Ads1262::new(bus, ready, Delay, Converter::default());
        driver.start().await.expect("the chip is well");
        let mut read = Vec::new();
        for _ in 0..5 {
            read.push(driver.read().await.is_ok());
        }
        read
    }
}

#[test]
fn the_converters_driver_starts_and_reads_over_the_wires() {
    assert_eq!(ads1262::SPI_MODE, MODE_1);
    both::<Convert>(&Ads1262::default(), MODE_1, ads1262::GREATEST_BUS_HERTZ);
}

struct Feel;

impl Errand for Feel {
    type Chip = Adxl355;
    type Outcome = bool;

    async fn run(bus: impl SpiDevice<Error = ErrorKind>, _: &Rig<Adxl355>) -> bool {
        let mut driver = adxl355::Adxl355::new(bus, Delay, OutputRate::Hz125);
        driver.start().await.expect("the chip is well");
        Timer::after_millis(20).await;
        driver.read().await.is_ok()
    }
}

#[test]
fn the_accelerometers_driver_starts_and_reads_over_the_wires() {
    both::<Feel>(&Adxl355::new(start()), MODE_0, adxl355::BUS_HERTZ);
}

struct Look;

impl Errand for Look {
    type Chip = Mt6835;
    type Outcome = bool;

    async fn run(bus: impl SpiDevice<Error = ErrorKind>, _: &Rig<Mt6835>) -> bool {
        let mut driver = mt6835::Mt6835::new(bus, Delay, mt6835::Configuration::default());
        driver.start().await.expect("the chip is well");
        driver.read().await.is_ok()
    }
}

#[test]
fn the_encoders_driver_starts_and_reads_over_the_wires() {
    both::<Look>(&Mt6835::new(start()), MODE_3, mt6835::BUS_HERTZ);
}

struct Turn;

impl Errand for Turn {
    type Chip = Tmc5160;
    type Outcome = i32;

    async fn run(bus: impl SpiDevice<Error = ErrorKind>, _: &Rig<Tmc5160>) -> i32 {
        let mut driver = tmc5160::Tmc5160::new(bus, Delay, Motor::default());
        driver.start().await.expect("the chip is well");
        driver.go_to(20_000).await.expect("it moves");
        Timer::after_secs(20).await;
        driver.status().await.expect("it answers").position
    }
}

#[test]
fn the_motors_driver_starts_and_turns_over_the_wires() {
    let chip = Tmc5160::new(Oscillator::Internal { hertz: 12_000_000 }, start());
    both::<Turn>(&chip, MODE_3, tmc5160::BUS_HERTZ);
}

#[test]
fn no_driver_starts_in_a_wrong_mode() {
    let chip = rig(Adxl355::new(start()));
    let wires = RefCell::new(SpiWires::new());
    let port = WirePort {
        rig: &chip,
        wires: &wires,
        select: CHIP,
        mode: MODE_3,
        hertz: adxl355::BUS_HERTZ,
    };
    let mut driver = adxl355::Adxl355::new(port, Delay, OutputRate::Hz125);
    assert!(run(driver.start()).is_err());
    assert!(wires.borrow().faults().count > 0);
    assert!(!violations(&chip).contains(&Misuse::ClockTooFast));
}
