//! Waits for events and interrupts that end at once.

use cortex_m::asm::{sev, wfe, wfi};

use crate::Step;
use crate::handlers::{on, write};
use crate::interrupts::{FIRST, PEND, enable, unmask};
use crate::line::say;

/// `SCR`, and its bit by which an interrupt that becomes pending is an event.
const SLEEP: u32 = 0xE000_ED10;
const PENDING_IS_EVENT: u32 = 1 << 4;

/// The steps.
pub const STEPS: &[Step] = &[
    ("event sent", sent),
    ("event of a return", returned),
    ("event of what is pending", pending),
    ("interrupt that is masked", masked),
];

fn sent() {
    sev();
    wfe();
    say!(" awake");
}

fn returned() {
    enable([0x80; 4]);
    write(PEND, FIRST);
    wfe();
    say!(" awake");
}

fn pending() {
    enable([0x80; 4]);
    write(SLEEP, PENDING_IS_EVENT);
    cortex_m::interrupt::disable();
    write(PEND, FIRST);
    wfe();
    say!(" awake");
    unmask();
    write(SLEEP, 0);
}

fn masked() {
    enable([0x80; 4]);
    on(0x3C, |_| say!(" taken"));
    cortex_m::interrupt::disable();
    write(PEND, FIRST);
    wfi();
    say!(" awake");
    unmask();
}
