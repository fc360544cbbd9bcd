//! The controller of boards with an STM32: its buses, edges, flash, log and watchdog, the chips on their wires, and the tasks
//! of the sample path.
//!
//! A board's crate connects its pins to [`wiring`]; its crate `programs` begins what is here.
#![no_std]

pub mod brown_out;
pub mod chain;
pub mod configuration;
pub mod edges;
pub mod flash;
pub mod i2c;
pub mod link;
pub mod log;
pub mod ports;
pub mod sample_path;
pub mod spi;
pub mod watchdog;
pub mod wiring;

pub use configuration::PLATFORM;
pub use flash::{UpperBank, note_unreadable_row};
pub use log::BoardLog;

use embassy_executor::{SpawnError, SpawnToken};

/// A task that is spawned once, so that there is memory for it.
///
/// # Panics
/// Where it runs already, with the place of the call.
#[expect(clippy::expect_used, reason = "to spawn a task twice is a mistake of the program")]
#[track_caller]
pub fn once<S>(task: Result<SpawnToken<S>, SpawnError>) -> SpawnToken<S> {
    task.expect("a task is spawned once")
}
