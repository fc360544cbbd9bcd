//! What boards with an STM32 share: the instrument's programs, one for each carrier, what they are
//! configured with, and its chips on their wires.
//!
//! A board's crate connects its pins to [`wiring`], starts its clocks, and spawns the program of
//! [`PLATFORM`], which is chosen when the image is built.
#![no_std]

mod configuration;
pub mod edges;
mod flash;
pub mod i2c;
mod ports;
mod settings;
pub mod spi;
pub mod watchdog;
pub mod wiring;

pub mod spinning;
pub mod stepwise;
pub mod stops;
pub mod turning;

pub use configuration::PLATFORM;
pub use flash::note_unreadable_row;

use core::future::pending;

use embassy_executor::SendSpawner;
use embassy_futures::select::select;
use embassy_time::Timer;
use firmware::acquire::{acquire, on_stage};
use firmware::keep::{Keep, Keeping};
use firmware::link;
use firmware::log::DefmtLog;
use firmware::mechanism::Mechanism;
use firmware::ports::{Recorder, Store};
use firmware::run::{Outside, find, operate};
use firmware::settings::Settings;
use firmware::shared::{Shared, discard};
use firmware::sway::SwayCompensation;
use orientation::alignment::Method;
use orientation::alignment::setup::SetupError;
use orientation::attitude::{Keeper, Setting};
use orientation::signal::{Sample, Timed};
use static_cell::StaticCell;

use i2c::BaseBus;
use wiring::Link;

/// Executors above the thread, which has what may wait: conclusions, plans, link and store.
#[derive(Clone, Copy)]
pub struct Executors {
    /// Of acquisition, with the greater priority: what is read belongs to the moment of its conversion.
    pub acquisition: SendSpawner,
    /// Of mechanism and keeper.
    pub control: SendSpawner,
}

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
fn keeping<C>(settings: &Settings<C>) -> Option<Keeping<'static>> {
    settings.holds.then(|| {
        let keeper = keeper(&configuration::base_keeper(settings.latitude));
        Keeping { keeper, policy: configuration::base_policy(settings) }
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

/// Serves the mechanism and keeps the attitude, for ever.
async fn control(mechanism: &mut impl Mechanism, keeping: impl Keep, shared: &Shared<'static>) {
    let until = (shared.over.wait(), pending());
    operate(mechanism, keeping, &(), shared, until).await;
    pending().await
}

/// Aligns, reports over the link and stores what is to be kept; then reports the conclusion without end. It never
/// returns, because the peripherals would be dropped: the link would lose its last bytes.
async fn find_and_report<S: Timed>(
    method: &mut dyn Method<S>,
    mut link: Link,
    recorder: &mut impl Recorder<S>,
    store: impl Store,
    channels: &'static Channels<S>,
) {
    let shared = &channels.shared;
    find(method, &(), Outside { link: &mut link, recorder, store }, channels).await;
    shared.over.signal(());
    defmt::info!("board: done, {} faults on the way", shared.health.get().faults());
    let reporting = async {
        loop {
            Timer::after_secs(1).await;
            link::send(&mut link, shared).await;
        }
    };
    select(reporting, discard(channels)).await;
}
