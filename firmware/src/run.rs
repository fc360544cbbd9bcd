//! The instrument: its parts joined in fixed order, so that one seed gives one run anywhere.
//!
//! Acquisition is a future of its own, beside [`run`]: it is woken several times for every sample and
//! must not wait for a conclusion, so a board may give it a task, or an interrupt, of its own. Both
//! are generic over their ports, and both end within a bounded time, whatever the devices do.

use core::future::pending;
use core::pin::{Pin, pin};

use embassy_futures::select::{select, select4};
use embedded_io_async::Write;
use orientation::device::Device;
use orientation::error::Refusal;
use orientation::session::{Session, rotating};

use crate::acquire::Acquisition;
use crate::conduct::{Conducted, Conductor, Rotating, Stepwise};
use crate::configuration::{Configuration, FramesConfiguration, TurntableConfiguration};
use crate::gimbal::Gimbal;
use crate::health::{self, Health};
use crate::link;
use crate::pointing::{FrameShafts, Shaft};
use crate::ports::{
    Accelerometer, Actuator, CalibrationStore, Encoder, Frames, Gyro, Observer, Ports, Recorder,
    Sensors,
};
use crate::shared::{LatestAngle, Shared};
use crate::stage::Stage;
use crate::steady::Base;
use crate::storage;
use crate::turntable::Turntable;

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
    let Sensors { gyro, accelerometer, encoder, base } = sensors;
    let harmonics = configuration.encoder;
    let (name, latest) = (Device::Encoder, &shared.angle);
    let shaft = Shaft::new(encoder, name, harmonics, configuration, latest, shared);
    let reason = Acquisition::new(gyro, accelerometer, shaft, base.steady(), configuration, shared)
        .run()
        .await;
    shared.fail(reason);
    pending::<()>().await;
}

/// The same for a mount with two frames, whose latest angles go to `latest`.
pub async fn acquire_frames<G, A, E, B, O>(
    sensors: &mut Sensors<G, A, Frames<E>, B>,
    configuration: &Configuration,
    frames: &FramesConfiguration,
    latest: &Frames<LatestAngle>,
    shared: &Shared<'_, O>,
) where
    G: Gyro,
    A: Accelerometer,
    E: Encoder,
    B: Base,
    O: Observer,
{
    let Sensors { gyro, accelerometer, encoder, base } = sensors;
    let shafts = FrameShafts::new(encoder, configuration, frames, latest, shared);
    let reason =
        Acquisition::new(gyro, accelerometer, shafts, base.steady(), configuration, shared)
            .run()
            .await;
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
    let turning = pin!(stage.run());
    beside(turning, link, recorder, &mut Stepwise::new(session), shared).await
}

/// The same on a platform that turns all the time. Whatever the end, the platform comes to rest.
pub async fn run_rotating<M, L, R, O>(
    ports: &mut Ports<M, L, R>,
    configuration: &TurntableConfiguration,
    session: &mut rotating::Session,
    shared: &Shared<'_, O>,
) -> Health
where
    M: Actuator,
    L: Write,
    R: Recorder,
    O: Observer,
{
    if !is_coupled(session) {
        session.handle(rotating::Event::Failed(Refusal::CouplingUnknown));
    }
    let Ports { actuator, link, recorder } = ports;
    let mut turntable = Turntable::new(actuator, configuration, shared);
    let health = {
        let turning = pin!(turntable.run());
        beside(turning, link, recorder, &mut Rotating::new(session), shared).await
    };
    // Where that fails, too, the log has the reason.
    select(turntable.rest(), discard(shared)).await;
    health
}

/// Whether a session can tell how its sensor feels the platform: one that is not flat must know it, or
/// be about to learn it.
fn is_coupled(session: &rotating::Session) -> bool {
    let setting = session.setting();
    let is_known = setting.couplings.iter().any(Option::is_some);
    setting.sensor.is_flat || session.procedure().uneven_turns > 0 || is_known
}

/// The same as [`run_rotating`], and keeps the couplings that it found. Those that were kept before must
/// be in the session already, by [`storage::prepare`].
pub async fn run_storing<M, L, R, S, O>(
    ports: &mut Ports<M, L, R>,
    configuration: &TurntableConfiguration,
    session: &mut rotating::Session,
    store: &mut S,
    shared: &Shared<'_, O>,
) -> Health
where
    M: Actuator,
    L: Write,
    R: Recorder,
    S: CalibrationStore,
    O: Observer,
{
    let health = run_rotating(ports, configuration, session, shared).await;
    select(storage::conserve(store, session, shared), discard(shared)).await;
    health
}

/// The same as [`run`] on a mount with two frames. After an azimuth it takes the gyro's axis to the vertical,
/// where it can store it.
pub async fn run_frames<M, L, R, O>(
    ports: &mut Ports<Frames<M>, L, R>,
    frames: &FramesConfiguration,
    latest: &Frames<LatestAngle>,
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
    let mut gimbal = Gimbal::new(actuator, frames, latest, shared);
    let health = {
        let turning = pin!(gimbal.run());
        beside(turning, link, recorder, &mut Stepwise::new(session), shared).await
    };
    if session.conclusion().is_some_and(|conclusion| conclusion.verdict.is_ok()) {
        // Where that fails, the log has the reason; the azimuth stands all the same.
        select(gimbal.store(), discard(shared)).await;
    }
    health
}

/// Lets samples go by.
async fn discard<O>(shared: &Shared<'_, O>) {
    loop {
        shared.samples.receive().await;
    }
}

/// Joins the parts around what turns the gyro, which ends only with a reason to end everything.
async fn beside<L, R, O>(
    turning: Pin<&mut dyn Future<Output = Refusal>>,
    link: &mut L,
    recorder: &mut R,
    session: &mut dyn Conducted<O>,
    shared: &Shared<'_, O>,
) -> Health
where
    L: Write,
    R: Recorder,
    O: Observer,
{
    let mut conductor = Conductor::new(session, recorder, shared);
    // Pinned here, each part lies in memory once.
    let conduct = pin!(conductor.run());
    let position = pin!(async {
        shared.fail(turning.await);
        pending::<()>().await;
    });
    let tell = pin!(link::run(link, shared));
    let watch = pin!(health::watch(shared));
    select4(conduct, position, tell, watch).await;
    shared.health.get()
}
