//! Entry into exceptions and return from them: what is stacked, and how the registers change.

use unicorn_engine::{RegisterARM, Unicorn};

use super::exceptions::{HARD_FAULT, NOT_MASKABLE, SUPERVISOR_CALL};
use super::faults::Fault;
use super::{Processor, State, masks};
use crate::FLASH;
use crate::controller::Controller;
use crate::controller::protection::Access;
use crate::time::Time;

/// Cycles that an entry takes, that from one handler to the next, and a return (Cortex-M4 TRM, 3.9.1).
const ENTRY_CYCLES: u64 = 12;
const CHAIN_CYCLES: u64 = 6;
const RETURN_CYCLES: u64 = 12;
/// Words that an entry stacks, without and with floating-point registers.
const WORDS: usize = 8;
const FLOAT_WORDS: usize = 26;

/// Registers that an entry stacks, in the order of their addresses, before the program counter and the status.
const STACKED: [RegisterARM; 6] = [
    RegisterARM::R0,
    RegisterARM::R1,
    RegisterARM::R2,
    RegisterARM::R3,
    RegisterARM::R12,
    RegisterARM::LR,
];
/// Floating-point registers that it stacks above them, two words each.
const FLOATS: [RegisterARM; 8] = [
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
const UNPRIVILEGED: u64 = 1;
/// Bit of it: threads are on the process stack.
const PROCESS_STACK: u64 = 2;
/// Bit of it: floating-point registers are in use.
const FLOAT_ACTIVE: u64 = 4;
/// The same as Unicorn wants it, which takes the core for one with a secure state and begins with a new status of
/// floating-point arithmetic where only the first bit is set.
const FLOATS_IN_USE: u64 = FLOAT_ACTIVE | 8;
/// Bit of the stacked status: the stack was moved by a word to be aligned.
const ALIGNED: u32 = 1 << 9;

impl State {
    /// Goes on with a handler, or with what it interrupted, after so many cycles.
    fn change(&mut self, number: u32, cycles: u64, uc: &Unicorn<'_, ()>) {
        self.active = number;
        self.event = true;
        self.now = self.now + Time::periods(cycles, self.controller.hertz());
        self.level = self.level(uc);
    }
}

impl Processor {
    /// Starts from the vectors.
    pub(super) fn start(&mut self) {
        let mut vectors = [0; 8];
        self.peek(FLASH, &mut vectors);
        let word = |place: usize| {
            u64::from(u32::from_le_bytes([0, 1, 2, 3].map(|byte| vectors[place + byte])))
        };
        self.set(RegisterARM::IPSR, 0);
        for register in [
            RegisterARM::PRIMASK,
            RegisterARM::FAULTMASK,
            RegisterARM::BASEPRI,
            RegisterARM::CONTROL,
        ] {
            self.set(register, 0);
        }
        self.set(RegisterARM::SP, word(0));
        self.set(RegisterARM::LR, 0xFFFF_FFFF);
        self.set(RegisterARM::PC, word(4));
        self.refresh();
    }

    /// Takes the exceptions that are to be taken now.
    pub(super) fn take_exceptions(&mut self) {
        let next = self.state.borrow().controller.exceptions.next(masks(&self.uc));
        if let Some(number) = next {
            self.enter(number);
        }
    }

    /// Takes a call of the supervisor; one that cannot be taken is a hard fault.
    pub(super) fn call(&mut self) {
        if let Some(number) =
            self.escalated(Fault { number: SUPERVISOR_CALL, status: 0, address: None })
        {
            self.enter(number);
        }
    }

    /// Takes a fault of the instruction that is executed, which has changed nothing.
    pub(super) fn fault(&mut self, fault: Fault) {
        self.put_back();
        if let Some(number) = self.escalated(fault) {
            self.enter(number);
        }
    }

    /// The exception that a fault becomes (B1.5.14): one that cannot be taken is a hard fault, and one that a hard
    /// fault cannot interrupt locks the core up.
    fn escalated(&mut self, fault: Fault) -> Option<u32> {
        let masks = masks(&self.uc);
        let mut state = self.state.borrow_mut();
        let exceptions = &state.controller.exceptions;
        let (is_locked, escalates) =
            (exceptions.is_locked(masks), exceptions.escalates(fault.number, masks));
        state.controller.system.tell(fault, escalates && fault.number != HARD_FAULT);
        // Only the watchdog goes on.
        state.is_locked |= is_locked;
        (!is_locked).then_some(if escalates { HARD_FAULT } else { fault.number })
    }

    /// Stacks the registers and begins the handler of an exception.
    fn enter(&mut self, number: u32) {
        let link = self.link();
        match self.stack() {
            Ok(()) => self.begin(number, link, ENTRY_CYCLES),
            Err(fault) => self.derive(fault, Some(number), link, ENTRY_CYCLES),
        }
    }

    /// Begins the most urgent handler where stacking or unstacking faults too (B1.5.12).
    fn derive(&mut self, fault: Fault, original: Option<u32>, link: u32, cycles: u64) {
        let Some(derived) = self.escalated(fault) else { return };
        let next = {
            let masks = masks(&self.uc);
            let exceptions = &mut self.state.borrow_mut().controller.exceptions;
            original
                .into_iter()
                .chain([derived])
                .for_each(|number| exceptions.pending.put(number, true));
            exceptions.next(masks).unwrap_or(derived)
        };
        self.begin(next, link, cycles);
    }

    /// How a handler that is entered now returns (`EXC_RETURN`, B1.5.8).
    fn link(&self) -> u32 {
        let control = self.get(RegisterARM::CONTROL);
        let to_thread = self.get(RegisterARM::IPSR) == 0;
        let has_floats = control & FLOAT_ACTIVE != 0;
        let on_process_stack = to_thread && control & PROCESS_STACK != 0;
        0xFFFF_FFE1
            | u32::from(!has_floats) << 4
            | u32::from(to_thread) << 3
            | u32::from(on_process_stack) << 2
    }

    /// Stacks the registers.
    fn stack(&mut self) -> Result<(), Fault> {
        let has_floats = self.get(RegisterARM::CONTROL) & FLOAT_ACTIVE != 0;
        let status = self.get(RegisterARM::XPSR) as u32;
        let sp = self.get(RegisterARM::SP) as u32;
        let frame = sp.wrapping_sub(4 * if has_floats { FLOAT_WORDS } else { WORDS } as u32) & !7;
        let mut stacked: Vec<u32> =
            STACKED.iter().map(|register| self.get(*register) as u32).collect();
        stacked.push(self.get(RegisterARM::PC) as u32 & !1);
        stacked.push(status & !ALIGNED | if sp & 4 != 0 { ALIGNED } else { 0 });
        if has_floats {
            for register in FLOATS {
                let pair = self.get(register);
                stacked.extend([pair as u32, (pair >> 32) as u32]);
            }
            stacked.extend([self.get(RegisterARM::FPSCR) as u32, 0]);
        }
        let bytes: Vec<u8> = stacked.into_iter().flat_map(u32::to_le_bytes).collect();
        self.set(RegisterARM::SP, frame.into());
        if !self.may(frame, bytes.len(), Access::Write) {
            return Err(Fault::stacking(true));
        }
        if self.poke(frame, &bytes) { Ok(()) } else { Err(Fault::stacking(false)) }
    }

    /// Whether a frame on the stack may be accessed.
    fn may(&self, frame: u32, bytes: usize, access: Access) -> bool {
        let state = self.state.borrow();
        let words = (0..bytes as u32).step_by(4).map(|offset| frame.wrapping_add(offset));
        let protection = &state.controller.system.protection;
        !protection.is_on()
            || words.into_iter().all(|word| protection.allows(word, 4, access, state.level))
    }

    /// Begins the handler of an exception whose registers are stacked.
    fn begin(&mut self, number: u32, link: u32, cycles: u64) {
        // The handler begins without floating-point context, outside of conditional instructions, on the main stack.
        let control = self.get(RegisterARM::CONTROL);
        self.set(RegisterARM::IPSR, number.into());
        if control & PROCESS_STACK != 0 {
            // Only a thread with privilege chooses the stack.
            self.set(RegisterARM::CONTROL, 0);
            self.set(RegisterARM::IPSR, 0);
            self.set(RegisterARM::CONTROL, 0);
            self.set(RegisterARM::IPSR, number.into());
        }
        self.set(RegisterARM::CONTROL, control & UNPRIVILEGED);
        self.set(RegisterARM::LR, link.into());
        self.set(RegisterARM::EPSR, 1 << 24);
        let vector = self.vector(number);
        self.set(RegisterARM::PC, vector.into());
        self.refresh();
        let mut state = self.state.borrow_mut();
        state.controller.exceptions.enter(number);
        state.counts.exceptions += 1;
        state.change(number, cycles, &self.uc);
    }

    /// The handler of an exception.
    fn vector(&self, number: u32) -> u32 {
        let table = match self.state.borrow().controller.system.vectors {
            0 => FLASH,
            table => table,
        };
        let mut bytes = [0; 4];
        self.peek(table + 4 * number, &mut bytes);
        u32::from_le_bytes(bytes)
    }

    /// Returns from an exception as its link says: to what it interrupted, or to the handler of another one that
    /// waits (B1.5.8).
    pub(super) fn leave(&mut self) {
        let link = self.get(RegisterARM::PC) as u32 | 1;
        let number = self.get(RegisterARM::XPSR) as u32 & 0x1FF;
        let is_valid = self.is_valid(link, number);
        self.state.borrow_mut().controller.exceptions.leave(number);
        if number != NOT_MASKABLE {
            self.set(RegisterARM::FAULTMASK, 0);
        }
        if !is_valid {
            return self.derive(Fault::NO_RETURN, None, link, CHAIN_CYCLES);
        }
        let next = self.state.borrow().controller.exceptions.next(masks(&self.uc));
        match next {
            Some(next) => self.begin(next, link, CHAIN_CYCLES),
            None => {
                if let Err(fault) = self.unstack(link) {
                    self.derive(fault, None, link, CHAIN_CYCLES);
                }
            }
        }
    }

    /// Whether a handler may return so.
    fn is_valid(&self, link: u32, number: u32) -> bool {
        let state = self.state.borrow();
        let Controller { exceptions, system, .. } = &state.controller;
        let is_base = exceptions.is_base(number);
        exceptions.active.has(number)
            && match link & 0xF {
                0x1 => !is_base,
                0x9 | 0xD => is_base || system.returns_to_thread_at_any_time(),
                _ => false,
            }
    }

    /// Unstacks the registers, and goes on with what was interrupted.
    fn unstack(&mut self, link: u32) -> Result<(), Fault> {
        let to_process_stack = link & 4 != 0;
        let frame =
            self.get(if to_process_stack { RegisterARM::PSP } else { RegisterARM::MSP }) as u32;
        let has_floats = link & 0x10 == 0;
        let mut bytes = vec![0; 4 * if has_floats { FLOAT_WORDS } else { WORDS }];
        if !self.may(frame, bytes.len(), Access::Read) {
            return Err(Fault::unstacking(true));
        }
        if !self.peek(frame, &mut bytes) {
            return Err(Fault::unstacking(false));
        }
        let stacked: Vec<u32> = bytes
            .chunks_exact(4)
            .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect();
        let status = stacked[7];
        let sp = (frame + bytes.len() as u32) | if status & ALIGNED != 0 { 4 } else { 0 };
        // The mode changes first, since each has its stack pointer; privilege ends last.
        let is_unprivileged = self.get(RegisterARM::CONTROL) & UNPRIVILEGED;
        let in_use = if has_floats { FLOATS_IN_USE } else { 0 }
            | if to_process_stack { PROCESS_STACK } else { 0 };
        self.set(RegisterARM::CONTROL, in_use);
        self.set(RegisterARM::XPSR, (status & !ALIGNED).into());
        self.set(RegisterARM::APSR_NZCVQG, status.into());
        self.set(RegisterARM::CONTROL, in_use);
        self.set(RegisterARM::SP, sp.into());
        STACKED
            .iter()
            .zip(&stacked)
            .for_each(|(register, word)| self.set(*register, (*word).into()));
        if has_floats {
            for (register, pair) in FLOATS.iter().zip(stacked[8..24].chunks_exact(2)) {
                self.set(*register, u64::from(pair[1]) << 32 | u64::from(pair[0]));
            }
            self.set(RegisterARM::FPSCR, stacked[24].into());
        }
        self.set(RegisterARM::CONTROL, in_use | is_unprivileged);
        self.set(RegisterARM::PC, u64::from(stacked[6] | 1));
        self.refresh();
        self.state.borrow_mut().change(status & 0x1FF, RETURN_CYCLES, &self.uc);
        Ok(())
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
    fn refresh(&mut self) {
        let flags = self.get(RegisterARM::APSR_NZCV);
        self.set(RegisterARM::APSR_NZCV, flags);
    }
}
