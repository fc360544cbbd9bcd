//! Pins (RM0351, chapter 8): their modes, what they drive, which peripheral they are given to.

use super::Refused;

/// Mode of an output of the port (`GPIOx_MODER`).
const OUTPUT: u32 = 1;
/// Mode of an alternate function.
const ALTERNATE: u32 = 2;
/// Analogue mode.
const ANALOGUE: u32 = 3;

/// A port of sixteen pins.
#[derive(Clone, Debug)]
pub struct Port {
    /// `GPIOx_MODER`: two bits for each pin.
    mode: u32,
    /// `GPIOx_OTYPER`: outputs with an open drain.
    open_drain: u32,
    /// `GPIOx_OSPEEDR` and `PUPDR`: without effect here, all wires have their levels.
    others: [u32; 2],
    /// `GPIOx_ASCR`: the analogue switch, without effect.
    analogue: u32,
    /// `GPIOx_ODR`.
    output: u16,
    /// `GPIOx_AFRL` and `AFRH`: four bits for each pin.
    functions: [u32; 2],
}

impl Port {
    /// The port after a reset; A and B have the pins of the debugger, H has two pins (8.4.1 to 8.4.4).
    pub fn new(index: usize) -> Self {
        let (mode, others) = match index {
            0 => (0xABFF_FFFF, [0x0C00_0000, 0x6400_0000]),
            1 => (0xFFFF_FEBF, [0, 0x0000_0100]),
            7 => (0x0000_000F, [0; 2]),
            _ => (0xFFFF_FFFF, [0; 2]),
        };
        Self { mode, open_drain: 0, others, analogue: 0, output: 0, functions: [0; 2] }
    }

    /// Reads a register; `levels` are those of the wires.
    pub fn read(&self, offset: u32, levels: u16) -> Result<u32, Refused> {
        Ok(match offset {
            0x00 => self.mode,
            0x04 => self.open_drain,
            0x08 | 0x0C => self.others[(offset / 4 - 2) as usize],
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
            0x04 => self.open_drain = value & 0xFFFF,
            0x08 | 0x0C => self.others[(offset / 4 - 2) as usize] = value,
            // The levels of the wires are not written.
            0x10 => {}
            0x14 => self.output = value as u16,
            0x18 => self.output = self.output & !(value >> 16) as u16 | value as u16,
            0x20 | 0x24 => self.functions[(offset / 4 - 8) as usize] = value,
            0x28 => self.output &= !(value as u16),
            0x2C => self.analogue = value,
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// The mode of a pin.
    const fn mode(&self, pin: u32) -> u32 {
        self.mode >> (2 * pin) & 3
    }

    /// The level that the port itself drives a pin to; none where the pin is no output, or an open drain that is high.
    pub fn driven(&self, pin: u32) -> Option<bool> {
        let is_high = self.output >> pin & 1 != 0;
        (self.mode(pin) == OUTPUT && !(is_high && self.is_open_drain(pin))).then_some(is_high)
    }

    /// Whether a pin is read: in analogue mode its input is off, and reads as zero (8.3.12).
    pub const fn is_read(&self, pin: u32) -> bool {
        self.mode(pin) != ANALOGUE
    }

    /// Whether an output is an open drain.
    pub const fn is_open_drain(&self, pin: u32) -> bool {
        self.open_drain >> pin & 1 != 0
    }

    /// Whether a pin is given to the alternate function of this number.
    pub const fn has_function(&self, pin: u32, function: u32) -> bool {
        let chosen = self.functions[(pin / 8) as usize] >> (4 * (pin % 8)) & 0xF;
        self.mode(pin) == ALTERNATE && chosen == function
    }
}
