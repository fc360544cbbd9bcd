//! Pins (RM0351, chapter 8): what each port drives. Which function a pin has besides is written and not looked at: wires
//! go to the peripherals that the board's pins are meant for.

use super::Refused;

/// A port of sixteen pins.
#[derive(Clone, Debug)]
pub struct Port {
    /// `GPIOx_MODER`: two bits for each pin.
    mode: u32,
    /// `GPIOx_OTYPER`, `OSPEEDR` and `PUPDR`: without effect here, all wires have their levels.
    others: [u32; 3],
    /// `GPIOx_ASCR`: the analogue switch, without effect.
    analogue: u32,
    /// `GPIOx_ODR`.
    output: u16,
    /// `GPIOx_AFRL` and `AFRH`.
    functions: [u32; 2],
}

impl Port {
    /// The port after a reset; A and B have the pins of the debugger (8.4.1).
    pub fn new(index: usize) -> Self {
        let mode = [0xABFF_FFFF, 0xFFFF_FEBF].get(index).copied().unwrap_or(0xFFFF_FFFF);
        Self { mode, others: [0; 3], analogue: 0, output: 0, functions: [0; 2] }
    }

    /// Reads a register; `levels` are those of the wires.
    pub fn read(&self, offset: u32, levels: u16) -> Result<u32, Refused> {
        Ok(match offset {
            0x00 => self.mode,
            0x04 | 0x08 | 0x0C => self.others[(offset / 4 - 1) as usize],
            0x10 => levels.into(),
            0x14 => self.output.into(),
            0x18 | 0x28 => 0,
            0x20 | 0x24 => self.functions[(offset / 4 - 8) as usize],
            0x2C => self.analogue,
            _ => return Err(Refused::Unknown),
        })
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refused> {
        match offset {
            0x00 => self.mode = value,
            0x04 | 0x08 | 0x0C => self.others[(offset / 4 - 1) as usize] = value,
            0x14 => self.output = value as u16,
            0x18 => self.output = self.output & !(value >> 16) as u16 | value as u16,
            0x20 | 0x24 => self.functions[(offset / 4 - 8) as usize] = value,
            0x28 => self.output &= !(value as u16),
            0x2C => self.analogue = value,
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// The level that a pin drives; none where it is no output.
    pub fn driven(&self, pin: u32) -> Option<bool> {
        (self.mode >> (2 * pin) & 3 == 1).then_some(self.output >> pin & 1 != 0)
    }
}
