//! Power control (RM0351, chapter 5): only what the start of an image asks for.

use super::Refused;

/// `PWR_CR1` to `PWR_CR4` after a reset (5.4.1 to 5.4.4): the regulator has its range 1.
const RESET: [u32; 4] = [0x200, 0, 0x8000, 0];
/// Bits of them that may be set otherwise: which mode deep sleep is, which the core does not have here; whether the
/// backup domain may be written; whether port G, which the package does not have, is supplied.
const FREE: [u32; 4] = [0x107, 1 << 9, 0, 0];

/// The registers, as written.
#[derive(Clone, Debug)]
pub struct Power {
    /// `PWR_CR1` to `PWR_CR4`.
    control: [u32; 4],
}

impl Default for Power {
    fn default() -> Self {
        Self { control: RESET }
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
            0x00..0x10 => {
                let place = (offset / 4) as usize;
                if (value ^ RESET[place]) & !FREE[place] != 0 {
                    return Err(Refused::NotModelled("other voltages, their monitors, or standby"));
                }
                self.control[place] = value;
                Ok(())
            }
            _ => Err(Refused::Unknown),
        }
    }

    /// Whether the backup domain may be written.
    pub fn is_backup_open(&self) -> bool {
        self.control[0] & 0x100 != 0
    }
}
