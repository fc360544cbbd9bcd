//! Programs of the board on a stage or on two frames that stand at positions. They hold azimuth, pitch
//! and roll afterwards, by the IMU of the board on the base.

use firmware::configuration::FramesConfiguration;
use firmware::not_begun::NotBegun;
use firmware::ports::Frames;
use firmware::settings::{StageSchedule, TwoFrameSchedule};
use firmware::sway::SwayCompensation;
use orientation::alignment::setup::SetupError;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::{Prepared, Session};
use orientation::alignment::stepwise::setting::Setting;
use orientation::signal::Sample;
use static_cell::StaticCell;

use stm32::link::Link;
use stm32::sample_path::{
    Channels, acquire_on_axis, acquire_on_frames, find_on_positions, operate_frames, operate_stage,
};
use stm32::wiring::{AxisPlatformWires, FramesWires};
use stm32::{once, ports};

use crate::{Executors, Initial, Instrument, Statics, keeping, methods, on_base};

/// Runs the instrument on a stage: it aligns, then holds the result without end.
#[embassy_executor::task]
pub async fn on_a_stage(executors: Executors, wires: AxisPlatformWires, link: Link) {
    static STATICS: Statics<Sample, StageSchedule> = Statics::new();
    let instrument = Instrument::new(&STATICS, &wires.outlets);
    let initial = instrument.until_begin(executors, link).await;
    let begin = |initial| begin_on_a_stage(executors, wires, instrument.channels, initial);
    instrument.tell(initial.and_then(begin));
}

/// Spawns the tasks of the sample path, of all priorities. Not inlined, so that what is made on the way is in no
/// frame of the program.
///
/// # Errors
/// Why nothing begins.
#[inline(never)]
fn begin_on_a_stage(
    executors: Executors,
    wires: AxisPlatformWires,
    channels: &'static Channels,
    (settings, latitude): Initial<StageSchedule>,
) -> Result<(), NotBegun> {
    let settings = &*settings;
    let AxisPlatformWires { converter, accelerometer, axes, base, motor_enable, .. } = wires;
    let latitude = latitude.ok_or(NotBegun::NoLatitude)?;
    let clocks = channels.shared.clocks;
    let procedure = methods::procedure(settings, clocks);
    let session = session(methods::setting(settings, latitude), procedure)?;
    let encoder = ports::encoder(axes.encoder);
    let base = SwayCompensation::new(on_base(base));
    let converter = (converter, &settings.gyro);
    let inputs = ports::inputs(converter, accelerometer, encoder, base)?;
    let motor = ports::motor(axes.motor);
    let encoder = settings.calibration.encoder;
    executors.acquisition.spawn(once(acquire_on_axis(inputs, encoder, channels)));
    let keeping = keeping(settings, latitude, clocks);
    executors.control.spawn(once(operate_stage(motor, motor_enable, keeping, channels)));
    executors.thread.spawn(once(find_on_positions(session, channels)));
    Ok(())
}

/// Runs the instrument on two frames: it aligns, then holds the result without end with the sensitive
/// axis vertical.
#[embassy_executor::task]
pub async fn on_two_frames(executors: Executors, wires: FramesWires, link: Link) {
    static STATICS: Statics<Sample, TwoFrameSchedule> = Statics::new();
    let instrument = Instrument::new(&STATICS, &wires.outlets);
    let initial = instrument.until_begin(executors, link).await;
    let begin = |initial| begin_on_two_frames(executors, wires, instrument.channels, initial);
    instrument.tell(initial.and_then(begin));
}

/// Spawns the tasks of the sample path, of all priorities. Not inlined, so that what is made on the way is in no
/// frame of the program.
///
/// # Errors
/// Why nothing begins.
#[inline(never)]
fn begin_on_two_frames(
    executors: Executors,
    wires: FramesWires,
    channels: &'static Channels,
    (settings, latitude): Initial<TwoFrameSchedule>,
) -> Result<(), NotBegun> {
    static FRAMES: StaticCell<FramesConfiguration> = StaticCell::new();
    let settings = &*settings;
    let FramesWires { converter, accelerometer, axes, base, motor_enable, .. } = wires;
    let latitude = latitude.ok_or(NotBegun::NoLatitude)?;
    let frames = methods::frames(settings)?;
    let (Frames { outer, inner }, clocks) = (axes, channels.shared.clocks);
    let procedure = methods::mount_procedure(settings, clocks);
    let session = session(methods::mount_setting(settings, latitude), procedure)?;
    let frames = &*FRAMES.init(frames);
    let encoders = Frames { outer: outer.encoder, inner: inner.encoder }.map(ports::encoder);
    let base = SwayCompensation::new(on_base(base));
    let converter = (converter, &settings.gyro);
    let inputs = ports::inputs(converter, accelerometer, encoders, base)?;
    let motors = Frames { outer: outer.motor, inner: inner.motor }.map(ports::motor);
    executors.acquisition.spawn(once(acquire_on_frames(inputs, frames, channels)));
    let keeping = keeping(settings, latitude, clocks);
    executors.control.spawn(once(operate_frames(motors, motor_enable, frames, keeping, channels)));
    executors.thread.spawn(once(find_on_positions(session, channels)));
    Ok(())
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
