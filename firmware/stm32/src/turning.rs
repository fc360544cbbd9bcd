//! Program of the board on a platform that rotates continuously, with the axis misalignment stored
//! in flash. It holds azimuth, pitch and roll afterwards, by the IMU of the board on the base.

use core::convert::Infallible;
use core::future::pending;

use embassy_stm32::gpio::Output;
use firmware::keep::Keeping;
use firmware::not_begun::NotBegun;
use firmware::run::find;
use firmware::settings::{Settings, TurntableSchedule};
use firmware::storage::{CalibrationStore, SharedStore, Today, load_calibration};
use firmware::sway::SwayCompensation;
use firmware::turntable::Turntable;
use orientation::alignment::rotating::session::Session;
use orientation::alignment::setup::SetupError;
use static_cell::StaticCell;

use crate::flash::Store;
use crate::ports::AxisMotor;
use crate::wiring::{AxisPlatformWires, Link};
use crate::{
    Channels, Executors, configuration, connected, control_motors, keeping, on_base, once, ports,
    refuse, settings, stage_acquisition,
};

/// Date of the day, which a board does not know: an axis misalignment of any age is used.
const TODAY: Today = Today { date: None, longest: None };

/// Runs the instrument on a rotating platform: it aligns, then holds the result without end.
#[embassy_executor::task]
pub async fn align(executors: Executors, wires: AxisPlatformWires, link: Link) {
    static CHANNELS: StaticCell<Channels> = StaticCell::new();
    let channels = connected(&CHANNELS, executors, &wires.outlets, link);
    let Err(reason) = begin(executors, wires, channels).await;
    refuse(reason, &channels.shared);
    pending::<()>().await;
}

/// Runs without end.
///
/// # Errors
/// Why nothing begins.
async fn begin(
    executors: Executors,
    wires: AxisPlatformWires,
    channels: &'static Channels,
) -> Result<Infallible, NotBegun> {
    let AxisPlatformWires { converter, accelerometer, axes, base, motor_enable, outlets } = wires;
    let settings = settings::load(&outlets, settings::turntable)?;
    let clocks = channels.shared.clocks;
    let base = SwayCompensation::for_keeping(on_base(base));
    let encoder = ports::encoder(axes.encoder);
    let converter = (converter, &settings.gyro);
    let inputs = ports::inputs(converter, accelerometer, encoder, base)?;
    let store = &SharedStore::new(outlets.flash.store());
    let session = session(&settings, store, channels).await?;
    let motor = ports::motor(axes.motor);
    executors.acquisition.spawn(once(stage_acquisition(inputs, channels)));
    let keeping = keeping(&settings, clocks);
    executors.control.spawn(once(platform(motor, motor_enable, keeping, channels)));
    let recorder = &mut CalibrationStore { store, channels };
    find(session, &(), recorder, store, channels).await;
    pending().await
}

/// Motor and keeper on a rotating platform.
#[embassy_executor::task]
async fn platform(
    mut motor: AxisMotor,
    motor_enable: Output<'static>,
    keeping: Option<Keeping<'static>>,
    channels: &'static Channels,
) {
    let shared = &channels.shared;
    let mut platform = Turntable::new(&mut motor, &configuration::platform(), shared);
    control_motors(&mut platform, motor_enable, keeping, shared).await;
}

/// Creates the session at its final place in memory, with the stored axis misalignment.
///
/// # Errors
/// A procedure that is none.
async fn session(
    settings: &Settings<TurntableSchedule>,
    mut store: &SharedStore<Store>,
    channels: &Channels,
) -> Result<&'static mut Session, SetupError> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let mut setting = configuration::turning_setting(settings);
    let mut procedure = configuration::turning_procedure(settings, channels.shared.clocks);
    procedure.check()?;
    load_calibration(&mut store, TODAY, (&mut setting, &mut procedure), &channels.shared).await;
    Ok(SESSION.init_with(|| Session::of(setting, procedure)))
}
