//! Hooks of Unicorn: blocks that begin, exceptions and faults, accesses to the controller's registers and to the flash
//! behind the image.

use std::rc::Rc;

use hal_mock::flash::Bank;
use unicorn_engine::{HookType, MemType, Prot, RegisterARM, TlbEntry, TlbType, Unicorn, uc_error};

use super::Processor;
use super::memory::{DEVICES, REGISTERS, Ram};
use super::protecting::forget_conditions;
use super::state::Halt;
use crate::controller::Refused;
use crate::exceptions::NOT_MASKABLE;
use crate::faults::Fault;
use crate::{FLASH, FLASH_BYTES, RAM, RAM_BYTES, RAM2, RAM2_BYTES};

/// The addresses that are not in RAM, of which every access succeeds. A hook that covers RAM halves the speed: Unicorn
/// then calls a function for each write.
const WITHOUT_RAM: [(u32, u32); 3] =
    [(0, RAM2 - 1), (RAM2 + RAM2_BYTES as u32, RAM - 1), (RAM + RAM_BYTES as u32, u32::MAX)];

/// Why an access is refused that no register and no memory of the model answers, and the chip does.
fn unmodelled(kind: MemType, address: u32) -> Option<Refused> {
    match kind {
        MemType::READ_UNMAPPED | MemType::WRITE_UNMAPPED if address < FLASH_BYTES as u32 => Some(
            Refused::NotModelled("the flash from the address 0 on, where a null pointer leads"),
        ),
        MemType::WRITE_PROT if address.wrapping_sub(FLASH) < FLASH_BYTES as u32 => {
            Some(Refused::NotModelled("a store into the program"))
        }
        _ => None,
    }
}

/// Has Unicorn tell pages of code from those of data. Each write to a page that may hold code looks for code that it
/// changes, which is slow; Unicorn takes all RAM for such pages, since the default map of the core does.
pub(super) fn split_accesses(uc: &mut Unicorn<'_, ()>) -> Result<(), uc_error> {
    uc.ctl_set_tlb_type(TlbType::VIRTUAL)?;
    let entry = |uc: &mut Unicorn<'_, ()>, paddr, kind| {
        if kind == MemType::FETCH {
            return Some(TlbEntry { paddr, perms: Prot::READ | Prot::EXEC });
        }
        forget_conditions(uc);
        Some(TlbEntry { paddr, perms: Prot::READ | Prot::WRITE })
    };
    uc.add_tlb_hook(1, 0, entry).map(|_| ())
}

impl Processor {
    /// Hooks blocks, exceptions and faults.
    pub(super) fn hook(&mut self) -> Result<(), uc_error> {
        let state = Rc::clone(&self.state);
        self.uc.add_block_hook(1, 0, move |uc, address, size| {
            if state.borrow_mut().begin_block(address as u32, size, uc) {
                let _ = uc.emu_stop();
            }
        })?;
        let state = Rc::clone(&self.state);
        self.uc.add_intr_hook(move |uc, number| {
            let halt = match number {
                2 => Halt::Calling,
                3 => Halt::Faulting(Fault::PROTECTED_CODE),
                7 => Halt::Faulting(Fault::BREAKPOINT),
                8 => Halt::Returning,
                4 | 22 => Halt::Faulting(Fault::UNALIGNED),
                _ => Halt::Faulting(Fault::UNDEFINED),
            };
            state.borrow_mut().halt(uc, halt);
        })?;
        let state = Rc::clone(&self.state);
        self.uc.add_insn_invalid_hook(move |uc| {
            let mut state = state.borrow_mut();
            let wait = state.wait(uc);
            let is_thumb = uc.reg_read(RegisterARM::XPSR).unwrap_or(0) & 1 << 24 != 0;
            let fault = if is_thumb { Fault::UNDEFINED } else { Fault::NO_THUMB };
            state.halt(uc, wait.unwrap_or(Halt::Faulting(fault)));
            wait.is_some()
        })?;
        WITHOUT_RAM.into_iter().try_for_each(|(first, last)| self.hook_faults(first, last))
    }

    /// Hooks accesses that fault between two addresses. Where devices are watched, their accesses come here before
    /// Unicorn splits them: one that is not aligned is a fault (A3.2.1), the others go on.
    fn hook_faults(&mut self, first: u32, last: u32) -> Result<(), uc_error> {
        let state = Rc::clone(&self.state);
        let hook = move |uc: &mut Unicorn<'_, ()>, kind, address, size: usize, value: i64| {
            let address = address as u32;
            let is_register =
                matches!(kind, MemType::READ_PROT | MemType::WRITE_PROT) && address >= DEVICES;
            if let Some(reason) = unmodelled(kind, address) {
                let written = matches!(kind, MemType::WRITE_UNMAPPED | MemType::WRITE_PROT);
                let halt =
                    Halt::Refused { address, written: written.then_some(value as u32), reason };
                state.borrow_mut().halt(uc, halt);
                return false;
            }
            let fault = match kind {
                _ if is_register && address.is_multiple_of(size as u32) => {
                    forget_conditions(uc);
                    return true;
                }
                _ if is_register => Fault::UNALIGNED,
                MemType::FETCH_UNMAPPED | MemType::FETCH_PROT => Fault::fetch(address),
                _ => Fault::bus(address),
            };
            state.borrow_mut().abort(uc, fault, None);
            false
        };
        let kinds = HookType::MEM_UNMAPPED | HookType::MEM_PROT;
        self.uc.add_mem_hook(kinds, first.into(), last.into(), hook).map(|_| ())
    }

    /// Maps the flash behind the image, which is read and written through the controller.
    pub(super) fn map_store(&mut self, code: usize) -> Result<(), uc_error> {
        let (reads, writes) = (Rc::clone(&self.state), Rc::clone(&self.state));
        let read = move |uc: &mut Unicorn<'_, ()>, offset: u64, size: usize| {
            let mut state = reads.borrow_mut();
            let offset = code as u32 + offset as u32;
            loop {
                let now = state.now;
                match state.controller.flash.load(offset, size as u32, now) {
                    Ok(value) => {
                        if std::mem::take(&mut state.controller.flash.is_broken) {
                            state.controller.exceptions.pending.put(NOT_MASKABLE, true);
                            state.is_pending = true;
                        }
                        return value.into();
                    }
                    // The bus stalls until the bank can be read.
                    Err(until) => {
                        state.now = until;
                        state.controller.advance(&mut Ram(uc), until);
                    }
                }
            }
        };
        let write = move |uc: &mut Unicorn<'_, ()>, offset: u64, size: usize, value: u64| {
            let mut state = writes.borrow_mut();
            let offset = code as u32 + offset as u32;
            if let Err(reason) = state.controller.flash.leave_program(Bank::of(offset)) {
                let (address, written) = (FLASH + offset, Some(value as u32));
                return state.halt(uc, Halt::Refused { address, written, reason });
            }
            while let Some(until) = {
                let now = state.now;
                state.controller.flash.store(offset, value as u32, size as u32, now)
            } {
                state.now = until;
                state.controller.advance(&mut Ram(uc), until);
            }
            state.look();
        };
        let rest = (FLASH_BYTES - code) as u64;
        self.uc.mmio_map(u64::from(FLASH) + code as u64, rest, Some(read), Some(write))
    }

    /// Maps the registers of the controller.
    pub(super) fn map_registers(&mut self) -> Result<(), uc_error> {
        for (base, size) in REGISTERS {
            self.map_peripherals(base, size)?;
        }
        Ok(())
    }

    /// Maps registers from this address on, of so many bytes.
    fn map_peripherals(&mut self, base: u32, size: u64) -> Result<(), uc_error> {
        let (reads, writes) = (Rc::clone(&self.state), Rc::clone(&self.state));
        let read = move |uc: &mut Unicorn<'_, ()>, offset: u64, size: usize| {
            let mut state = reads.borrow_mut();
            let (address, at) = (base + offset as u32, (state.now, state.active));
            if state.is_barred(uc, address) {
                return 0;
            }
            let read = state.controller.read(&mut Ram(uc), address, size as u32, at);
            state.look();
            read.unwrap_or_else(|reason| {
                state.halt(uc, Halt::Refused { address, written: None, reason });
                0
            })
            .into()
        };
        let write = move |uc: &mut Unicorn<'_, ()>, offset: u64, size: usize, value: u64| {
            let mut state = writes.borrow_mut();
            let (address, now) = (base + offset as u32, state.now);
            if state.is_barred(uc, address) {
                return;
            }
            let was_watched = state.controller.system.protection.watched(false);
            let written =
                state.controller.write(&mut Ram(uc), address, (value as u32, size as u32), now);
            state.look();
            if let Err(reason) = written {
                state.halt(uc, Halt::Refused { address, written: Some(value as u32), reason });
            }
            if was_watched != state.controller.system.protection.watched(false) {
                state.halt(uc, Halt::Protecting);
            }
        };
        self.uc.mmio_map(base.into(), size, Some(read), Some(write))
    }
}
