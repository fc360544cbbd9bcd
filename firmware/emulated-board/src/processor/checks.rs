//! Instructions of which Unicorn does not check what makes them fault: accesses of several words that must be aligned,
//! by two and by many registers and by the floating-point unit (ARMv7-M Architecture Reference Manual, A3.2.1), and all
//! use of that unit while it is off (B1.5.14).
//!
//! A hook of each access or instruction would halve the speed. All of these accesses are a multiple of four bytes from
//! their base register, so the registers are looked at where a block begins. An access whose base the block itself
//! computes, and what is conditional, are not checked.

use unicorn_engine::Unicorn;

use super::instructions::instructions;
use super::registers::KEPT;
use crate::faults::Fault;

/// How many registers can be the base of an access that is not aligned: stack pointer and program counter cannot.
const BASES: usize = 13;

/// What is looked at before instructions are executed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Checks {
    /// Registers that must be aligned to a word, as bits.
    bases: u16,
    /// Registers that may be written, as bits.
    written: u16,
    /// Whether there are instructions for the floating-point unit.
    has_floats: bool,
}

impl Checks {
    /// What is looked at before all instructions of a block.
    pub(super) fn of(bytes: &[u8]) -> Self {
        let mut finder = Finder::default();
        let mut all = Self::default();
        for (_, first, second) in instructions(bytes) {
            let one = finder.take(first, second);
            all.bases |= one.bases;
            all.has_floats |= one.has_floats;
        }
        Self { written: finder.written as u16, ..all }
    }

    /// The fault that the instructions would be, as registers and unit are now; some registers are known to be aligned.
    pub(super) fn fault(
        self,
        aligned: u16,
        uc: &Unicorn<'_, ()>,
        is_unit_on: bool,
    ) -> Option<Fault> {
        if self.has_floats && !is_unit_on {
            return Some(Fault::NO_COPROCESSOR);
        }
        let mut bases = self.bases & !aligned;
        while bases != 0 {
            let base = uc.reg_read(KEPT[bases.trailing_zeros() as usize]).unwrap_or(0);
            if base & 3 != 0 {
                return Some(Fault::UNALIGNED);
            }
            bases &= bases - 1;
        }
        None
    }

    /// The registers that are known to be aligned after the instructions, of which these were before.
    pub(super) const fn aligned_after(self, aligned: u16) -> u16 {
        (aligned | self.bases) & !self.written
    }
}

/// The first instruction of a block that faults, as registers and unit are at its beginning: its distance from there,
/// bytes, and the fault.
pub(super) fn first_fault(
    bytes: &[u8],
    uc: &Unicorn<'_, ()>,
    is_unit_on: bool,
) -> Option<(u16, Fault)> {
    let mut finder = Finder::default();
    instructions(bytes).find_map(|(offset, first, second)| {
        Some((offset, finder.take(first, second).fault(0, uc, is_unit_on)?))
    })
}

/// Finds what is looked at before instructions that come one after the other.
#[derive(Debug, Default)]
struct Finder {
    /// Registers that the block may have written, as bits.
    written: u32,
    /// How many of the next instructions are conditional.
    conditional: u32,
}

impl Finder {
    /// What is looked at before the next instruction: its first half-word, and the second of a wide one.
    fn take(&mut self, first: u16, second: Option<u16>) -> Checks {
        let base = base(first, second)
            .filter(|base| usize::from(*base) < BASES && self.written >> base & 1 == 0);
        let checks = match self.conditional {
            0 => Checks {
                bases: base.map_or(0, |base| 1 << base),
                has_floats: second.is_some_and(|second| is_float(first, second)),
                ..Checks::default()
            },
            _ => Checks::default(),
        };
        self.written |= second.map_or_else(|| written(first), |second| written_wide(first, second));
        self.conditional = match first {
            // IT: the lowest bit that is set ends the mask.
            0xBF01..=0xBFFF if first & 0xF != 0 => 4 - u32::from(first).trailing_zeros(),
            _ => self.conditional.saturating_sub(1),
        };
        checks
    }
}

/// Whether a wide instruction is one of the floating-point unit (A5.3.18, A6.4).
const fn is_float(first: u16, second: u16) -> bool {
    first & 0xEC00 == 0xEC00 && second & 0x0E00 == 0x0A00
}

/// The base register of an access that must be aligned to a word (A5.2, A5.3.5, A5.3.6, A6.5).
fn base(first: u16, second: Option<u16>) -> Option<u8> {
    let Some(second) = second else {
        // LDM, STM.
        return (first & 0xF000 == 0xC000).then_some((first >> 8 & 7) as u8);
    };
    let is_multiple = first & 0xFE40 == 0xE800;
    // Neither an offset nor a change of the base (P = W = 0): an exclusive access, or a branch by a table.
    let is_double = first & 0xFE40 == 0xE840 && first & 0x0120 != 0;
    let is_of_floats =
        first & 0xFE00 == 0xEC00 && first & 0xFFE0 != 0xEC40 && is_float(first, second);
    (is_multiple || is_double || is_of_floats).then_some((first & 0xF) as u8)
}

/// Registers that an instruction of 16 bits may write, among others that it does not; a base that an access of many
/// registers moves stays aligned (A5.2).
const fn written(first: u16) -> u32 {
    let by_fields = 1 << (first & 7) | 1 << (first >> 8 & 7);
    match first >> 10 {
        // Operations on high registers.
        0b01_0001 => 1 << (first >> 4 & 8 | first & 7),
        // LDM; POP.
        0b11_0010 | 0b11_0011 | 0b10_1111 => by_fields | first as u32 & 0xFF,
        _ => by_fields,
    }
}

/// Registers that an instruction of 32 bits may write, among others that it does not (A5.3).
const fn written_wide(first: u16, second: u16) -> u32 {
    let (base, upper, lower) = (1 << (first & 0xF), 1 << (second >> 12), 1 << (second >> 8 & 0xF));
    match first >> 9 {
        // Of many registers; of two, exclusive ones, branches by a table.
        0b111_0100 if first & 0x40 == 0 => second as u32,
        0b111_0100 => upper | lower | 1 << (second & 0xF),
        // Moves from the floating-point unit, and its other instructions.
        _ if is_float(first, second) => {
            let is_move =
                first & 0xFF00 == 0xEE00 && second & 0x10 != 0 || first & 0xFFE0 == 0xEC40;
            if is_move { base | upper } else { 0 }
        }
        // Data processing with shifts, with immediate operands, with registers; long products.
        0b111_0101 | 0b111_1000..=0b111_1011 => lower,
        0b111_1101 if first & 0xFF80 != 0xFB80 => lower,
        0b111_1101 => lower | upper,
        // Of one register.
        0b111_1100 => base | upper,
        _ => u32::MAX,
    }
}
