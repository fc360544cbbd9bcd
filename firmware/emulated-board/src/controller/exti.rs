//! Interrupts by edges of pins (RM0351, chapter 14), with the choice of the port (9.2.3 to 9.2.6).

use super::Refused;

/// `EXTI_IMR1` after a reset: the lines that are no pins, and whose flags are the peripherals', may interrupt (14.5.1).
const MASK: u32 = 0xFF82_0000;
/// Lines with edges of their own, up to 31: pins, and 16 and 18 to 22, at which nothing of the model makes one.
const EDGES: u32 = 0x007D_FFFF;
/// `SYSCFG_EXTICRx`: three bits for each port.
const PORTS: u32 = 0x7777;

/// Lines 0 to 15, which are pins.
#[derive(Clone, Debug)]
pub struct Exti {
    /// `EXTI_IMR1`: lines that interrupt.
    mask: u32,
    /// `EXTI_RTSR1` and `EXTI_FTSR1`: lines on whose rising and falling edges they become pending.
    edges: [u32; 2],
    /// `EXTI_PR1`.
    pending: u32,
    /// `SYSCFG_EXTICR1` to `EXTICR4`: the port of each line, four bits for each.
    ports: [u32; 4],
    /// Falling edges that came while the line was still pending from the one before.
    pub missed: u64,
    /// Lines, as bits, whose wire is broken: no edge comes any more.
    pub broken: u32,
}

impl Default for Exti {
    fn default() -> Self {
        Self { mask: MASK, edges: [0; 2], pending: 0, ports: [0; 4], missed: 0, broken: 0 }
    }
}

impl Exti {
    /// A reset; the count of edges that were missed goes on, and broken wires stay.
    pub fn reset(&mut self) {
        *self = Self { missed: self.missed, broken: self.broken, ..Self::default() };
    }

    /// Reads a register of the interrupt controller; those of lines 32 and up are at their reset values.
    pub fn read(&self, offset: u32) -> Result<u32, Refused> {
        Ok(match offset {
            0x00 => self.mask,
            0x04 => 0,
            0x08 => self.edges[0],
            0x0C => self.edges[1],
            0x14 => self.pending,
            _ => return Err(Refused::Unknown),
        })
    }

    /// Writes a register of the interrupt controller.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refused> {
        match offset {
            0x00 => self.mask = value,
            0x04 if value != 0 => return Err(Refused::NotModelled("lines that wake as events")),
            0x04 => {}
            0x08 => self.edges[0] = value & EDGES,
            0x0C => self.edges[1] = value & EDGES,
            0x14 => self.pending &= !value,
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// Reads a register of the system configuration that holds ports of lines.
    pub fn read_ports(&self, offset: u32) -> Result<u32, Refused> {
        self.ports.get(ports_place(offset)?).copied().ok_or(Refused::Unknown)
    }

    /// Writes such a register.
    pub fn write_ports(&mut self, offset: u32, value: u32) -> Result<(), Refused> {
        let ports = self.ports.get_mut(ports_place(offset)?).ok_or(Refused::Unknown)?;
        *ports = value & PORTS;
        Ok(())
    }

    /// A reset of the system configuration alone.
    pub const fn reset_ports(&mut self) {
        self.ports = [0; 4];
    }

    /// The port that a line listens to, A being 0.
    pub fn port(&self, line: u32) -> usize {
        (self.ports[(line / 4) as usize] >> (4 * (line % 4)) & 0xF) as usize
    }

    /// An edge of a pin.
    pub fn edge(&mut self, port: usize, pin: u32, rises: bool) {
        let bit = !self.broken & 1 << pin;
        if self.port(pin) == port && self.edges[usize::from(!rises)] & bit != 0 {
            self.missed += u64::from(self.pending & self.mask & bit != 0);
            self.pending |= bit;
        }
    }

    /// Lines that interrupt now.
    pub fn active(&self) -> u32 {
        self.pending & self.mask
    }
}

/// Which of the registers that hold ports of lines is at an offset of the system configuration.
fn ports_place(offset: u32) -> Result<usize, Refused> {
    offset.checked_sub(8).map(|distance| (distance / 4) as usize).ok_or(Refused::Unknown)
}
