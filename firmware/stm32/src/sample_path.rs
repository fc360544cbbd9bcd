//! The tasks of the sample path: each carrier's acquisition, and what its motions go to.

use core::future::pending;

use embassy_futures::join::join;
use embassy_futures::select::select;
use embassy_stm32::gpio::Output;
use firmware::acquire::{
    SpinAcquisition, TriadAcquisition, acquire, on_mount, on_stage as stage_acquisition,
};
use firmware::calibration::Harmonics;
use firmware::configuration::{FramesConfiguration, StageConfiguration, TurntableConfiguration};
use firmware::gimbal::Gimbal;
use firmware::keep::{Keep, Keeping};
use firmware::mechanism::{Mechanism, Strapdown};
use firmware::ports::Frames;
use firmware::ports::NoRecorder;
use firmware::run::{find, operate, wake};
use firmware::shared::Shared;
use firmware::spin::configuration::SpinConfiguration;
use firmware::stage::Stage;
use firmware::storage::{CalibrationStore, SharedStore};
use firmware::turntable::Turntable;
use orientation::alignment::{rotating, stepwise, stops};
use orientation::roll::Flight;
use orientation::signal::{InertialSample, Sample, SpinSample};

use crate::configuration;
use crate::flash::Archive;
use crate::ports::{AxisMotor, Inputs, MountInputs, OnBase, Spinning, Triad};

/// The channels between the instrument's parts.
pub type Channels<S = Sample> = firmware::shared::Channels<'static, S>;

/// Acquires samples on a stage or a turntable for ever.
#[embassy_executor::task]
pub async fn acquire_on_axis(
    mut inputs: Inputs<OnBase>,
    encoder: Harmonics,
    channels: &'static Channels,
) {
    let instrument = configuration::instrument(encoder);
    acquire(&mut stage_acquisition(&mut inputs, &instrument, channels)).await;
}

/// Acquires samples on two frames for ever.
#[embassy_executor::task]
pub async fn acquire_on_frames(
    mut inputs: MountInputs<OnBase>,
    frames: &'static FramesConfiguration,
    channels: &'static Channels,
) {
    let instrument = configuration::instrument(frames.encoders.outer);
    acquire(&mut on_mount(&mut inputs, &instrument, frames, channels)).await;
}

/// Acquires samples in a vehicle for ever.
#[embassy_executor::task]
pub async fn acquire_in_vehicle(mut sensors: Triad, channels: &'static Channels<InertialSample>) {
    let configuration = configuration::vehicle();
    acquire(&mut TriadAcquisition::new(&mut sensors, &configuration, channels)).await;
}

/// Acquires samples on a spinning body for ever.
#[embassy_executor::task]
pub async fn acquire_on_spinning_body(
    mut sensors: Spinning,
    configuration: SpinConfiguration,
    channels: &'static Channels<SpinSample>,
) {
    acquire(&mut SpinAcquisition::new(&mut sensors, &configuration, channels)).await;
}

/// Aligns on a stage or two frames, for ever.
#[embassy_executor::task]
pub async fn find_on_positions(
    session: &'static mut stepwise::session::Session,
    channels: &'static Channels,
) {
    find(session, &(), &mut NoRecorder, channels).await;
}

/// Aligns on a rotating platform, for ever, and keeps the axis misalignments that are found.
#[embassy_executor::task]
pub async fn find_on_turntable(
    session: &'static mut rotating::session::Session,
    store: &'static SharedStore<Archive>,
    channels: &'static Channels,
) {
    find(session, &(), &mut CalibrationStore { store, channels }, channels).await;
}

/// Aligns in a vehicle, for ever.
#[embassy_executor::task]
pub async fn find_in_vehicle(
    session: &'static mut stops::session::Session,
    channels: &'static Channels<InertialSample>,
) {
    find(session, &(), &mut NoRecorder, channels).await;
}

/// Follows the roll of a spinning body, for ever.
#[embassy_executor::task]
pub async fn find_on_spinning_body(
    flight: &'static mut Flight,
    channels: &'static Channels<SpinSample>,
) {
    find(flight, &(), &mut NoRecorder, channels).await;
}

/// Serves the motor of a stage and keeps the attitude of its base, for ever.
#[embassy_executor::task]
pub async fn operate_stage(
    mut motor: AxisMotor,
    motor_enable: Output<'static>,
    keeping: Option<Keeping<'static>>,
    channels: &'static Channels,
) {
    let shared = &channels.shared;
    let mut stage = Stage::new(&mut motor, &StageConfiguration::default(), shared);
    control_motors(&mut stage, motor_enable, keeping, shared).await;
}

/// Serves the motor of a rotating platform and keeps the attitude of its base, for ever.
#[embassy_executor::task]
pub async fn operate_turntable(
    mut motor: AxisMotor,
    tolerances: TurntableConfiguration,
    motor_enable: Output<'static>,
    keeping: Option<Keeping<'static>>,
    channels: &'static Channels,
) {
    let shared = &channels.shared;
    let mut platform = Turntable::new(&mut motor, &tolerances, shared);
    control_motors(&mut platform, motor_enable, keeping, shared).await;
}

/// Serves the motors of two frames and keeps the attitude of their base, for ever.
#[embassy_executor::task]
pub async fn operate_frames(
    mut motors: Frames<AxisMotor>,
    motor_enable: Output<'static>,
    frames: &'static FramesConfiguration,
    keeping: Option<Keeping<'static>>,
    channels: &'static Channels,
) {
    let shared = &channels.shared;
    let mut mount = Gimbal::new(&mut motors, frames, shared);
    control_motors(&mut mount, motor_enable, keeping, shared).await;
}

/// Keeps the attitude of a vehicle, for ever.
#[embassy_executor::task]
pub async fn keep_vehicle(
    keeping: Option<Keeping<'static>>,
    channels: &'static Channels<InertialSample>,
) {
    let shared = &channels.shared;
    control(&mut Strapdown::new(shared), keeping, shared).await;
}

/// Serves the mechanism and keeps the attitude, for ever.
async fn control(mechanism: &mut impl Mechanism, keeping: impl Keep, shared: &Shared<'static>) {
    let until = (wait(shared), pending());
    operate(mechanism, keeping, &(), shared, until).await;
    pending::<()>().await;
}

/// Serves a mechanism with motors and keeps the attitude, for ever; gives the motors their current once all rest, and
/// takes it away where one cannot be brought to rest.
async fn control_motors(
    mechanism: &mut impl Mechanism,
    mut motor_enable: Output<'static>,
    keeping: impl Keep,
    shared: &Shared<'static>,
) {
    let switching = async {
        loop {
            // Active low.
            motor_enable.set_level((!shared.current.wait().await).into());
        }
    };
    join(control(mechanism, keeping, shared), switching).await;
}

/// Waits for the end of all. Once a second the parts beside it are woken, to check in.
async fn wait(shared: &Shared<'static>) {
    select(shared.over.wait(), wake()).await;
}
