//! The handler of the non-maskable interrupt.
#![expect(unsafe_code, reason = "its handler is unsafe to define")]

use cortex_m_rt::exception;
use stm32::note_unreadable_row;

use crate::crash;

/// A row of the store that cannot be read is an error of that read; anything else ends the run.
#[exception]
unsafe fn NonMaskableInt() {
    if !note_unreadable_row() {
        crash::unhandled(2);
    }
}
