//! Reset and clock control (RM0351, chapter 6): which clock runs, what resets it, which peripheral has its clock.

use super::{Refused, ResetReason};
use crate::time::Time;

/// Frequency of the internal oscillator LSI, Hz; 31 040 to 32 960 (DS10969, LSI oscillator characteristics).
pub const LSI_HERTZ: u64 = 32_000;
/// The crystal X2 of the board, Hz.
pub const LSE_HERTZ: u64 = 32_768;
/// The internal oscillator HSI16, Hz.
const HSI_HERTZ: u64 = 16_000_000;
/// Ranges of the oscillator MSI, Hz (`RCC_CR`, MSIRANGE).
const MSI_HERTZ: [u64; 12] = [
    100_000, 200_000, 400_000, 800_000, 1_000_000, 2_000_000, 4_000_000, 8_000_000, 16_000_000,
    24_000_000, 32_000_000, 48_000_000,
];
/// Start of the crystal (DS10969, LSE oscillator characteristics: typical with any drive).
const LSE_START: Time = Time::microseconds(2_000_000);

/// Bits of `RCC_CSR` by the reason of a reset.
const fn flags(reason: ResetReason) -> u32 {
    const PIN: u32 = 1 << 26;
    match reason {
        // Every reset pulls the pin.
        ResetReason::Supply => 1 << 27 | PIN,
        ResetReason::Software => 1 << 28 | PIN,
        ResetReason::OptionBytes => 1 << 25 | PIN,
        ResetReason::Watchdog => 1 << 29 | PIN,
        ResetReason::Pin => PIN,
    }
}

/// What is true of the board's oscillators.
#[derive(Clone, Copy, Debug)]
pub struct Oscillators {
    /// Whether the crystal of 32 768 Hz oscillates.
    pub has_crystal: bool,
    /// Relative error of the oscillator MSI where it is not locked to the crystal.
    pub msi_error: f64,
}

/// The registers.
#[derive(Clone, Debug)]
pub struct Rcc {
    /// The registers as written, by word.
    words: [u32; 40],
    /// Oscillators of the board.
    oscillators: Oscillators,
    /// When the crystal was switched on.
    crystal_since: Option<Time>,
}

/// Word of `RCC_CR`.
const CR: usize = 0;
/// Bits of `RCC_CR` that say which oscillators are ready, which is at once.
const READY: u32 = 1 << 1 | 1 << 10 | 1 << 17 | 1 << 25;
/// Bits of `RCC_CFGR` that divide the clocks of the buses.
const DIVIDERS: u32 = 0x3FF0;
/// Word of `RCC_CFGR`.
const CFGR: usize = 0x08 / 4;
/// Word of `RCC_PLLCFGR`.
const PLLCFGR: usize = 0x0C / 4;
/// Word of `RCC_CIFR`, which is not written.
const CIFR: usize = 0x1C / 4;
/// Word of `RCC_CICR`, which clears what is never set here.
const CICR: usize = 0x20 / 4;
/// Word of `RCC_BDCR`.
const BDCR: usize = 0x90 / 4;
/// Word of `RCC_CSR`.
const CSR: usize = 0x94 / 4;

/// Registers that are not zero after a reset (6.4), but for `BDCR` and `CSR`: offset and value. The calibration of `ICSCR`
/// is that of no board.
const RESET: [(usize, u32); 12] = [
    (0x00, 0x63),
    (0x04, 0x1000_0000),
    (0x0C, 0x1000),
    (0x10, 0x1000),
    (0x14, 0x1000),
    (0x48, 0x100),
    (0x68, 0x0001_1303),
    (0x6C, 0x0005_32FF),
    (0x70, 0x101),
    (0x78, 0xF2FE_CA3F),
    (0x7C, 0x25),
    (0x80, 0x0167_7C01),
];

/// Registers of which only these bits may change, since the model does not have what the others ask for: the offset of
/// the first and of the last one, the bits, what the others are. Outputs of the PLL that nothing here uses may be on.
const PARTIAL: [(u32, u32, u32, &str); 8] = [
    (0x00, 0x00, 0x0100_01FD | READY, "the oscillator HSE, a guard of clocks, a further PLL"),
    (0x04, 0x04, 0, "trimmed oscillators"),
    (0x08, 0x08, 0x3FFF, "a pin with a clock, a wake-up by the oscillator HSI16"),
    (0x0C, 0x0C, 0x0773_7F73, "reserved bits of the PLL"),
    (0x10, 0x18, 0, "a further PLL, interrupts of oscillators that are ready"),
    (0x68, 0x80, 0, "clocks that stop while the core sleeps"),
    (0x88, 0x88, !0xC003, "another clock of USART1 or I2C2"),
    (
        0x90,
        0x90,
        0x0001_831B,
        "the crystal without its oscillator, its guard, a pin with a slow clock",
    ),
];

/// Offsets of the registers from the first to the last of those that follow each other (6.4).
const REGISTERS: [[u32; 2]; 9] = [
    [0x00, 0x20],
    [0x28, 0x30],
    [0x38, 0x40],
    [0x48, 0x50],
    [0x58, 0x60],
    [0x68, 0x70],
    [0x78, 0x80],
    [0x88, 0x88],
    [0x90, 0x94],
];

/// The word of the register at an offset.
fn word(offset: u32) -> Result<usize, Refused> {
    let is_there = REGISTERS.iter().any(|[first, last]| (*first..=*last).contains(&offset));
    if is_there { Ok((offset / 4) as usize) } else { Err(Refused::Unknown) }
}

impl Rcc {
    /// The registers after the supply came up.
    pub fn new(oscillators: Oscillators) -> Self {
        let mut rcc = Self { words: [0; 40], oscillators, crystal_since: None };
        rcc.reset(ResetReason::Supply);
        rcc
    }

    /// A reset: the backup domain stays unless the supply was lost, the reasons add up until they are cleared.
    pub fn reset(&mut self, reason: ResetReason) {
        let (backup, reasons) = match reason {
            ResetReason::Supply => (0, 0),
            _ => (self.words[BDCR], self.words[CSR] & 0xFF00_0000),
        };
        self.words = [0; 40];
        for (offset, value) in RESET {
            self.words[offset / 4] = value;
        }
        self.words[BDCR] = backup;
        self.words[CSR] = 0x600 | reasons | flags(reason);
        if backup & 1 == 0 {
            self.crystal_since = None;
        }
    }

    /// Reads a register.
    pub fn read(&self, offset: u32, now: Time) -> Result<u32, Refused> {
        let word = word(offset)?;
        let value = self.words[word];
        Ok(match word {
            CR => value | (value & 0x0101_0001) << 1 | (value & 1 << 8) << 2,
            CFGR => value & !0xC | (value & 3) << 2,
            BDCR if self.crystal_runs(now) => value | 2,
            CSR => value | (value & 1) << 1,
            _ => value,
        })
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32, now: Time) -> Result<(), Refused> {
        let word = word(offset)?;
        let held = &mut self.words[word];
        for (first, last, bits, others) in PARTIAL {
            if (first..=last).contains(&offset) && (*held ^ value) & !bits != 0 {
                return Err(Refused::NotModelled(others));
            }
        }
        match word {
            CIFR | CICR => {}
            CSR if value & 1 << 23 != 0 => *held = value & 0xFFF,
            CSR => *held = *held & 0xFF00_0000 | value & 0xFFF,
            BDCR if value & 1 << 16 != 0 => {
                *held = value & 1 << 16;
                self.crystal_since = None;
            }
            BDCR => {
                // Once the clock of the RTC is chosen, only a reset of the backup domain changes it (6.4.29).
                let chosen = *held & 0x300;
                *held = if chosen == 0 { value & !2 } else { value & !0x302 | chosen };
                match (value & 1, self.crystal_since) {
                    (0, _) => self.crystal_since = None,
                    (_, None) => self.crystal_since = Some(now),
                    _ => {}
                }
            }
            CR => *held = value & !READY,
            _ => *held = value,
        }
        Ok(())
    }

    /// Whether the crystal oscillates.
    fn crystal_runs(&self, now: Time) -> bool {
        self.oscillators.has_crystal
            && self.crystal_since.is_some_and(|since| now >= since + LSE_START)
    }

    /// When the crystal oscillates, where it is to.
    pub fn crystal_due(&self) -> Option<Time> {
        Some(self.crystal_since? + LSE_START).filter(|_| self.oscillators.has_crystal)
    }

    /// Whether a peripheral has its clock: the offset of its enable register and the bit in it.
    pub fn has_clock(&self, offset: u32, bit: u32) -> bool {
        self.words[(offset / 4) as usize] >> bit & 1 != 0
    }

    /// Frequency of the core and of both peripheral buses, Hz.
    ///
    /// # Errors
    /// A divider or a source that is not modelled.
    pub fn hertz(&self, now: Time) -> Result<u64, Refused> {
        let configuration = self.words[CFGR];
        if configuration & DIVIDERS != 0 {
            return Err(Refused::NotModelled("a divider of the buses' clocks"));
        }
        match configuration & 3 {
            0 => Ok(self.msi(now)),
            1 => Ok(HSI_HERTZ),
            3 => self.pll(now),
            _ => Err(Refused::NotModelled("the crystal HSE")),
        }
    }

    /// Frequency of the oscillator MSI, Hz: with the crystal the nearest multiple of it, 122 for 4 MHz.
    fn msi(&self, now: Time) -> u64 {
        let control = self.words[CR];
        let range = if control & 8 != 0 { control >> 4 & 0xF } else { self.words[CSR] >> 8 & 0xF };
        let nominal = MSI_HERTZ[(range as usize).min(MSI_HERTZ.len() - 1)];
        if control & 4 != 0 && self.crystal_runs(now) {
            return (nominal + LSE_HERTZ / 2) / LSE_HERTZ * LSE_HERTZ;
        }
        (nominal as f64 * (1.0 + self.oscillators.msi_error)).round() as u64
    }

    /// Frequency of the output R of the main PLL, Hz.
    fn pll(&self, now: Time) -> Result<u64, Refused> {
        let configuration = self.words[PLLCFGR];
        let source = match configuration & 3 {
            1 => self.msi(now),
            2 => HSI_HERTZ,
            _ => return Err(Refused::NotModelled("the PLL's source")),
        };
        let divider = u64::from(configuration >> 4 & 7) + 1;
        let multiplier = u64::from(configuration >> 8 & 0x7F);
        let output = 2 * (u64::from(configuration >> 25 & 3) + 1);
        Ok(source * multiplier / divider / output)
    }
}
