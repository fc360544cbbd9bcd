//! What boards with an STM32 share: the instrument's programs, one for each carrier, what they are
//! configured with, and its chips on their wires.
//!
//! A board's crate connects its pins to [`wiring`], starts its clocks, and spawns the program of
//! [`CARRIER`], which is chosen when the image is built.
#![no_std]

mod configuration;
mod flash;
mod ports;
pub mod watchdog;
pub mod wiring;

pub mod spinning;
pub mod stepwise;
pub mod stops;
pub mod turning;

pub use configuration::{CARRIER, Carrier};

use embassy_time::Timer;
use firmware::health::Health;
use firmware::link;
use firmware::shared::Shared;

use wiring::Link;

/// The channels between the instrument's parts on a platform.
type Channels = firmware::shared::Channels<'static>;

/// Reports the conclusion without end. It never returns, because the peripherals would be dropped:
/// the motor would lose its current and the link its last bytes.
async fn report_conclusion(health: &Health, link: &mut Link, shared: &Shared<'static>) -> ! {
    defmt::info!("board: done, {} faults on the way", health.faults());
    loop {
        Timer::after_secs(1).await;
        link::send(link, shared).await;
    }
}
