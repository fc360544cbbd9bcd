//! What boards with an STM32 share: the instrument's programs, one for each carrier, what they are
//! configured with, and its chips on their wires.
//!
//! A board's crate connects its pins to [`wiring`], starts its clocks, and spawns the program of
//! [`PLATFORM`], which is chosen when the image is built.
#![no_std]

mod configuration;
mod flash;
mod ports;
mod settings;
pub mod watchdog;
pub mod wiring;

pub mod spinning;
pub mod stepwise;
pub mod stops;
pub mod turning;

pub use configuration::PLATFORM;

use embassy_time::Timer;
use firmware::acquire::{acquire, on_stage};
use firmware::health::Health;
use firmware::keep::Keeping;
use firmware::link;
use firmware::log::DefmtLog;
use firmware::settings::Settings;
use firmware::shared::Shared;
use firmware::sway::SwayCompensation;
use orientation::alignment::setup::SetupError;
use orientation::attitude::{Keeper, Setting};
use orientation::signal::Sample;
use static_cell::StaticCell;

use wiring::{BaseBus, Link};

/// The channels between the instrument's parts.
type Channels<S = Sample> = firmware::shared::Channels<'static, S>;

/// The IMU on the base, which measures its motion.
type OnBase = SwayCompensation<'static, ports::Base>;

/// Channels of the instrument on a platform, at their final place in memory.
fn channels() -> &'static Channels {
    static CHANNELS: StaticCell<Channels> = StaticCell::new();
    CHANNELS.init_with(|| Channels::new(&DefmtLog))
}

/// Connects the IMU on the base.
fn on_base(bus: BaseBus) -> &'static mut ports::Base {
    static BASE: StaticCell<ports::Base> = StaticCell::new();
    BASE.init(ports::base(bus))
}

/// Attitude and heading of a platform's base after the alignment, where they are held.
fn keeping<C, T>(settings: &Settings<C>, store: T) -> Option<Keeping<'static, T>> {
    settings.holds.then(|| {
        let keeper = keeper(&configuration::base_keeper(settings.latitude));
        Keeping { keeper, policy: configuration::base_policy(settings), store }
    })
}

/// The estimator of attitude and heading at its final place in memory.
fn keeper(setting: &Setting) -> &'static mut Keeper {
    static KEEPER: StaticCell<Keeper> = StaticCell::new();
    KEEPER.init_with(|| Keeper::new(setting))
}

/// What a session begins with; logs why, if it cannot begin.
fn begun<T>(checked: Result<T, SetupError>) -> Option<T> {
    checked.inspect_err(|error| defmt::error!("board: no session: {}", error)).ok()
}

/// Task that acquires samples on a stage or a turntable for ever.
#[embassy_executor::task]
async fn stage_acquisition(mut inputs: ports::Inputs<OnBase>, channels: &'static Channels) {
    acquire(&mut on_stage(&mut inputs, &configuration::instrument(), channels)).await;
}

/// Reports the conclusion without end. It never returns, because the peripherals would be dropped:
/// the motor would lose its current and the link its last bytes.
async fn report_conclusion(health: &Health, link: &mut Link, shared: &Shared<'static>) -> ! {
    defmt::info!("board: done, {} faults on the way", health.faults());
    loop {
        Timer::after_secs(1).await;
        link::send(link, shared).await;
    }
}
