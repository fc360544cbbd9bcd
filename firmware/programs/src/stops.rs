//! Program of the board in a vehicle that drives from stop to stop, and holds azimuth, pitch and
//! roll afterwards.

use firmware::keep::Keeping;
use firmware::not_begun::NotBegun;
use firmware::settings::{Settings, VehicleSchedule};
use orientation::alignment::setup::SetupError;
use orientation::alignment::stops::session::Session;
use orientation::earth::Latitude;
use orientation::signal::InertialSample;
use orientation::timebase::Timebase;
use static_cell::StaticCell;

use stm32::link::Link;
use stm32::sample_path::{Channels, acquire_in_vehicle, find_in_vehicle, keep_vehicle};
use stm32::wiring::VehicleWires;
use stm32::{once, ports};

use crate::{Executors, Initial, Instrument, Statics, keeper, methods};

/// Runs the instrument: it aligns, then holds the result without end, also across a loss of supply.
#[embassy_executor::task]
pub async fn align(executors: Executors, wires: VehicleWires, link: Link) {
    static STATICS: Statics<InertialSample, VehicleSchedule> = Statics::new();
    let instrument = Instrument::new(&STATICS, &wires.outlets);
    let initial = instrument.until_begin(executors, link).await;
    instrument.tell(initial.and_then(|it| begin(executors, wires, instrument.channels, it)));
}

/// Spawns the tasks of the sample path, of all priorities. Not inlined, so that what is made on the way is in no
/// frame of the program.
///
/// # Errors
/// Why nothing begins.
#[inline(never)]
fn begin(
    executors: Executors,
    wires: VehicleWires,
    channels: &'static Channels<InertialSample>,
    (settings, latitude): Initial<VehicleSchedule>,
) -> Result<(), NotBegun> {
    let settings = &*settings;
    let VehicleWires { converters, accelerometer, .. } = wires;
    let latitude = latitude.ok_or(NotBegun::NoLatitude)?;
    let clocks = channels.shared.clocks;
    let session = session(settings, latitude, clocks)?;
    let sensors = ports::triad((converters, &settings.gyro), accelerometer)?;
    let keeping = settings.holds.then(|| {
        let keeper = keeper(&methods::keeper(settings, latitude, clocks));
        Keeping { keeper, policy: methods::policy(settings, clocks) }
    });
    executors.acquisition.spawn(once(acquire_in_vehicle(sensors, channels)));
    executors.control.spawn(once(keep_vehicle(keeping, channels)));
    executors.thread.spawn(once(find_in_vehicle(session, channels)));
    Ok(())
}

/// Creates the session at its final place in memory.
///
/// # Errors
/// A procedure that is none.
fn session(
    settings: &Settings<VehicleSchedule>,
    latitude: Latitude,
    clocks: Timebase,
) -> Result<&'static mut Session, SetupError> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let procedure = methods::driving_procedure(settings, clocks);
    procedure.check()?;
    let setting = || methods::driving_setting(settings, latitude, clocks);
    Ok(SESSION.init_with(|| Session::of(setting(), procedure)))
}
