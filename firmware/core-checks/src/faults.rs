//! Faults: what they tell, where they come from, what becomes of one that cannot be taken.

use crate::Step;
use crate::assembly::{
    call, divide, jump, load, load_and_move, load_exclusive, load_float, load_floats, load_if,
    load_many, load_pair, load_pair_late, store, store_many, store_pair, undefined,
};
use crate::floats::end_use;
use crate::handlers::{Entry, on, read, write};
use crate::interrupts::{FIRST, PEND, enable, unmask};
use crate::line::say;

/// `SHCSR`, and its bits that enable memory, bus and usage faults.
const HANDLERS: u32 = 0xE000_ED24;
const ALL: u32 = 7 << 16;
/// `SHPR1`.
const PRIORITIES: u32 = 0xE000_ED18;
/// `CFSR`, `HFSR`, `MMFAR`, `BFAR`.
const STATUS: u32 = 0xE000_ED28;
const HARD_STATUS: u32 = 0xE000_ED2C;
const MEMORY_ADDRESS: u32 = 0xE000_ED34;
const BUS_ADDRESS: u32 = 0xE000_ED38;
/// An address where there is neither memory nor register.
const NOWHERE: u32 = 0x6000_0000;

/// The steps.
pub const STEPS: &[Step] = &[
    ("undefined", undefined_instruction),
    ("undefined, escalated", escalated),
    ("undefined under the mask", under_mask),
    ("undefined in a handler as urgent", as_urgent),
    ("undefined in a handler", in_handler),
    ("load from nowhere", load_nowhere),
    ("load that moves its base", load_moves),
    ("store to nowhere", store_nowhere),
    ("code from nowhere", code_nowhere),
    ("code from peripherals", code_peripherals),
    ("code without Thumb", no_thumb),
    ("load in conditional instructions", load_conditional),
    ("accesses not aligned", not_aligned),
    ("access not aligned after others", not_aligned_late),
    ("registers not aligned", registers_not_aligned),
    ("division by zero", by_zero),
    ("call in a hard fault", in_hard_fault),
];

/// Tells what the core says of a fault, and clears it.
pub fn say_faults() {
    let (status, hard) = (read(STATUS), read(HARD_STATUS));
    say!(" {status:x} {hard:x}");
    if status & 1 << 7 != 0 {
        say!(" memory {:x}", read(MEMORY_ADDRESS));
    }
    if status & 1 << 15 != 0 {
        say!(" bus {:x}", read(BUS_ADDRESS));
    }
    write(STATUS, status);
    write(HARD_STATUS, hard);
    say!(" {:x}", read(HANDLERS));
}

/// Tells of a fault, and how far it is from the beginning of a function, and goes on behind the call of it.
fn say_at(entry: &mut Entry, function: u32) {
    say_faults();
    say!(" at {:x}", entry.frame().pc.wrapping_sub(function & !1));
    entry.skip();
}

/// Goes on behind what was called where a fault is told.
pub fn tell(entry: &mut Entry) {
    say_at(entry, 0);
}

/// Goes on behind the load that broke.
pub fn tell_load(entry: &mut Entry) {
    say_at(entry, load as *const () as u32);
}

/// Enables the handlers of all three faults, and has them and the hard fault tell.
pub fn on_faults(tell: fn(&mut Entry)) {
    write(HANDLERS, ALL);
    (3..7).for_each(|number| on(number, tell));
}

fn undefined_instruction() {
    on_faults(|entry| say_at(entry, undefined as *const () as u32));
    undefined();
}

fn escalated() {
    undefined_instruction();
    write(HANDLERS, 0);
    undefined();
    load(NOWHERE);
    write(HANDLERS, ALL);
}

fn under_mask() {
    on_faults(|entry| say_at(entry, undefined as *const () as u32));
    cortex_m::interrupt::disable();
    undefined();
    unmask();
}

fn as_urgent() {
    enable([0x40; 4]);
    on_faults(|entry| say_at(entry, undefined as *const () as u32));
    write(PRIORITIES, 0x40_40_40);
    on(0x3C, |_| {
        undefined();
    });
    write(PEND, FIRST);
    write(PRIORITIES, 0);
}

fn in_handler() {
    enable([0x40; 4]);
    on_faults(|entry| {
        say!(" {:x}", entry.link);
        say_at(entry, undefined as *const () as u32);
    });
    on(0x3C, |_| {
        undefined();
    });
    write(PEND, FIRST);
}

fn load_nowhere() {
    on_faults(tell_load);
    say!(" {:x}", load(NOWHERE + 8));
}

fn load_moves() {
    on_faults(|entry| {
        say!(" {:x}", entry.frame().general[0]);
        say_at(entry, load_and_move as *const () as u32);
    });
    say!(" {:x}", load_and_move(NOWHERE));
}

fn store_nowhere() {
    on_faults(|entry| say_at(entry, store as *const () as u32));
    say!(" {:x}", store(NOWHERE + 4, 1));
}

fn code_nowhere() {
    on_faults(tell);
    jump(NOWHERE | 1);
}

fn code_peripherals() {
    on_faults(tell);
    jump(0x4000_0001);
}

fn no_thumb() {
    on_faults(|entry| say_at(entry, call as *const () as u32 & !3));
    // The address is that of an instruction, without the bit that says so.
    jump(call as *const () as u32 & !3);
}

fn load_conditional() {
    on_faults(|entry| {
        say!(" {:x} {:x}", entry.frame().status & 0x0600_FC00, entry.frame().general[1]);
        say_at(entry, load_if as *const () as u32);
    });
    load_if(NOWHERE);
}

fn not_aligned() {
    on_faults(tell);
    let words = [0x0102_0304_u32, 0x0506_0708, 0, 0];
    say!(" {:x}", load(words.as_ptr() as u32 + 1));
    for access in
        [load_pair, load_many, store_pair, store_many, load_exclusive, load_float, load_floats]
    {
        on_faults(|entry| {
            say_faults();
            entry.skip();
        });
        access(words.as_ptr() as u32 + 2);
    }
    say!(" {:x} {:x}", words[0], words[2]);
    end_use();
}

fn not_aligned_late() {
    on_faults(|entry| {
        say!(" {:x}", entry.frame().general[1]);
        say_at(entry, load_pair_late as *const () as u32);
    });
    let words = [0x0102_0304_u32, 0x0506_0708, 0];
    say!(" {:x}", load_pair_late(words.as_ptr() as u32 + 4, 7));
    load_pair_late(words.as_ptr() as u32 + 5, 7);
}

fn registers_not_aligned() {
    on_faults(tell_load);
    load(HANDLERS + 1);
    on_faults(|entry| say_at(entry, store as *const () as u32));
    store(PRIORITIES + 2, 0);
    say!(" {:x}", read(PRIORITIES));
}

fn by_zero() {
    on_faults(tell);
    say!(" {:x} {:x}", divide(7, 0), divide(0x8000_0000, 0xFFFF_FFFF));
}

fn in_hard_fault() {
    on_faults(tell);
    write(HANDLERS, 0);
    enable([0; 4]);
    on(3, |entry| {
        // More urgent than any interrupt.
        write(PEND, FIRST);
        say!(" held");
        tell_load(entry);
    });
    load(NOWHERE);
    write(HANDLERS, ALL);
}

/// Faults in the handler of the hard fault, after which the core does nothing.
pub fn lock_up() -> ! {
    write(HANDLERS, 0);
    on(3, |_| {
        undefined();
    });
    loop {
        undefined();
    }
}
