//! Registers of the core: interrupt controller, system control, memory protection, debug (ARMv7-M Architecture
//! Reference Manual, B3).

use super::Refused;
use super::protection::Protection;
use crate::exceptions::{
    BUS_FAULT, EXCEPTIONS, Exceptions, FIRST_INTERRUPT, HARD_FAULT, MEMORY_FAULT, NOT_MASKABLE,
    PENDABLE_SERVICE, PRIORITY_MASK, SUPERVISOR_CALL, SYSTEM_TICK, Set, USAGE_FAULT,
};
use crate::faults::Fault;
use crate::{FLASH, FLASH_BYTES, RAM, RAM_BYTES, RAM2, RAM2_BYTES};

/// The core's identity: Cortex-M4, r0p1.
const IDENTITY: u32 = 0x410F_C241;

/// Registers beside those of the exceptions.
#[derive(Clone, Debug, Default)]
pub struct System {
    /// `SYST_CSR`, without the bit that has it count, and `SYST_RVR`.
    tick: [u32; 2],
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
    /// `FPCCR`.
    float: u32,
    /// `DEMCR`.
    debug: u32,
    /// The memory protection unit.
    pub protection: Protection,
    /// Whether the program asks for a reset.
    pub wants_reset: bool,
}

impl System {
    /// Tells of a fault, and whether it became a hard fault.
    pub const fn tell(&mut self, fault: Fault, is_escalated: bool) {
        self.faults[0] |= fault.status;
        match (fault.number, fault.address) {
            (MEMORY_FAULT, Some(address)) => self.faults[2] = address,
            (BUS_FAULT, Some(address)) => self.faults[3] = address,
            // DEBUGEVT.
            (HARD_FAULT, _) => self.faults[1] |= 1 << 31,
            _ => {}
        }
        // FORCED.
        self.faults[1] |= (is_escalated as u32) << 30;
    }

    /// Whether a return to a thread may leave exceptions active (`NONBASETHRDENA`).
    #[must_use]
    pub const fn returns_to_thread_at_any_time(&self) -> bool {
        self.configuration & 1 != 0
    }

    /// Whether the floating-point unit is on.
    #[must_use]
    pub const fn is_float_unit_on(&self) -> bool {
        self.coprocessors >> 20 & 0xF == 0xF
    }

    /// Whether an exception that becomes pending is an event (`SEVONPEND`).
    #[must_use]
    pub const fn pending_is_event(&self) -> bool {
        self.sleep & 1 << 4 != 0
    }

    /// The registers after a reset; the vectors are at the beginning of the flash.
    pub fn new() -> Self {
        Self { configuration: 0x200, float: 0xC000_0000, ..Self::default() }
    }

    /// Reads a register by its distance from 0xE000 E000; `active` is the exception that is being handled.
    pub fn read(&self, offset: u32, exceptions: &Exceptions, active: u32) -> Result<u32, Refused> {
        let bits = |set: Set| set.interrupts(offset % 0x80 * 8);
        Ok(match offset {
            0x010 | 0x014 => self.tick[(offset as usize - 0x010) / 4],
            0x018 | 0xDF0 | 0xF3C => 0,
            0x004 => 2,
            0x100..0x10C | 0x180..0x18C => bits(exceptions.enabled),
            0x200..0x20C | 0x280..0x28C => bits(exceptions.requested()),
            0x300..0x30C => bits(exceptions.active),
            0x400..0x454 => priorities(exceptions, FIRST_INTERRUPT + offset - 0x400),
            0xD00 => IDENTITY,
            0xD04 => icsr(exceptions, active),
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
            0xD90..0xDA4 => self.protection.read(offset - 0xD90).ok_or(Refused::Unknown)?,
            0xDFC => self.debug,
            0xF34 => self.float,
            _ => return Err(Refused::Unknown),
        })
    }

    /// Writes a register by its distance from 0xE000 E000, by an access of so many bytes.
    pub fn write(
        &mut self,
        offset: u32,
        value: u32,
        size: u32,
        exceptions: &mut Exceptions,
    ) -> Result<(), Refused> {
        Refused::where_asked(unmodelled(offset, value))?;
        match offset {
            0x010..0x01C => self.write_tick(offset, value)?,
            0x100..0x454 | 0xF00 => write_interrupts(exceptions, offset, value, size)?,
            0xD04 => set_pending(exceptions, value),
            0xD18..0xD24 => set_priorities(exceptions, 4 + offset - 0xD18, value, size),
            0xD24 => set_shcsr(exceptions, value)?,
            0xD08 => self.vectors = value & !0x7F,
            0xD0C => self.wants_reset |= value & 4 != 0,
            0xD10 => self.sleep = value,
            0xD14 => self.configuration = value,
            0xD88 => self.coprocessors = value,
            0xDFC => self.debug = value,
            0xD28 => self.faults[0] &= !value,
            0xD2C => self.faults[1] &= !value,
            0xD94..0xDA4 if self.protection.write(offset - 0xD90, value) => {}
            0xF34 => self.float = value,
            0xF3C => {}
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }

    /// Writes a register of the core's timer, which may be set, and does not count.
    fn write_tick(&mut self, offset: u32, value: u32) -> Result<(), Refused> {
        match offset {
            0x010 => self.tick[0] = value & 6,
            0x014 => self.tick[1] = value & 0xFF_FFFF,
            // Any value clears the count, which is zero.
            0x018 => {}
            _ => return Err(Refused::Unknown),
        }
        Ok(())
    }
}

/// What a write of a register asks for that is not modelled.
fn unmodelled(offset: u32, value: u32) -> Option<&'static str> {
    match offset {
        0x010 if value & 1 != 0 => Some("the core's timer"),
        0xD08 if !is_table(value) => Some("vectors outside of flash and RAM"),
        0xD0C if value >> 16 != 0x05FA => Some("a wrong key, with which nothing is written"),
        0xD0C if value & 0x703 != 0 => Some("groups of priorities, or a reset by a debugger"),
        0xD10 if value & 6 != 0 => Some("deep sleep, or sleep at a return"),
        // Returns to a thread at any time, and frames that are aligned, are all that there is.
        0xD14 if value & !1 != 0x200 => Some("traps and alignment of the configuration"),
        0xD88 if value >> 20 & 0xF != 0xF => Some("a floating-point unit that is off"),
        // TRCENA: the units that it enables are not there.
        0xDFC if value & !(1 << 24) != 0 => Some("debug events"),
        // LSPEN: whether they are stacked at once or when they are needed shows nowhere.
        0xF34 if value & !(1 << 30) != 1 << 31 => {
            Some("floating-point registers that are not stacked")
        }
        0xF3C if value != 0 => Some("a default status of floating-point arithmetic"),
        _ => None,
    }
}

/// Writes a register of the interrupt controller.
fn write_interrupts(
    exceptions: &mut Exceptions,
    offset: u32,
    value: u32,
    size: u32,
) -> Result<(), Refused> {
    let set = |set: &mut Set, are_in: bool| set.put_interrupts(offset % 0x80 * 8, value, are_in);
    match offset {
        0x100..0x10C => set(&mut exceptions.enabled, true),
        0x180..0x18C => set(&mut exceptions.enabled, false),
        0x200..0x20C => set(&mut exceptions.pending, true),
        0x280..0x28C => set(&mut exceptions.pending, false),
        0x400..0x454 => set_priorities(exceptions, FIRST_INTERRUPT + offset - 0x400, value, size),
        0xF00 => exceptions.pending.put_interrupts(value & 0x60, 1 << (value & 0x1F), true),
        _ => return Err(Refused::Unknown),
    }
    Ok(())
}

/// Makes exceptions of the core pending or not, by the bits of `ICSR`.
fn set_pending(exceptions: &mut Exceptions, value: u32) {
    for (bit, number, is_set) in PENDING_BITS {
        if value >> bit & 1 != 0 {
            exceptions.pending.put(number, is_set);
        }
    }
}

/// Whether a table of vectors is where the model has memory: at the beginning, where the flash is too, or in flash or
/// RAM.
fn is_table(address: u32) -> bool {
    let memory = [(FLASH, FLASH_BYTES), (RAM, RAM_BYTES), (RAM2, RAM2_BYTES)];
    address == 0 || memory.iter().any(|(start, bytes)| address.wrapping_sub(*start) < *bytes as u32)
}

/// Bits of `ICSR` that make exceptions of the core pending or not: the bit, the exception, which of both.
const PENDING_BITS: [(u32, u32, bool); 5] = [
    (31, NOT_MASKABLE, true),
    (28, PENDABLE_SERVICE, true),
    (27, PENDABLE_SERVICE, false),
    (26, SYSTEM_TICK, true),
    (25, SYSTEM_TICK, false),
];

/// What is active and pending (`ICSR`, B3.2.4); `active` is the exception that is being handled.
fn icsr(exceptions: &Exceptions, active: u32) -> u32 {
    let requested = exceptions.requested();
    let of_core = PENDING_BITS.iter().filter(|(_, _, is_set)| *is_set);
    let of_core: u32 =
        of_core.map(|(bit, number, _)| u32::from(requested.has(*number)) << bit).sum();
    let of_peripherals =
        u32::from((0..EXCEPTIONS as u32).step_by(32).any(|first| requested.interrupts(first) != 0));
    let most_urgent = exceptions.most_urgent().unwrap_or(0);
    active
        | u32::from(exceptions.is_base(active)) << 11
        | most_urgent << 12
        | of_peripherals << 22
        | of_core
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

/// Enables faults by the bits of `SHCSR`. The others are to stay as they are.
fn set_shcsr(exceptions: &mut Exceptions, value: u32) -> Result<(), Refused> {
    const FAULTS: [(u32, u32); 3] = [(16, MEMORY_FAULT), (17, BUS_FAULT), (18, USAGE_FAULT)];
    if (value ^ shcsr(exceptions)) & 0xFFFF != 0 {
        return Err(Refused::NotModelled("exceptions that become active or pending by SHCSR"));
    }
    for (bit, number) in FAULTS {
        exceptions.enabled.put(number, value >> bit & 1 != 0);
    }
    Ok(())
}

/// Which exceptions of the core are enabled, pending and active (`SHCSR`, B3.2.13).
fn shcsr(exceptions: &Exceptions) -> u32 {
    let Exceptions { active, enabled, pending, .. } = exceptions;
    let bits = [
        (active, MEMORY_FAULT, 0),
        (active, BUS_FAULT, 1),
        (active, USAGE_FAULT, 3),
        (active, SUPERVISOR_CALL, 7),
        (active, PENDABLE_SERVICE, 10),
        (active, SYSTEM_TICK, 11),
        (pending, USAGE_FAULT, 12),
        (pending, MEMORY_FAULT, 13),
        (pending, BUS_FAULT, 14),
        (pending, SUPERVISOR_CALL, 15),
        (enabled, MEMORY_FAULT, 16),
        (enabled, BUS_FAULT, 17),
        (enabled, USAGE_FAULT, 18),
    ];
    bits.iter().map(|(set, number, bit)| u32::from(set.has(*number)) << bit).sum()
}
