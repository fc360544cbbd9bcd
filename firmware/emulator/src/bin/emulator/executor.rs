//! Executor of the emulated image: when all tasks wait, the virtual clock advances.

#![expect(unsafe_code, reason = "embassy's raw executor relies on its caller to poll it correctly")]

use core::sync::atomic::{AtomicBool, Ordering};

use embassy_executor::raw::Executor;

use crate::clock;
use crate::meter::Meter;

/// Whether a task is to be polled.
static PENDED: AtomicBool = AtomicBool::new(false);

/// Pender that the executor calls when a task was woken.
// SAFETY: this is the symbol and the signature that embassy-executor asks for; nothing else has it.
#[unsafe(export_name = "__pender")]
fn pend(_: *mut ()) {
    PENDED.store(true, Ordering::Relaxed);
}

/// Creates an executor for [`run`].
pub fn new() -> Executor {
    Executor::new(core::ptr::null_mut())
}

/// Polls until the application has finished, and returns what it has then; [`None`] where all tasks
/// wait for an event that no passage of time brings.
pub fn run<T>(
    executor: &'static Executor,
    meter: &Meter,
    finished: impl Fn() -> Option<T>,
) -> Option<T> {
    loop {
        if let Some(found) = finished() {
            return Some(found);
        }
        if PENDED.swap(false, Ordering::Relaxed) {
            // SAFETY: only this loop polls, it is not re-entered, and `init_with` has made the
            // executor where it stays.
            meter.poll(|| unsafe { executor.poll() });
        } else if !clock::advance() {
            return None;
        }
    }
}
