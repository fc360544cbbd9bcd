//! A chip on a bus in virtual time, and voltages to convert.

use std::cell::RefCell;

use drivers::ads1262::Ads1262 as Driver;
use drivers::ads1262::configuration::Configuration;
use embassy_time::{Delay, Instant, Timer};
use embedded_hal_async::spi::SpiDevice;
use hal_mock::ads1262::Ads1262;
use hal_mock::chip::{Select, Single, SpiChip};
use hal_mock::environment::AnalogueInput;
use hal_mock::spi::{ReadyPin, SpiPort};
use simulated::line::ObservedLine;

/// Bus clock of these tests, Hz.
pub const HERTZ: u32 = 8_000_000;

/// A voltage that rises with time, and a count of how often it was asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Input {
    pub volts: f64,
    pub volts_per_s: f64,
    pub asked: u32,
}

impl Input {
    pub fn steady(volts: f64) -> Self {
        Self { volts, ..Self::default() }
    }
}

impl AnalogueInput for Input {
    fn volts(&mut self, now: Instant) -> f64 {
        self.asked += 1;
        self.volts + self.volts_per_s * now.as_micros() as f64 * 1e-6
    }
}

pub type Rig = RefCell<Single<Ads1262, Input>>;
pub type Device<'a> = Driver<SpiPort<'a>, ObservedLine<'a, ReadyPin<'a>>, Delay>;

pub fn rig(input: Input) -> Rig {
    RefCell::new(Single { chip: Ads1262::default(), environment: input })
}

pub fn port(rig: &Rig, hertz: u32) -> SpiPort<'_> {
    SpiPort::new(rig, Select::Gyro, hertz)
}

pub fn device(rig: &Rig, configuration: Configuration) -> Device<'_> {
    let ready = ObservedLine::new(rig, Select::Gyro, ReadyPin::new(rig, Select::Gyro));
    Driver::new(port(rig, HERTZ), ready, Delay, configuration)
}

/// Sends bytes and gives the reply.
pub async fn exchange(rig: &Rig, sent: &[u8]) -> Vec<u8> {
    let mut bytes = sent.to_vec();
    port(rig, HERTZ).transfer_in_place(&mut bytes).await.expect("the simulated bus does not fail");
    bytes
}

pub fn violations(rig: &Rig) -> usize {
    let single = rig.borrow();
    SpiChip::<Input>::violations(&single.chip).count
}

/// Waits until so many microseconds after the start of time, unless they are over.
pub async fn until(micros: u64) {
    if Instant::now().as_micros() < micros {
        Timer::at(Instant::from_micros(micros)).await;
    }
}

/// Runs a test in virtual time.
pub use crate::support::rig::run;
