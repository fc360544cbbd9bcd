//! Registers of the core: interrupt controller, system control, memory protection, debug (ARMv7-M Architecture
//! Reference Manual, B3).

use super::Refused;
use crate::processor::exceptions::{
    BUS_FAULT, EXCEPTIONS, Exceptions, FIRST_INTERRUPT, MEMORY_FAULT, PENDABLE_SERVICE, PRIORITY_MASK, SYSTEM_TICK,
    USAGE_FAULT,
};

/// The core's identity: Cortex-M4, r0p1.
const IDENTITY: u32 = 0x410F_C241;

/// A region of the memory protection unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Region {
    /// `MPU_RBAR`.
    pub base: u32,
    /// `MPU_RASR`.
    pub attributes: u32,
}

/// Registers beside those of the exceptions.
#[derive(Clone, Debug, Default)]
pub struct System {
    /// `VTOR`.
    pub vectors: u32,
    /// `SCR`.
    pub sleep: u32,
    /// `CCR`.
    configuration: u32,
    /// `CFSR`, `HFSR`, `MMFAR`, `BFAR`.
    pub faults: [u32; 4],
    /// `CPACR`.
    pub coprocessors: u32,
    /// `FPCCR`, `FPCAR`, `FPDSCR`.
    float: [u32; 3],
    /// `DEMCR`.
    debug: u32,
    /// `MPU_CTRL` and `MPU_RNR`.
    protection: [u32; 2],
    /// Its eight regions.
    regions: [Region; 8],
    /// Whether the program asks for a reset.
    pub wants_reset: bool,
}

impl System {
    /// The registers after a reset; the vectors are at the beginning of the flash.
    pub fn new() -> Self {
        Self { configuration: 0x200, float: [0xC000_0000, 0, 0], ..Self::default() }
    }

    /// Reads a register by its distance from 0xE000 E000; `active` is the exception that is being handled.
    pub fn read(&self, offset: u32, exceptions: &Exceptions, active: u32) -> Result<u32, Refused> {
        let bits = |flags: &[bool; EXCEPTIONS]| {
            let first = FIRST_INTERRUPT as usize + (offset % 0x80 * 8) as usize;
            let bits = flags.iter().skip(first).take(32).enumerate();
            bits.map(|(bit, is_set)| u32::from(*is_set) << bit).sum()
        };
        Ok(match offset {
            0x010 | 0x014 | 0x018 => 0,
            0x004 => 2,
            0x100..0x10C | 0x180..0x18C => bits(&exceptions.enabled),
            0x200..0x20C | 0x280..0x28C => bits(&exceptions.pending),
            0x300..0x30C => bits(&exceptions.active),
            0x400..0x454 => priorities(exceptions, FIRST_INTERRUPT + offset - 0x400),
            0xD00 => IDENTITY,
            0xD04 => active | pending(exceptions) << 12,
            0xD08 => self.vectors,
            0xD0C => 0xFA05_0000,
            0xD10 => self.sleep,
            0xD14 => self.configuration,
            0xD18..0xD24 => priorities(exceptions, 4 + offset - 0xD18),
            0xD24 => shcsr(exceptions),
            0xD28 => self.faults[0],
            0xD2C => self.faults[1],
            0xD34 | 0xD38 => self.faults[(offset as usize - 0xD34) / 4 + 2],
            0xD88 => self.coprocessors,
            0xD90 => 0x800,
            0xD94 | 0xD98 => self.protection[(offset as usize - 0xD94) / 4],
            0xD9C => self.region().base,
            0xDA0 => self.region().attributes,
            0xDF0 => 0,
            0xDFC => self.debug,
            0xF34..0xF40 => self.float[(offset as usize - 0xF34) / 4],
            _ => return Err(Refused::Unknown),
        })
    }

    /// The region that the register of numbers chooses.
    fn region(&self) -> Region {
        self.regions[(self.protection[1] & 7) as usize]
    }

    /// Writes a register by its distance from 0xE000 E000, by an access of so many bytes.
    pub fn write(&mut self, offset: u32, value: u32, size: u32, exceptions: &mut Exceptions) -> Result<(), Refused> {
        let set = |flags: &mut [bool; EXCEPTIONS], is_set: bool| {
            let first = FIRST_INTERRUPT as usize + (offset % 0x80 * 8) as usize;
            let bits = flags.iter_mut().skip(first).take(32).enumerate();
            bits.filter(|(bit, _)| value >> bit & 1 != 0).for_each(|(_, flag)| *flag = is_set);
        };
        match offset {
            0x010 if value & 1 != 0 => return Err(Refused::NotModelled("the core's timer")),
            0x010 | 0x014 | 0x018 => {}
            0x100..0x10C => set(&mut exceptions.enabled, true),
            0x180..0x18C => set(&mut exceptions.enabled, false),
            0x200..0x20C => set(&mut exceptions.pending, true),
            0x280..0x28C => set(&mut exceptions.pending, false),
            0x400..0x454 => set_priorities(exceptions, FIRST_INTERRUPT + offset - 0x400, value, size),
            0xD04 => {
                exceptions.pending[PENDABLE_SERVICE as usize] |= value & 1 << 28 != 0;
                exceptions.pending[PENDABLE_SERVICE as usize] &= value & 1 << 27 == 0;
                exceptions.pending[SYSTEM_TICK as usize] |= value & 1 << 26 != 0;
            }
            0xD08 => self.vectors = value,
            0xD0C if value >> 16 == 0x05FA => {
                if value & 0x700 != 0 {
                    return Err(Refused::NotModelled("groups of priorities"));
                }
                self.wants_reset |= value & 4 != 0;
            }
            0xD10 if value & 4 != 0 => return Err(Refused::NotModelled("deep sleep")),
            0xD10 => self.sleep = value,
            0xD14 => self.configuration = value,
            0xD18..0xD24 => set_priorities(exceptions, 4 + offset - 0xD18, value, size),
            0xD24 => {
                for (bit, number) in [(16, MEMORY_FAULT), (17, BUS_FAULT), (18, USAGE_FAULT)] {
                    exceptions.enabled[number as usize] = value >> bit & 1 != 0;
                }
            }
            0xD28 => self.faults[0] &= !value,
            0xD2C => self.faults[1] &= !value,
            0xD88 => self.coprocessors = value,
            0xD94 if value & 1 != 0 => return Err(Refused::NotModelled("the memory protection unit")),
            0xD94 | 0xD98 => self.protection[(offset as usize - 0xD94) / 4] = value,
            0xD9C => {
                if value & 0x10 != 0 {
                    self.protection[1] = value & 0xF;
                }
                self.regions[(self.protection[1] & 7) as usize].base = value & !0x1F;
            }
            0xDA0 => self.regions[(self.protection[1] & 7) as usize].attributes = value,
            0xDFC => self.debug = value,
            0xF00 => exceptions.pending[(FIRST_INTERRUPT + (value & 0x1FF)) as usize % EXCEPTIONS] = true,
            0xF34..0xF40 => self.float[(offset as usize - 0xF34) / 4] = value,
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }
}

/// The most urgent exception that waits, for the register that shows it.
fn pending(exceptions: &Exceptions) -> u32 {
    exceptions.next(Default::default()).unwrap_or(0)
}

/// Priorities of four exceptions from this number on.
fn priorities(exceptions: &Exceptions, first: u32) -> u32 {
    let all = exceptions.priorities.iter().skip(first as usize).take(4).enumerate();
    all.map(|(place, priority)| u32::from(*priority) << (8 * place)).sum()
}

/// Sets the priorities of exceptions from this number on, as many as the access has bytes.
fn set_priorities(exceptions: &mut Exceptions, first: u32, value: u32, size: u32) {
    let all = exceptions.priorities.iter_mut().skip(first as usize).take(size as usize);
    all.zip(value.to_le_bytes()).for_each(|(priority, byte)| *priority = byte & PRIORITY_MASK);
}

/// Which faults are enabled and active (`SHCSR`).
fn shcsr(exceptions: &Exceptions) -> u32 {
    let flag = |flags: &[bool; EXCEPTIONS], number: u32, bit: u32| u32::from(flags[number as usize]) << bit;
    flag(&exceptions.active, MEMORY_FAULT, 0)
        | flag(&exceptions.active, BUS_FAULT, 1)
        | flag(&exceptions.active, USAGE_FAULT, 3)
        | flag(&exceptions.enabled, MEMORY_FAULT, 16)
        | flag(&exceptions.enabled, BUS_FAULT, 17)
        | flag(&exceptions.enabled, USAGE_FAULT, 18)
}
