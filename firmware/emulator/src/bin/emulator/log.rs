//! Log by defmt over semihosting, decoded on the host; and the end of the image after a failure.

#![expect(unsafe_code, reason = "a hard fault's handler is unsafe to define")]

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{ExceptionFrame, exception};
use defmt::{error, println};
use defmt_semihosting as _;
use semihosting::process::ExitCode;

use crate::clock;
use crate::meter::{Accounts, Meter, Task};

defmt::timestamp!("{=u64:us}", clock::now());

/// Logs the cost of the whole instrument from its first dwell to its last, for a gyro with this
/// sample rate, Hz.
pub fn effort(meter: &Meter, sample_rate: f64) {
    let Accounts { instrument, stand_ins, simulation, microseconds } = meter.between_marks();
    println!(
        "effort instructions={=u64} stand-ins={=u64} simulation={=u64} samples={=u64} \
         microseconds={=u64}",
        instrument.instructions(),
        stand_ins.instructions(),
        simulation.instructions(),
        (microseconds as f64 * sample_rate * 1e-6) as u64,
        microseconds
    );
}

/// Logs the cost of a task.
pub fn task(task: &Task) {
    println!(
        "task polls={=u64} instructions={=u64} worst={=u64} name={=str}",
        task.polls.get(),
        task.total.get().instructions(),
        task.worst.get().instructions(),
        task.name
    );
}

/// Logs the deepest stack, bytes.
pub fn stack(bytes: usize) {
    println!("stack bytes={=usize}", bytes);
}

/// Logs a row of bit patterns, at every log level.
pub fn row(kind: &'static str, bits: &[u64]) {
    println!("row {=str} {=[?]}", kind, bits);
}

/// Whether the image is already ending after a failure.
static ENDING: AtomicBool = AtomicBool::new(false);

/// Ends the emulator with an error; logs the reason once, even if logging itself fails.
fn end(why: impl FnOnce()) -> ! {
    if !ENDING.swap(true, Ordering::Relaxed) {
        why();
    }
    ExitCode::FAILURE.exit_process()
}

#[panic_handler]
fn panic(information: &PanicInfo) -> ! {
    // Only the place is logged: formatting the message here would take 4 KB.
    let place = information.location().map_or(("?", 0), |place| (place.file(), place.line()));
    end(|| error!("panic in {=str}, line {=u32}", place.0, place.1))
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    end(|| error!("hard fault at {=u32:#x}", frame.pc()))
}
