//! Communication between the parts of the instrument: one bounded queue of samples, signals and
//! cells.

use core::cell::Cell;

use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use embassy_time::Instant;
use orientation::alignment::refusal::Refusal;
use orientation::device::{Device, Trouble};
use orientation::signal::Sample;
use orientation::signal::sway::SwayNoise;
use orientation::units::Angle;

use crate::event::Event;
use crate::health::Health;
use crate::keep::KeeperChannels;
use crate::link::Status;
use crate::ports::Observer;
use crate::retry_budget::Symptom;

/// Capacity of the queue of samples: 8 ms at 2 kHz.
pub const QUEUE: usize = 16;

/// The queue of samples from acquisition to the session.
pub type Queue<S> = Channel<NoopRawMutex, S, QUEUE>;

/// All channels of an instrument whose samples are of the type `S`. Only acquisition and the
/// session depend on that type.
pub struct Channels<'a, S = Sample> {
    /// The samples from acquisition to the session.
    pub samples: Queue<S>,
    /// All other signals and cells.
    pub shared: Shared<'a>,
}

impl<'a, S> Channels<'a, S> {
    /// Channels without any message; events go to the observer.
    pub fn new(observer: &'a dyn Observer) -> Self {
        Self { samples: Queue::new(), shared: Shared::new(observer) }
    }
}

/// The latest corrected angle of an axis' encoder and the time of its reading.
pub type LatestAngle = Cell<(Angle, Instant)>;

/// Signals and cells between the parts. All parts run in one executor, so no lock is needed.
pub struct Shared<'a> {
    /// From the session to the drive: the requested angle, rad, or on a turntable the requested
    /// rate, rad/s. A new request replaces the one before.
    pub wanted: Signal<NoopRawMutex, f64>,
    /// From acquisition to the drive: the sensors give data.
    pub sensing: Signal<NoopRawMutex, ()>,
    /// From the drive to the session: the angles are valid. Without a stage they are valid from the
    /// begin.
    pub homed: Signal<NoopRawMutex, ()>,
    /// From any part to the session: the session cannot continue.
    pub failure: Signal<NoopRawMutex, Refusal>,
    /// From the session to the link: the status is final.
    pub concluded: Signal<NoopRawMutex, ()>,
    /// The latest angle of the stage's encoder.
    pub angle: LatestAngle,
    /// Noise that the compensated sway leaves in the samples, determined before the stage is homed.
    pub sway: Cell<SwayNoise>,
    /// The channels between acquisition, session and attitude keeper.
    pub keep: KeeperChannels,
    /// Counters of faults.
    pub health: Cell<Health>,
    /// The status that the link reports.
    pub status: Cell<Status>,
    /// Receiver of events.
    pub observer: &'a dyn Observer,
}

impl<'a> Shared<'a> {
    /// Signals and cells without any message.
    pub fn new(observer: &'a dyn Observer) -> Self {
        Self {
            wanted: Signal::new(),
            sensing: Signal::new(),
            homed: Signal::new(),
            failure: Signal::new(),
            concluded: Signal::new(),
            angle: Cell::new((Angle(0), Instant::MIN)),
            sway: Cell::new(SwayNoise::NONE),
            keep: KeeperChannels::new(),
            health: Cell::default(),
            status: Cell::new(Status::Starting),
            observer,
        }
    }

    /// Ends the session with a reason. The first reason is kept.
    pub fn fail(&self, reason: Refusal) {
        if !self.failure.signaled() {
            self.failure.signal(reason);
        }
    }

    /// Reports an event with the present time. Not inlined, since every part calls it and it
    /// contains the clock and the log.
    #[inline(never)]
    pub fn report(&self, event: Event) {
        self.observer.event(Instant::now(), &event);
    }

    /// Changes the counters of faults.
    pub fn count(&self, change: impl FnOnce(&mut Health)) {
        let mut health = self.health.get();
        change(&mut health);
        self.health.set(health);
    }

    /// Counts and reports a lost reading of a device.
    pub fn lose(&self, device: Device, symptom: Symptom) {
        self.count(|health| health.lose(device));
        self.report(Event::Lost(device, symptom));
    }

    /// Counts and reports the restart of a device.
    pub fn restart(&self, device: Device, symptom: Symptom) {
        self.count(|health| health.restart(device));
        self.report(Event::Restarting(device, symptom));
    }

    /// Reports that a device is given up, and returns the refusal that ends the session.
    pub fn give_up(&self, device: Device, trouble: Trouble) -> Refusal {
        self.report(Event::GivenUp(device, trouble));
        Refusal::Device { device, trouble }
    }
}
