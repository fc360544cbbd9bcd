//! Runs the instrument: joins its parts in fixed order, so that one seed gives the same run on
//! every machine.
//!
//! ```text
//!  acquire ─┬─ motions ──▶ operate: mechanism, navigator ◀── requests, azimuth ─┐
//!           │                       └── attitude ──▶ link                         │
//!           └─ samples ──▶ find: aligner, store ────────────────────────────────┘
//! ```
//!
//! What must not wait for the computation of a conclusion is acquisition, [`operate`] and the [`link`]; a board gives them
//! executors of higher priority, and leaves [`find`] the thread. [`navigate`] is all of them in one executor, beside
//! acquisition. Acquisition never returns; [`navigate`] ends within bounded time, whatever the devices do,
//! unless it is to hold the azimuth, or to track a roll, without end.

use core::convert::Infallible;
use core::future::pending;
use core::pin::pin;

use embassy_futures::select::{select, select3, select4};
use embassy_time::{Duration, Timer};
use embedded_io_async::Write;
use orientation::alignment::Method;
use orientation::signal::Timed;

use crate::align::align;
use crate::check_ins::Part;
use crate::health::Health;
use crate::keep::{Keep, remember};
use crate::link;
use crate::mechanism::Mechanism;
use crate::ports::{Aiding, Recorder, Store};
use crate::shared::{Channels, Shared, discard};
use crate::watch::watch;

/// Runs a method from power-on to its verdict, and keeps the azimuth until the policy's duration is
/// over. Whatever the outcome, the mechanism is parked. Returns the counters of faults.
///
/// The method is the largest object in memory; the caller owns it and chooses its place.
pub async fn navigate<M: Mechanism, L: Write, R: Recorder<S>, T: Store, K: Keep, S: Timed>(
    mechanism: &mut M,
    method: &mut dyn Method<S>,
    keeping: K,
    aiding: &dyn Aiding,
    outside: Outside<'_, L, R, T>,
    channels: &Channels<'_, S>,
) -> Health {
    let shared = &channels.shared;
    let Outside { link, recorder, store } = outside;
    let beside = async {
        // Each is pinned here, so that it exists in memory once.
        let finding = pin!(find(method, aiding, recorder, store, channels));
        let reporting = pin!(link::run(link, shared));
        select(finding, shared.checked(Part::Link, reporting)).await;
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

/// Where results go: link, recorder, and the store of what outlasts a loss of supply.
pub struct Outside<'o, L, R, T> {
    /// Serial link.
    pub link: &'o mut L,
    /// Recorder of samples and conclusions.
    pub recorder: &'o mut R,
    /// Store of the heading.
    pub store: T,
}

/// Time after which the parts of [`find`] are polled although nothing has woken them, so that each checks in.
const CHECK_IN: Duration = Duration::from_secs(1);

/// Wakes a task without end, so that its parts check in.
pub async fn wake() -> Infallible {
    loop {
        Timer::after(CHECK_IN).await;
    }
}

/// Aligns, as often as it is ordered, and keeps what is to be saved, without end.
pub async fn find<R: Recorder<S>, T: Store, S: Timed>(
    method: &mut dyn Method<S>,
    aiding: &dyn Aiding,
    recorder: &mut R,
    mut store: T,
    channels: &Channels<'_, S>,
) {
    let shared = &channels.shared;
    shared.required.set(method.required_sigma());
    // Each part is pinned here, so that it exists in memory once.
    let aligning = pin!(align(method, aiding, recorder, channels));
    let watching = pin!(watch(shared));
    let storing = pin!(remember(&mut store, shared));
    let aligning = shared.checked(Part::Aligner, aligning);
    let storing = shared.checked(Part::Store, storing);
    select4(aligning, watching, storing, pin!(wake())).await;
}
