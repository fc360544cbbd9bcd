//! Runs the aligner: passes samples to it, has its requests executed, and reports its progress.

use core::convert::Infallible;

use embassy_futures::select::{Either, select};
use embassy_time::{Duration, Timer};
use orientation::alignment::{Method, Progress, Request};
use orientation::navigation::aligner::{Input, State};
use orientation::navigation::{Aligner, Order};
use orientation::signal::Timed;

use crate::event::Event;
use crate::ports::{Aiding, Recorder};
use crate::shared::{Channels, Shared, WAITING};

/// Longest rest once the queue is empty. Samples are then taken several at a time, because waking for each would cost
/// more than processing it.
const REST: Duration = Duration::from_millis(10);
/// The same where the sensors are fixed to the body: no mechanism waits for what follows from a sample.
const LONG_REST: Duration = Duration::from_millis(20);

/// Runs alignments for ever: the first at once, others as they are ordered.
pub async fn align<R: Recorder<S>, S: Timed>(
    method: &mut dyn Method<S>,
    aiding: &dyn Aiding,
    recorder: &mut R,
    channels: &Channels<'_, S>,
) -> Infallible {
    let shared = &channels.shared;
    let mut aligner = Aligner::new(method);
    let mut request = aligner.begin(&mut listener(shared));
    loop {
        request = match request {
            Request::Compute => compute(&mut aligner, channels),
            Request::Locate => match aiding.displacement() {
                Some(place) => give(&mut aligner, Input::Displaced(place), shared),
                None => Request::Continue,
            },
            Request::Done => {
                recorder.conclude(aligner.method()).await;
                shared.conclude(aligner.hand_over());
                Request::Continue
            }
            Request::Continue | Request::MayDrive => {
                let is_homing = aligner.state == State::Homing && shared.homed.signaled();
                if let Some(sway) = shared.observed_sway().filter(|_| is_homing) {
                    let first = give(&mut aligner, Input::Homed(sway), shared);
                    if first != Request::Continue {
                        request = first;
                        continue;
                    }
                }
                match &next(channels, aligner.state != State::Homing).await {
                    Either::First(order) if shared.obey(order) => {
                        give(&mut aligner, Input::Ordered(*order), shared)
                    }
                    Either::First(_) => Request::Continue,
                    Either::Second(sample) => match aligner.state {
                        State::Homing => give(&mut aligner, Input::Passed(sample.time()), shared),
                        State::Aligning => {
                            recorder.record(sample).await;
                            aligner.sample(sample, &mut listener(shared))
                        }
                        State::Idle => Request::Continue,
                    },
                }
            }
            movement => {
                shared.wanted.signal(movement);
                Request::Continue
            }
        };
    }
}

/// Waits for an order or a sample; where there is none, notes that all were taken. The aligner may rest then.
async fn next<S>(channels: &Channels<'_, S>, may_rest: bool) -> Either<Order, S> {
    let Channels { samples, shared } = channels;
    if let Some(order) = shared.orders.try_take() {
        return Either::First(order);
    }
    if let Ok(sample) = samples.try_receive() {
        return Either::Second(sample);
    }
    shared.catch_up();
    let period = shared.period.get();
    if may_rest && period < REST {
        let longest = if shared.is_strapdown.get() { LONG_REST } else { REST };
        Timer::after(longest.min(period * WAITING as u32)).await;
    }
    select(shared.orders.take(), samples.receive()).await
}

/// Has the aligner compute what follows from the samples that it has taken. It needs no others meanwhile: they are passed
/// by and reported, and so are those that waited then, so that no gap is in what it measures next.
fn compute<S: Timed>(aligner: &mut Aligner<'_, S>, channels: &Channels<'_, S>) -> Request {
    let Channels { samples, shared } = channels;
    if let Some(taken) = aligner.taken() {
        shared.concluding.signal(taken);
    }
    let passed_by = || shared.health.get().passed_by;
    let before = passed_by();
    shared.is_computing.set(true);
    shared.caught_up.signal(());
    let request = aligner.compute(&mut listener(shared));
    shared.is_computing.set(false);
    if passed_by() > before {
        while samples.try_receive().is_ok() {
            shared.pass_by();
        }
        shared.report(Event::PassedBy(passed_by() - before));
    }
    request
}

/// Gives the aligner an input beside its samples.
fn give<S: Timed>(aligner: &mut Aligner<'_, S>, input: Input, shared: &Shared<'_>) -> Request {
    shared.observer.aligns(&input);
    aligner.take(&input, &mut listener(shared))
}

/// What the aligner reports its progress to.
fn listener(shared: &Shared<'_>) -> impl FnMut(Progress) {
    |progress| shared.progress(progress)
}
