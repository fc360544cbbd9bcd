//! The heading over a loss of supply: stored at rest, forgotten when the vehicle sets off, believed again
//! only where it is found to stand as it stood.
//!
//! **How long the flash lasts.** An item is written when the vehicle has come to rest, when it sets off,
//! and between them at most once a minute and only where azimuth or its σ have changed: some five in
//! an hour of work. An item takes 80 bytes, so a page of 2 KiB holds 24; two pages of 10 000 erasures
//! (STM32L475 data sheet, table 59) take 480 000 items, ten years of work around the clock.

use drivers::fault::Fault;
use embassy_time::{Duration, Instant};
use orientation::keep::Keeper;
use orientation::keep::restart::{Doubt, Remembered};
use orientation::units::DEGREE;

use crate::event::Event;
use crate::ports::{HeadingStore, Observer};
use crate::shared::Shared;

/// Least time between two writings.
const PERIOD: Duration = Duration::from_secs(60);
/// Change of azimuth or σ that is worth writing, rad.
const CHANGE: f64 = 0.01 * DEGREE;
/// What is written where nothing is to be believed: its checksum is wrong.
const NOTHING: [u8; Remembered::BYTES] = [0; Remembered::BYTES];

/// What the flash holds, as far as this run knows.
pub(super) struct Memory<M> {
    store: M,
    /// What was there at the start and was not judged yet.
    found: Option<Remembered>,
    /// Azimuth and σ that are stored, rad, and since when.
    stored: Option<([f64; 2], Instant)>,
    /// Whether it has failed, which is told once.
    has_failed: bool,
}

impl<M: HeadingStore> Memory<M> {
    pub(super) fn new(store: M) -> Self {
        Self { store, found: None, stored: None, has_failed: false }
    }

    /// What it keeps it in.
    pub(super) fn store(&self) -> &M {
        &self.store
    }

    /// Looks what was kept.
    pub(super) async fn load<O: Observer>(&mut self, shared: &Shared<'_, O>) {
        match self.store.load_heading().await {
            Ok(bytes) => self.found = bytes.as_ref().and_then(|b| Remembered::from_bytes(b)),
            Err(fault) => self.fail(fault, shared),
        }
    }

    fn fail<O: Observer>(&mut self, fault: Fault, shared: &Shared<'_, O>) {
        if !core::mem::replace(&mut self.has_failed, true) {
            shared.tell(Event::HeadingNotKept(fault));
        }
    }

    /// Nothing of before the restart counts any more.
    pub(super) fn drop_found(&mut self) {
        self.found = None;
    }

    /// Judges what was kept before the restart, once the vehicle has rested for long enough; whether it
    /// is believed.
    pub(super) fn recall<O: Observer>(
        &mut self,
        keeper: &mut Keeper,
        shared: &Shared<'_, O>,
    ) -> bool {
        let Some(found) = &self.found else { return false };
        let outcome = keeper.recall(found);
        match outcome {
            Err(Doubt::NotAtRest { .. }) => return false,
            Err(doubt) => shared.tell(Event::Doubted(doubt)),
            Ok(()) => {}
        }
        self.found = None;
        outcome.is_ok()
    }

    /// Keeps the heading of a body at rest, not too often, and forgets it when the body sets off. Before
    /// what was found at the start is judged, it stays.
    pub(super) async fn keep<O: Observer>(
        &mut self,
        keeper: &Keeper,
        is_at_rest: bool,
        shared: &Shared<'_, O>,
    ) {
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

    /// Whether this is worth writing, and may be written again.
    fn is_new(&self, now: [f64; 2]) -> bool {
        let Some((then, since)) = self.stored else { return true };
        let has_changed = (0..2).any(|index| (now[index] - then[index]).abs() > CHANGE);
        has_changed && since.elapsed() >= PERIOD
    }

    async fn write<O: Observer>(
        &mut self,
        bytes: &[u8; Remembered::BYTES],
        shared: &Shared<'_, O>,
    ) {
        if let Err(fault) = self.store.save_heading(bytes).await {
            self.fail(fault, shared);
        }
    }
}
