//! The keeper beside the session: pitch and roll from switch-on, azimuth from its alignment on.
//!
//! ```text
//!  acquire ─motion─▶ keeper ─report─▶ link, log        flash ◀─rest─┐
//!                      ▲  ▲                              └─restart─▶ keeper
//!  session ─azimuth────┘  └─azimuth, speed─ outside
//! ```
//!
//! Motion has a channel of its own. The keeper takes what the session has had the chance to take, never
//! more: so an azimuth, which belongs to the last sample of its session, is handed over between that
//! sample and the next, and nothing that turns meanwhile is lost.

mod memory;
mod part;
mod told;

pub use part::{Keep, Keeping};
pub use told::Kept;

use core::cell::Cell;
use core::future::pending;

use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use embassy_time::{Duration, Timer};
use orientation::keep::Handover;
use orientation::signal::InertialSample;
use orientation::units::Instant;

use crate::ports::Observer;
use crate::shared::{QUEUE, Shared};

/// Time after which a device that was given up is tried again while an azimuth is kept.
pub(crate) const RETRY: Duration = Duration::from_secs(10);

/// Which gyro shows how the body turns about its down axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VerticalGyro {
    /// The one beside the other two.
    Coarse,
    /// The same, whose bias was found beside the precise one.
    Calibrated,
    /// The precise one, which a mount has turned to the vertical.
    Precise,
}

/// What acquisition tells the keeper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The body has moved.
    Moved(InertialSample),
    /// From the next sample on another gyro shows the down axis.
    Exchanged(VerticalGyro),
}

/// The channel between the keeper and the others.
pub struct KeeperChannels {
    /// From acquisition to the keeper.
    pub motions: Channel<NoopRawMutex, Motion, QUEUE>,
    /// Whether anybody keeps.
    pub is_wanted: Cell<bool>,
    /// Whether there are samples that the session was not given yet.
    pub is_behind: Cell<bool>,
    /// From the session to the keeper: it has taken what there was.
    pub caught_up: Signal<NoopRawMutex, ()>,
    /// From the session to the keeper: an azimuth, and the sample that it belongs to.
    pub found: Signal<NoopRawMutex, (Instant, Handover)>,
    /// From the keeper to the session: the azimuth is known without it.
    pub spare: Signal<NoopRawMutex, ()>,
    /// From the keeper to the session: begin again.
    pub again: Signal<NoopRawMutex, ()>,
    /// Whether there is no session: the last has ended and no other has begun.
    pub is_idle: Cell<bool>,
    /// Whether the first session has ended. Devices that are given up from then on are tried again
    /// later, instead of ending everything.
    pub is_kept: Cell<bool>,
    /// From the keeper to a mount with two frames: the precise gyro to the vertical.
    pub store: Signal<NoopRawMutex, ()>,
    /// Whether the body rests, as the keeper sees it.
    pub is_at_rest: Cell<bool>,
    /// What the link tells instead of the session's status.
    pub told: Cell<Option<Kept>>,
}

impl KeeperChannels {
    /// Nobody keeps yet.
    pub(crate) const fn new() -> Self {
        Self {
            motions: Channel::new(),
            is_wanted: Cell::new(false),
            is_behind: Cell::new(false),
            caught_up: Signal::new(),
            found: Signal::new(),
            spare: Signal::new(),
            again: Signal::new(),
            is_idle: Cell::new(false),
            is_kept: Cell::new(false),
            store: Signal::new(),
            is_at_rest: Cell::new(false),
            told: Cell::new(None),
        }
    }

    /// Lets some time go by before sensors that were given up are tried again; for ever where nobody
    /// keeps.
    pub(crate) async fn rest(&self) {
        if self.is_wanted.get() {
            Timer::after(RETRY).await;
        } else {
            pending::<()>().await;
        }
    }

    /// The session has taken what there was.
    pub(crate) fn catch_up(&self) {
        self.is_behind.set(false);
        self.caught_up.signal(());
    }
}

impl<O: Observer> Shared<'_, O> {
    /// Queues a motion for the keeper, if there is one; counts it where it does not fit. What is missing
    /// then shows in the times of those that do.
    pub(crate) fn move_on(&self, motion: Motion) {
        if self.keep.is_wanted.get() && self.keep.motions.try_send(motion).is_err() {
            self.count(|health| health.unkept = health.unkept.saturating_add(1));
        }
    }
}
