//! Entry into exceptions and return from them: what is stacked, and how the registers change.

use unicorn_engine::RegisterARM;

use super::exceptions::HARD_FAULT;
use super::{EXCEPTION_CYCLES, Processor, masks};
use crate::FLASH;
use crate::time::Time;

/// Registers that an entry stacks, in the order of their addresses, before the program counter and the status.
const STACKED: [RegisterARM; 6] =
    [RegisterARM::R0, RegisterARM::R1, RegisterARM::R2, RegisterARM::R3, RegisterARM::R12, RegisterARM::LR];
/// Floating-point registers that it stacks above them, two words each.
const FLOATS: [RegisterARM; 8] = [
    RegisterARM::D0, RegisterARM::D1, RegisterARM::D2, RegisterARM::D3, RegisterARM::D4, RegisterARM::D5,
    RegisterARM::D6, RegisterARM::D7,
];
/// Bit of the control register: floating-point registers are in use.
const FLOAT_ACTIVE: u64 = 4;
/// Bit of the stacked status: the stack was moved by a word to be aligned.
const ALIGNED: u32 = 1 << 9;

impl Processor {
    /// Starts from the vectors.
    pub(super) fn start(&mut self) {
        let mut vectors = [0; 8];
        self.peek(FLASH, &mut vectors);
        let word = |place: usize| u64::from(u32::from_le_bytes([0, 1, 2, 3].map(|byte| vectors[place + byte])));
        self.set(RegisterARM::IPSR, 0);
        for register in [RegisterARM::PRIMASK, RegisterARM::FAULTMASK, RegisterARM::BASEPRI, RegisterARM::CONTROL] {
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

    /// Takes a fault or a call of the core itself; one that cannot be taken becomes a hard fault.
    pub(super) fn fault(&mut self, number: u32) {
        let mut state = self.state.borrow_mut();
        let masks = masks(&self.uc);
        let exceptions = &state.controller.exceptions;
        let is_locked = exceptions.is_locked(masks);
        let escalates = exceptions.escalates(number, masks);
        if escalates {
            state.controller.system.faults[1] |= 1 << 30;
        }
        drop(state);
        if is_locked {
            // The core locks up; only the watchdog goes on.
            return self.lock();
        }
        self.enter(if escalates { HARD_FAULT } else { number });
    }

    /// A fault in a handler of faults: the core does nothing more until a reset.
    fn lock(&mut self) {
        let mut state = self.state.borrow_mut();
        let due = state.controller.watchdog.due();
        let end = if due == Time::NEVER { state.now + Time::seconds(1.0) } else { due };
        state.now = state.now.max(end);
        let now = state.now;
        state.controller.advance(&mut super::Ram(&mut self.uc), now);
    }

    /// Stacks the registers and begins the handler of an exception.
    fn enter(&mut self, number: u32) {
        let control = self.get(RegisterARM::CONTROL);
        let has_floats = control & FLOAT_ACTIVE != 0;
        let status = self.get(RegisterARM::XPSR) as u32;
        let sp = self.get(RegisterARM::SP) as u32;
        let words = if has_floats { 26 } else { 8 };
        let frame = (sp - 4 * words) & !7;
        let status_stacked = status & !ALIGNED | if sp & 4 != 0 { ALIGNED } else { 0 };
        let mut stacked: Vec<u32> = STACKED.iter().map(|register| self.get(*register) as u32).collect();
        stacked.push(self.get(RegisterARM::PC) as u32 & !1);
        stacked.push(status_stacked);
        if has_floats {
            for register in FLOATS {
                let pair = self.get(register);
                stacked.extend([pair as u32, (pair >> 32) as u32]);
            }
            stacked.extend([self.get(RegisterARM::FPSCR) as u32, 0]);
        }
        let bytes: Vec<u8> = stacked.into_iter().flat_map(u32::to_le_bytes).collect();
        let is_stacked = self.poke(frame, &bytes);
        let nested = status & 0x1FF != 0;
        let on_process_stack = !nested && control & 2 != 0;
        self.set(RegisterARM::SP, frame.into());
        self.set(RegisterARM::IPSR, number.into());
        let link = 0xFFFF_FFE1 | if has_floats { 0 } else { 0x10 } | if nested { 0 } else { 8 } | if on_process_stack { 4 } else { 0 };
        self.set(RegisterARM::LR, link);
        // The handler begins without floating-point context, outside of conditional instructions, on the main stack.
        self.set(RegisterARM::CONTROL, control & 1);
        self.set(RegisterARM::EPSR, 1 << 24);
        let vector = self.vector(number);
        self.set(RegisterARM::PC, vector.into());
        self.refresh();
        let mut state = self.state.borrow_mut();
        state.controller.exceptions.enter(number);
        state.active = number;
        state.event = true;
        state.counts.exceptions += 1;
        let spent = Time::periods(EXCEPTION_CYCLES, state.controller.hertz());
        state.now = state.now + spent;
        drop(state);
        if !is_stacked {
            self.lock();
        }
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

    /// Returns from an exception: unstacks what its link says.
    pub(super) fn leave(&mut self) {
        let link = self.get(RegisterARM::PC) as u32 | 1;
        let number = self.get(RegisterARM::XPSR) as u32 & 0x1FF;
        // The main stack is in use until the mode changes.
        let to_process_stack = link & 0xC == 0xC;
        let frame = if to_process_stack { self.get(RegisterARM::PSP) } else { self.get(RegisterARM::SP) } as u32;
        let has_floats = link & 0x10 == 0;
        let words = if has_floats { 26 } else { 8 };
        let mut bytes = vec![0; 4 * words];
        if !self.peek(frame, &mut bytes) {
            return self.lock();
        }
        let stacked: Vec<u32> =
            bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect();
        let status = stacked[7];
        let sp = frame + 4 * words as u32 | if status & ALIGNED != 0 { 4 } else { 0 };
        // The mode changes first, since each has its stack pointer.
        self.set(RegisterARM::SP, sp.into());
        self.set(RegisterARM::XPSR, (status & !ALIGNED).into());
        self.set(RegisterARM::APSR_NZCVQG, status.into());
        let control = self.get(RegisterARM::CONTROL) & 1;
        let floats = if has_floats { FLOAT_ACTIVE } else { 0 };
        self.set(RegisterARM::CONTROL, control | if to_process_stack { 2 } else { 0 } | floats);
        if to_process_stack {
            self.set(RegisterARM::SP, sp.into());
        }
        STACKED.iter().zip(&stacked).for_each(|(register, word)| self.set(*register, (*word).into()));
        if has_floats {
            for (register, pair) in FLOATS.iter().zip(stacked[8..24].chunks_exact(2)) {
                self.set(*register, u64::from(pair[1]) << 32 | u64::from(pair[0]));
            }
            self.set(RegisterARM::FPSCR, stacked[24].into());
        }
        self.set(RegisterARM::PC, u64::from(stacked[6] | 1));
        self.refresh();
        let mut state = self.state.borrow_mut();
        state.controller.exceptions.leave(number);
        state.active = status & 0x1FF;
        state.event = true;
        let spent = Time::periods(EXCEPTION_CYCLES, state.controller.hertz());
        state.now = state.now + spent;
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
