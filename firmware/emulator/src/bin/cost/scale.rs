//! Known loops, which prove that the counter counts instructions.

#![expect(unsafe_code, reason = "only assembly has a known number of instructions")]

use core::arch::asm;

/// Number of instructions of [`thousand`].
pub const THOUSAND: u64 = 1000;
/// Number of rounds of [`long_loop`]: several wraps of the counter.
const ROUNDS: u32 = 5_000_000;
/// Number of instructions of [`long_loop`].
pub const LONG_LOOP: u64 = 2 * ROUNDS as u64;

/// Executes a thousand instructions in a row.
pub fn thousand() {
    // SAFETY: `nop` changes no register, flag or memory.
    unsafe { asm!(".rept 1000", "nop", ".endr", options(nomem, nostack, preserves_flags)) }
}

/// Executes ten million instructions in a loop.
pub fn long_loop() {
    // SAFETY: counts the register that it is given down to zero; flags are declared as changed.
    unsafe {
        asm!("2:", "subs {0}, {0}, #1", "bne 2b", inout(reg) ROUNDS => _, options(nomem, nostack));
    }
}
