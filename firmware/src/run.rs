//! The whole instrument: its parts joined in fixed order, so that one seed gives one run anywhere.

use core::future::pending;

use embassy_futures::select::select4;
use embedded_io_async::Write;
use orientation::error::Refusal;
use orientation::session::Session;

use crate::acquire::Acquisition;
use crate::conduct::Conductor;
use crate::configuration::Configuration;
use crate::health::Health;
use crate::link;
use crate::ports::{Accelerometer, Actuator, Encoder, Gyro, Observer, Ports, Recorder};
use crate::shared::Shared;
use crate::stage::Stage;

/// Runs an alignment from power-on to its conclusion, which is then in the session.
///
/// The session, the greatest piece of memory, belongs to the caller, who chooses where it lies.
/// Gives what went wrong meanwhile. Ends within a bounded time, whatever the devices do: every wait inside has a limit.
pub async fn run<G, A, E, M, L, R, O>(
    mut ports: Ports<G, A, E, M, L, R, O>,
    configuration: &Configuration,
    session: &mut Session,
) -> Health
where
    G: Gyro,
    A: Accelerometer,
    E: Encoder,
    M: Actuator,
    L: Write,
    R: Recorder,
    O: Observer,
{
    let shared = &Shared::new(&ports.observer);
    let acquisition =
        Acquisition::new(ports.gyro, ports.accelerometer, ports.encoder, configuration, shared);
    let stage = Stage::new(ports.actuator, &configuration.stage, shared);
    let conductor = Conductor::new(session, ports.recorder, shared);
    select4(
        failing(acquisition.run(), shared),
        failing(stage.run(), shared),
        conductor.run(),
        link::run(&mut ports.link, shared),
    )
    .await;
    link::send(&mut ports.link, shared).await;
    shared.health.get()
}

/// A part that ends only by failing: the session is told the first reason, and it is silent.
async fn failing<O: Observer>(part: impl Future<Output = Refusal>, shared: &Shared<'_, O>) {
    let reason = part.await;
    if !shared.failure.signaled() {
        shared.failure.signal(reason);
    }
    pending().await
}
