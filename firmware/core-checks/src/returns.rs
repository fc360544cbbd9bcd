//! Returns from exceptions: the integrity checks of the link and of what is unstacked, and with which privilege.

use crate::Step;
use crate::assembly::{call, jump, read_unprivileged};
use crate::faults::{on_faults, say_faults, tell};
use crate::handlers::{Entry, number, on, write};
use crate::interrupts::{FIRST, PEND, SECOND, enable};
use crate::line::say;
use crate::protection::{CONTROL, ON, PRIVILEGED, end, region};
use crate::stacks::set_control;

/// `CCR`: aligned frames; returns to a thread while other exceptions are active.
const CONFIGURATION: u32 = 0xE000_ED14;
const ALIGNED: u32 = 1 << 9;
const TO_THREAD: u32 = 1;
/// Bit of a link that says whether a return is one to a thread.
const THREAD: u32 = 8;
/// Bits of the status: number of the exception, Thumb code.
const NUMBER: u32 = 0x1FF;
const THUMB: u32 = 1 << 24;

/// The steps.
pub const STEPS: &[Step] = &[
    ("link that there is not", no_link),
    ("link in a thread", in_thread),
    ("to a thread among handlers", among_handlers),
    ("to a thread at any time", at_any_time),
    ("to a thread with a handler's number", number_for_thread),
    ("to a handler without a number", no_number),
    ("to code without Thumb", no_thumb),
    ("unstacked without privilege", without_privilege),
];

/// Has usage faults tell, and mend by what a return has failed.
fn on_usage(mend: fn(&mut Entry)) {
    on_faults(tell);
    on(6, mend);
}

/// Has an interrupt happen within another; the inner one does this.
fn nested(inner: fn(&mut Entry)) {
    enable([0x80, 0x40, 0x80, 0x80]);
    on(0x3D, inner);
    on(0x3C, |_| {
        write(PEND, SECOND);
        say!(" in {:x}", number());
    });
    write(PEND, FIRST);
}

fn no_link() {
    enable([0x80; 4]);
    on_usage(|entry| {
        say!(" {:x}", entry.link);
        say_faults();
        // As it was.
        entry.link ^= 0xA;
    });
    on(0x3C, |entry| entry.link ^= 0xA);
    write(PEND, FIRST);
}

fn in_thread() {
    on_faults(tell);
    jump(0xFFFF_FFF9);
}

fn among_handlers() {
    on_usage(|entry| {
        say!(" {:x}", entry.link & !0x10);
        say_faults();
        entry.link ^= THREAD;
    });
    nested(|entry| entry.link ^= THREAD);
}

fn at_any_time() {
    write(CONFIGURATION, ALIGNED | TO_THREAD);
    on_usage(|_| say_faults());
    enable([0x80, 0x40, 0x80, 0x80]);
    // The rest of the outer handler is done by a thread, until a call makes it a handler again.
    on(0x3D, |entry| {
        entry.frame().status &= !NUMBER;
        entry.link |= THREAD;
    });
    on(11, |entry| {
        entry.frame().status |= 0x3C;
        entry.link &= !THREAD;
    });
    on(0x3C, |_| {
        write(PEND, SECOND);
        say!(" in {:x}", number());
        call();
        say!(" in {:x}", number());
    });
    write(PEND, FIRST);
    write(CONFIGURATION, ALIGNED);
}

fn number_for_thread() {
    enable([0x80; 4]);
    on_usage(|entry| {
        say_faults();
        say!(" {:x}", entry.frame().status & NUMBER);
        entry.frame().status &= !NUMBER;
    });
    on(0x3C, |entry| entry.frame().status |= 0x3D);
    write(PEND, FIRST);
}

fn no_number() {
    on_usage(|entry| {
        say_faults();
        entry.frame().status |= 0x3C;
    });
    nested(|entry| entry.frame().status &= !NUMBER);
}

fn no_thumb() {
    enable([0x80; 4]);
    on_usage(|entry| {
        say_faults();
        say!(" {:x}", entry.frame().status & (THUMB | NUMBER));
        entry.frame().status |= THUMB;
    });
    on(0x3C, |entry| entry.frame().status &= !THUMB);
    write(PEND, FIRST);
}

/// Leaves a frame to code with privilege.
fn protect(entry: &Entry) {
    region(2, entry.frame as u32 & !0x1F, 5, PRIVILEGED);
    write(CONTROL, ON);
}

fn without_privilege() {
    on_faults(|_| {
        say_faults();
        end();
        set_control(0);
    });
    on(11, |entry| protect(entry));
    say!(" {:x}", read_unprivileged(0x0800_0000) >> 24);
    on(11, |entry| {
        protect(entry);
        set_control(0);
    });
    say!(" {:x}", read_unprivileged(0x0800_0000) >> 24);
    end();
}
