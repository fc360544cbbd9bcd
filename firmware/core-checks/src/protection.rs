//! The memory protection unit: regions that may not be read, written or executed, and a guard of a stack.

use core::ptr::addr_of_mut;

use crate::Step;
use crate::assembly::{
    jump, load, loads_if, push_at, pushed, read_unprivileged, store, store_byte,
};
use crate::faults::{on_faults, say_faults, tell_load};
use crate::handlers::{Entry, Frame, on, read, write};
use crate::interrupts::unmask;
use crate::line::say;
use crate::stacks::set_control;

/// `MPU_TYPE`: how many regions there are.
const TYPE: u32 = 0xE000_ED90;
/// `MPU_CTRL`: whether the unit is on.
pub const CONTROL: u32 = 0xE000_ED94;
/// `MPU_RNR`: the region that is set.
const NUMBER: u32 = 0xE000_ED98;
/// `MPU_RBAR`: where it begins.
const BASE: u32 = 0xE000_ED9C;
/// `MPU_RASR`: its size, and who may do what there.
const ATTRIBUTES: u32 = 0xE000_EDA0;

/// Enabled, with the default map for privileged code.
pub const ON: u32 = 0b101;
/// Attributes of RAM (normal memory, not shared), with the bit that enables the region.
const RAM: u32 = 0b1011 << 16 | 1;
/// No access.
const NONE: u32 = 0;
/// Reads and writes by privileged code.
pub const PRIVILEGED: u32 = 1 << 24;
/// Reads by all code.
const READ_ONLY: u32 = 6 << 24;
/// Reads and writes by all code.
const FULL: u32 = 3 << 24;
/// No execution.
const NEVER: u32 = 1 << 28;

/// The steps.
pub const STEPS: &[Step] = &[
    ("protection unit", unit),
    ("no access", no_access),
    ("read only", read_only),
    ("small region", small),
    ("subregion", subregion),
    ("region over region", over),
    ("execute never", never),
    ("conditional loads", conditional),
    ("without the default map", without_map),
    ("privileged only", privileged),
    ("hard fault without protection", unprotected),
    ("stack guard", guard),
];

/// What is protected.
#[repr(align(2048))]
struct Protected([u32; 512]);

/// What is protected.
static mut PROTECTED: Protected = Protected([0; 512]);

/// The address of what is protected.
fn address() -> u32 {
    addr_of_mut!(PROTECTED) as u32
}

/// Sets a region of 2 to this power of bytes.
pub fn region(number: u32, base: u32, power: u32, attributes: u32) {
    write(NUMBER, number);
    write(BASE, base);
    write(ATTRIBUTES, RAM | attributes | (power - 1) << 1);
}

/// Ends the protection, of all regions.
pub fn end() {
    write(CONTROL, 0);
    for number in 0..8 {
        write(NUMBER, number);
        write(ATTRIBUTES, 0);
    }
}

/// Tries words of what is protected: writes, and reads back.
fn try_words(offsets: &[u32]) {
    for offset in offsets {
        let word = address() + offset;
        store(word, 0x55);
        say!(" {:x}", load(word).min(0x55));
    }
}

/// Tells of a fault at an address within what is protected.
fn on_protected() {
    on_faults(|entry| {
        entry.frame().general[0] = 0xF;
        say!(" {:x}", read(0xE000_ED34).wrapping_sub(address()).min(0x1000));
        let status = read(0xE000_ED28);
        write(0xE000_ED28, status);
        say!(" {status:x}");
        entry.skip();
    });
    // SAFETY: nothing else refers to it.
    unsafe { *addr_of_mut!(PROTECTED.0) = [0x11; 512] };
}

fn unit() {
    write(BASE, 0x2000_0000 | 0x13);
    say!(" {:x} {:x} {:x} {:x}", read(TYPE), read(CONTROL), read(NUMBER), read(BASE));
    end();
}

fn no_access() {
    on_protected();
    region(0, address(), 11, NONE);
    try_words(&[0]);
    write(CONTROL, ON);
    try_words(&[0, 0x7FC]);
    end();
    say!(" {:x} {:x}", load(address()), load(address() + 0x7FC));
}

fn read_only() {
    on_protected();
    region(0, address(), 11, READ_ONLY);
    write(CONTROL, ON);
    try_words(&[0x10]);
    store_byte(address() + 0x21, 1);
    end();
    say!(" {:x} {:x}", load(address() + 0x10), load(address() + 0x20));
}

fn small() {
    on_protected();
    region(0, address() + 0x40, 5, NONE);
    write(CONTROL, ON);
    try_words(&[0x3C, 0x40, 0x5C, 0x60]);
    // A word of which the last byte is protected.
    say!(" {:x}", load(address() + 0x3D));
    end();
}

fn subregion() {
    on_protected();
    // The second and the last eighth are not of the region.
    region(0, address(), 11, NONE | 0b1000_0010 << 8);
    write(CONTROL, ON);
    try_words(&[0xFC, 0x100, 0x1FC, 0x200, 0x6FC, 0x700]);
    end();
}

fn over() {
    on_protected();
    region(3, address() + 0x400, 10, FULL);
    region(1, address(), 11, READ_ONLY);
    write(CONTROL, ON);
    try_words(&[0x3FC, 0x400]);
    end();
}

fn never() {
    on_faults(tell_fetch);
    // bx lr.
    // SAFETY: nothing else refers to it.
    unsafe { *addr_of_mut!(PROTECTED.0) = [0x4770_4770; 512] };
    cortex_m::asm::isb();
    jump(address() | 1);
    say!(" done");
    region(0, address(), 11, FULL | NEVER);
    write(CONTROL, ON);
    jump(address() | 1);
    end();
    jump(address() | 1);
    say!(" done");
}

fn conditional() {
    on_protected();
    say!(" {:x}", loads_if(address()));
    region(0, address(), 11, READ_ONLY);
    write(CONTROL, ON);
    say!(" {:x}", loads_if(address()));
    region(0, address(), 11, NONE);
    say!(" {:x}", loads_if(address()));
    end();
}

/// Tells of a fault of fetched code, at an address within what is protected.
fn tell_fetch(entry: &mut Entry) {
    say!(" {:x}", entry.frame().pc.wrapping_sub(address()).min(0x1000));
    say_faults();
    entry.skip();
}

fn without_map() {
    on_protected();
    // Flash and RAM alone; peripherals and what is above them are not of a region.
    region(0, 0x0800_0000, 20, READ_ONLY);
    region(1, 0x2000_0000, 17, FULL);
    write(CONTROL, 1);
    try_words(&[0]);
    on_faults(tell_load);
    load(0x1000_0000);
    end();
}

fn privileged() {
    on_protected();
    on(11, |_| set_control(0));
    region(0, 0x0800_0000, 20, READ_ONLY);
    region(1, 0x2000_0000, 17, FULL);
    region(2, address(), 11, PRIVILEGED);
    write(CONTROL, ON);
    try_words(&[0]);
    say!(" {:x}", read_unprivileged(address() + 4));
    // No region has it, and the default map is for privileged code.
    say!(" {:x}", read_unprivileged(0x1000_0000));
    end();
}

fn unprotected() {
    on_protected();
    region(0, address(), 11, NONE);
    write(CONTROL, ON);
    on(3, |entry| {
        say_faults();
        say!(" {:x}", load(address()));
        entry.skip();
    });
    cortex_m::interrupt::disable();
    crate::assembly::undefined();
    unmask();
    end();
}

/// A frame with which a thread goes on whose stack cannot be used.
static mut RESUMED: [u32; 10] = [0; 10];

fn guard() {
    on_faults(|_| {
        let status = read(0xE000_ED28);
        write(0xE000_ED28, status);
        say!(" {status:x}");
        end();
        let resumed = (addr_of_mut!(RESUMED) as u32 + 7) & !7;
        let frame = Frame {
            general: [0; 4],
            r12: 0,
            lr: 0,
            pc: pushed as *const () as u32 & !1,
            status: 1 << 24,
        };
        // SAFETY: the memory is the frame's, and the thread's stack begins with it.
        unsafe {
            *(resumed as *mut Frame) = frame;
            cortex_m::register::psp::write(resumed);
        }
    });
    region(0, address(), 5, NONE);
    // SAFETY: nothing else refers to it.
    unsafe { *addr_of_mut!(PROTECTED.0) = [0x11; 512] };
    write(CONTROL, ON);
    // Of four words the first two would lie in the guard.
    push_at((address() + 0x28) as *mut u32);
    say!(" {:x} {:x}", load(address() + 0x1C), load(address() + 0x20));
}
