//! The image that is flashed, executed: the unmodified ELF file of a board behind a model of its microcontroller,
//! with the simulated chips of `hal-mock` on its pins.
//!
//! ```text
//!  ELF ─▶ processor (Unicorn) ⇄ controller: clocks, timers, SPI, DMA, flash … ─pins, bytes─▶ wiring ─▶ chips, world
//!              │  exceptions ◀─lines──┘ └─ RTT ─▶ probe ─▶ log       └─ USART ─▶ link
//!              └─ blocks ─▶ measure: instructions by where they go, waits, losses
//! ```
//!
//! Time is instructions times a stated number of cycles for each, at the clock that the image sets. What the model
//! does not know is an error that names address and code line: nothing is answered by guess.
#![allow(clippy::must_use_candidate, reason = "nothing here is reckoned only to be looked at")]

pub mod controller;
pub mod exceptions;
pub mod faults;
pub mod image;
pub mod link;
pub mod measure;
pub mod observation;
pub mod pace;
pub mod probe;
pub mod processor;
pub mod run;
pub mod time;
pub mod wiring;
pub mod world;

/// Where the flash begins (RM0351, 2.2.2).
pub const FLASH: u32 = 0x0800_0000;
/// Size of the flash, bytes.
pub const FLASH_BYTES: usize = 1 << 20;
/// Where SRAM1 begins.
pub const RAM: u32 = 0x2000_0000;
/// Size of SRAM1, bytes.
pub const RAM_BYTES: usize = 96 << 10;
/// Where SRAM2 begins.
pub const RAM2: u32 = 0x1000_0000;
/// Size of SRAM2, bytes.
pub const RAM2_BYTES: usize = 32 << 10;

/// The clock of the simulated world is the model's: nothing here waits for another.
struct NoClock;

impl embassy_time_driver::Driver for NoClock {
    fn now(&self) -> u64 {
        0
    }

    fn schedule_wake(&self, _: u64, _: &std::task::Waker) {}
}

embassy_time_driver::time_driver_impl!(static CLOCK: NoClock = NoClock);
