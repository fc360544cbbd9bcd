//! The microcontroller STM32L475VG around its core: those of its peripherals that an image of this project uses.
//!
//! Register facts are those of the reference manual RM0351. A register that is not listed, a peripheral without its
//! clock or its pins and a function that is not modelled are errors, never a value.

mod dma;
mod exti;
pub mod flash;
mod gpio;
mod i2c;
pub mod identity;
mod map;
mod pins;
mod power;
pub mod protection;
pub mod rcc;
mod registers;
mod spi;
pub mod system;
mod timer;
mod transfers;
mod usart;
mod watchdog;

use thiserror::Error;

use self::dma::Dma;
use self::exti::Exti;
use self::flash::Flash;
use self::gpio::Port;
use self::i2c::I2c;
use self::map::DMA_INTERRUPTS;
use self::pins::Signal;
use self::power::Power;
use self::rcc::{Oscillators, Rcc};
use self::spi::Spi;
use self::system::System;
use self::timer::Timer;
use self::usart::Usart;
use self::watchdog::Watchdog;
use crate::exceptions::{Exceptions, FIRST_INTERRUPT, NOT_MASKABLE};
use crate::time::Time;
use crate::wiring::{Pin, Wiring};

/// Ports A to H.
const PORTS: usize = 8;
/// Why an access is not answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Refused {
    /// The model has no such register.
    #[error("the model has no such register")]
    Unknown,
    /// The peripheral has no clock.
    #[error("the peripheral has no clock")]
    NoClock,
    /// A function that the model does not have.
    #[error("not modelled: {0}")]
    NotModelled(&'static str),
    /// A peripheral is used whose signal is not connected to the pin at which the board has its wire. What asks for it
    /// may have been done before, as by direct memory access.
    #[error("{0}")]
    NotConnected(Signal),
}

impl Refused {
    /// Refuses a function that the model does not have, where one is asked for.
    fn where_asked(function: Option<&'static str>) -> Result<(), Self> {
        function.map_or(Ok(()), |function| Err(Self::NotModelled(function)))
    }
}

/// Why the controller starts again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetReason {
    /// The supply came up, or was too low.
    Supply,
    /// The program asked for it.
    Software,
    /// The program had the option bytes loaded.
    OptionBytes,
    /// The watchdog was not fed.
    Watchdog,
    /// The reset pin.
    Pin,
}

/// The memory that direct memory access reaches.
pub trait Memory {
    /// Reads bytes; whether there is memory.
    fn read(&self, address: u32, bytes: &mut [u8]) -> bool;

    /// Writes bytes; whether there is memory.
    fn write(&mut self, address: u32, bytes: &[u8]) -> bool;
}

/// The microcontroller without its core.
pub struct Controller {
    /// Exceptions of the core.
    pub exceptions: Exceptions,
    /// Registers of the core.
    pub system: System,
    /// Reset and clocks.
    rcc: Rcc,
    power: Power,
    /// Flash.
    pub flash: Flash,
    ports: [Port; PORTS],
    /// Interrupts by edges.
    pub exti: Exti,
    timer: Timer,
    /// Serial buses 1 and 2.
    pub spi: [Spi; 2],
    dma: [Dma; 2],
    /// The bus to the IMU on the base.
    pub i2c: I2c,
    /// The serial port.
    pub usart: Usart,
    /// The watchdog.
    pub watchdog: Watchdog,
    /// `DBGMCU_CR`, `APB1FZR1`, `APB1FZR2`, `APB2FZR`.
    debug: [u32; 4],
    /// Clock of the core and of the buses, Hz.
    hertz: u64,
    /// What is on the pins.
    pub wiring: Box<dyn Wiring>,
    /// A reset that is due.
    pub reset: Option<ResetReason>,
    /// The resets that there were.
    pub resets: Vec<ResetReason>,
    /// When the crystal begins to oscillate, where the clock then changes.
    crystal: Time,
    /// What happened of itself that the model does not carry out: the next access tells it.
    refused: Option<Refused>,
}

impl Controller {
    /// A controller whose supply comes up.
    pub fn new(oscillators: Oscillators, seed: u64, wiring: Box<dyn Wiring>) -> Self {
        Self {
            exceptions: Exceptions::default(),
            system: System::new(),
            rcc: Rcc::new(oscillators),
            power: Power::default(),
            flash: Flash::new(seed),
            ports: std::array::from_fn(Port::new),
            exti: Exti::default(),
            timer: Timer::new(4_000_000),
            spi: [Spi::new(), Spi::new()],
            dma: Default::default(),
            i2c: I2c::new(),
            usart: Usart::new(),
            watchdog: Watchdog::default(),
            debug: [0; 4],
            hertz: 4_000_000,
            wiring,
            reset: None,
            resets: Vec::new(),
            crystal: Time::NEVER,
            refused: None,
        }
    }

    /// Starts again: all registers have their reset values, but for those of the backup domain and of the debug unit,
    /// which a loss of supply alone resets (RM0351, 6.1 and 48.16).
    pub fn restart(&mut self, reason: ResetReason, now: Time) {
        self.resets.push(reason);
        self.rcc.reset(reason);
        self.flash.reset(now);
        if matches!(reason, ResetReason::Supply | ResetReason::OptionBytes) {
            self.flash.load_options();
        }
        (self.exceptions, self.system, self.power) = Default::default();
        self.system = System::new();
        self.usart.reset();
        self.exti.reset();
        self.dma = Default::default();
        self.reset_i2c(now);
        self.timer = Timer::new(self.hertz);
        self.spi.iter_mut().for_each(Spi::reset);
        self.watchdog = Watchdog::default();
        if reason == ResetReason::Supply {
            self.debug = [0; 4];
        }
        (self.reset, self.refused) = (None, None);
        for index in 0..PORTS {
            self.ports[index] = Port::new(index);
            self.drive(index, now);
        }
        self.reclock(now);
    }

    /// Puts the interface of the base's bus into reset.
    fn reset_i2c(&mut self, now: Time) {
        self.i2c.let_go(now, self.hertz, &mut *self.wiring);
        self.i2c = I2c::new();
    }

    /// Clock of the core, Hz.
    pub const fn hertz(&self) -> u64 {
        self.hertz
    }

    /// The other side of the serial port sends bytes from now on, one after the other. One that comes while the port does
    /// not receive is lost.
    pub fn hear(&mut self, bytes: &[u8], now: Time) {
        self.usart.offer(bytes, self.wiring.baud(), now);
    }

    /// When something next happens of itself.
    pub fn due(&mut self, now: Time) -> Time {
        let spi = self.spi.iter().map(|spi| spi.due(self.hertz)).min().unwrap_or(Time::NEVER);
        let rest = [
            self.timer.due(),
            self.usart.due(),
            self.i2c.due(),
            self.watchdog.due(),
            self.wiring.due(),
            self.crystal,
            self.flash.due(now),
        ];
        rest.into_iter().fold(spi, Time::min)
    }

    /// Lets everything happen that is due until now.
    pub fn advance(&mut self, memory: &mut dyn Memory, now: Time) {
        loop {
            let at = self.due(now);
            if at > now || self.reset.is_some() {
                break;
            }
            self.happen(memory, at);
        }
    }

    /// Does what is due.
    fn happen(&mut self, memory: &mut dyn Memory, at: Time) {
        self.timer.advance(at);
        for bus in 0..2 {
            if self.spi[bus].due(self.hertz) <= at {
                self.spi[bus].receive(self.wiring.finish(bus));
            }
        }
        if self.usart.advance(at, self.hertz) {
            self.wiring.frame(self.usart.baud(self.hertz));
        }
        if self.i2c.due() <= at {
            self.i2c.advance(at, self.hertz, &mut *self.wiring);
        }
        self.flash.advance(at);
        if self.flash.is_cut(at) {
            self.reset = Some(ResetReason::Supply);
        }
        if self.wiring.due() <= at {
            for (Pin { port, number }, rises) in self.wiring.edges(at) {
                if self.ports[port].is_read(number) {
                    self.exti.edge(port, number, rises);
                }
            }
        }
        if self.crystal <= at {
            self.reclock(at);
        }
        if self.watchdog.due() <= at {
            self.reset = Some(ResetReason::Watchdog);
        }
        self.settle(memory, at);
    }

    /// Serves direct memory access, begins what waits, and sets the lines of the interrupts.
    fn settle(&mut self, memory: &mut dyn Memory, now: Time) {
        while self.transfer(memory) {}
        for (bus, spi) in self.spi.iter_mut().enumerate() {
            if let Some(byte) = spi.begin(now) {
                self.wiring.begin(bus, byte, spi.clock(self.hertz), now);
            }
        }
        if self.usart.begin(now, self.hertz) {
            self.wiring.frame(self.usart.baud(self.hertz));
        }
        if self.i2c.due() == Time::NEVER {
            self.i2c.advance(now, self.hertz, &mut *self.wiring);
        }
        // What has begun may leave room for another byte.
        while self.transfer(memory) {}
        if let Some(signal) = self.disconnected() {
            self.refused = Some(Refused::NotConnected(signal));
        }
        self.raise();
    }

    /// A signal that is on its way although its pin is not connected to its peripheral.
    fn disconnected(&self) -> Option<Signal> {
        let [sends, receives] = self.usart.uses();
        let [first, second] = self.spi.each_ref().map(Spi::is_shifting);
        let used: [(bool, &[Signal]); 5] = [
            (first, &pins::SPI[0]),
            (second, &pins::SPI[1]),
            (self.i2c.uses_wires(), &pins::I2C),
            (sends, &pins::SENT),
            (receives, &pins::RECEIVED),
        ];
        let mut signals = used.into_iter().filter(|(is_used, _)| *is_used).flat_map(|(_, all)| all);
        signals.find(|signal| !signal.is_connected(&self.ports)).copied()
    }

    /// Sets the lines of the interrupts.
    fn raise(&mut self) {
        let lines = &mut self.exceptions.lines;
        let mut set =
            |interrupt: u32, is_active: bool| lines.put(FIRST_INTERRUPT + interrupt, is_active);
        set(4, self.flash.interrupts());
        let edges = self.exti.active();
        (0..5).for_each(|line| set(6 + line, edges >> line & 1 != 0));
        set(23, edges & 0x3E0 != 0);
        set(40, edges & 0xFC00 != 0);
        for (dma, interrupts) in self.dma.iter().zip(DMA_INTERRUPTS) {
            for (channel, interrupt) in interrupts.into_iter().enumerate() {
                set(interrupt, dma.interrupts(channel));
            }
        }
        set(24, self.timer.interrupts());
        let [event, error] = self.i2c.interrupts();
        set(33, event);
        set(34, error);
        set(35, self.spi[0].interrupts());
        set(36, self.spi[1].interrupts());
        set(37, self.usart.interrupts());
        // A row that cannot be corrected (3.3.2).
        if std::mem::take(&mut self.flash.is_broken) {
            self.exceptions.pending.put(NOT_MASKABLE, true);
        }
    }

    /// Determines the clock anew.
    fn reclock(&mut self, now: Time) {
        self.crystal = self.rcc.crystal_due().filter(|due| *due > now).unwrap_or(Time::NEVER);
        if let Ok(hertz) = self.rcc.hertz(now) {
            self.hertz = hertz;
            self.timer.reclock(hertz, now);
        }
    }

    /// Tells the wires which levels a port drives.
    fn drive(&mut self, port: usize, now: Time) {
        for number in 0..16 {
            self.wiring.drive(Pin { port, number }, self.ports[port].driven(number), now);
        }
    }

    /// The levels of a port's pins, as their inputs read them.
    fn levels(&mut self, port: usize, now: Time) -> u16 {
        let read = (0..16).filter(|number| self.ports[port].is_read(*number));
        read.fold(0, |levels, number| {
            let driven = self.ports[port].driven(number);
            let level = driven.unwrap_or_else(|| self.wiring.level(Pin { port, number }, now));
            levels | u16::from(level) << number
        })
    }
}
