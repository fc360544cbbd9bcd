//! Critical sections of this board: they hold back all interrupts but those of the data-ready lines.
//!
//! A line of the log takes a tenth of a millisecond, which would come between an edge and its stamp, and between two transfers
//! of a spinning body's converters. The handlers of priority 0 therefore touch nothing that a critical section guards:
//! they write words that are atomic, and leave it to the interrupt of [`NOTIFIER`](stm32::edges::NOTIFIER), which has the
//! next priority, to wake tasks.

use core::sync::atomic::{Ordering, compiler_fence};

use cortex_m::asm::isb;
use cortex_m::register::{basepri, basepri_max};
use critical_section::{Impl, RawRestoreState, set_impl};

/// The highest priority that is held back, 1, as the core has it: in the upper half of a byte.
const HELD_BACK: u8 = 1 << 4;

/// Critical sections by the base priority of the core.
struct BelowEdges;

set_impl!(BelowEdges);

#[expect(unsafe_code, reason = "it is for the program alone to say what a critical section is")]
// SAFETY: an interrupt of priority 1 or below finds no other within a critical section, nor does a task. Those of
// priority 0 reach nothing that one guards.
unsafe impl Impl for BelowEdges {
    unsafe fn acquire() -> RawRestoreState {
        let before = basepri::read();
        basepri_max::write(HELD_BACK);
        isb();
        compiler_fence(Ordering::SeqCst);
        before
    }

    unsafe fn release(before: RawRestoreState) {
        compiler_fence(Ordering::SeqCst);
        #[expect(unsafe_code, reason = "to lower the base priority lets interrupts in")]
        // SAFETY: it is what it was before the critical section.
        unsafe {
            basepri::write(before);
        }
    }
}
