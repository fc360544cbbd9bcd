//! Runs the instrument: joins its parts in fixed order, so that one seed gives the same run on
//! every machine.
//!
//! Acquisition is a future of its own beside [`navigate`]. It is woken several times per sample and
//! must not wait for the computation of a conclusion, so a board may give it a task or an interrupt
//! of its own. All are generic over their ports. Acquisition never returns; the functions that run
//! a session end within bounded time, whatever the devices do.

use core::future::pending;
use core::pin::{Pin, pin};

use embassy_futures::select::{select3, select5};
use embedded_io_async::Write;
use orientation::signal::SpinSample;

use crate::health::{self, Health};
use crate::keep::Keep;
use crate::link;
use crate::mechanism::Mechanism;
use crate::ports::Recorder;
use crate::runner::{AlignmentSession, SessionRunner};
use crate::shared::Channels;
use crate::spin::{self, Flight};

/// Runs an alignment from power-on to its conclusion, which is then in the session, and keeps its
/// azimuth until the configured duration is over; a keeper of the unit type keeps nothing. Whatever
/// the outcome, the mechanism is parked. Returns the counters of faults.
///
/// The session is the largest object in memory; the caller owns it and chooses its place.
pub async fn navigate<M: Mechanism, L: Write, R: Recorder<S>, K: Keep, S>(
    mechanism: &mut M,
    session: &mut dyn AlignmentSession<S>,
    link: &mut L,
    recorder: &mut R,
    keeping: &mut K,
    channels: &Channels<'_, S>,
) -> Health {
    let shared = &channels.shared;
    let health = {
        let turning = pin!(async {
            let Err(reason) = mechanism.serve().await;
            shared.fail(reason);
            pending::<()>().await;
        });
        let kept = pin!(keeping.run(shared));
        join(turning, kept, link, recorder, session, channels).await
    };
    mechanism.park(discard(channels)).await;
    health
}

/// Tracks the roll of a spinning body until the duration of the flight is over or a sensor is given
/// up.
pub async fn run_spin<L: Write, R: Recorder<SpinSample>>(
    link: &mut L,
    recorder: &mut R,
    flight: &mut Flight,
    channels: &Channels<'_, SpinSample>,
) -> Health {
    let shared = &channels.shared;
    {
        let reporting = pin!(async {
            link::run(link, shared).await;
            pending::<()>().await;
        });
        let watch = pin!(health::watch(shared));
        select3(spin::follow(flight, recorder, channels), reporting, watch).await;
    }
    link::send(link, shared).await;
    shared.health.get()
}

/// Discards samples while another part finishes.
pub(crate) async fn discard<S>(channels: &Channels<'_, S>) {
    loop {
        channels.samples.receive().await;
    }
}

/// Joins the parts with the control of the mechanism and with a keeper, whose end is the end of
/// all. The kinds of mechanism and keeper are not part of the type, so that its code exists once.
async fn join<L: Write, R: Recorder<S>, S>(
    turning: Pin<&mut dyn Future<Output = ()>>,
    kept: Pin<&mut dyn Future<Output = ()>>,
    link: &mut L,
    recorder: &mut R,
    session: &mut dyn AlignmentSession<S>,
    channels: &Channels<'_, S>,
) -> Health {
    let shared = &channels.shared;
    let mut session_runner = SessionRunner::new(session, recorder, channels);
    // Each part is pinned here, so that it exists in memory once.
    let runner = pin!(session_runner.run());
    let reporting = pin!(link::run(link, shared));
    let watch = pin!(health::watch(shared));
    // The keeper is polled last, so that it takes only what the session has taken.
    select5(runner, turning, reporting, watch, kept).await;
    shared.health.get()
}
