//! Runs the tasks; when all of them wait, the clock jumps.

#![expect(unsafe_code, reason = "embassy's raw executor trusts whoever polls it")]

use core::sync::atomic::{AtomicBool, Ordering};

use embassy_executor::raw::Executor;

use crate::clock;
use crate::meter::Meter;

/// Whether a task is to be polled.
static PENDED: AtomicBool = AtomicBool::new(false);

/// Called by the executor when a task was woken.
// SAFETY: this is the symbol and the signature that embassy-executor asks for; nothing else has it.
#[unsafe(export_name = "__pender")]
fn pend(_: *mut ()) {
    PENDED.store(true, Ordering::Relaxed);
}

/// Every task waits for something that no time brings.
pub struct Deadlock;

/// An executor for [`run`].
pub fn new() -> Executor {
    Executor::new(core::ptr::null_mut())
}

/// Polls until the application says that it is finished.
pub fn run(
    executor: &'static Executor,
    meter: &Meter,
    finished: impl Fn() -> bool,
) -> Result<(), Deadlock> {
    while !finished() {
        if PENDED.swap(false, Ordering::Relaxed) {
            // SAFETY: only this loop polls, it is not re-entered, and `init_with` has made the
            // executor where it stays.
            meter.poll(|| unsafe { executor.poll() });
        } else if !clock::advance() {
            return Err(Deadlock);
        }
    }
    Ok(())
}
