//! Where an entry stacks: alignment, process stack, privilege.

use core::ptr::addr_of_mut;

use crate::Step;
use crate::assembly::{call_on, on_process_stack, read_unprivileged};
use crate::handlers::on;
use crate::interrupts::{CONTROL, FIRST, PEND, enable};
use crate::line::say;

/// The steps.
pub const STEPS: &[Step] =
    &[("alignment", alignment), ("process stack", process), ("privilege", privilege)];

/// Words of a process stack.
const WORDS: usize = 64;

/// A process stack.
#[repr(align(256))]
struct Stack([u32; WORDS]);

/// The process stack.
static mut STACK: Stack = Stack([0; WORDS]);

/// The upper end of the process stack.
pub fn top() -> *mut u32 {
    // SAFETY: the address is that behind the static.
    unsafe { addr_of_mut!(STACK.0).cast::<u32>().add(WORDS) }
}

fn alignment() {
    on(11, |entry| say!(" {} {:x}", entry.frame as u32 % 8, entry.frame().status >> 9 & 1));
    // One of both is not aligned to 8 bytes.
    say!(" {}", call_on(8));
    say!(" {}", call_on(12));
}

fn process() {
    enable([0x80; 4]);
    on(11, |entry| say!(" {:x} {}", entry.link, top() as u32 - entry.frame as u32));
    on(0x3C, |entry| say!(" {:x} {}", entry.link, top() as u32 - entry.frame as u32));
    let end = on_process_stack(top(), FIRST, PEND);
    say!(" {}", top() as u32 - end);
}

/// Control of privilege, of a thread.
pub fn set_control(control: u32) {
    // SAFETY: the step ends as it began.
    unsafe { core::arch::asm!("msr control, {}", "isb", in(reg) control) };
}

fn privilege() {
    on(11, |_| set_control(0));
    on(5, |entry| {
        crate::faults::say_faults();
        entry.frame().general[0] = 7;
        entry.skip();
    });
    on(3, |entry| {
        crate::faults::say_faults();
        entry.skip();
    });
    say!(" {:x}", read_unprivileged(0x0800_0000));
    say!(" {:x}", read_unprivileged(CONTROL));
    say!(" {}", u32::from(cortex_m::register::primask::read().is_inactive()));
}
