//! Interrupts among floating-point code: registers survive, and what is stacked says so.

use core::hint::black_box;

use cortex_m::register::control;

use crate::Step;
use crate::assembly::{floats_across, spoil_floats};
use crate::handlers::{self, on};
use crate::interrupts::{FIRST, PEND, SECOND, enable};
use crate::line::say;

/// The steps.
pub const STEPS: &[Step] = &[
    ("integers stacked", integers),
    ("floats stacked", floats),
    ("floats nested", nested),
    ("storm", storm),
];

/// Whether floating-point registers are in use.
fn in_use() -> u32 {
    u32::from(control::read().fpca().is_active())
}

/// Ends the use of floating-point registers.
pub fn end_use() {
    // SAFETY: no register of them is in use.
    unsafe { core::arch::asm!("msr control, {}", "isb", in(reg) 0) };
}

fn integers() {
    enable([0x80; 4]);
    end_use();
    on(0x3C, |entry| say!(" {:x} {}", entry.link, in_use()));
    handlers::write(PEND, FIRST);
    say!(" {}", in_use());
}

/// Register contents and status that come out of an interrupt as they went in.
fn across() {
    let mut before = [0; 33];
    before.iter_mut().zip(0x4000_0001..).for_each(|(word, value)| *word = value);
    before[32] = 0xA380_001F;
    let mut after = [0; 33];
    floats_across(before.as_ptr(), FIRST, PEND, after.as_mut_ptr());
    say!(" {} {:x}", u32::from(before == after), after[32]);
}

fn floats() {
    enable([0x80; 4]);
    on(0x3C, |entry| {
        say!(" {:x} {}", entry.link, in_use());
        say!(" {:x}", spoil_floats());
        say!(" {}", in_use());
    });
    across();
    say!(" {}", in_use());
    end_use();
}

fn nested() {
    enable([0x80, 0x40, 0x80, 0x80]);
    on(0x3D, |entry| say!(" {:x} {:x}", entry.link, spoil_floats()));
    on(0x3C, |entry| {
        handlers::write(PEND, SECOND);
        let half = black_box(0.5_f32) * black_box(3.0);
        handlers::write(PEND, SECOND);
        say!(" {:x} {:x}", entry.link, half.to_bits());
    });
    for _ in 0..3 {
        across();
    }
    end_use();
}

/// Enables and disables the quiet interrupt, and pends it.
const ENABLE: u32 = 0xE000_E104;
const DISABLE: u32 = 0xE000_E184;
const QUIET: u32 = 1 << (handlers::QUIET - 16 - 32);

/// Arithmetic with comparisons, loops and conditional instructions, whose result no interrupt may change, wherever it
/// comes.
fn storm() {
    handlers::write(ENABLE, QUIET);
    let (mut x, mut above, mut bits) = (black_box(0.3_f32), 0_u32, 0x9E37_79B9_u32);
    for turn in 0..2000_u32 {
        x = 3.9 * x * (1.0 - x);
        above += if x > 0.5 { turn } else { 1 };
        bits = if bits & 1 == 0 { bits >> 1 } else { (bits >> 1) ^ 0xEDB8_8320 };
        bits = bits.wrapping_add(greater(turn, above)).rotate_left(turn % 7);
        x = x.clamp(0.001, 0.999);
        if turn % 64 == 0 {
            handlers::write(PEND, QUIET);
        }
    }
    handlers::write(DISABLE, QUIET);
    say!(" {:x} {above:x} {bits:x}", x.to_bits());
    end_use();
}

/// The greater of two numbers, by way of the stack.
#[inline(never)]
fn greater(first: u32, second: u32) -> u32 {
    *black_box([first, second]).iter().max().unwrap_or(&0)
}
