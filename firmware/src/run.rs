//! Runs the instrument: joins its parts in fixed order, so that one seed gives the same run on
//! every machine.
//!
//! ```text
//!  acquire ─┬─ motions ──▶ operate: mechanism, navigator ◀── requests, azimuth ─┐
//!           │                       └── attitude ──▶ link                         │
//!           └─ samples ──▶ find: aligner ───────────────────────────────────────┘
//! ```
//!
//! What must not wait for the computation of a conclusion is acquisition, [`operate`] and the conversation over
//! the link; a board gives them executors of higher priority, and leaves [`find`] and [`store`] the thread. [`navigate`] is
//! all of them in one executor, beside acquisition. Acquisition never returns; [`navigate`] ends within bounded time, whatever the devices do,
//! unless it is to hold the azimuth, or to track a roll, without end.

use core::convert::Infallible;
use core::future::pending;
use core::pin::pin;

use embassy_futures::select::{select, select3};
use embassy_time::{Duration, Timer};
use orientation::alignment::Method;
use orientation::signal::Timed;

use crate::align::align;
use crate::check_ins::Part;
use crate::health::Health;
use crate::keep::{Keep, remember};
use crate::mechanism::Mechanism;
use crate::ports::{Aiding, Recorder, Store};
use crate::settings::BoardSettings;
use crate::shared::{Channels, Shared, discard};
use crate::watch::watch;

/// Runs a method from power-on to its verdict, and keeps the azimuth until the policy's duration is
/// over. Whatever the outcome, the mechanism is parked. Returns the counters of faults.
///
/// The method is the largest object in memory; the caller owns it and chooses its place.
pub async fn navigate<M: Mechanism, R: Recorder<S>, K: Keep, S: Timed>(
    mechanism: &mut M,
    method: &mut dyn Method<S>,
    keeping: K,
    aiding: &dyn Aiding,
    recorder: &mut R,
    (storing, conversing): (impl Future<Output = ()>, impl Future<Output = ()>),
    channels: &Channels<'_, S>,
) -> Health {
    let shared = &channels.shared;
    let beside = async move {
        // Each is pinned here, so that it exists in memory once.
        let finding = pin!(find(method, aiding, recorder, channels));
        let (storing, conversing) = (pin!(storing), pin!(conversing));
        select3(finding, storing, shared.checked(Part::Link, conversing)).await;
    };
    operate(mechanism, keeping, aiding, shared, (beside, discard(channels))).await;
    shared.health.get()
}

/// Serves the mechanism and keeps the attitude, until its duration or what runs `beside` ends. Then parks the
/// mechanism, while `meanwhile`, which never ends, takes the samples.
pub async fn operate<M: Mechanism, K: Keep>(
    mechanism: &mut M,
    mut keeping: K,
    aiding: &dyn Aiding,
    shared: &Shared<'_>,
    (beside, meanwhile): (impl Future<Output = ()>, impl Future<Output = ()>),
) {
    // Known before any part runs, since a method may refuse at once.
    shared.is_kept.set(keeping.is_held());
    {
        let turning = pin!(async {
            let Err(reason) = mechanism.serve().await;
            shared.without_mechanism.set(Some(reason));
            shared.fail(reason);
            mechanism.halt().await;
            pending::<Infallible>().await
        });
        let kept = pin!(keeping.keep(aiding, shared));
        // The navigator is polled last, so that it takes only what the aligner has taken.
        let turning = shared.checked(Part::Mechanism, turning);
        select3(pin!(beside), turning, shared.checked(Part::Keeper, kept)).await;
    }
    shared.checked(Part::Mechanism, pin!(mechanism.park(meanwhile))).await;
}

/// Time after which a part is polled although nothing has woken it, so that it checks in.
const CHECK_IN: Duration = Duration::from_secs(1);

/// Wakes a task without end, so that its parts check in.
pub async fn wake() -> Infallible {
    loop {
        Timer::after(CHECK_IN).await;
    }
}

/// Aligns, as often as it is ordered, without end.
pub async fn find<R: Recorder<S>, S: Timed>(
    method: &mut dyn Method<S>,
    aiding: &dyn Aiding,
    recorder: &mut R,
    channels: &Channels<'_, S>,
) {
    let shared = &channels.shared;
    shared.required.set(method.required_sigma());
    // Each part is pinned here, so that it exists in memory once.
    let aligning = pin!(align(method, aiding, recorder, channels));
    let watching = pin!(watch(shared));
    select3(shared.checked(Part::Aligner, aligning), watching, pin!(wake())).await;
}

/// Keeps in a store what is to outlast a loss of supply, without end.
pub async fn store<T: Store>(
    mut store: T,
    settings: Option<BoardSettings<'_>>,
    shared: &Shared<'_>,
) {
    let storing = pin!(remember(&mut store, settings, shared));
    select(shared.checked(Part::Store, storing), pin!(wake())).await;
}
