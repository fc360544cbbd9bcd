//! Interrupts among floating-point code: registers survive, and what is stacked says so.

use core::hint::black_box;

use cortex_m::register::control;

use crate::Step;
use crate::assembly::{floats_across, spoil_floats};
use crate::handlers::on;
use crate::interrupts::{FIRST, PEND, SECOND, enable};
use crate::line::say;

/// The steps.
pub const STEPS: [Step; 3] =
    [("integers stacked", integers), ("floats stacked", floats), ("floats nested", nested)];

/// Whether floating-point registers are in use.
fn in_use() -> u32 {
    u32::from(control::read().fpca().is_active())
}

/// Ends the use of floating-point registers.
fn end_use() {
    // SAFETY: no register of them is in use.
    unsafe { core::arch::asm!("msr control, {}", "isb", in(reg) 0) };
}

fn integers() {
    enable([0x80; 4]);
    end_use();
    on(0x3C, |entry| say!(" {:x} {}", entry.link, in_use()));
    crate::handlers::write(PEND, FIRST);
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
        crate::handlers::write(PEND, SECOND);
        let half = black_box(0.5_f32) * black_box(3.0);
        crate::handlers::write(PEND, SECOND);
        say!(" {:x} {:x}", entry.link, half.to_bits());
    });
    for _ in 0..3 {
        across();
    }
    end_use();
}
