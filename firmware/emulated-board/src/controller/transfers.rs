//! Direct memory access between memory and the data registers of peripherals (RM0351, chapter 11).

use std::cmp::Reverse;

use super::dma::Item;
use super::map::{Peripheral, REQUESTS, Request, peripheral};
use super::{Controller, Memory, Refused};

/// Why a channel is refused whose address in the peripheral is that of another register.
const NO_DATA_REGISTER: Refused =
    Refused::NotModelled("direct memory access to another register than one of data");

impl Controller {
    /// Transfers one item of a channel whose peripheral asks for it; whether there was one. Of several channels of a
    /// controller the one with the highest priority goes first, among equals that with the lowest number (11.4.3).
    pub(super) fn transfer(&mut self, memory: &mut dyn Memory) -> bool {
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
        if let Some(item) = self.dma[controller].take(channel) {
            match self.carry(memory, item) {
                Ok(true) => {}
                Ok(false) => self.dma[controller].fail(channel),
                Err(refused) => self.refused = Some(refused),
            }
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
    fn carry(&mut self, memory: &mut dyn Memory, item: Item) -> Result<bool, Refused> {
        let mut bytes = [0; 4];
        if item.is_to_peripheral {
            let is_there = memory.read(item.memory, &mut bytes[..item.memory_size as usize]);
            if is_there {
                self.put(item, u32::from_le_bytes(bytes))?;
            }
            return Ok(is_there);
        }
        let value = self.get(item)?;
        Ok(memory.write(item.memory, &value.to_le_bytes()[..item.memory_size as usize]))
    }

    /// Writes an item into the register of a peripheral that sends.
    fn put(&mut self, item: Item, value: u32) -> Result<(), Refused> {
        let offset = item.peripheral & 0x3FF;
        let (peripheral, _) = peripheral(item.peripheral).ok_or(NO_DATA_REGISTER)?;
        match (peripheral, offset) {
            (Peripheral::Spi(bus), 0x0C) => {
                self.spi[bus].write(offset, value, item.peripheral_size)
            }
            (Peripheral::I2c, 0x28) => self.i2c.write(offset, value),
            (Peripheral::Usart, 0x28) => self.usart.write(offset, value),
            _ => Err(NO_DATA_REGISTER),
        }
    }

    /// Reads an item from the register of a peripheral that receives.
    fn get(&mut self, item: Item) -> Result<u32, Refused> {
        let offset = item.peripheral & 0x3FF;
        let (peripheral, _) = peripheral(item.peripheral).ok_or(NO_DATA_REGISTER)?;
        match (peripheral, offset) {
            (Peripheral::Spi(bus), 0x0C) => self.spi[bus].read(offset, item.peripheral_size),
            (Peripheral::I2c, 0x24) => self.i2c.read(offset),
            (Peripheral::Usart, 0x24) => self.usart.read(offset),
            _ => Err(NO_DATA_REGISTER),
        }
    }
}
