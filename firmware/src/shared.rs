//! What the parts of the instrument hand to each other: one bounded channel, some signals and cells.

use core::cell::Cell;

use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use embassy_time::Instant;
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::signal::Sample;
use orientation::signal::sway::SwayNoise;
use orientation::units::Angle;

use crate::event::Event;
use crate::health::Health;
use crate::keep::KeeperChannels;
use crate::link::Status;
use crate::ports::Observer;
use crate::retry_budget::Symptom;

/// Samples that may wait for the session: 8 ms at 2 kHz.
pub const QUEUE: usize = 16;

/// Samples on their way from acquisition to the session.
pub type Queue<S> = Channel<NoopRawMutex, S, QUEUE>;

/// All channels of an instrument whose samples are of the kind `S`. Only acquisition and the session know the
/// kind.
pub struct Channels<'a, O, S = Sample> {
    /// From acquisition to the session.
    pub samples: Queue<S>,
    /// The others.
    pub shared: Shared<'a, O>,
}

impl<'a, O: Observer, S> Channels<'a, O, S> {
    /// Nothing has happened yet.
    pub const fn new(observer: &'a O) -> Self {
        Self { samples: Queue::new(), shared: Shared::new(observer) }
    }
}

/// The latest encoder angle of an axis, corrected, and when it was read.
pub type LatestAngle = Cell<(Angle, Instant)>;

/// The channels between the parts, but for the samples. All of them run in one executor, so nothing needs a
/// lock.
pub struct Shared<'a, O> {
    /// From the session to what turns the gyro: where to stand, rad, or on a turntable how fast to
    /// turn, rad/s. The latest counts.
    pub wanted: Signal<NoopRawMutex, f64>,
    /// From acquisition to the stage: the sensors give data.
    pub sensing: Signal<NoopRawMutex, ()>,
    /// From the stage to the session: angles mean something. Without a stage they do from the beginning.
    pub homed: Signal<NoopRawMutex, ()>,
    /// From anybody to the session: it cannot go on.
    pub failure: Signal<NoopRawMutex, Refusal>,
    /// From the session to the link: the last status stands.
    pub concluded: Signal<NoopRawMutex, ()>,
    /// The stage's latest angle.
    pub angle: LatestAngle,
    /// What a subtracted sway leaves in the samples; decided before the stage is homed.
    pub sway: Cell<SwayNoise>,
    /// What acquisition and the session hand to the keeper, and it to them.
    pub keep: KeeperChannels,
    /// What went wrong so far.
    pub health: Cell<Health>,
    /// What the link tells.
    pub status: Cell<Status>,
    observer: &'a O,
}

impl<'a, O: Observer> Shared<'a, O> {
    /// Nothing has happened yet.
    pub const fn new(observer: &'a O) -> Self {
        Self {
            wanted: Signal::new(),
            sensing: Signal::new(),
            homed: Signal::new(),
            failure: Signal::new(),
            concluded: Signal::new(),
            angle: Cell::new((Angle(0), Instant::MIN)),
            sway: Cell::new(SwayNoise::NONE),
            keep: KeeperChannels::new(),
            health: Cell::new(Health::EMPTY),
            status: Cell::new(Status::Starting),
            observer,
        }
    }

    /// Tells the session why it cannot go on; the first reason stands.
    pub fn fail(&self, reason: Refusal) {
        if !self.failure.signaled() {
            self.failure.signal(reason);
        }
    }

    /// Tells what happened. In one place: every part tells, and a clock and a log go with it.
    #[inline(never)]
    pub fn tell(&self, event: Event) {
        self.observer.event(Instant::now(), &event);
    }

    /// Who is told.
    pub fn observer(&self) -> &O {
        self.observer
    }

    /// Counts something.
    pub fn count(&self, change: impl FnOnce(&mut Health)) {
        let mut health = self.health.get();
        change(&mut health);
        self.health.set(health);
    }

    /// Counts and tells a lost reading.
    pub fn lose(&self, device: Device, symptom: Symptom) {
        self.count(|health| health.lose(device));
        self.tell(Event::Lost(device, symptom));
    }

    /// Counts and tells that a device is started again.
    pub fn restart(&self, device: Device, symptom: Symptom) {
        self.count(|health| health.restart(device));
        self.tell(Event::Restarting(device, symptom));
    }

    /// Tells that a device is given up, and gives the reason for the session's end.
    pub fn give_up(&self, device: Device, trouble: Trouble) -> Refusal {
        self.tell(Event::GivenUp(device, trouble));
        Refusal::Device { device, trouble }
    }
}
