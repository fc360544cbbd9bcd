//! Interrupts by edges of pins (RM0351, chapter 14), with the choice of the port (9.2.3 to 9.2.6).

use super::Refused;

/// Lines 0 to 15, which are pins.
#[derive(Clone, Debug, Default)]
pub struct Exti {
    /// `EXTI_IMR1`: lines that interrupt.
    mask: u32,
    /// `EXTI_EMR1`.
    events: u32,
    /// `EXTI_RTSR1` and `EXTI_FTSR1`: lines on whose rising and falling edges they become pending.
    edges: [u32; 2],
    /// `EXTI_PR1`.
    pending: u32,
    /// `SYSCFG_EXTICR1` to `EXTICR4`: the port of each line, four bits for each.
    ports: [u32; 4],
    /// Falling edges that came while the line was still pending from the one before.
    pub missed: u64,
}

impl Exti {
    /// A reset; the count of edges that were missed goes on.
    pub fn reset(&mut self) {
        *self = Self { missed: self.missed, ..Self::default() };
    }

    /// Reads a register of the interrupt controller; those of lines 32 and up are at their reset values.
    pub fn read(&self, offset: u32) -> Result<u32, Refused> {
        Ok(match offset {
            0x00 => self.mask,
            0x04 => self.events,
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
            0x04 => self.events = value,
            0x08 => self.edges[0] = value,
            0x0C => self.edges[1] = value,
            0x14 => self.pending &= !value,
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// The register of the system configuration that holds ports of lines.
    pub fn ports(&mut self, offset: u32) -> Result<&mut u32, Refused> {
        let place = offset.checked_sub(8).ok_or(Refused::Unknown)? / 4;
        self.ports.get_mut(place as usize).ok_or(Refused::Unknown)
    }

    /// The port that a line listens to, A being 0.
    pub fn port(&self, line: u32) -> usize {
        (self.ports[(line / 4) as usize] >> (4 * (line % 4)) & 0xF) as usize
    }

    /// An edge of a pin.
    pub fn edge(&mut self, port: usize, pin: u32, rises: bool) {
        let bit = 1 << pin;
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
