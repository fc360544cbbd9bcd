//! The attitude keeper beside the session: pitch and roll from switch-on, the azimuth from its
//! alignment on (heading hold).
//!
//! ```text
//!  acquire ─motion─▶ keeper ─report─▶ link, log        flash ◀─rest─┐
//!                      ▲  ▲                              └─restart─▶ keeper
//!  session ─azimuth────┘  └─azimuth, speed─ outside
//! ```
//!
//! Inertial samples reach the keeper through a channel of their own. The keeper never runs ahead of
//! the session: it takes only samples that the session has had the chance to take. An azimuth
//! belongs to the last sample of its session, so it is handed over exactly between that sample and
//! the next, and no rotation during the computation is lost.

mod attitude;
mod memory;
mod part;

pub use attitude::AttitudeReport;
pub use part::{Keep, Keeping};

use core::cell::Cell;
use core::future::pending;

use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use embassy_time::{Duration, Timer};
use orientation::attitude::Handover;
use orientation::signal::InertialSample;
use orientation::units::Instant;

use crate::shared::{QUEUE, Shared};

/// Time after which a device that was given up is tried again while an azimuth is kept.
pub(crate) const RETRY: Duration = Duration::from_secs(10);

/// The gyro that measures the rotation about the body's down axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VerticalGyro {
    /// The coarse gyro that is read beside the other two.
    Coarse,
    /// The coarse gyro, whose bias was determined by comparison with the precise one.
    Calibrated,
    /// The precise gyro, whose sensitive axis a mount has turned to the vertical.
    Precise,
}

/// A message from acquisition to the keeper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// An increment of rotation and velocity of the body.
    Moved(InertialSample),
    /// From the next increment on, another gyro measures about the down axis.
    Exchanged(VerticalGyro),
}

/// The channels between the keeper and the other parts. All run in one executor, so no lock is
/// needed.
pub struct KeeperChannels {
    /// From acquisition to the keeper: the inertial samples, in the order of time.
    pub motions: Channel<NoopRawMutex, Motion, QUEUE>,
    /// Whether a keeper runs.
    pub is_wanted: Cell<bool>,
    /// Whether there are samples that the session has not taken yet.
    pub is_behind: Cell<bool>,
    /// From the session to the keeper: all samples of the queue have been taken.
    pub caught_up: Signal<NoopRawMutex, ()>,
    /// From the session to the keeper: an azimuth, and the time of the sample to which it belongs.
    pub found: Signal<NoopRawMutex, (Instant, Handover)>,
    /// From the keeper to the session: the azimuth is known, so the alignment may be skipped.
    pub spare: Signal<NoopRawMutex, ()>,
    /// From the keeper to the session: a new session is to begin.
    pub again: Signal<NoopRawMutex, ()>,
    /// Whether no session runs: the last one has ended, and no other has begun.
    pub is_idle: Cell<bool>,
    /// Whether the first session has ended. From then on, a device that is given up does not end
    /// the operation; it is tried again after a pause.
    pub is_kept: Cell<bool>,
    /// From the keeper to a two-frame mount: set the precise gyro's sensitive axis vertical.
    pub store: Signal<NoopRawMutex, ()>,
    /// Whether the body is at rest, by the keeper's detection.
    pub is_at_rest: Cell<bool>,
    /// The attitude that the link reports instead of the session's status; [`None`] before there is
    /// any.
    pub attitude: Cell<Option<AttitudeReport>>,
}

impl KeeperChannels {
    /// Channels without a keeper and without messages.
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
            attitude: Cell::new(None),
        }
    }

    /// Waits before sensors that were given up are tried again: 10 s while a keeper runs, otherwise
    /// for ever.
    pub(crate) async fn rest(&self) {
        if self.is_wanted.get() {
            Timer::after(RETRY).await;
        } else {
            pending::<()>().await;
        }
    }

    /// Signals the keeper that the session has taken all samples of the queue.
    pub(crate) fn catch_up(&self) {
        self.is_behind.set(false);
        self.caught_up.signal(());
    }
}

impl Shared<'_> {
    /// Queues an increment for the keeper, if one runs. If the queue is full, the increment is
    /// discarded and counted; the keeper sees the gap in the time stamps.
    pub(crate) fn move_on(&self, motion: Motion) {
        if self.keep.is_wanted.get() && self.keep.motions.try_send(motion).is_err() {
            self.count(|health| health.unkept = health.unkept.saturating_add(1));
        }
    }
}
