//! The peripherals of the model by their registers, as the reference manual RM0351 describes them.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod bus;
mod carrier;
mod clocks;
mod core;
mod edges;
mod flash;
mod identity;
mod pins;
mod power;
mod resets;
mod ring;
mod serial;

use std::cell::RefCell;
use std::rc::Rc;

use emulated_board::controller::rcc::Oscillators;
use emulated_board::controller::{Controller, Memory, Refused};
use emulated_board::time::Time;
use emulated_board::wiring::board::Served;
use emulated_board::wiring::{I2cBus, Pin, Wiring};
use hal_mock::wires::Clock;

/// Reset and clock control.
const RCC: u32 = 0x4002_1000;

/// Port A; the others follow it.
const GPIO: u32 = 0x4800_0000;

/// Signals of the peripherals, the pins at which the board has their wires, and the alternate functions that connect them
/// (DS10969, tables of alternate functions).
const SIGNALS: [(&str, &[u8], u32); 10] = [
    ("SPI1_SCK", b"PA5", 5),
    ("SPI1_MISO", b"PA6", 5),
    ("SPI1_MOSI", b"PA7", 5),
    ("SPI2_SCK", b"PD1", 5),
    ("SPI2_MISO", b"PD3", 5),
    ("SPI2_MOSI", b"PD4", 5),
    ("I2C2_SCL", b"PB10", 4),
    ("I2C2_SDA", b"PB11", 4),
    ("USART1_TX", b"PB6", 7),
    ("USART1_RX", b"PB7", 7),
];

/// Where the memory begins.
const MEMORY: u32 = 0x2000_0000;

/// Memory for the direct access.
struct Ram(Vec<u8>);

impl Memory for Ram {
    fn read(&self, address: u32, bytes: &mut [u8]) -> bool {
        let start = address.wrapping_sub(MEMORY) as usize;
        let held = self.0.get(start..start.saturating_add(bytes.len()));
        held.map(|held| bytes.copy_from_slice(held)).is_some()
    }

    fn write(&mut self, address: u32, bytes: &[u8]) -> bool {
        let start = address.wrapping_sub(MEMORY) as usize;
        let held = self.0.get_mut(start..start.saturating_add(bytes.len()));
        held.map(|held| held.copy_from_slice(bytes)).is_some()
    }
}

/// Wires on which each byte comes back inverted, and on which a device answers at address 0x6A. The other side of the serial
/// port sends 10 000 baud. All others are high.
#[derive(Default)]
struct Wires {
    /// Bytes that were begun: bus, byte, clock and time.
    bytes: Vec<(usize, u8, Clock, Time)>,
    /// Bytes on the two-wire bus, and its conditions.
    conditions: Vec<String>,
    /// To which levels pins were driven, as often as that was told.
    driven: Vec<(Pin, Option<bool>)>,
    /// Wires that are low.
    low: Vec<Pin>,
    /// Rates of the frames on the serial port, baud.
    rates: Vec<u32>,
    /// The next edge of a wire: when, at which pin, whether it rises.
    edge: Option<(Time, Pin, bool)>,
}

/// The wires, which a test looks at too.
#[derive(Clone, Default)]
struct Shared(Rc<RefCell<Wires>>);

impl I2cBus for Shared {
    fn start(&mut self, address: u8, reads: bool, _: u32, _: Time) -> bool {
        let condition = format!("start {address:#x} {}", if reads { "reads" } else { "writes" });
        self.0.borrow_mut().conditions.push(condition);
        address == 0x6A
    }

    fn write(&mut self, byte: u8, _: Time) -> bool {
        self.0.borrow_mut().conditions.push(format!("write {byte:#x}"));
        true
    }

    fn read(&mut self, is_acknowledged: bool, _: Time) -> u8 {
        let condition = if is_acknowledged { "read" } else { "read the last" };
        self.0.borrow_mut().conditions.push(condition.to_owned());
        0x42
    }

    fn stop(&mut self, _: Time) {
        self.0.borrow_mut().conditions.push("stop".to_owned());
    }

    fn stop_clock(&mut self, bit: u32, _: Time) {
        self.0.borrow_mut().conditions.push(format!("no clock from bit {bit} on"));
    }
}

impl Wiring for Shared {
    fn served(&mut self, _: Time) -> Served {
        Served::default()
    }

    fn drive(&mut self, pin: Pin, level: Option<bool>, _: Time) {
        self.0.borrow_mut().driven.push((pin, level));
    }

    fn level(&mut self, pin: Pin, _: Time) -> bool {
        !self.0.borrow().low.contains(&pin)
    }

    fn begin(&mut self, bus: usize, byte: u8, clock: Clock, now: Time) {
        self.0.borrow_mut().bytes.push((bus, byte, clock, now));
    }

    fn finish(&mut self, bus: usize) -> u8 {
        let wires = self.0.borrow();
        let latest = wires.bytes.iter().rfind(|(own, ..)| *own == bus);
        latest.map_or(0xFF, |(_, byte, ..)| !byte)
    }

    fn baud(&self) -> u32 {
        10_000
    }

    fn frame(&mut self, baud: u32) {
        self.0.borrow_mut().rates.push(baud);
    }

    fn faults(&self) -> Vec<String> {
        Vec::new()
    }

    fn due(&self) -> Time {
        self.0.borrow().edge.map_or(Time::NEVER, |(at, ..)| at)
    }

    fn edges(&mut self, _: Time) -> Vec<(Pin, bool)> {
        let edge = self.0.borrow_mut().edge.take();
        edge.map(|(_, pin, rises)| (pin, rises)).into_iter().collect()
    }
}

/// Where the registers of a pin's port begin.
fn registers(pin: Pin) -> u32 {
    GPIO + 0x400 * pin.port as u32
}

/// A controller with memory and wires, and the time.
struct Bench {
    controller: Controller,
    ram: Ram,
    wires: Shared,
    now: Time,
}

impl Bench {
    /// A controller at 4 MHz with all peripherals clocked, and connected to the wires.
    fn new() -> Self {
        let mut bench = Self::clocked();
        bench.connect_all();
        bench
    }

    /// A controller after the supply came up, at 4 MHz, with all peripherals clocked.
    fn clocked() -> Self {
        let wires = Shared::default();
        Self { wires: wires.clone(), ..Self::wired(wires) }
    }

    /// As [`Self::clocked`], with other wires.
    fn wired(wiring: impl Wiring + 'static) -> Self {
        let oscillators = Oscillators { has_crystal: true, msi_error: 0.0 };
        let controller = Controller::new(oscillators, 1, Box::new(wiring));
        let (ram, wires) = (Ram(vec![0; 4096]), Shared::default());
        let mut bench = Self { controller, ram, wires, now: Time::ZERO };
        bench.clock_all();
        bench
    }

    /// Gives all peripherals their clock.
    fn clock_all(&mut self) {
        for offset in [0x48, 0x4C, 0x58, 0x60] {
            self.write(RCC + offset, 0xFFFF_FFFF);
        }
    }

    /// Connects all peripherals to the wires.
    fn connect_all(&mut self) {
        for (_, pin, function) in SIGNALS {
            self.connect(Pin::named(pin), function);
        }
        // The wires of I2C2 are pulled down by the devices, too: open drains.
        self.write(GPIO + 0x400 + 4, 3 << 10);
    }

    /// Gives a pin to an alternate function.
    fn connect(&mut self, pin: Pin, function: u32) {
        self.set_mode(pin, 2);
        let functions = registers(pin) + 0x20 + 4 * (pin.number / 8);
        let (held, place) = (self.read(functions), 4 * (pin.number % 8));
        self.write(functions, held & !(0xF << place) | function << place);
    }

    /// Sets the mode of a pin: input, output, alternate function, analogue.
    fn set_mode(&mut self, pin: Pin, mode: u32) {
        let held = self.read(registers(pin));
        self.write(registers(pin), held & !(3 << (2 * pin.number)) | mode << (2 * pin.number));
    }

    /// Reads a word.
    fn read(&mut self, address: u32) -> u32 {
        self.try_read(address, 4).expect("the register is there")
    }

    /// Reads by an access of so many bytes.
    fn try_read(&mut self, address: u32, size: u32) -> Result<u32, Refused> {
        self.controller.read(&mut self.ram, address, size, (self.now, 0))
    }

    /// Writes a word.
    fn write(&mut self, address: u32, value: u32) {
        self.try_write(address, value, 4).expect("the register takes it");
    }

    /// Writes by an access of so many bytes.
    fn try_write(&mut self, address: u32, value: u32, size: u32) -> Result<(), Refused> {
        self.controller.write(&mut self.ram, address, (value, size), self.now)
    }

    /// Time passes.
    fn pass(&mut self, span: Time) {
        self.now = self.now + span;
        self.controller.advance(&mut self.ram, self.now);
    }

    /// Whether an interrupt of a peripheral waits.
    fn interrupts(&self, number: usize) -> bool {
        self.controller.exceptions.lines.has(16 + number as u32)
    }
}
