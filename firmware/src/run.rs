//! The instrument: its parts joined in fixed order, so that one seed gives one run anywhere.
//!
//! Acquisition is a future of its own, beside [`run`]: it is woken several times for every sample and
//! must not wait for a conclusion, so a board may give it a task, or an interrupt, of its own. Both
//! are generic over their ports, and both end within a bounded time, whatever the devices do.

use core::future::pending;
use core::pin::pin;

use embassy_futures::select::select4;
use embedded_io_async::Write;
use orientation::session::Session;

use crate::acquire::Acquisition;
use crate::conduct::Conductor;
use crate::configuration::Configuration;
use crate::health::{self, Health};
use crate::link;
use crate::ports::{Accelerometer, Actuator, Encoder, Gyro, Observer, Ports, Recorder, Sensors};
use crate::shared::Shared;
use crate::stage::Stage;
use crate::steady::Base;

/// Samples until a sensor is given up, which the session is told; never ends.
pub async fn acquire<G, A, E, B, O>(
    sensors: &mut Sensors<G, A, E, B>,
    configuration: &Configuration,
    shared: &Shared<'_, O>,
) where
    G: Gyro,
    A: Accelerometer,
    E: Encoder,
    B: Base,
    O: Observer,
{
    let reason = Acquisition::new(sensors, configuration, shared).run().await;
    shared.fail(reason);
    pending::<()>().await;
}

/// Runs an alignment from power-on to its conclusion, which is then in the session; gives what went
/// wrong meanwhile.
///
/// The session, the greatest piece of memory, belongs to the caller, who chooses where it lies.
pub async fn run<M, L, R, O>(
    ports: &mut Ports<M, L, R>,
    configuration: &Configuration,
    session: &mut Session,
    shared: &Shared<'_, O>,
) -> Health
where
    M: Actuator,
    L: Write,
    R: Recorder,
    O: Observer,
{
    let Ports { actuator, link, recorder } = ports;
    let mut stage = Stage::new(actuator, &configuration.stage, shared);
    let mut conductor = Conductor::new(session, recorder, shared);
    // Pinned here, each part lies in memory once.
    let conduct = pin!(conductor.run());
    let position = pin!(async {
        shared.fail(stage.run().await);
        pending::<()>().await;
    });
    let tell = pin!(link::run(link, shared));
    let watch = pin!(health::watch(shared));
    select4(conduct, position, tell, watch).await;
    shared.health.get()
}
