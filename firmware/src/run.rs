//! Runs the instrument: joins its parts in fixed order, so that one seed gives the same run on
//! every machine.
//!
//! Acquisition is a future of its own beside [`run`]. It is woken several times per sample and must
//! not wait for the computation of a conclusion, so a board may give it a task or an interrupt of
//! its own. All are generic over their ports. Acquisition never returns; the functions that run a
//! session end within bounded time, whatever the devices do.

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

/// Acquires samples on a stage until a sensor is given up, and ends the session then. While an
/// azimuth is kept, tries again later. Never returns.
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

/// Acquires samples on a two-frame mount, as [`acquire`] does on a stage; the latest frame angles
/// are written to `latest`.
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

/// Acquires samples in a vehicle from three gyros and an accelerometer fixed to the body. Never
/// returns.
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

/// Acquires samples on a spinning body until a sensor is given up, and ends the session then. Never
/// returns.
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

/// Runs a multi-position alignment from power-on to its conclusion, which is then in the session;
/// returns the counters of faults.
///
/// The session is the largest object in memory; the caller owns it and chooses its place.
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

/// Runs a multi-position alignment and then keeps its azimuth until the configured duration is
/// over.
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

/// Runs an alignment by continuous rotation to its conclusion. Whatever the outcome, the platform
/// comes to rest.
///
/// A sensor whose axis misalignment matters but is unknown is refused with
/// [`Refusal::CouplingUnknown`].
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
    // If the stop fails as well, the log has the reason.
    select(turntable.rest(), discard(channels)).await;
    health
}

/// Whether the session knows the axis misalignment, or needs none: it is negligible by the sensor's
/// statement, will be estimated by rate-modulated turns, or is known from a calibration.
fn is_coupled(session: &rotating::Session) -> bool {
    let setting = session.setting();
    let is_known = setting.couplings.iter().any(Option::is_some);
    setting.sensor.is_flat || session.procedure().uneven_turns > 0 || is_known
}

/// Runs an alignment by continuous rotation and stores the axis misalignments that it found. Those
/// stored before must be in the session already, by [`storage::load_calibration`].
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

/// Runs a multi-position alignment on a two-frame mount. After an azimuth was found, the gyro's
/// sensitive axis is set vertical, where it can hold the azimuth.
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

/// Runs a multi-position alignment on a two-frame mount and then keeps its azimuth by the precise
/// gyro, whose axis is set vertical.
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
        // If this fails, the log has the reason; the azimuth is valid nevertheless.
        select(gimbal.store(), discard(channels)).await;
    }
    health
}

/// Runs an inertial-frame alignment in a vehicle, which is driven from stop to stop as link and log
/// request.
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

/// Runs an inertial-frame alignment in a vehicle and then keeps its azimuth until the configured
/// duration is over.
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
    // There is no index to find, and nothing to turn.
    channels.shared.homed.signal(());
    let still = pin!(pending());
    let kept = pin!(keeping.run(&channels.shared));
    let mut session = Stops::new(session, position_aiding);
    keep_beside(still, kept, link, recorder, &mut session, channels).await
}

/// Tracks the roll of a spinning body until the duration of the flight is over or a sensor is given
/// up.
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

/// Discards samples while another part finishes.
async fn discard<O, S>(channels: &Channels<'_, O, S>) {
    loop {
        channels.samples.receive().await;
    }
}

/// Joins the parts with the control of the motor, which returns only to end the session.
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

/// Joins the parts with the control of the motor and with a keeper, whose end is the end of all.
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
    // Each part is pinned here, so that it exists in memory once.
    let runner = pin!(conductor.run());
    let position = pin!(async {
        shared.fail(turning.await);
        pending::<()>().await;
    });
    let tell = pin!(link::run(link, shared));
    let watch = pin!(health::watch(shared));
    // The keeper is polled last, so that it takes only what the session has taken.
    select5(runner, position, tell, watch, kept).await;
    shared.health.get()
}
