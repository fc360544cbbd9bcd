//! Memory of the heading over a loss of supply. The heading is stored while the vehicle is at rest
//! and erased when it sets off; after a restart it is used again only if the vehicle is found to
//! stand as before.
//!
//! **Endurance of the flash.** An item is written when the vehicle has come to rest, when it sets
//! off, and between them at most once a minute and only if azimuth or σ have changed: about five
//! items per hour of operation. An item takes 80 bytes, so a page of 2 KiB holds 24. Two pages of
//! 10 000 erase cycles (STM32L475 data sheet, table 59) take 480 000 items, about ten years of
//! continuous operation.

use drivers::fault::Fault;
use embassy_time::{Duration, Instant};
use orientation::attitude::Keeper;
use orientation::attitude::restart::{RecallRefusal, Remembered};
use orientation::units::DEGREE;

use crate::event::Event;
use crate::ports::Store;
use crate::shared::Shared;
use crate::storage::HEADING;

/// Least time between two writes of the same stop.
const PERIOD: Duration = Duration::from_secs(60);
/// Change of azimuth or σ that is worth a write, rad.
const CHANGE: f64 = 0.01 * DEGREE;
/// The item that invalidates the stored heading: its checksum is wrong.
const NOTHING: [u8; Remembered::BYTES] = [0; Remembered::BYTES];

/// The stored heading, and the heading found at the start.
pub(super) struct Memory<M> {
    /// The non-volatile store.
    store: M,
    /// The heading found at the start, until it has been accepted or rejected.
    pub(super) found: Option<Remembered>,
    /// Azimuth and σ that this run has stored, rad, and the time of the write.
    stored: Option<([f64; 2], Instant)>,
    /// Whether the store has failed; a failure is reported once.
    has_failed: bool,
}

impl<M: Store> Memory<M> {
    /// Wraps a store; nothing is read yet.
    pub(super) fn new(store: M) -> Self {
        Self { store, found: None, stored: None, has_failed: false }
    }

    /// Reads the heading that was stored before the restart. An item with a wrong checksum counts
    /// as absent.
    pub(super) async fn load(&mut self, shared: &Shared<'_>) {
        match self.store.load::<{ Remembered::BYTES }>(HEADING).await {
            Ok(bytes) => self.found = bytes.as_ref().and_then(|b| Remembered::from_bytes(b)),
            Err(fault) => self.fail(fault, shared),
        }
    }

    /// Reports the first failure of the store.
    fn fail(&mut self, fault: Fault, shared: &Shared<'_>) {
        if !core::mem::replace(&mut self.has_failed, true) {
            shared.report(Event::HeadingNotKept(fault));
        }
    }

    /// Decides on the heading from before the restart once the vehicle has rested long enough; true
    /// if it is used. Until then it stays pending.
    pub(super) fn recall(&mut self, keeper: &mut Keeper, shared: &Shared<'_>) -> bool {
        let Some(found) = &self.found else { return false };
        let outcome = keeper.recall(found);
        match outcome {
            Err(RecallRefusal::NotAtRest { .. }) => return false,
            Err(reason) => shared.report(Event::RecallRefused(reason)),
            Ok(()) => {}
        }
        self.found = None;
        outcome.is_ok()
    }

    /// Stores the heading of a body at rest, at most once a minute, and erases it when the body
    /// sets off. The item found at the start stays until it has been decided on.
    pub(super) async fn keep(&mut self, keeper: &Keeper, is_at_rest: bool, shared: &Shared<'_>) {
        if self.found.is_some() {
            return;
        }
        if !is_at_rest {
            if self.stored.take().is_some() {
                self.write(&NOTHING, shared).await;
            }
            return;
        }
        let (Some(azimuth), Some(remembered)) = (keeper.report().azimuth, keeper.remember()) else {
            return;
        };
        let now = [azimuth.angle, azimuth.sigma];
        if self.is_new(now) {
            self.stored = Some((now, Instant::now()));
            self.write(&remembered.to_bytes(), shared).await;
        }
    }

    /// Whether azimuth or σ have changed enough, and the last write is long enough ago.
    fn is_new(&self, now: [f64; 2]) -> bool {
        let Some((then, since)) = self.stored else { return true };
        let has_changed = (0..2).any(|index| (now[index] - then[index]).abs() > CHANGE);
        has_changed && since.elapsed() >= PERIOD
    }

    /// Writes an item and reports the first failure.
    async fn write(&mut self, bytes: &[u8; Remembered::BYTES], shared: &Shared<'_>) {
        if let Err(fault) = self.store.save(HEADING, bytes).await {
            self.fail(fault, shared);
        }
    }
}
