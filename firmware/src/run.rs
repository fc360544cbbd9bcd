//! Runs the instrument: joins its parts in fixed order, so that one seed gives the same run on
//! every machine.
//!
//! Acquisition is a future of its own beside [`navigate`]. It is woken several times per sample and
//! must not wait for the computation of a conclusion, so a board may give it a task or an interrupt
//! of its own. Acquisition never returns; [`navigate`] ends within bounded time, whatever the
//! devices do, unless it is to hold the azimuth, or to track a roll, without end.

use core::future::pending;
use core::pin::{Pin, pin};

use embassy_futures::select::select5;
use embedded_io_async::Write;
use orientation::alignment::Method;
use orientation::signal::Timed;

use crate::align::align;
use crate::health::Health;
use crate::keep::Keep;
use crate::link;
use crate::mechanism::Mechanism;
use crate::ports::{Aiding, Recorder};
use crate::shared::{Channels, discard};
use crate::watch::watch;

/// Runs a method from power-on to its verdict, and keeps the azimuth until the policy's duration is
/// over. Whatever the outcome, the mechanism is parked. Returns the counters of faults.
///
/// The method is the largest object in memory; the caller owns it and chooses its place.
pub async fn navigate<M: Mechanism, L: Write, R: Recorder<S>, K: Keep, S: Timed>(
    mechanism: &mut M,
    method: &mut dyn Method<S>,
    mut keeping: K,
    aiding: &dyn Aiding,
    (link, recorder): (&mut L, &mut R),
    channels: &Channels<'_, S>,
) -> Health {
    let shared = &channels.shared;
    // Known before any part runs, since a method may refuse at once.
    shared.is_kept.set(keeping.is_held());
    {
        let turning = pin!(async {
            let Err(reason) = mechanism.serve().await;
            shared.fail(reason);
            pending::<()>().await;
        });
        let kept = pin!(keeping.keep(aiding, shared));
        join(turning, kept, link, recorder, (method, aiding), channels).await;
    }
    mechanism.park(discard(channels)).await;
    shared.health.get()
}

/// Joins the parts with the control of the mechanism and with the navigator, whose end is the end
/// of all. The kinds of mechanism and store are not part of the type, so that its code exists once.
async fn join<L: Write, R: Recorder<S>, S: Timed>(
    turning: Pin<&mut dyn Future<Output = ()>>,
    kept: Pin<&mut dyn Future<Output = ()>>,
    link: &mut L,
    recorder: &mut R,
    (method, aiding): (&mut dyn Method<S>, &dyn Aiding),
    channels: &Channels<'_, S>,
) {
    let shared = &channels.shared;
    // Each part is pinned here, so that it exists in memory once.
    let aligning = pin!(align(method, aiding, recorder, channels));
    let reporting = pin!(link::run(link, shared));
    let watching = pin!(watch(shared));
    // The navigator is polled last, so that it takes only what the aligner has taken.
    select5(aligning, turning, reporting, watching, kept).await;
}
