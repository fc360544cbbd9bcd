//! Runs the navigator beside the aligner: passes inertial samples and aiding to it, has its outputs
//! executed, and keeps its heading in flash over a loss of supply.
//!
//! The navigator takes only samples that the aligner has had the chance to take, but for those that come
//! while it computes. An azimuth belongs to the last sample of its alignment: it is handed over exactly
//! between that sample and the next, or carried on from the course that was marked there. Where the aligner
//! does not go on, as where the thread is busy or stuck, the navigator does before its queue is full; an azimuth
//! of a sample that it has left behind so is refused.
//!
//! **Endurance of the flash.** An item is written when the vehicle has come to rest, when it sets
//! off, and between them at most once a minute and only if azimuth or σ have changed: about five
//! items per hour of operation. A heading takes 96 bytes, that it is forgotten 8, and a record of
//! settings 216, so a page of 2 KiB takes 17 headings beside it and the heading that was carried along. Two
//! pages of 10 000 erase cycles (STM32L475 data sheet, table 59) take 340 000 items, about eight years of
//! continuous operation.

use core::convert::Infallible;
use core::future::pending;

use drivers::fault::Fault;
use embassy_futures::select::{Either, select};
use embassy_time::{Duration, Instant, Timer, with_timeout};
use orientation::attitude::Keeper;
use orientation::attitude::restart::Remembered;
use orientation::navigation::{Input, Motion, Navigator, Output, Policy};
use orientation::units;

use crate::event::Event;
use crate::ports::{Aiding, Store};
use crate::settings::BoardSettings;
use crate::shared::{Saving, Shared, WAITING};
use crate::storage::HEADING;

/// Longest time for which inertial samples wait in the queue, where the aligner does not say that it has had theirs: twice as
/// long as the aligner rests.
const REST: Duration = Duration::from_millis(50);
/// Time after which what has failed is tried again with the stored heading: one from before the drive must not be recalled
/// after it.
const TRIED_AGAIN: Duration = Duration::from_secs(10);
/// Time without an inertial sample after which the navigator goes by the clock, µs.
const SILENCE: u64 = 100_000;

/// What an instrument that keeps its attitude is given.
pub struct Keeping<'k> {
    /// The estimator of the attitude, which has had no sample.
    pub keeper: &'k mut Keeper,
    /// Duration, policy at stops and stated errors of the gyros.
    pub policy: Policy,
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

impl Keep for Option<Keeping<'_>> {
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

/// Keeps the attitude until its duration is over, once the store has said which heading it holds.
async fn keep(keeping: &mut Keeping<'_>, aiding: &dyn Aiding, shared: &Shared<'_>) {
    let remembered = shared.remembered.wait().await;
    let mut keeper = Navigation {
        navigator: Navigator::new(keeping.keeper, &keeping.policy),
        aiding,
        shared,
        latest: Instant::MIN,
    };
    if let Some(heading) = remembered {
        keeper.give(Input::Remembered(heading));
    }
    while !keeper.navigator.is_over() {
        select(shared.caught_up.wait(), Timer::after(rest(shared.motion_period.get()))).await;
        keeper.give(Input::Idle(shared.is_idle()));
        if shared.may_move() {
            keeper.take_moves();
            keeper.take_stated();
        }
        keeper.pass_time();
        shared.is_at_rest.set(keeper.navigator.is_at_rest);
    }
}

/// Time for which inertial samples of this period wait in the queue.
fn rest(period: Duration) -> Duration {
    REST.min(period * 2 * WAITING as u32)
}

/// The navigator with what it is given.
struct Navigation<'n, 'k> {
    navigator: Navigator<'k>,
    aiding: &'n dyn Aiding,
    shared: &'n Shared<'n>,
    /// Time at which the latest increment was taken.
    latest: Instant,
}

impl Navigation<'_, '_> {
    /// Gives the navigator an input, and executes what follows.
    fn give(&mut self, input: Input) {
        let shared = self.shared;
        shared.observer.navigates(&input);
        self.navigator.take(&input, &mut |output| execute(output, shared));
    }

    /// Gives it what is known from outside, where it wants that before an event of this time.
    fn aid(&mut self, now: units::Instant) {
        if self.navigator.wants_aiding(now) {
            self.give(Input::Aided(self.aiding.velocity(), self.aiding.azimuth()));
        }
    }

    /// Gives it an azimuth that was stated over the link, at once: the body may turn.
    fn take_stated(&mut self) {
        if let Some(azimuth) = self.shared.stated.try_take() {
            self.give(Input::Aided(self.aiding.velocity(), Some(azimuth)));
        }
    }

    /// Gives it all increments that are queued, and between them what an alignment has come to.
    fn take_moves(&mut self) {
        let shared = self.shared;
        let computing = shared.concluding.try_take();
        match shared.found.try_take() {
            Some((at, azimuth)) => self.give(Input::Found(at, azimuth)),
            None => computing.into_iter().for_each(|at| self.give(Input::Concluding(at))),
        }
        while let Ok(motion) = shared.motions.try_receive() {
            if let Motion::Moved(sample) = motion {
                self.aid(sample.time);
                self.latest = Instant::now();
            }
            self.give(Input::Motion(motion));
        }
        self.give(Input::Settled);
    }

    /// Lets time pass by the clock, where no increment comes.
    fn pass_time(&mut self) {
        if self.latest.elapsed().as_micros() >= SILENCE {
            let now = units::Instant(Instant::now().as_micros());
            let now = self.shared.clocks.instant(now);
            self.aid(now);
            self.give(Input::Passed(now));
        }
    }
}

/// Does what the console orders of a store: keeps the settings, or reads a record of the log.
async fn obey<T: Store>(
    store: &mut T,
    settings: Option<BoardSettings<'_>>,
    ordered: Either<(), u32>,
    shared: &Shared<'_>,
) {
    match (ordered, settings) {
        (Either::First(()), Some(settings)) => {
            shared.kept.signal(settings.save(store).await);
        }
        (Either::First(()), None) => {}
        (Either::Second(after), _) => shared.line.signal(store.record_after(after).await),
    }
}

/// Says which heading a store holds from before the restart, then keeps in it what the navigator saves and the console
/// orders, for ever.
pub async fn remember<T: Store>(
    store: &mut T,
    settings: Option<BoardSettings<'_>>,
    shared: &Shared<'_>,
) -> Infallible {
    let mut has_failed = false;
    let loaded = load(store).await;
    shared.remembered.signal(loaded.unwrap_or_default());
    // One that cannot be read now may be read after a drive.
    let (mut outcome, mut latest) = (loaded.map(|_| ()), Saving::Nothing);
    loop {
        if let Err(fault) = outcome
            && !core::mem::replace(&mut has_failed, true)
        {
            shared.report(Event::HeadingNotKept(fault));
        }
        let is_again = outcome.is_err();
        let saving = async {
            let saving = shared.saving.wait();
            if is_again {
                with_timeout(TRIED_AGAIN, saving).await.unwrap_or(latest)
            } else {
                saving.await
            }
        };
        let ordered = select(shared.keep.wait(), shared.wanted_line.wait());
        match select(saving, ordered).await {
            Either::First(saving) => latest = saving,
            Either::Second(ordered) => {
                obey(store, settings, ordered, shared).await;
                continue;
            }
        }
        outcome = put(store, latest, is_again).await;
    }
}

/// Keeps in a store what the navigator saves. After a failure the stored heading may be one from before a drive: it is
/// forgotten first.
async fn put<T: Store>(store: &mut T, saving: Saving, is_again: bool) -> Result<(), Fault> {
    if is_again || saving == Saving::Nothing {
        store.forget(HEADING).await?;
    }
    match saving {
        Saving::Heading(heading) => store.save(HEADING, &heading.to_bytes()).await,
        Saving::Nothing => Ok(()),
    }
}

/// Reads the heading that was stored before the restart. An item with a wrong checksum counts as
/// absent.
async fn load<T: Store>(store: &mut T) -> Result<Option<Remembered>, Fault> {
    let item = store.load::<{ Remembered::BYTES }>(HEADING).await?;
    Ok(item.as_ref().and_then(|bytes| Remembered::from_bytes(bytes)))
}

/// Executes an output of the navigator.
fn execute(output: Output, shared: &Shared<'_>) {
    match output {
        Output::Progress(progress) => shared.report(Event::Navigation(progress)),
        Output::Order(order) => shared.order_of_navigator(order),
        Output::Request(request) => shared.wanted.signal(request),
        Output::Save(remembered) => shared.saving.signal(Saving::Heading(remembered)),
        Output::Forget => shared.saving.signal(Saving::Nothing),
        Output::Report(report) => shared.observer.kept(&report),
        Output::Attitude(attitude) => {
            shared.attitude.set(Some(attitude));
            shared.looked.signal(());
        }
    }
}
