//! What is connected to the pins of the microcontroller.

pub mod board;

use std::fmt;

use hal_mock::wires::Clock;

use crate::time::Time;

/// A pin of the microcontroller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pin {
    /// Its port, A being 0.
    pub port: usize,
    /// Its number, 0 to 15.
    pub number: u32,
}

impl Pin {
    /// The pin with a name as in the data sheet: `PA5` is number 5 of port A.
    pub const fn named(name: &[u8]) -> Self {
        let mut number = 0;
        let mut place = 2;
        while place < name.len() {
            number = 10 * number + (name[place] - b'0') as u32;
            place += 1;
        }
        Self { port: (name[1] - b'A') as usize, number }
    }
}

impl fmt::Display for Pin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "P{}{}", char::from(b'A' + self.port as u8), self.number)
    }
}

/// A two-wire bus with its devices.
pub trait I2cBus {
    /// A start with an address of seven bits, at this clock in hertz; whether a device acknowledges. All times are those at
    /// which something begins on the wires.
    fn start(&mut self, address: u8, reads: bool, hertz: u32, now: Time) -> bool;

    /// A byte to the device; whether it acknowledges.
    fn write(&mut self, byte: u8, now: Time) -> bool;

    /// A byte from the device, which is acknowledged or not.
    fn read(&mut self, is_acknowledged: bool, now: Time) -> u8;

    /// A stop.
    fn stop(&mut self, now: Time);

    /// The clock stops, while it is high, amid a byte from the device that began then; the bit of this number is on the
    /// wire, from 0, 8 being the acknowledge. The device goes on driving it.
    fn stop_clock(&mut self, bit: u32, began: Time);
}

/// What is connected to the pins. Times never fall.
pub trait Wiring: I2cBus {
    /// A pin is driven to a level, or not driven.
    fn drive(&mut self, pin: Pin, level: Option<bool>, now: Time);

    /// How conversions were served since the last time that was asked.
    fn served(&mut self, now: Time) -> board::Served;

    /// The level of a pin that the microcontroller does not drive.
    fn level(&mut self, pin: Pin, now: Time) -> bool;

    /// A byte begins on a serial bus, 0 or 1.
    fn begin(&mut self, bus: usize, byte: u8, clock: Clock, now: Time);

    /// The byte on a serial bus has ended: what came back.
    fn finish(&mut self, bus: usize) -> u8;

    /// The rate of the other side of the serial port, baud.
    fn baud(&self) -> u32;

    /// A frame begins to be sent, or was received, on the serial port at this rate of the microcontroller, baud.
    fn frame(&mut self, baud: u32);

    /// Rules of the wires that were broken, as sentences.
    fn faults(&self) -> Vec<String>;

    /// When a wire next changes of itself.
    fn due(&self) -> Time;

    /// Edges that wires make of themselves at [`Self::due`]: the pin, and whether it rises.
    fn edges(&mut self, now: Time) -> Vec<(Pin, bool)>;
}
