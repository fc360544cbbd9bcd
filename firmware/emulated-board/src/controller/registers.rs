//! Accesses of registers: the peripheral at an address, and what follows from a write beside the peripheral itself.

use super::dma::Dma;
use super::gpio::Port;
use super::i2c::is_data_low;
use super::map::{Peripheral, peripheral};
use super::power::Power;

use super::timer::Timer;
use super::{Controller, Memory, Refused, ResetReason, identity};
use crate::time::Time;

impl Controller {
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
            Peripheral::Identity => identity::read(offset),
            Peripheral::I2c if offset == 0x18 => {
                Ok(self.i2c.status(is_data_low(&mut *self.wiring, now)))
            }
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
        if self.flash.launches {
            self.reset = Some(ResetReason::OptionBytes);
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
            Peripheral::Identity => Err(Refused::NotModelled("a write to the device's number")),
            Peripheral::I2c => {
                if offset == 0 && value & 1 == 0 {
                    self.i2c.let_go(now, self.hertz, &mut *self.wiring);
                }
                self.i2c.write(offset, value)
            }
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
                (0x38, 14) => self.spi[1].reset(),
                (0x38, 22) => self.reset_i2c(now),
                (0x38, 28) => self.power = Power::default(),
                (0x40, 0) => self.exti.reset_ports(),
                (0x40, 12) => self.spi[0].reset(),
                (0x40, 14) => self.usart.reset(),
                (0x40, 16) => self.timer = Timer::new(self.hertz),
                _ => {}
            }
        }
    }
}
