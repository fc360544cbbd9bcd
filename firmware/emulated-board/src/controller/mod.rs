//! The microcontroller STM32L475VG around its core: those of its peripherals that an image of this project uses.
//!
//! Register facts are those of the reference manual RM0351. A register that is not listed, a peripheral without its
//! clock or its pins and a function that is not modelled are errors, never a value.

mod dma;
mod exti;
pub mod flash;
mod gpio;
mod i2c;
mod map;
mod pins;
mod power;
pub mod protection;
pub mod rcc;
mod spi;
pub mod system;
mod timer;
mod usart;
mod watchdog;

use std::cmp::Reverse;

use thiserror::Error;

use self::dma::{Dma, Item};
use self::exti::Exti;
use self::flash::Flash;
use self::gpio::Port;
use self::i2c::I2c;
use self::map::{DMA_INTERRUPTS, Peripheral, REQUESTS, Request, peripheral};
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
/// What a channel meets whose address in the peripheral is that of another register.
const NO_DATA_REGISTER: Refused =
    Refused::NotModelled("direct memory access to another register than one of data");

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
            crystal: Time::NEVER,
            refused: None,
        }
    }

    /// Starts again: all registers but those of the backup domain have their reset values.
    pub fn restart(&mut self, reason: ResetReason, now: Time) {
        self.rcc.reset(reason);
        self.flash.reset(now);
        (self.exceptions, self.system, self.power) = Default::default();
        self.system = System::new();
        self.usart.reset();
        self.exti.reset();
        (self.dma, self.i2c) = (Default::default(), I2c::new());
        self.timer = Timer::new(self.hertz);
        self.spi = [Spi::new(), Spi::new()];
        self.watchdog = Watchdog::default();
        self.debug = [0; 4];
        (self.reset, self.refused) = (None, None);
        for index in 0..PORTS {
            self.ports[index] = Port::new(index);
            self.drive(index, now);
        }
        self.reclock(now);
    }

    /// Clock of the core, Hz.
    pub const fn hertz(&self) -> u64 {
        self.hertz
    }

    /// The other side of the serial port sends bytes from now on, one after the other.
    pub fn hear(&mut self, bytes: &[u8], now: Time) {
        self.usart.offer(bytes);
        self.usart.begin(now, self.hertz);
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
        self.usart.advance(at);
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
        self.usart.begin(now, self.hertz);
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

    /// Transfers one item of a channel whose peripheral asks for it; whether there was one. Of several channels of a
    /// controller the one with the highest priority goes first, among equals that with the lowest number (11.4.3).
    fn transfer(&mut self, memory: &mut dyn Memory) -> bool {
        let due = REQUESTS.into_iter().filter(|(controller, channel, selection, request)| {
            let dma = &self.dma[*controller];
            dma.channels[*channel].is_armed()
                && dma.selection(*channel) == *selection
                && self.asks(*request)
        });
        let first = due.max_by_key(|(controller, channel, ..)| {
            (Reverse(*controller), self.dma[*controller].priority(*channel), Reverse(*channel))
        });
        let Some((controller, channel, ..)) = first else { return false };
        if let Some(item) = self.dma[controller].take(channel)
            && !self.carry(memory, item)
        {
            self.dma[controller].fail(channel);
        }
        true
    }

    /// Whether a peripheral asks for an item.
    fn asks(&self, request: Request) -> bool {
        match request {
            Request::FromSpi(bus) => self.spi[bus].has_byte(),
            Request::ToSpi(bus) => self.spi[bus].wants_byte(),
            Request::FromI2c => self.i2c.has_byte(),
            Request::ToI2c => self.i2c.wants_byte(),
            Request::FromUsart => self.usart.has_byte(),
            Request::ToUsart => self.usart.wants_byte(),
        }
    }

    /// Carries an item between memory and a register; whether there is memory.
    fn carry(&mut self, memory: &mut dyn Memory, item: Item) -> bool {
        let mut bytes = [0; 4];
        let held = &mut bytes[..item.memory_size as usize];
        if item.is_to_peripheral {
            let is_there = memory.read(item.memory, held);
            if is_there && self.put(item, u32::from_le_bytes(bytes)).is_none() {
                self.refused = Some(NO_DATA_REGISTER);
            }
            return is_there;
        }
        let Some(value) = self.get(item) else {
            self.refused = Some(NO_DATA_REGISTER);
            return true;
        };
        memory.write(item.memory, &value.to_le_bytes()[..item.memory_size as usize])
    }

    /// Writes an item into the register of a peripheral that sends; none where it is no such register.
    fn put(&mut self, item: Item, value: u32) -> Option<()> {
        let offset = item.peripheral & 0x3FF;
        match (peripheral(item.peripheral)?.0, offset) {
            (Peripheral::Spi(bus), 0x0C) => {
                self.spi[bus].write(offset, value, item.peripheral_size)
            }
            (Peripheral::I2c, 0x28) => self.i2c.write(offset, value),
            (Peripheral::Usart, 0x28) => self.usart.write(offset, value),
            _ => return None,
        }
        .ok()
    }

    /// Reads an item from the register of a peripheral that receives; none where it is no such register.
    fn get(&mut self, item: Item) -> Option<u32> {
        let offset = item.peripheral & 0x3FF;
        match (peripheral(item.peripheral)?.0, offset) {
            (Peripheral::Spi(bus), 0x0C) => self.spi[bus].read(offset, item.peripheral_size),
            (Peripheral::I2c, 0x24) => self.i2c.read(offset),
            (Peripheral::Usart, 0x24) => self.usart.read(offset),
            _ => return None,
        }
        .ok()
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

    /// Reads a register by an access of so many bytes; `active` is the exception that is being handled.
    ///
    /// # Errors
    /// What the model does not know.
    pub fn read(
        &mut self,
        memory: &mut dyn Memory,
        address: u32,
        size: u32,
        (now, active): (Time, u32),
    ) -> Result<u32, Refused> {
        self.advance(memory, now);
        let offset = address & 0x3FC;
        let word = match self.clocked(address)? {
            Peripheral::Spi(bus) => self.spi[bus].read(offset, size),
            Peripheral::I2c => self.i2c.read(offset),
            Peripheral::Power => self.power.read(offset),
            Peripheral::Watchdog => self.watchdog.read(offset),
            Peripheral::System => self.system.read(address & 0xFFC, &self.exceptions, active),
            Peripheral::Configuration => self.exti.read_ports(offset),
            Peripheral::Exti => self.exti.read(offset),
            Peripheral::Usart => self.usart.read(offset),
            Peripheral::Timer => self.timer.read(offset, now),
            Peripheral::Dma(controller) => self.dma[controller].read(offset),
            Peripheral::Rcc => self.rcc.read(offset, now),
            Peripheral::Flash => self.flash.read(offset, now),
            Peripheral::Gpio(port) => {
                let levels = if offset == 0x10 { self.levels(port, now) } else { 0 };
                self.ports[port].read(offset, levels)
            }
            Peripheral::Debug => self.debug_word(address).copied(),
        }?;
        self.settle(memory, now);
        self.refused.take().map_or(Ok(word >> (8 * (address & 3))), Err)
    }

    /// Writes a register by an access of so many bytes.
    ///
    /// # Errors
    /// What the model does not know.
    pub fn write(
        &mut self,
        memory: &mut dyn Memory,
        address: u32,
        (value, size): (u32, u32),
        now: Time,
    ) -> Result<(), Refused> {
        self.advance(memory, now);
        let peripheral = self.clocked(address)?;
        if !peripheral.takes(address, size) {
            return Err(Refused::NotModelled("a write of a part of a register"));
        }
        self.write_to(peripheral, address, (value, size), now)?;
        if !self.flash.keeps_up(self.hertz) {
            return Err(Refused::NotModelled("too few wait states of the flash for the clock"));
        }
        if self.system.wants_reset {
            self.reset = Some(ResetReason::Software);
        }
        self.settle(memory, now);
        self.refused.take().map_or(Ok(()), Err)
    }

    /// The peripheral at an address, which has its clock.
    fn clocked(&self, address: u32) -> Result<Peripheral, Refused> {
        let (peripheral, gate) = peripheral(address).ok_or(Refused::Unknown)?;
        if gate.is_some_and(|(offset, bit)| !self.rcc.has_clock(offset, bit)) {
            return Err(Refused::NoClock);
        }
        Ok(peripheral)
    }

    /// Writes a register of a peripheral.
    fn write_to(
        &mut self,
        peripheral: Peripheral,
        address: u32,
        (value, size): (u32, u32),
        now: Time,
    ) -> Result<(), Refused> {
        let offset = address & 0x3FF;
        match peripheral {
            Peripheral::Spi(bus) => self.spi[bus].write(offset, value, size),
            Peripheral::I2c => self.i2c.write(offset, value),
            Peripheral::Power => self.power.write(offset, value),
            Peripheral::Watchdog => self.watchdog.write(offset, value, now),
            Peripheral::System => {
                self.system.write(address & 0xFFF, value, size, &mut self.exceptions)
            }
            Peripheral::Configuration => self.exti.write_ports(offset, value),
            Peripheral::Exti => self.exti.write(offset, value),
            Peripheral::Usart => self.usart.write(offset, value),
            Peripheral::Timer => self.timer.write(offset, value, now),
            Peripheral::Dma(controller) => self.dma[controller].write(offset, value),
            Peripheral::Rcc => self.write_clocks(offset, value, now),
            Peripheral::Flash => self.flash.write(offset, value, now),
            Peripheral::Gpio(port) => {
                let written = self.ports[port].write(offset, value);
                self.drive(port, now);
                written
            }
            Peripheral::Debug => self.debug_word(address).map(|word| *word = value),
        }
    }

    /// A register of the debug unit: what stops while a debugger halts the core, which none does.
    fn debug_word(&mut self, address: u32) -> Result<&mut u32, Refused> {
        let place = (address & 0x3FF).checked_sub(4).ok_or(Refused::Unknown)? / 4;
        self.debug.get_mut(place as usize).ok_or(Refused::Unknown)
    }

    /// Writes a register of the clocks, with what follows from it.
    fn write_clocks(&mut self, offset: u32, value: u32, now: Time) -> Result<(), Refused> {
        if offset == 0x90 && !self.power.is_backup_open() {
            return Ok(());
        }
        self.rcc.write(offset, value, now)?;
        self.reset_peripherals(offset, value, now);
        self.reclock(now);
        self.rcc.hertz(now).map(|_| ())
    }

    /// Puts peripherals into reset, by a reset register and its bits. The flash is only reset without its power (6.4.10).
    fn reset_peripherals(&mut self, offset: u32, bits: u32, now: Time) {
        for bit in (0..32).filter(|bit| bits >> bit & 1 != 0) {
            match (offset, bit) {
                (0x28, 0 | 1) => self.dma[bit as usize] = Dma::default(),
                (0x2C, 0..8) => {
                    self.ports[bit as usize] = Port::new(bit as usize);
                    self.drive(bit as usize, now);
                }
                (0x38, 14) => self.spi[1] = Spi::new(),
                (0x38, 22) => self.i2c = I2c::new(),
                (0x38, 28) => self.power = Power::default(),
                (0x40, 0) => self.exti.reset_ports(),
                (0x40, 12) => self.spi[0] = Spi::new(),
                (0x40, 14) => self.usart.reset(),
                (0x40, 16) => self.timer = Timer::new(self.hertz),
                _ => {}
            }
        }
    }
}
