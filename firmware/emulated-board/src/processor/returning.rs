//! Return from exceptions: its integrity checks, what is unstacked, and what the core goes on with (ARMv7-M
//! Architecture Reference Manual, B1.5.8).

use unicorn_engine::RegisterARM;

use super::frame::{
    ALIGNED, FLOAT_WORDS, FLOATS, FLOATS_IN_USE, PROCESS_STACK, STACKED, UNPRIVILEGED, WORDS,
};
use super::state::masks;
use super::{Processor, THUMB, Unknown};
use crate::controller::protection::{Access, Level};
use crate::exceptions::NOT_MASKABLE;
use crate::faults::Fault;

/// Cycles that a return takes, and that from one handler to the next (Cortex-M4 TRM, 3.9.1).
const RETURN_CYCLES: u64 = 12;
const CHAIN_CYCLES: u64 = 6;
/// Number of the exception in the status of the core (`IPSR`); none of a thread.
const NUMBER: u32 = 0x1FF;
/// Bits of `EXC_RETURN` that are one on a core with a floating-point unit; another return is unpredictable.
const LINK_ONES: u32 = 0xFFFF_FFE0;
/// What of `EXC_RETURN` says where a return goes: to a handler, to a thread on either stack.
const TO: u32 = 0xF;
const TO_HANDLER: u32 = 0x1;
const TO_MAIN_STACK: u32 = 0x9;
const TO_PROCESS_STACK: u32 = 0xD;
/// Its bit that is zero where floating-point registers are unstacked, too.
const NO_FLOATS: u32 = 0x10;

/// What a return unstacks.
struct Frame {
    /// Its address.
    address: u32,
    /// Its words.
    words: Vec<u32>,
}

/// Places of words in it: the address of the next instruction, the status, the status of the floating-point unit.
const RETURN_ADDRESS: usize = 6;
const STATUS: usize = 7;
const FLOAT_STATUS: usize = 24;

impl Processor {
    /// Returns from an exception as its link says: to what it interrupted, or to the handler of another one that
    /// waits. A link by which a thread branches is an address, and no code is there.
    ///
    /// # Errors
    /// A link of which the manual leaves open what it does.
    pub(super) fn leave(&mut self) -> Result<(), Unknown> {
        let status = self.get(RegisterARM::XPSR);
        let link = self.get(RegisterARM::PC) as u32 | u32::from(status & THUMB != 0);
        let number = status as u32 & NUMBER;
        self.set(RegisterARM::PC, (link | 1).into());
        if number == 0 {
            self.fault(Fault::PROTECTED_CODE);
            return Ok(());
        }
        if link & LINK_ONES != LINK_ONES {
            let reason = format!("a return by EXC_RETURN {link:#x} is unpredictable (B1.5.8)");
            return Err(Unknown::Stopped { place: self.place(), reason });
        }
        let is_valid = self.is_valid(link, number);
        self.state.borrow_mut().controller.exceptions.leave(number);
        if number != NOT_MASKABLE {
            self.set(RegisterARM::FAULTMASK, 0);
        }
        if is_valid {
            self.go_back(link);
        } else {
            self.derive(Fault::INVALID_RETURN, None, link, CHAIN_CYCLES);
        }
        Ok(())
    }

    /// Whether a handler may return so: it is active, and returns to a handler, or to a thread where no other one is
    /// active or that does not matter.
    fn is_valid(&self, link: u32, number: u32) -> bool {
        let controller = &self.state.borrow().controller;
        let exceptions = &controller.exceptions;
        exceptions.active.has(number)
            && match link & TO {
                TO_HANDLER => true,
                TO_MAIN_STACK | TO_PROCESS_STACK => {
                    exceptions.is_base(number) || controller.system.returns_to_thread_at_any_time()
                }
                _ => false,
            }
    }

    /// Goes on with the handler of another exception that waits, or with what was interrupted. Without the bit of
    /// Thumb its first instruction is a fault.
    fn go_back(&mut self, link: u32) {
        let next = self.state.borrow().controller.exceptions.next(masks(&self.uc));
        if let Some(next) = next {
            return self.begin(next, link, CHAIN_CYCLES);
        }
        match self.frame(link) {
            Ok(frame) => self.unstack(link, &frame),
            Err(fault) => self.derive(fault, None, link, CHAIN_CYCLES),
        }
    }

    /// Reads the frame that a return unstacks, with the privilege of what is returned to, and checks it: the number of
    /// its exception says whether it is that of a handler.
    fn frame(&self, link: u32) -> Result<Frame, Fault> {
        let is_to_thread = link & TO != TO_HANDLER;
        let control = self.get(RegisterARM::CONTROL);
        let level = Level {
            is_unprivileged: is_to_thread && control & UNPRIVILEGED != 0,
            is_above_faults: self.state.borrow().controller.exceptions.is_locked(masks(&self.uc)),
        };
        let is_on_process_stack = link & TO == TO_PROCESS_STACK;
        let stack = if is_on_process_stack { RegisterARM::PSP } else { RegisterARM::MSP };
        let address = self.get(stack) as u32;
        let words = if link & NO_FLOATS == 0 { FLOAT_WORDS } else { WORDS };
        let mut bytes = vec![0; 4 * words];
        if !self.may_access(address, bytes.len(), Access::Read, level) {
            return Err(Fault::unstacking(true));
        }
        if !self.peek(address, &mut bytes) {
            return Err(Fault::unstacking(false));
        }
        let words: Vec<u32> = bytes
            .chunks_exact(4)
            .map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect();
        // The manual pops such a frame, and pushes it again.
        if is_to_thread != (words[STATUS] & NUMBER == 0) {
            return Err(Fault::INVALID_RETURN);
        }
        Ok(Frame { address, words })
    }

    /// Unstacks the registers.
    fn unstack(&mut self, link: u32, frame: &Frame) {
        let Frame { address, words } = frame;
        let status = words[STATUS];
        let end = address.wrapping_add(4 * words.len() as u32);
        let sp = end | if status & ALIGNED != 0 { 4 } else { 0 };
        let has_floats = link & NO_FLOATS == 0;
        // The mode changes first, since each has its stack pointer; privilege ends last.
        let is_unprivileged = self.get(RegisterARM::CONTROL) & UNPRIVILEGED;
        let in_use = if has_floats { FLOATS_IN_USE } else { 0 }
            | if link & TO == TO_PROCESS_STACK { PROCESS_STACK } else { 0 };
        self.set(RegisterARM::CONTROL, in_use);
        self.set(RegisterARM::XPSR, (status & !ALIGNED).into());
        self.set(RegisterARM::APSR_NZCVQG, status.into());
        self.set(RegisterARM::CONTROL, in_use);
        self.set(RegisterARM::SP, sp.into());
        STACKED.iter().zip(words).for_each(|(register, word)| self.set(*register, (*word).into()));
        if has_floats {
            for (register, pair) in FLOATS.iter().zip(words[WORDS..].chunks_exact(2)) {
                self.set(*register, u64::from(pair[1]) << 32 | u64::from(pair[0]));
            }
            self.set(RegisterARM::FPSCR, words[FLOAT_STATUS].into());
        }
        self.set(RegisterARM::CONTROL, in_use | is_unprivileged);
        // The lowest bit of an address says to Unicorn whether it is that of Thumb code.
        let is_thumb = u32::from(u64::from(status) & THUMB != 0);
        self.set(RegisterARM::PC, (words[RETURN_ADDRESS] & !1 | is_thumb).into());
        self.refresh();
        self.state.borrow_mut().change(status & NUMBER, RETURN_CYCLES, &self.uc);
    }
}
