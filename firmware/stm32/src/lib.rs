//! What boards with an STM32 share: the instrument's programs, one for each carrier, what they are
//! configured with, and its chips on their wires.
//!
//! A board's crate connects its pins to [`wiring`], starts its clocks and its [`Executors`], and spawns the program of
//! [`PLATFORM`], which is chosen when the image is built. A sample passes through all priorities:
//!
//! | priority | what | how long at most |
//! |---|---|---|
//! | interrupts of data-ready edges | stamp them; on a spinning body read its converters | a microsecond |
//! | interrupts of devices and of the clock | wake tasks | some microseconds |
//! | executor of acquisition | reads the sensors, queues samples and motions | 0.4 ms |
//! | executor of control | motors; attitude and heading from the motions | 1.5 ms, once a second |
//! | thread | aligner, conclusions, plans, link, store | a conclusion takes up to some seconds |
#![no_std]

pub mod brown_out;
pub mod chain;
mod configuration;
pub mod edges;
pub mod flash;
pub mod i2c;
pub mod log;
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
pub use flash::{UpperBank, note_unreadable_row};
pub use log::BoardLog;

use core::future::pending;
use core::pin::pin;

use embassy_executor::{SendSpawner, SpawnError, SpawnToken};
use embassy_futures::join::join;
use embassy_futures::select::select;
use embassy_stm32::gpio::Output;
use embassy_time::{Duration, Timer};
use firmware::acquire::{acquire, on_stage};
use firmware::check_ins::{Checked, Part};
use firmware::keep::{Keep, Keeping};
use firmware::kept_lines::Weight;
use firmware::link;
use firmware::mechanism::Mechanism;
use firmware::not_begun::NotBegun;
use firmware::ports::{NoRecorder, Observer, Recorder, Store};
use firmware::run::{Outside, find, operate};
use firmware::settings::Settings;
use firmware::shared::Shared;
use firmware::sway::SwayCompensation;
use orientation::alignment::Method;
use orientation::attitude::{Keeper, Setting};
use orientation::signal::{Sample, Timed};
use orientation::timebase::Timebase;
use static_cell::StaticCell;

use i2c::BaseBus;
use wiring::Link;

/// Longest time between two polls of the parts that are to check in.
const CHECK_IN: Duration = Duration::from_secs(1);

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

/// What the thread is given: a method, the flash for what is to be kept, and the channels.
type Begun<M, S = Sample> = (&'static mut M, UpperBank, &'static Channels<S>);

/// The IMU on the base, which measures its motion.
type OnBase = SwayCompensation<'static, ports::Base>;

/// Channels of the instrument on a platform, at their final place in memory.
fn channels(log: &'static BoardLog, clocks: Timebase) -> &'static Channels {
    static CHANNELS: StaticCell<Channels> = StaticCell::new();
    let channels = CHANNELS.init_with(|| Channels::new(log));
    channels.shared.clocks = clocks;
    channels
}

/// Connects the IMU on the base.
fn on_base(bus: BaseBus) -> &'static mut ports::Base {
    static BASE: StaticCell<ports::Base> = StaticCell::new();
    BASE.init(ports::base(bus))
}

/// Attitude and heading of a platform's base after the alignment, where they are held.
fn keeping<C>(settings: &Settings<C>, clocks: Timebase) -> Option<Keeping<'static>> {
    settings.holds.then(|| {
        let keeper = keeper(&configuration::base_keeper(settings.latitude, clocks));
        Keeping { keeper, policy: configuration::base_policy(settings, clocks) }
    })
}

/// The estimator of attitude and heading at its final place in memory.
fn keeper(setting: &Setting) -> &'static mut Keeper {
    static KEEPER: StaticCell<Keeper> = StaticCell::new();
    KEEPER.init_with(|| Keeper::new(setting))
}

/// A task that is spawned once, so that there is memory for it.
///
/// # Panics
/// Where it runs already, with the place of the call.
#[expect(clippy::expect_used, reason = "to spawn a task twice is a mistake of the program")]
#[track_caller]
pub fn once<S>(task: Result<SpawnToken<S>, SpawnError>) -> SpawnToken<S> {
    task.expect("a task is spawned once")
}

/// Task that acquires samples on a stage or a turntable for ever.
#[embassy_executor::task]
async fn stage_acquisition(mut inputs: ports::Inputs<OnBase>, channels: &'static Channels) {
    acquire(&mut on_stage(&mut inputs, &configuration::instrument(), channels)).await;
}

/// Serves the mechanism and keeps the attitude, for ever.
async fn control(mechanism: &mut impl Mechanism, keeping: impl Keep, shared: &Shared<'static>) {
    let until = (wait(shared), pending());
    operate(mechanism, keeping, &(), shared, until).await;
    pending::<()>().await;
}

/// Serves a mechanism with motors and keeps the attitude, for ever; gives the motors their current once all rest, and
/// takes it away where one cannot be brought to rest.
async fn control_motors(
    mechanism: &mut impl Mechanism,
    mut motor_enable: Output<'static>,
    keeping: impl Keep,
    shared: &Shared<'static>,
) {
    let switching = async {
        loop {
            // Active low.
            motor_enable.set_level((!shared.current.wait().await).into());
        }
    };
    join(control(mechanism, keeping, shared), switching).await;
}

/// Waits for the end of all. Once a second the parts beside it are woken, to check in.
async fn wait(shared: &Shared<'static>) {
    let waking = async {
        loop {
            Timer::after(CHECK_IN).await;
        }
    };
    select(shared.over.wait(), waking).await;
}

/// Aligns, reports over the link and stores what is to be kept; then reports the conclusion without end. It never
/// returns, because the peripherals would be dropped: the link would lose its last bytes.
async fn find_and_report<S: Timed>(
    method: &mut dyn Method<S>,
    link: &mut Link,
    recorder: &mut impl Recorder<S>,
    store: impl Store,
    channels: &'static Channels<S>,
) -> ! {
    let shared = &channels.shared;
    let outside = Outside { link: &mut link.sender, recorder, store };
    find(method, &(), outside, channels).await;
    shared.over.signal(());
    defmt::info!("board: done, {} faults on the way", shared.health.get().faults());
    shared.checked(Part::Link, pin!(link::repeat(&mut link.sender, channels))).await
}

/// Goes on with what has begun, without end, where nothing but a heading is kept; or says why nothing has.
async fn go_on<M: Method<S>, S: Timed>(
    begun: Result<Begun<M, S>, NotBegun>,
    link: &mut Link,
    log: &BoardLog,
) -> ! {
    match begun {
        Ok((method, flash, channels)) => {
            find_and_report(method, link, &mut NoRecorder, flash.store(), channels).await
        }
        Err(reason) => refuse(reason, link, log).await,
    }
}

/// Says why nothing begins: once in the log, every second over the link.
async fn refuse(reason: NotBegun, link: &mut Link, log: &BoardLog) -> ! {
    log.keep(Weight::Outcome, || defmt::error!("board: {}", reason));
    Checked::new(log.check_ins(), Part::Link, pin!(link::refuse(&mut link.sender, reason.brief())))
        .await
}
