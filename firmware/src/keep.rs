//! Runs the navigator beside the aligner: passes inertial samples and aiding to it, has its outputs
//! executed, and keeps its heading in flash over a loss of supply.
//!
//! The navigator never runs ahead of the aligner: it takes only samples that the aligner has had
//! the chance to take. An azimuth belongs to the last sample of its alignment, so it is handed over
//! exactly between that sample and the next.
//!
//! **Endurance of the flash.** An item is written when the vehicle has come to rest, when it sets
//! off, and between them at most once a minute and only if azimuth or σ have changed: about five
//! items per hour of operation. An item takes 88 bytes and a record of settings 208, so a page of 2 KiB
//! holds 20 beside it. Two pages of 10 000 erase cycles (STM32L475 data sheet, table 59) take 400 000
//! items, about nine years of continuous operation.

use core::cell::Cell;
use core::future::pending;

use drivers::fault::Fault;
use embassy_futures::select::select;
use embassy_time::{Duration, Instant, Timer};
use orientation::attitude::Keeper;
use orientation::attitude::restart::Remembered;
use orientation::navigation::{Input, Motion, Navigator, Output, Policy};
use orientation::units;

use crate::event::Event;
use crate::ports::{Aiding, Store};
use crate::shared::Shared;
use crate::storage::HEADING;

/// Longest time for which inertial samples wait in the queue: half of the queue's capacity at 2
/// kHz.
const REST: Duration = Duration::from_millis(4);
/// Time without an inertial sample after which the navigator goes by the clock, µs.
const SILENCE: u64 = 100_000;
/// The item that invalidates the stored heading: its checksum is wrong.
const NOTHING: [u8; Remembered::BYTES] = [0; Remembered::BYTES];

/// What an instrument that keeps its attitude is given.
pub struct Keeping<'k, T> {
    /// The estimator of the attitude, which has had no sample.
    pub keeper: &'k mut Keeper,
    /// Duration, policy at stops and stated errors of the gyros.
    pub policy: Policy,
    /// Store of the heading over a loss of supply.
    pub store: T,
}

/// What an instrument does with its azimuth after the alignment.
pub trait Keep {
    /// Whether an attitude is kept at all.
    fn is_held(&self) -> bool;

    /// Keeps the attitude until its duration is over; never returns if nothing is kept.
    async fn keep(&mut self, aiding: &dyn Aiding, shared: &Shared<'_>);
}

/// An instrument without inertial sensors beside its precise gyro keeps no attitude, and contains no
/// code for it.
#[derive(Clone, Copy, Debug)]
pub struct NotKept;

impl Keep for NotKept {
    fn is_held(&self) -> bool {
        false
    }

    async fn keep(&mut self, _: &dyn Aiding, _: &Shared<'_>) {
        pending::<()>().await;
    }
}

impl<T: Store> Keep for Option<Keeping<'_, T>> {
    fn is_held(&self) -> bool {
        self.as_ref().is_some_and(|keeping| keeping.policy.holds())
    }

    async fn keep(&mut self, aiding: &dyn Aiding, shared: &Shared<'_>) {
        match self.as_mut().filter(|keeping| keeping.policy.holds()) {
            Some(keeping) => keep(keeping, aiding, shared).await,
            None => pending().await,
        }
    }
}

/// Keeps the attitude until its duration is over.
async fn keep<T: Store>(keeping: &mut Keeping<'_, T>, aiding: &dyn Aiding, shared: &Shared<'_>) {
    let Keeping { keeper, policy, store } = keeping;
    let mut has_failed = false;
    let loaded = load(store).await;
    let to_save = Cell::new(None);
    let mut navigator = Navigator::new(keeper, policy);
    let give = |navigator: &mut Navigator, input: Input| {
        shared.observer.navigates(&input);
        navigator.take(&input, &mut |output| execute(output, &to_save, shared));
    };
    match loaded {
        Ok(Some(heading)) => give(&mut navigator, Input::Remembered(heading)),
        Ok(None) => {}
        Err(fault) => fail(fault, &mut has_failed, shared),
    }
    let mut latest = Instant::MIN;
    while !navigator.is_over() {
        select(shared.caught_up.wait(), Timer::after(REST)).await;
        give(&mut navigator, Input::Idle(shared.is_idle()));
        if !shared.is_behind.get() {
            if let Some((at, azimuth)) = shared.found.try_take() {
                give(&mut navigator, Input::Found(at, azimuth));
            }
            while let Ok(motion) = shared.motions.try_receive() {
                if let Motion::Moved(sample) = motion {
                    if navigator.wants_aiding(sample.time) {
                        give(&mut navigator, aided(aiding));
                    }
                    latest = Instant::now();
                }
                give(&mut navigator, Input::Motion(motion));
            }
            give(&mut navigator, Input::Settled);
        }
        if latest.elapsed().as_micros() >= SILENCE {
            let now = units::Instant(Instant::now().as_micros());
            if navigator.wants_aiding(now) {
                give(&mut navigator, aided(aiding));
            }
            give(&mut navigator, Input::Passed(now));
        }
        shared.is_at_rest.set(navigator.is_at_rest);
        if let Some(item) = to_save.take()
            && let Err(fault) = store.save(HEADING, &item).await
        {
            fail(fault, &mut has_failed, shared);
        }
    }
}

/// What is known from outside at this moment.
fn aided(aiding: &dyn Aiding) -> Input {
    Input::Aided(aiding.velocity(), aiding.azimuth())
}

/// Reads the heading that was stored before the restart. An item with a wrong checksum counts as
/// absent.
async fn load<T: Store>(store: &mut T) -> Result<Option<Remembered>, Fault> {
    let item = store.load::<{ Remembered::BYTES }>(HEADING).await?;
    Ok(item.as_ref().and_then(|bytes| Remembered::from_bytes(bytes)))
}

/// Reports the first failure of the store.
fn fail(fault: Fault, has_failed: &mut bool, shared: &Shared<'_>) {
    if !core::mem::replace(has_failed, true) {
        shared.report(Event::HeadingNotKept(fault));
    }
}

/// Executes an output of the navigator; an item to be saved is noted.
fn execute(output: Output, to_save: &Cell<Option<[u8; Remembered::BYTES]>>, shared: &Shared<'_>) {
    match output {
        Output::Progress(progress) => shared.report(Event::Navigation(progress)),
        Output::Order(order) => shared.order(order),
        Output::Request(request) => shared.wanted.signal(request),
        Output::Save(remembered) => to_save.set(Some(remembered.to_bytes())),
        Output::Forget => to_save.set(Some(NOTHING)),
        Output::Report(report, attitude) => {
            shared.observer.kept(&report);
            if let Some(attitude) = attitude {
                shared.status.set((&attitude).into());
            }
        }
    }
}
