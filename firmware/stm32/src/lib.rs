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
//! | executor of the link | sentences and messages of the attitude | 1 ms, ten times a second |
//! | thread | aligner, conclusions, plans, store | a conclusion takes up to some seconds |
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
use firmware::acquire::{acquire, on_stage};
use firmware::check_ins::Part;
use firmware::event::Event;
use firmware::keep::{Keep, Keeping};
use firmware::mechanism::Mechanism;
use firmware::not_begun::NotBegun;
use firmware::ports::NoRecorder;
use firmware::run::{find, operate, wake};
use firmware::settings::Settings;
use firmware::shared::Shared;
use firmware::sway::SwayCompensation;
use orientation::alignment::Method;
use orientation::attitude::{Keeper, Setting};
use orientation::signal::{Sample, Timed};
use orientation::timebase::Timebase;
use static_cell::StaticCell;

use i2c::BaseBus;
use wiring::{Link, Outlets};

/// Executors above the thread, which has what may wait: conclusions, plans and store. Each has a greater priority than
/// the next.
#[derive(Clone, Copy)]
pub struct Executors {
    /// Of acquisition: what is read belongs to the moment of its conversion.
    pub acquisition: SendSpawner,
    /// Of mechanism and keeper.
    pub control: SendSpawner,
    /// Of the link, which goes on while the thread computes.
    pub link: SendSpawner,
}

/// The channels between the instrument's parts.
type Channels<S = Sample> = firmware::shared::Channels<'static, S>;

/// The IMU on the base, which measures its motion.
type OnBase = SwayCompensation<'static, ports::Base>;

/// Channels of an instrument at their final place in memory. The link reports from now on.
fn connected<S: Send>(
    place: &'static StaticCell<Channels<S>>,
    executors: Executors,
    outlets: &Outlets,
    port: Link,
) -> &'static Channels<S> {
    let channels = place.init_with(|| Channels::new(outlets.log));
    channels.shared.clocks = configuration::timebase(outlets.clock);
    let channels: &'static Channels<S> = channels;
    executors.link.spawn(once(link(port, &channels.shared)));
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
    select(shared.over.wait(), wake()).await;
}

/// Reports over the link, for ever; says when nothing more will happen.
#[embassy_executor::task]
async fn link(mut port: Link, shared: &'static Shared<'static>) {
    let reporting = async {
        firmware::link::run(&mut port.sender, shared).await;
        shared.over.signal(());
        defmt::info!("board: done, {} faults on the way", shared.health.get().faults());
        firmware::link::serve(&mut port.sender, shared).await;
    };
    shared.checked(Part::Link, pin!(reporting)).await;
}

/// Goes on with what has begun, without end, where nothing but a heading is kept; or says why nothing has.
async fn go_on<M: Method<S>, S: Timed>(
    begun: Result<&'static mut M, NotBegun>,
    flash: UpperBank,
    channels: &'static Channels<S>,
) -> ! {
    match begun {
        Ok(method) => find(method, &(), &mut NoRecorder, flash.store(), channels).await,
        Err(reason) => refuse(reason, &channels.shared),
    }
    pending().await
}

/// Says why nothing begins.
fn refuse(reason: NotBegun, shared: &Shared<'static>) {
    shared.report(Event::NotBegun(reason));
    shared.refuse_to_begin();
}
