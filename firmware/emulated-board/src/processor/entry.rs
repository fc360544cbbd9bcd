//! Entry into exceptions: which one a fault becomes, what is stacked, and how the handler begins (ARMv7-M Architecture
//! Reference Manual, B1.5.6, B1.5.7, B1.5.12).

use unicorn_engine::RegisterARM;

use super::Processor;
use super::frame::{
    ALIGNED, FLOAT_ACTIVE, FLOAT_WORDS, FLOATS, PROCESS_STACK, STACKED, UNPRIVILEGED, WORDS,
};
use super::state::masks;
use crate::FLASH;
use crate::controller::protection::Access;
use crate::exceptions::{HARD_FAULT, SUPERVISOR_CALL};
use crate::faults::Fault;

/// Cycles that an entry takes (Cortex-M4 TRM, 3.9.1).
const ENTRY_CYCLES: u64 = 12;

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
        self.roll_back();
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
    pub(super) fn derive(&mut self, fault: Fault, original: Option<u32>, link: u32, cycles: u64) {
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
        self.state.borrow_mut().watch_stack(&self.uc);
        let level = self.state.borrow().level;
        if !self.may_access(frame, bytes.len(), Access::Write, level) {
            return Err(Fault::stacking(true));
        }
        if self.poke(frame, &bytes) { Ok(()) } else { Err(Fault::stacking(false)) }
    }

    /// Begins the handler of an exception whose registers are stacked.
    pub(super) fn begin(&mut self, number: u32, link: u32, cycles: u64) {
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
}
