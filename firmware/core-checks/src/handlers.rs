//! One handler for all exceptions: it tells that it begins and ends, and does what the step has set for it.

use core::ptr::{addr_of, addr_of_mut, read_volatile, write_volatile};

use crate::assembly::spoil_floats;
use crate::line::say;

/// What an entry stacks.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Frame {
    pub general: [u32; 4],
    pub r12: u32,
    pub lr: u32,
    pub pc: u32,
    pub status: u32,
}

/// What a handler is told and may change: where it returns to (`EXC_RETURN`), and what was stacked.
pub struct Entry {
    pub link: u32,
    pub frame: *mut Frame,
}

impl Entry {
    /// What was stacked.
    pub fn frame(&mut self) -> &mut Frame {
        // SAFETY: the entry stacked it there, and nothing else refers to it.
        unsafe { &mut *self.frame }
    }

    /// Goes on behind the call of the function that the exception came from, which has stacked nothing:
    /// neither within conditional instructions nor without Thumb.
    pub fn skip(&mut self) {
        let frame = self.frame();
        frame.pc = frame.lr & !1;
        frame.status = frame.status & !0x0600_FC00 | 1 << 24;
    }
}

/// The exception whose handler says nothing: it overwrites what handlers may, and is pended from outside too.
pub const QUIET: u32 = 16 + 50;

/// What a step has a handler do.
pub type Action = fn(&mut Entry);

/// The actions by the number of the exception.
static mut ACTIONS: [Option<Action>; 112] = [None; 112];

/// Has the handler of an exception do something in this step.
pub fn on(number: u32, action: Action) {
    // SAFETY: no handler runs that reads it.
    unsafe { (*addr_of_mut!(ACTIONS))[number as usize] = Some(action) };
}

/// Ends the actions of a step.
pub fn forget() {
    // SAFETY: no handler runs that reads it.
    unsafe { *addr_of_mut!(ACTIONS) = [None; 112] };
}

/// Number of the exception that is being handled.
pub fn number() -> u32 {
    let number: u32;
    // SAFETY: reads a register.
    unsafe { core::arch::asm!("mrs {}, ipsr", out(reg) number, options(nomem, nostack)) };
    number
}

/// Reads a register of the core.
pub fn read(address: u32) -> u32 {
    // SAFETY: the callers name registers and RAM.
    unsafe { read_volatile(address as *const u32) }
}

/// Writes a register of the core, and waits until it is in force.
pub fn write(address: u32, value: u32) {
    // SAFETY: the callers name registers and RAM.
    unsafe { write_volatile(address as *mut u32, value) };
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
}

/// Handles any exception; by what it returns (`EXC_RETURN`).
#[unsafe(no_mangle)]
extern "C" fn handle(link: u32, frame: *mut Frame) -> u32 {
    let mut entry = Entry { link, frame };
    let number = number();
    if number == QUIET {
        spoil_floats();
        return link;
    }
    say!(" >{number:x}");
    // SAFETY: no step changes it while handlers run.
    if let Some(action) = unsafe { (*addr_of!(ACTIONS))[number as usize] } {
        action(&mut entry);
    }
    say!(" <{number:x}");
    entry.link
}
