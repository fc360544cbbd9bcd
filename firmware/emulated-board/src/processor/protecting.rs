//! Accesses that must not happen: the core is as it was before them, and nothing is written.
//!
//! Unicorn goes on to the end of an access that a hook refuses, and, among conditional instructions, beyond it. So
//! registers and memory are put back. The protection of memory is a hook of accesses of data, since its regions are
//! smaller than Unicorn's pages; it is there only while protection is on, and only where that may refuse an access.

use std::rc::Rc;

use unicorn_engine::{HookType, MemType, RegisterARM, Unicorn};

use super::Processor;
use super::memory::{Ram, is_ram};
use super::registers::KEPT;
use super::state::{Halt, State};
use crate::controller::Memory;
use crate::controller::protection::Access;
use crate::faults::Fault;

/// Puts right what Unicorn leaves behind where it calls a hook for an access of data among conditional instructions:
/// their state, which would hold for the next block too.
pub(super) fn forget_conditions(uc: &mut Unicorn<'_, ()>) {
    const NONE: u64 = 1 << 24;
    if uc.reg_read(RegisterARM::EPSR) != Ok(NONE) {
        let _ = uc.reg_write(RegisterARM::EPSR, NONE);
    }
}

/// Registers, and memory that is written, before an access that faults: it leaves them as they are.
pub(super) struct Checkpoint {
    registers: [u64; KEPT.len()],
    /// Address and bytes.
    memory: Option<(u32, Vec<u8>)>,
}

impl State {
    /// Stops the core for a fault of an access, which is rolled back; a write has so many bytes at an address.
    pub(super) fn abort(
        &mut self,
        uc: &mut Unicorn<'_, ()>,
        fault: Fault,
        written: Option<(u32, usize)>,
    ) {
        if self.halt.is_some() {
            return;
        }
        // A register is not read, which may do something; it is not written either.
        let memory = written.filter(|(address, _)| is_ram(*address)).map(|(address, size)| {
            let mut bytes = vec![0; size];
            let _ = uc.mem_read(address.into(), &mut bytes);
            (address, bytes)
        });
        self.checkpoint = Some(Checkpoint {
            registers: KEPT.map(|register| uc.reg_read(register).unwrap_or(0)),
            memory,
        });
        self.halt(uc, Halt::Faulting(fault));
    }

    /// Whether a register of the controller must not be accessed: the core stops already, or has no privilege for its
    /// own registers (B3.1.1).
    pub(super) fn is_barred(&mut self, uc: &mut Unicorn<'_, ()>, address: u32) -> bool {
        if self.level.is_unprivileged && address >> 20 == 0xE00 {
            self.halt(uc, Halt::Faulting(Fault::bus(address)));
        }
        matches!(self.halt, Some(Halt::Faulting(_)))
    }

    /// Holds an access of data to the protection of memory.
    fn check(&mut self, uc: &mut Unicorn<'_, ()>, kind: MemType, address: u32, size: usize) {
        let access = if kind == MemType::WRITE { Access::Write } else { Access::Read };
        let protection = &self.controller.system.protection;
        if let Some(refused) = protection.refuses(address, size as u32, access, self.level) {
            let written = (access == Access::Write).then_some((address, size));
            self.abort(uc, Fault::protected(refused), written);
        }
        forget_conditions(uc);
    }
}

impl Processor {
    /// Puts back what an access that faulted has changed.
    pub(super) fn roll_back(&mut self) {
        let Some(before) = self.state.borrow_mut().checkpoint.take() else { return };
        if let Some((address, bytes)) = before.memory {
            Ram(&mut self.uc).write(address, &bytes);
        }
        for (register, value) in KEPT.iter().zip(before.registers) {
            // Writing the address also says that it is Thumb code, as all of it is.
            self.set(*register, if *register == RegisterARM::PC { value | 1 } else { value });
        }
    }

    /// Holds accesses of data to the protection of memory, where it may refuse them. Once there was a thread without
    /// privilege, that is everywhere: a change has all code translated anew.
    pub(super) fn protect(&mut self) {
        let watched = {
            let state = self.state.borrow();
            self.was_unprivileged |= state.level.is_unprivileged;
            state.controller.system.protection.watched(self.was_unprivileged)
        };
        if watched == self.protecting.map(|(_, watched)| watched) {
            return;
        }
        if let Some((hook, _)) = self.protecting.take() {
            let _ = self.uc.remove_hook(hook);
        }
        if let Some((first, last)) = watched {
            let state = Rc::clone(&self.state);
            let check = move |uc: &mut Unicorn<'_, ()>, kind, address, size, _| {
                state.borrow_mut().check(uc, kind, address as u32, size);
                true
            };
            // An access of up to eight bytes may begin before what is watched.
            let begin = first.saturating_sub(7);
            let kinds = HookType::MEM_READ | HookType::MEM_WRITE;
            let hook = self.uc.add_mem_hook(kinds, begin.into(), last.into(), check);
            self.protecting = hook.ok().map(|hook| (hook, (first, last)));
        }
        // Code that was translated before does without the hook, or with it.
        let _ = self.uc.ctl_flush_tb();
    }
}
