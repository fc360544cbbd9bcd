//! Signals of peripherals at the pins of the board: a peripheral is connected where its pin is in the mode of an
//! alternate function, with the number of that peripheral (RM0351, 8.3.2; DS10969, tables of alternate functions). The
//! pins are those to which the board B-L475E-IOT01A and the chips of a carrier are wired (the first page of its image).

use std::fmt;

use super::gpio::Port;
use crate::wiring::Pin;

/// A signal of a peripheral and the pin at which the board has its wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Its name in the data sheet.
    name: &'static str,
    /// The pin.
    pub pin: Pin,
    /// The number of the alternate function that connects them.
    function: u32,
    /// Whether the pin must only ever pull its wire down, since others do so, too.
    is_open_drain: bool,
}

impl Signal {
    /// A signal that the peripheral drives to both levels, or reads.
    const fn new(name: &'static str, pin: &[u8], function: u32) -> Self {
        Self { name, pin: Pin::named(pin), function, is_open_drain: false }
    }

    /// Whether it is connected to its wire.
    pub fn is_connected(&self, ports: &[Port]) -> bool {
        let Pin { port, number } = self.pin;
        ports[port].has_function(number, self.function)
            && (!self.is_open_drain || ports[port].is_open_drain(number))
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, pin, function, is_open_drain } = self;
        let drain = if *is_open_drain { " with an open drain" } else { "" };
        write!(
            f,
            "{name} is not connected: {pin} is not in the mode of alternate function {function}{drain}"
        )
    }
}

/// Signals of SPI1 and SPI2: clock, data in, data out.
pub const SPI: [[Signal; 3]; 2] = [
    [
        Signal::new("SPI1_SCK", b"PA5", 5),
        Signal::new("SPI1_MISO", b"PA6", 5),
        Signal::new("SPI1_MOSI", b"PA7", 5),
    ],
    [
        Signal::new("SPI2_SCK", b"PD1", 5),
        Signal::new("SPI2_MISO", b"PD3", 5),
        Signal::new("SPI2_MOSI", b"PD4", 5),
    ],
];

/// Signals of I2C2, both with an open drain (RM0351, 39.4.1): clock and data.
pub const I2C: [Signal; 2] = [
    Signal { is_open_drain: true, ..Signal::new("I2C2_SCL", b"PB10", 4) },
    Signal { is_open_drain: true, ..Signal::new("I2C2_SDA", b"PB11", 4) },
];

/// What USART1 sends.
pub const SENT: [Signal; 1] = [Signal::new("USART1_TX", b"PB6", 7)];

/// What USART1 receives.
pub const RECEIVED: [Signal; 1] = [Signal::new("USART1_RX", b"PB7", 7)];
