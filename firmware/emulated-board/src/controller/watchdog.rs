//! The independent watchdog (RM0351, chapter 36): once started, only a reset stops it.

use super::Refused;
use super::rcc::LSI_HERTZ;
use crate::time::Time;

/// The registers.
#[derive(Clone, Debug)]
pub struct Watchdog {
    /// When it was last fed, where it runs.
    fed: Option<Time>,
    /// Whether prescaler and reload value may be written.
    is_open: bool,
    /// `IWDG_PR`.
    prescaler: u32,
    /// `IWDG_RLR`.
    reload: u32,
    /// How often it was fed.
    pub feedings: u64,
    /// The longest time between two feedings.
    pub longest: Time,
}

impl Default for Watchdog {
    fn default() -> Self {
        Self {
            fed: None,
            is_open: false,
            prescaler: 0,
            reload: 0xFFF,
            feedings: 0,
            longest: Time::ZERO,
        }
    }
}

impl Watchdog {
    /// Reads a register; updates are done at once, so the status is zero.
    pub fn read(&self, offset: u32) -> Result<u32, Refused> {
        match offset {
            0x00 | 0x0C => Ok(0),
            0x04 => Ok(self.prescaler),
            0x08 => Ok(self.reload),
            0x10 => Ok(0xFFF),
            _ => Err(Refused::Unknown),
        }
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32, now: Time) -> Result<(), Refused> {
        // Any key but that of access protects prescaler and reload value.
        if offset == 0 {
            self.is_open = value & 0xFFFF == 0x5555;
        }
        match (offset, value & 0xFFFF) {
            (0x00, 0xCCCC) => self.fed = self.fed.or(Some(now)),
            (0x00, 0xAAAA) => {
                if let Some(fed) = self.fed.replace(now) {
                    self.longest = self.longest.max(now - fed);
                    self.feedings += 1;
                } else {
                    self.fed = None;
                }
            }
            (0x04, value) if self.is_open => self.prescaler = value & 7,
            (0x08, value) if self.is_open => self.reload = value & 0xFFF,
            (0x00 | 0x04 | 0x08, _) => {}
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// When it resets the controller, unless it is fed before.
    pub fn due(&self) -> Time {
        let ticks = u64::from(self.reload + 1) << (2 + self.prescaler.min(6));
        self.fed.map_or(Time::NEVER, |fed| fed + Time::periods(ticks, LSI_HERTZ))
    }
}
