//! The instrument's programs, one for each carrier, from its settings to the tasks that run: what happens once, and at a
//! conversation's pace.
//!
//! A board's crate starts its clocks and its [`Executors`], and spawns the program of [`stm32::PLATFORM`], which is chosen
//! when the image is built. The program loads the settings, has the link converse, waits until it is to begin, and spawns
//! the tasks of [`stm32::sample_path`]. A sample passes through all priorities:
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

mod methods;
mod settings;

pub mod spinning;
pub mod stepwise;
pub mod stops;
pub mod turning;

pub use settings::output;

use core::pin::pin;

use conversation::{Conversation, Listening};
use cortex_m::peripheral::SCB;
use embassy_executor::{SendSpawner, Spawner};
use embassy_sync::mutex::{Mutex, MutexGuard};
use embassy_time::{Duration, block_for};
use firmware::check_ins::Part;
use firmware::crossing::Lock;
use firmware::event::Event;
use firmware::keep::Keeping;
use firmware::not_begun::NotBegun;
use firmware::run;
use firmware::settings::{BoardSettings, CarrierSchedule, Editable, Settings, Start};
use firmware::shared::Shared;
use firmware::status::Status;
use firmware::storage::SharedStore;
use orientation::attitude::{Keeper, Setting};
use orientation::earth::Latitude;
use orientation::timebase::Timebase;
use static_cell::StaticCell;
use stm32::configuration::timebase;
use stm32::flash::Archive;
use stm32::i2c::BaseBus;
use stm32::link::Link;
use stm32::sample_path::Channels;
use stm32::wiring::Outlets;
use stm32::{once, ports};

/// Executors: the thread has what may wait, conclusions, plans and store. Of the others each has a greater priority than
/// the next.
#[derive(Clone, Copy)]
pub struct Executors {
    /// Of what may wait.
    pub thread: Spawner,
    /// Of acquisition: what is read belongs to the moment of its conversion.
    pub acquisition: SendSpawner,
    /// Of mechanism and keeper.
    pub control: SendSpawner,
    /// Of the link, which goes on while the thread computes.
    pub link: SendSpawner,
}

/// Settings that parts of the instrument read and change.
type Kept<C> = Mutex<Lock, Settings<C>>;

/// Settings at the moment at which the first alignment begins, and the latitude that holds.
type Initial<C> = (MutexGuard<'static, Lock, Settings<C>>, Option<Latitude>);

/// Final places in memory of what the parts of an instrument share.
struct Statics<S: 'static, C: CarrierSchedule + 'static> {
    channels: StaticCell<Channels<S>>,
    settings: StaticCell<Kept<C>>,
}

impl<S: Send, C: CarrierSchedule> Statics<S, C> {
    /// Places that are still empty.
    const fn new() -> Self {
        Self { channels: StaticCell::new(), settings: StaticCell::new() }
    }
}

/// An instrument whose parts are connected, and whose settings are loaded.
struct Instrument<S: 'static, C: CarrierSchedule + 'static> {
    /// From one part to the next.
    channels: &'static Channels<S>,
    /// The store of what outlasts a loss of supply.
    store: &'static SharedStore<Archive>,
    settings: &'static Kept<C>,
    /// What an alignment begins with, or why none does.
    start: Result<Start, NotBegun>,
}

impl<S: Send, C: CarrierSchedule + 'static> Instrument<S, C> {
    /// Connects it at its final places in memory. Not inlined, so that what is made on the way is in no frame of the
    /// program.
    #[inline(never)]
    fn new(statics: &'static Statics<S, C>, outlets: &Outlets) -> Self {
        static STORE: StaticCell<SharedStore<Archive>> = StaticCell::new();
        let channels = statics.channels.init_with(|| Channels::new(outlets.log));
        channels.shared.clocks = timebase(outlets.clock);
        let store = STORE.init_with(|| SharedStore::new(outlets.flash.archive()));
        let loaded = settings::load::<C>(outlets);
        let start = loaded.as_ref().map(Editable::start).map_err(|reason| *reason);
        // The port was opened as a record says, even one that is refused.
        let settings = loaded
            .unwrap_or_else(|_| Settings { output: output(outlets.flash), ..Settings::default() });
        channels.shared.output.set(settings.output);
        Self { channels, store, settings: statics.settings.init(Mutex::new(settings)), start }
    }

    /// Has the link converse from now on, and waits until the first alignment is to begin: at once where the settings say
    /// so and state a latitude, otherwise until it is ordered.
    ///
    /// # Errors
    /// Why nothing begins.
    async fn until_begin(&self, executors: Executors, port: Link) -> Result<Initial<C>, NotBegun> {
        let Self { settings, store, start, .. } = *self;
        let shared = &self.channels.shared;
        let board = BoardSettings { settings, serial: settings::serial() };
        executors.link.spawn(once(converse(port, board, shared)));
        executors.thread.spawn(once(keep_store(store, board, shared)));
        let start = start?;
        let lacks_latitude = start.lacks_latitude(None);
        if lacks_latitude {
            shared.report(Event::NotBegun(NotBegun::NoLatitude));
        }
        if lacks_latitude || !start.is_at_power_on {
            shared.wait_to_begin();
            shared.begin.wait().await;
            shared.status.set(Status::Starting);
        }
        let settings = settings.lock().await;
        let start = settings.start();
        let latitude = start.latitude(shared.latitude.get());
        if start.stated.is_none() {
            latitude.into_iter().for_each(settings::tell_of_receiver);
        }
        Ok((settings, latitude))
    }

    /// Says why nothing begins, where that is so. Settings may be mended.
    fn tell(&self, begun: Result<(), NotBegun>) {
        if let Err(reason) = begun {
            self.channels.shared.report(Event::NotBegun(reason));
            self.channels.shared.refuse_to_begin(reason);
        }
    }
}

/// Time for which the port sends what it was given, at the slowest rate: two bytes.
const SENDING: Duration = Duration::from_millis(5);

/// Starts the controller anew.
fn restart() {
    block_for(SENDING);
    SCB::sys_reset();
}

/// Connects the IMU on the base.
fn on_base(bus: BaseBus) -> &'static mut ports::Base {
    static BASE: StaticCell<ports::Base> = StaticCell::new();
    BASE.init(ports::base(bus))
}

/// Attitude and heading of a platform's base after the alignment, where they are held.
fn keeping<C: CarrierSchedule>(
    settings: &Settings<C>,
    latitude: Latitude,
    clocks: Timebase,
) -> Option<Keeping<'static>> {
    settings.holds.then(|| {
        let keeper = keeper(&methods::base_keeper(latitude, clocks));
        Keeping { keeper, policy: methods::base_policy(settings, latitude, clocks) }
    })
}

/// The estimator of attitude and heading at its final place in memory.
fn keeper(setting: &Setting) -> &'static mut Keeper {
    static KEEPER: StaticCell<Keeper> = StaticCell::new();
    KEEPER.init_with(|| Keeper::new(setting))
}

/// Converses over the link, for ever; says when nothing more will happen.
#[embassy_executor::task]
async fn converse(port: Link, settings: BoardSettings<'static>, shared: &'static Shared<'static>) {
    let mut conversation = Conversation::new(port, Listening::new(settings, restart), shared);
    let conversing = async {
        conversation.until_over().await;
        shared.over.signal(());
        defmt::info!("board: done, {} faults on the way", shared.health.get().faults());
        conversation.without_end().await
    };
    shared.checked(Part::Link, pin!(conversing)).await;
}

/// Keeps what is to outlast a loss of supply, for ever.
#[embassy_executor::task]
async fn keep_store(
    store: &'static SharedStore<Archive>,
    settings: BoardSettings<'static>,
    shared: &'static Shared<'static>,
) {
    run::store(store, Some(settings), shared).await;
}
