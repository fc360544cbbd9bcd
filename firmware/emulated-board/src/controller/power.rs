//! Power control (RM0351, chapter 5): only what the start of an image asks for.

use super::Refused;

/// The registers, as written.
#[derive(Clone, Debug)]
pub struct Power {
    /// `PWR_CR1` to `PWR_CR4`.
    control: [u32; 4],
}

impl Default for Power {
    fn default() -> Self {
        Self { control: [0x200, 0, 0x8000, 0] }
    }
}

impl Power {
    /// Reads a register.
    pub fn read(&self, offset: u32) -> Result<u32, Refused> {
        match offset {
            0x00..0x10 => Ok(self.control[(offset / 4) as usize]),
            // The low-power regulator is ready; the voltage is at its range.
            0x14 => Ok(0x100),
            _ => Err(Refused::Unknown),
        }
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) -> Result<(), Refused> {
        match offset {
            0x00..0x10 => self.control[(offset / 4) as usize] = value,
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// Whether the backup domain may be written.
    pub fn is_backup_open(&self) -> bool {
        self.control[0] & 0x100 != 0
    }
}
