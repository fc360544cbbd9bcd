//! What an entry stacks and a return unstacks (ARMv7-M Architecture Reference Manual, B1.5.6), and access to registers.

use unicorn_engine::{RegisterARM, Unicorn};

use super::Processor;
use super::state::{State, masks};
use crate::controller::protection::{Access, Level};
use crate::time::Time;

/// Words that an entry stacks, without and with floating-point registers.
pub(super) const WORDS: usize = 8;
pub(super) const FLOAT_WORDS: usize = 26;

/// Registers that an entry stacks, in the order of their addresses, before the program counter and the status.
pub(super) const STACKED: [RegisterARM; 6] = [
    RegisterARM::R0,
    RegisterARM::R1,
    RegisterARM::R2,
    RegisterARM::R3,
    RegisterARM::R12,
    RegisterARM::LR,
];
/// Floating-point registers that it stacks above them, two words each.
pub(super) const FLOATS: [RegisterARM; 8] = [
    RegisterARM::D0,
    RegisterARM::D1,
    RegisterARM::D2,
    RegisterARM::D3,
    RegisterARM::D4,
    RegisterARM::D5,
    RegisterARM::D6,
    RegisterARM::D7,
];
/// Bit of the control register: threads have no privilege.
pub(super) const UNPRIVILEGED: u64 = 1;
/// Bit of it: threads are on the process stack.
pub(super) const PROCESS_STACK: u64 = 2;
/// Bit of it: floating-point registers are in use.
pub(super) const FLOAT_ACTIVE: u64 = 4;
/// The same as Unicorn wants it, which takes the core for one with a secure state and begins with a new status of
/// floating-point arithmetic where only the first bit is set.
pub(super) const FLOATS_IN_USE: u64 = FLOAT_ACTIVE | 8;
/// Bit of the stacked status: the stack was moved by a word to be aligned.
pub(super) const ALIGNED: u32 = 1 << 9;

impl State {
    /// Goes on with a handler, or with what it interrupted, after so many cycles.
    pub(super) fn change(&mut self, number: u32, cycles: u64, uc: &Unicorn<'_, ()>) {
        self.active = number;
        self.event = true;
        self.now = self.now + Time::periods(cycles, self.controller.hertz());
        self.level = self.level(uc, masks(uc));
    }
}

impl Processor {
    /// Whether each word of a frame on the stack may be accessed by code of this level.
    pub(super) fn may_access(
        &self,
        frame: u32,
        bytes: usize,
        access: Access,
        level: Level,
    ) -> bool {
        let state = self.state.borrow();
        let mut words = (0..bytes as u32).step_by(4).map(|offset| frame.wrapping_add(offset));
        let protection = &state.controller.system.protection;
        !protection.is_on() || words.all(|word| protection.allows(word, 4, access, level))
    }

    /// Reads a register.
    pub(super) fn get(&self, register: RegisterARM) -> u64 {
        self.uc.reg_read(register).unwrap_or(0)
    }

    /// Writes a register.
    pub(super) fn set(&mut self, register: RegisterARM, value: u64) {
        let _ = self.uc.reg_write(register, value);
    }

    /// Has Unicorn derive from the registers what it derives from them: only a write of these flags does.
    pub(super) fn refresh(&mut self) {
        let flags = self.get(RegisterARM::APSR_NZCV);
        self.set(RegisterARM::APSR_NZCV, flags);
    }
}
