//! Programs of the board on a stage or on two frames that stand at positions. They hold azimuth, pitch
//! and roll afterwards, by the IMU of the board on the base.

use embassy_executor::Spawner;
use firmware::acquire::{acquire, on_mount};
use firmware::configuration::FramesConfiguration;
use firmware::gimbal::Gimbal;
use firmware::ports::{Frames, NoRecorder};
use firmware::run::navigate;
use firmware::stage::Stage;
use firmware::sway::SwayCompensation;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::{Prepared, Session};
use orientation::alignment::stepwise::setting::Setting;
use static_cell::StaticCell;

use crate::flash::store;
use crate::ports::MountInputs;
use crate::wiring::{AxisPlatformWires, FramesWires, Outlets};
use crate::{
    Channels, OnBase, begun, channels, configuration, keeping, on_base, ports, report_conclusion,
    settings, stage_acquisition,
};

/// Runs the instrument on a stage: it aligns, then holds the result without end.
#[embassy_executor::task]
pub async fn on_a_stage(spawner: Spawner, wires: AxisPlatformWires) {
    let AxisPlatformWires { converter, accelerometer, axes, base, motor_enable: _enabled, outlets } =
        wires;
    let Outlets { mut link, mut flash } = outlets;
    let Some(settings) = settings::load(&mut flash, settings::stage) else { return };
    let session = session(configuration::setting(&settings), configuration::procedure(&settings));
    let Some(session) = session else { return };
    let encoder = ports::encoder(axes.encoder);
    let base = SwayCompensation::new(on_base(base));
    let converter = (converter, &settings.gyro);
    let Some(inputs) = ports::inputs(converter, accelerometer, encoder, base) else { return };
    let channels = channels();
    spawner.spawn(defmt::unwrap!(stage_acquisition(inputs, channels)));
    let mut motor = ports::motor(axes.motor);
    let mut stage = Stage::new(&mut motor, &configuration::instrument().stage, &channels.shared);
    let outside = (&mut link, &mut NoRecorder);
    let health =
        navigate(&mut stage, session, keeping(&settings, store(flash)), &(), outside, channels)
            .await;
    report_conclusion(&health, &mut link, &channels.shared).await;
}

/// Runs the instrument on two frames: it aligns, then holds the result without end with the sensitive
/// axis vertical.
#[embassy_executor::task]
pub async fn on_two_frames(spawner: Spawner, wires: FramesWires) {
    static FRAMES: StaticCell<FramesConfiguration> = StaticCell::new();
    let frames = match configuration::frames() {
        Ok(frames) => frames,
        Err(error) => return defmt::error!("board: no mount: {}", error),
    };
    let FramesWires { converter, accelerometer, axes, base, motor_enable: _enabled, outlets } =
        wires;
    let (Outlets { mut link, mut flash }, Frames { outer, inner }) = (outlets, axes);
    let Some(settings) = settings::load(&mut flash, settings::two_frame) else { return };
    let session =
        session(configuration::mount_setting(&settings), configuration::mount_procedure(&settings));
    let Some(session) = session else { return };
    let (frames, channels) = (&*FRAMES.init(frames), channels());
    let encoders = Frames { outer: outer.encoder, inner: inner.encoder }.map(ports::encoder);
    let base = SwayCompensation::new(on_base(base));
    let converter = (converter, &settings.gyro);
    let Some(inputs) = ports::inputs(converter, accelerometer, encoders, base) else { return };
    spawner.spawn(defmt::unwrap!(mount_acquisition(inputs, frames, channels)));
    let mut motors = Frames { outer: outer.motor, inner: inner.motor }.map(ports::motor);
    let mut gimbal = Gimbal::new(&mut motors, frames, &channels.shared);
    let outside = (&mut link, &mut NoRecorder);
    let health =
        navigate(&mut gimbal, session, keeping(&settings, store(flash)), &(), outside, channels)
            .await;
    report_conclusion(&health, &mut link, &channels.shared).await;
}

/// Task that acquires samples on two frames for ever.
#[embassy_executor::task]
async fn mount_acquisition(
    mut inputs: MountInputs<OnBase>,
    frames: &'static FramesConfiguration,
    channels: &'static Channels,
) {
    acquire(&mut on_mount(&mut inputs, &configuration::instrument(), frames, channels)).await;
}

/// Creates the session at its final place in memory; logs why, if there is none.
fn session(setting: Setting, procedure: Procedure) -> Option<&'static mut Session> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let prepared = begun(Prepared::new(setting, procedure))?;
    Some(SESSION.init_with(|| Session::from(prepared)))
}
