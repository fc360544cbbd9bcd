//! The instrument: its parts joined in fixed order, so that one seed gives one run anywhere.
//!
//! Acquisition is a future of its own, beside [`run`]: it is woken several times for every sample and
//! must not wait for a conclusion, so a board may give it a task, or an interrupt, of its own. Both
//! are generic over their ports, and both end within a bounded time, whatever the devices do.

use core::future::pending;
use core::pin::{Pin, pin};

use embassy_futures::select::{select, select3, select5};
use embedded_io_async::Write;
use orientation::device::Device;
use orientation::error::Refusal;
use orientation::session::{Session, rotating, stops};
use orientation::signal::{InertialSample, SpinSample};

use crate::acquire::{Acquisition, SpinAcquisition, TriadAcquisition};
use crate::configuration::{
    Configuration, FramesConfiguration, TurntableConfiguration, VehicleConfiguration,
};
use crate::gimbal::Gimbal;
use crate::health::{self, Health};
use crate::keep::Keep;
use crate::link;
use crate::pointing::{FrameShafts, Shaft};
use crate::ports::{
    Accelerometer, Actuator, CalibrationStore, Code, Encoder, Frames, Gyro, InStep, Observer,
    Ports, PositionAiding, Recorder, Sensors, SpinPorts, SpinSensors, VehiclePorts, VehicleSensors,
};
use crate::runner::{AlignmentSession, Rotating, SessionRunner, Stepwise, Stops};
use crate::shared::{Channels, LatestAngle};
use crate::spin::configuration::SpinConfiguration;
use crate::spin::{self, Flight};
use crate::stage::Stage;
use crate::steady::Base;
use crate::storage;
use crate::turntable::Turntable;

/// Samples until a sensor is given up, which the session is told; where an azimuth is kept, tries again
/// later. Never ends.
pub async fn acquire<G, A, E, B, O>(
    sensors: &mut Sensors<G, A, E, B>,
    configuration: &Configuration,
    channels: &Channels<'_, O>,
) where
    G: Gyro,
    A: Accelerometer,
    E: Encoder,
    B: Base,
    O: Observer,
{
    let Sensors { gyro, accelerometer, encoder, base } = sensors;
    let harmonics = configuration.encoder;
    let (shared, latest) = (&channels.shared, &channels.shared.angle);
    let shaft = Shaft::new(encoder, Device::Encoder, harmonics, configuration, latest, shared);
    let steady = base.steady();
    Acquisition::new(gyro, accelerometer, shaft, steady, configuration, channels)
        .run_for_ever()
        .await;
}

/// The same for a mount with two frames, whose latest angles go to `latest`.
pub async fn acquire_frames<G, A, E, B, O>(
    sensors: &mut Sensors<G, A, Frames<E>, B>,
    configuration: &Configuration,
    frames: &FramesConfiguration,
    latest: &Frames<LatestAngle>,
    channels: &Channels<'_, O>,
) where
    G: Gyro,
    A: Accelerometer,
    E: Encoder,
    B: Base,
    O: Observer,
{
    let Sensors { gyro, accelerometer, encoder, base } = sensors;
    let shafts = FrameShafts::new(encoder, configuration, frames, latest, &channels.shared);
    let steady = base.steady();
    Acquisition::new(gyro, accelerometer, shafts, steady, configuration, channels)
        .run_for_ever()
        .await;
}

/// The same for sensors that are fixed to a vehicle.
pub async fn acquire_triad<G, A, O>(
    sensors: &mut VehicleSensors<G, A>,
    configuration: &VehicleConfiguration,
    channels: &Channels<'_, O, InertialSample>,
) where
    G: InStep,
    A: Accelerometer,
    O: Observer,
{
    TriadAcquisition::new(sensors, configuration, channels).run_for_ever().await;
}

/// The same for sensors that are fixed to a spinning body.
pub async fn acquire_spin<C, O>(
    sensors: &mut SpinSensors<C>,
    configuration: &SpinConfiguration,
    channels: &Channels<'_, O, SpinSample>,
) where
    C: InStep<Code>,
    O: Observer,
{
    let reason = SpinAcquisition::new(sensors, configuration, channels).run().await;
    channels.shared.fail(reason);
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
    channels: &Channels<'_, O>,
) -> Health
where
    M: Actuator,
    L: Write,
    R: Recorder,
    O: Observer,
{
    run_and_keep(ports, configuration, session, &mut (), channels).await
}

/// The same, and goes on keeping what was found.
pub async fn run_and_keep<M, L, R, K, O>(
    ports: &mut Ports<M, L, R>,
    configuration: &Configuration,
    session: &mut Session,
    keeping: &mut K,
    channels: &Channels<'_, O>,
) -> Health
where
    M: Actuator,
    L: Write,
    R: Recorder,
    K: Keep,
    O: Observer,
{
    let Ports { actuator, link, recorder } = ports;
    let mut stage = Stage::new(actuator, &configuration.stage, &channels.shared);
    let turning = pin!(stage.run());
    let kept = pin!(keeping.run(&channels.shared));
    keep_beside(turning, kept, link, recorder, &mut Stepwise::new(session), channels).await
}

/// The same on a platform that turns all the time. Whatever the end, the platform comes to rest.
pub async fn run_rotating<M, L, R, O>(
    ports: &mut Ports<M, L, R>,
    configuration: &TurntableConfiguration,
    session: &mut rotating::Session,
    channels: &Channels<'_, O>,
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
    let mut turntable = Turntable::new(actuator, configuration, &channels.shared);
    let health = {
        let turning = pin!(turntable.run());
        beside(turning, link, recorder, &mut Rotating::new(session), channels).await
    };
    // Where that fails, too, the log has the reason.
    select(turntable.rest(), discard(channels)).await;
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
/// be in the session already, by [`storage::load_calibration`].
pub async fn run_storing<M, L, R, S, O>(
    ports: &mut Ports<M, L, R>,
    configuration: &TurntableConfiguration,
    session: &mut rotating::Session,
    store: &mut S,
    channels: &Channels<'_, O>,
) -> Health
where
    M: Actuator,
    L: Write,
    R: Recorder,
    S: CalibrationStore,
    O: Observer,
{
    let health = run_rotating(ports, configuration, session, channels).await;
    select(storage::save_calibration(store, session, &channels.shared), discard(channels)).await;
    health
}

/// The same as [`run`] on a mount with two frames. After an azimuth it takes the gyro's axis to the vertical,
/// where it can store it.
pub async fn run_frames<M, L, R, O>(
    ports: &mut Ports<Frames<M>, L, R>,
    frames: &FramesConfiguration,
    latest: &Frames<LatestAngle>,
    session: &mut Session,
    channels: &Channels<'_, O>,
) -> Health
where
    M: Actuator,
    L: Write,
    R: Recorder,
    O: Observer,
{
    run_frames_and_keep(ports, frames, latest, session, &mut (), channels).await
}

/// The same, and goes on keeping what was found, by the precise gyro once its axis is vertical.
pub async fn run_frames_and_keep<M, L, R, K, O>(
    ports: &mut Ports<Frames<M>, L, R>,
    frames: &FramesConfiguration,
    latest: &Frames<LatestAngle>,
    session: &mut Session,
    keeping: &mut K,
    channels: &Channels<'_, O>,
) -> Health
where
    M: Actuator,
    L: Write,
    R: Recorder,
    K: Keep,
    O: Observer,
{
    let Ports { actuator, link, recorder } = ports;
    let mut gimbal = Gimbal::new(actuator, frames, latest, &channels.shared);
    let health = {
        let turning = pin!(gimbal.run());
        let kept = pin!(keeping.run(&channels.shared));
        keep_beside(turning, kept, link, recorder, &mut Stepwise::new(session), channels).await
    };
    if channels.shared.keep.is_wanted.get() {
        return health;
    }
    if session.conclusion().is_some_and(|conclusion| conclusion.verdict.is_ok()) {
        // Where that fails, the log has the reason; the azimuth stands all the same.
        select(gimbal.store(), discard(channels)).await;
    }
    health
}

/// The same as [`run`] in a vehicle that somebody drives from stop to stop, when link and log say so.
pub async fn run_stops<W, L, R, O>(
    ports: &mut VehiclePorts<W, L, R>,
    session: &mut stops::Session,
    channels: &Channels<'_, O, InertialSample>,
) -> Health
where
    W: PositionAiding,
    L: Write,
    R: Recorder<InertialSample>,
    O: Observer,
{
    run_stops_and_keep(ports, session, &mut (), channels).await
}

/// The same, and goes on keeping what was found.
pub async fn run_stops_and_keep<W, L, R, K, O>(
    ports: &mut VehiclePorts<W, L, R>,
    session: &mut stops::Session,
    keeping: &mut K,
    channels: &Channels<'_, O, InertialSample>,
) -> Health
where
    W: PositionAiding,
    L: Write,
    R: Recorder<InertialSample>,
    K: Keep,
    O: Observer,
{
    let VehiclePorts { position_aiding, link, recorder } = ports;
    // There is no angle to find first, and nothing to turn.
    channels.shared.homed.signal(());
    let still = pin!(pending());
    let kept = pin!(keeping.run(&channels.shared));
    let mut session = Stops::new(session, position_aiding);
    keep_beside(still, kept, link, recorder, &mut session, channels).await
}

/// Follows the roll of a spinning body until the flight's time is over, or a sensor is given up.
pub async fn run_spin<L, R, O>(
    ports: &mut SpinPorts<L, R>,
    flight: &mut Flight,
    channels: &Channels<'_, O, SpinSample>,
) -> Health
where
    L: Write,
    R: Recorder<SpinSample>,
    O: Observer,
{
    let (SpinPorts { link, recorder }, shared) = (ports, &channels.shared);
    {
        let tell = pin!(async {
            link::run(link, shared).await;
            pending::<()>().await;
        });
        let watch = pin!(health::watch(shared));
        select3(spin::follow(flight, recorder, channels), tell, watch).await;
    }
    link::send(link, shared).await;
    shared.health.get()
}

/// Lets samples go by.
async fn discard<O, S>(channels: &Channels<'_, O, S>) {
    loop {
        channels.samples.receive().await;
    }
}

/// Joins the parts around what turns the gyro, which ends only with a reason to end everything.
async fn beside<L, R, O, S>(
    turning: Pin<&mut dyn Future<Output = Refusal>>,
    link: &mut L,
    recorder: &mut R,
    session: &mut dyn AlignmentSession<O, S>,
    channels: &Channels<'_, O, S>,
) -> Health
where
    L: Write,
    R: Recorder<S>,
    O: Observer,
{
    keep_beside(turning, pin!(pending()), link, recorder, session, channels).await
}

/// The same with what keeps, whose end is that of everything.
async fn keep_beside<L, R, O, S>(
    turning: Pin<&mut dyn Future<Output = Refusal>>,
    kept: Pin<&mut dyn Future<Output = ()>>,
    link: &mut L,
    recorder: &mut R,
    session: &mut dyn AlignmentSession<O, S>,
    channels: &Channels<'_, O, S>,
) -> Health
where
    L: Write,
    R: Recorder<S>,
    O: Observer,
{
    let shared = &channels.shared;
    let mut conductor = SessionRunner::new(session, recorder, channels);
    // Pinned here, each part lies in memory once.
    let runner = pin!(conductor.run());
    let position = pin!(async {
        shared.fail(turning.await);
        pending::<()>().await;
    });
    let tell = pin!(link::run(link, shared));
    let watch = pin!(health::watch(shared));
    // The keeper comes last: it takes what the session has taken.
    select5(runner, position, tell, watch, kept).await;
    shared.health.get()
}
