//! Interrupts: priorities, preemption, masks, what is pending and active.

use cortex_m::register::{basepri, basepri_max, faultmask, primask};

use crate::Step;
use crate::assembly::{call, call_if, pend_if};
use crate::handlers::{on, read, write};
use crate::line::say;

/// `ISER1`: interrupts 32 to 63 that are enabled.
const ENABLE: u32 = 0xE000_E104;
/// `ICER1`: those that are disabled.
const DISABLE: u32 = 0xE000_E184;
/// `ISPR1`: those that become pending.
pub const PEND: u32 = 0xE000_E204;
/// `ICPR1`: those that are pending no longer.
const UNPEND: u32 = 0xE000_E284;
/// `IABR1`: those that are active.
const ACTIVE: u32 = 0xE000_E304;
/// `IPR11`: priorities of interrupts 44 to 47.
const PRIORITIES: u32 = 0xE000_E42C;
/// `ICSR`.
pub const CONTROL: u32 = 0xE000_ED04;
/// `SHPR2`, `SHPR3`: priorities of calls, and of the pendable service.
const CALL_PRIORITY: u32 = 0xE000_ED1C;
const SERVICE_PRIORITY: u32 = 0xE000_ED20;
/// `STIR`.
const TRIGGER: u32 = 0xE000_EF00;

/// Interrupt 44, exception 3c, in the registers of interrupts 32 to 63. No peripheral of the board uses it here, nor the
/// next three.
pub const FIRST: u32 = 1 << 12;
/// Interrupt 45, exception 3d.
pub const SECOND: u32 = 1 << 13;
/// Interrupt 46, exception 3e.
const THIRD: u32 = 1 << 14;
/// Interrupt 47, exception 3f.
const FOURTH: u32 = 1 << 15;

/// The steps.
pub const STEPS: &[Step] = &[
    ("preemption", preemption),
    ("order", order),
    ("priority raised while active", raised),
    ("all masked", all_masked),
    ("base", base),
    ("base of calls", base_of_calls),
    ("base raised only", base_raised),
    ("bits of a priority", bits),
    ("faults masked", faults_masked),
    ("fault mask ends with the handler", fault_mask_ends),
    ("disabled", disabled),
    ("unpended", unpended),
    ("active and pending again", again),
    ("triggered", triggered),
    ("pendable service", service),
    ("call", called),
    ("call under the mask", called_masked),
    ("conditional instructions", conditional),
];

/// Enables the four with these priorities.
pub fn enable(priorities: [u8; 4]) {
    write(PRIORITIES, u32::from_le_bytes(priorities));
    write(ENABLE, FIRST | SECOND | THIRD | FOURTH);
}

/// What the core says of exceptions: which is handled, which waits, whether one waits, whether none is preempted.
fn say_state() {
    let control = read(CONTROL);
    say!(
        " [active {:x} pending {:x} {} base {}]",
        control & 0x1FF,
        control >> 12 & 0x1FF,
        control >> 22 & 1,
        control >> 11 & 1
    );
    say!(" {:x}", read(ACTIVE) >> 12 & 0xF);
}

fn preemption() {
    enable([0x80, 0x40, 0x80, 0x80]);
    on(0x3E, |_| {
        say_state();
        write(PEND, SECOND);
        write(PEND, FIRST | FOURTH);
        say_state();
    });
    on(0x3D, |_| say_state());
    write(PEND, THIRD);
    say_state();
}

fn order() {
    enable([0xC0, 0x80, 0x40, 0x80]);
    primask();
    write(PEND, FIRST | SECOND | THIRD | FOURTH);
    say_state();
    unmask();
}

/// Masks interrupts no longer.
pub fn unmask() {
    // SAFETY: nothing relies on the mask.
    unsafe { cortex_m::interrupt::enable() };
    cortex_m::asm::isb();
}

/// Masks all interrupts.
fn primask() {
    cortex_m::interrupt::disable();
    say!(" {}", u32::from(primask::read().is_inactive()));
}

fn raised() {
    enable([0x80, 0x60, 0x80, 0x80]);
    on(0x3C, |_| {
        write(PRIORITIES, u32::from_le_bytes([0x20, 0x60, 0x80, 0x80]));
        write(PEND, SECOND);
        say!(" held");
        write(PRIORITIES, u32::from_le_bytes([0xF0, 0x60, 0x80, 0x80]));
        say!(" let");
    });
    write(PEND, FIRST);
}

fn all_masked() {
    enable([0; 4]);
    primask();
    write(PEND, FIRST);
    say!(" held");
    unmask();
    say!(" let");
}

/// Sets the priority from which interrupts are held back.
fn set_base(priority: u8) {
    // SAFETY: nothing relies on the mask.
    unsafe { basepri::write(priority) };
    cortex_m::asm::isb();
}

fn base() {
    enable([0x80, 0x70, 0x90, 0x80]);
    set_base(0x80);
    write(PEND, FIRST | SECOND | THIRD);
    say!(" {:x}", basepri::read());
    set_base(0x90);
    say!(" {:x}", basepri::read());
    set_base(0);
}

fn base_of_calls() {
    write(CALL_PRIORITY, 0x40 << 24);
    set_base(0x50);
    call();
    set_base(0);
    write(CALL_PRIORITY, 0);
}

fn base_raised() {
    set_base(0x40);
    basepri_max::write(0x60);
    say!(" {:x}", basepri::read());
    basepri_max::write(0x20);
    say!(" {:x}", basepri::read());
    basepri_max::write(0);
    say!(" {:x}", basepri::read());
    set_base(0);
    basepri_max::write(0x80);
    say!(" {:x}", basepri::read());
    set_base(0);
}

/// Priorities of which the lower bits are not zero.
fn bits() {
    enable([0x4F, 0x3F, 0x80, 0x80]);
    write(CALL_PRIORITY, 0x21 << 24);
    say!(" {:x} {:x}", read(PRIORITIES), read(CALL_PRIORITY));
    set_base(0x4F);
    say!(" {:x}", basepri::read());
    write(PEND, FIRST | SECOND);
    say!(" held");
    set_base(0xF);
    say!(" {:x}", basepri::read());
    set_base(0);
    write(CALL_PRIORITY, 0);
}

/// Masks faults too, or no longer.
fn mask_faults(is_masked: bool) {
    // SAFETY: nothing relies on the mask.
    unsafe { core::arch::asm!("msr faultmask, {}", "isb", in(reg) u32::from(is_masked)) };
}

fn faults_masked() {
    enable([0; 4]);
    mask_faults(true);
    write(PEND, FIRST);
    say!(" held {}", u32::from(faultmask::read().is_inactive()));
    mask_faults(false);
    say!(" let");
}

fn fault_mask_ends() {
    enable([0x80, 0x40, 0x80, 0x80]);
    on(0x3C, |_| {
        mask_faults(true);
        write(PEND, SECOND);
        say!(" held {}", u32::from(faultmask::read().is_inactive()));
    });
    write(PEND, FIRST);
    say!(" {}", u32::from(faultmask::read().is_inactive()));
}

fn disabled() {
    write(DISABLE, FIRST);
    write(PEND, FIRST);
    say!(" {:x} {:x}", read(ENABLE) & FIRST, read(PEND) & FIRST);
    say_state();
    write(ENABLE, FIRST);
    say!(" {:x} {:x}", read(DISABLE) & FIRST, read(UNPEND) & FIRST);
}

fn unpended() {
    enable([0; 4]);
    primask();
    write(PEND, FIRST | SECOND);
    write(UNPEND, FIRST);
    unmask();
}

fn again() {
    enable([0x80, 0x80, 0x80, 0x80]);
    on(0x3C, |_| {
        on(0x3C, |_| say_state());
        write(PEND, FIRST);
        say_state();
    });
    write(PEND, FIRST);
}

fn triggered() {
    enable([0x80, 0x80, 0x80, 0x80]);
    write(TRIGGER, 46);
}

fn service() {
    enable([0x80, 0x80, 0x80, 0x80]);
    write(SERVICE_PRIORITY, 0xF0 << 16);
    on(0x3C, |_| {
        write(CONTROL, 1 << 28);
        write(PEND, SECOND);
        say_state();
    });
    write(PEND, FIRST);
    on(14, |_| write(PEND, THIRD));
    write(CONTROL, 1 << 28);
    // Cleared before it is taken.
    primask();
    write(CONTROL, 1 << 28);
    write(CONTROL, 1 << 27);
    unmask();
    write(SERVICE_PRIORITY, 0);
}

/// Tells the number that a call names.
fn say_call(entry: &mut crate::handlers::Entry) {
    let frame = entry.frame();
    let instruction = frame.pc - 2;
    let named = read(instruction & !3) >> (8 * (instruction & 2)) & 0xFF;
    say!(" {named:x} {}", frame.pc - (call as *const () as u32 & !1));
    frame.general[0] = 0x1234;
}

fn called() {
    on(11, say_call);
    say!(" {:x}", call());
}

fn called_masked() {
    primask();
    on(3, |_| crate::faults::say_faults());
    call();
    unmask();
}

fn conditional() {
    enable([0x80, 0x80, 0x80, 0x80]);
    on(11, |entry| say!(" {:x}", entry.frame().status & 0x0600_FC00));
    say!(" {:x}", call_if(0));
    say!(" {:x}", call_if(1));
    let sum: u32 = (0..6).map(|turn| pend_if(if turn % 2 == 0 { FIRST } else { 0 }, PEND)).sum();
    say!(" {sum:x}");
}
