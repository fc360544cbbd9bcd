//! The whole instrument: its parts joined in fixed order, so that one seed gives one run anywhere.

use core::future::pending;
use core::pin::pin;

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
    ports: &mut Ports<G, A, E, M, L, R, O>,
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
    let Ports { gyro, accelerometer, encoder, actuator, link, recorder, observer } = ports;
    let shared = &Shared::new(observer);
    let mut acquisition = Acquisition::new(gyro, accelerometer, encoder, configuration, shared);
    let mut stage = Stage::new(actuator, &configuration.stage, shared);
    let mut conductor = Conductor::new(session, recorder, shared);
    // Pinned here, each part lies in memory once.
    let acquire = pin!(async { fail(acquisition.run().await, shared).await });
    let position = pin!(async { fail(stage.run().await, shared).await });
    let conduct = pin!(conductor.run());
    let tell = pin!(link::run(link, shared));
    select4(acquire, position, conduct, tell).await;
    shared.health.get()
}

/// A part has failed: the session is told the first reason, and the part is silent.
async fn fail<O: Observer>(reason: Refusal, shared: &Shared<'_, O>) {
    if !shared.failure.signaled() {
        shared.failure.signal(reason);
    }
    pending().await
}
