//! Program of the board on a platform that rotates continuously, with the axis misalignment stored
//! in flash. It holds azimuth, pitch and roll afterwards, by the IMU of the board on the base.

use firmware::not_begun::NotBegun;
use firmware::settings::{Settings, TurntableSchedule};
use firmware::storage::{SharedStore, Today, load_calibration};
use firmware::sway::SwayCompensation;
use orientation::alignment::rotating::session::Session;
use orientation::alignment::setup::SetupError;
use orientation::earth::Latitude;
use orientation::signal::Sample;
use static_cell::StaticCell;

use stm32::flash::Archive;
use stm32::link::Link;
use stm32::sample_path::{Channels, acquire_on_axis, find_on_turntable, operate_turntable};
use stm32::wiring::AxisPlatformWires;
use stm32::{once, ports};

use crate::{Executors, Initial, Instrument, Statics, keeping, methods, on_base};

/// Date of the day, which a board does not know: an axis misalignment of any age is used.
const TODAY: Today = Today { date: None, longest: None };

/// Runs the instrument on a rotating platform: it aligns, then holds the result without end.
#[embassy_executor::task]
pub async fn align(executors: Executors, wires: AxisPlatformWires, link: Link) {
    static STATICS: Statics<Sample, TurntableSchedule> = Statics::new();
    let instrument = Instrument::new(&STATICS, &wires.outlets);
    let begun = match instrument.until_begin(executors, link).await {
        Ok(initial) => begin(executors, wires, &instrument, initial).await,
        Err(reason) => Err(reason),
    };
    instrument.tell(begun);
}

/// Spawns what runs without end.
///
/// # Errors
/// Why nothing begins.
async fn begin(
    executors: Executors,
    wires: AxisPlatformWires,
    instrument: &Instrument<Sample, TurntableSchedule>,
    (settings, latitude): Initial<TurntableSchedule>,
) -> Result<(), NotBegun> {
    let Instrument { channels, store, .. } = *instrument;
    let settings = &*settings;
    let AxisPlatformWires { converter, accelerometer, axes, base, motor_enable, .. } = wires;
    let latitude = latitude.ok_or(NotBegun::NoLatitude)?;
    let clocks = channels.shared.clocks;
    let base = SwayCompensation::for_keeping(on_base(base));
    let encoder = ports::encoder(axes.encoder);
    let converter = (converter, &settings.gyro);
    let inputs = ports::inputs(converter, accelerometer, encoder, base)?;
    let session = session((settings, latitude), store, channels).await?;
    let motor = ports::motor(axes.motor);
    let encoder = settings.calibration.platform.encoder;
    executors.acquisition.spawn(once(acquire_on_axis(inputs, encoder, channels)));
    let keeping = keeping(settings, latitude, clocks);
    let tolerances = methods::platform(settings);
    executors.control.spawn(once(operate_turntable(
        motor,
        tolerances,
        motor_enable,
        keeping,
        channels,
    )));
    executors.thread.spawn(once(find_on_turntable(session, store, channels)));
    Ok(())
}

/// Creates the session at its final place in memory, with the stored axis misalignment.
///
/// # Errors
/// A procedure that is none.
async fn session(
    (settings, latitude): (&Settings<TurntableSchedule>, Latitude),
    mut store: &SharedStore<Archive>,
    channels: &Channels,
) -> Result<&'static mut Session, SetupError> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let mut setting = methods::turning_setting(settings, latitude);
    let mut procedure = methods::turning_procedure(settings, channels.shared.clocks);
    procedure.check()?;
    load_calibration(&mut store, TODAY, (&mut setting, &mut procedure), &channels.shared).await;
    Ok(SESSION.init_with(|| Session::of(setting, procedure)))
}
