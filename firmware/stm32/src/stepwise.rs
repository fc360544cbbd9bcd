//! Programs of the board on a stage or on two frames that stand at positions. They hold azimuth, pitch
//! and roll afterwards, by the IMU of the board on the base.

use embassy_stm32::gpio::Output;
use firmware::acquire::{acquire, on_mount};
use firmware::configuration::FramesConfiguration;
use firmware::gimbal::Gimbal;
use firmware::keep::Keeping;
use firmware::not_begun::NotBegun;
use firmware::ports::Frames;
use firmware::stage::Stage;
use firmware::sway::SwayCompensation;
use orientation::alignment::setup::SetupError;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::{Prepared, Session};
use orientation::alignment::stepwise::setting::Setting;
use static_cell::StaticCell;

use crate::ports::{AxisMotor, MountInputs};
use crate::wiring::{AxisPlatformWires, FramesWires, Link};
use crate::{
    Channels, Executors, OnBase, configuration, connected, control_motors, go_on, keeping, on_base,
    once, ports, settings, stage_acquisition,
};

/// Channels of the instrument, of which an image has one.
static CHANNELS: StaticCell<Channels> = StaticCell::new();

/// Runs the instrument on a stage: it aligns, then holds the result without end.
#[embassy_executor::task]
pub async fn on_a_stage(executors: Executors, wires: AxisPlatformWires, link: Link) {
    let channels = connected(&CHANNELS, executors, &wires.outlets, link);
    let flash = wires.outlets.flash;
    go_on(begin_on_a_stage(executors, wires, channels), flash, channels).await;
}

/// Spawns what runs above the thread; the rest is for the thread. Not inlined, so that what is made on the way is in no
/// frame of the program.
///
/// # Errors
/// Why nothing begins.
#[inline(never)]
fn begin_on_a_stage(
    executors: Executors,
    wires: AxisPlatformWires,
    channels: &'static Channels,
) -> Result<&'static mut Session, NotBegun> {
    let AxisPlatformWires { converter, accelerometer, axes, base, motor_enable, outlets } = wires;
    let settings = settings::load(&outlets, settings::stage)?;
    let clocks = channels.shared.clocks;
    let procedure = configuration::procedure(&settings, clocks);
    let session = session(configuration::setting(&settings), procedure)?;
    let encoder = ports::encoder(axes.encoder);
    let base = SwayCompensation::new(on_base(base));
    let converter = (converter, &settings.gyro);
    let inputs = ports::inputs(converter, accelerometer, encoder, base)?;
    let motor = ports::motor(axes.motor);
    executors.acquisition.spawn(once(stage_acquisition(inputs, channels)));
    let keeping = keeping(&settings, clocks);
    executors.control.spawn(once(stage(motor, motor_enable, keeping, channels)));
    Ok(session)
}

/// Motor and keeper on a stage.
#[embassy_executor::task]
async fn stage(
    mut motor: AxisMotor,
    motor_enable: Output<'static>,
    keeping: Option<Keeping<'static>>,
    channels: &'static Channels,
) {
    let shared = &channels.shared;
    let mut stage = Stage::new(&mut motor, &configuration::instrument().stage, shared);
    control_motors(&mut stage, motor_enable, keeping, shared).await;
}

/// Runs the instrument on two frames: it aligns, then holds the result without end with the sensitive
/// axis vertical.
#[embassy_executor::task]
pub async fn on_two_frames(executors: Executors, wires: FramesWires, link: Link) {
    let channels = connected(&CHANNELS, executors, &wires.outlets, link);
    let flash = wires.outlets.flash;
    go_on(begin_on_two_frames(executors, wires, channels), flash, channels).await;
}

/// Spawns what runs above the thread; the rest is for the thread. Not inlined, so that what is made on the way is in no
/// frame of the program.
///
/// # Errors
/// Why nothing begins.
#[inline(never)]
fn begin_on_two_frames(
    executors: Executors,
    wires: FramesWires,
    channels: &'static Channels,
) -> Result<&'static mut Session, NotBegun> {
    static FRAMES: StaticCell<FramesConfiguration> = StaticCell::new();
    let frames = configuration::frames()?;
    let FramesWires { converter, accelerometer, axes, base, motor_enable, outlets } = wires;
    let settings = settings::load(&outlets, settings::two_frame)?;
    let (Frames { outer, inner }, clocks) = (axes, channels.shared.clocks);
    let procedure = configuration::mount_procedure(&settings, clocks);
    let session = session(configuration::mount_setting(&settings), procedure)?;
    let frames = &*FRAMES.init(frames);
    let encoders = Frames { outer: outer.encoder, inner: inner.encoder }.map(ports::encoder);
    let base = SwayCompensation::new(on_base(base));
    let converter = (converter, &settings.gyro);
    let inputs = ports::inputs(converter, accelerometer, encoders, base)?;
    let motors = Frames { outer: outer.motor, inner: inner.motor }.map(ports::motor);
    executors.acquisition.spawn(once(mount_acquisition(inputs, frames, channels)));
    let keeping = keeping(&settings, clocks);
    executors.control.spawn(once(mount(motors, motor_enable, frames, keeping, channels)));
    Ok(session)
}

/// Acquisition on two frames.
#[embassy_executor::task]
async fn mount_acquisition(
    mut inputs: MountInputs<OnBase>,
    frames: &'static FramesConfiguration,
    channels: &'static Channels,
) {
    acquire(&mut on_mount(&mut inputs, &configuration::instrument(), frames, channels)).await;
}

/// Motors and keeper on two frames.
#[embassy_executor::task]
async fn mount(
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

/// Creates the session at its final place in memory.
///
/// # Errors
/// A procedure that is none.
fn session(setting: Setting, procedure: Procedure) -> Result<&'static mut Session, SetupError> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let prepared = Prepared::new(setting, procedure)?;
    Ok(SESSION.init_with(|| Session::from(prepared)))
}
