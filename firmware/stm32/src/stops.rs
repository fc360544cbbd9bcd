//! Program of the board in a vehicle that drives from stop to stop, and holds azimuth, pitch and
//! roll afterwards.

use firmware::acquire::{TriadAcquisition, acquire};
use firmware::keep::Keeping;
use firmware::mechanism::Strapdown;
use firmware::not_begun::NotBegun;
use firmware::settings::{Settings, VehicleSchedule};
use orientation::alignment::setup::SetupError;
use orientation::alignment::stops::session::Session;
use orientation::signal::InertialSample;
use orientation::timebase::Timebase;
use static_cell::StaticCell;

use crate::ports::Triad;
use crate::wiring::{Link, VehicleWires};
use crate::{
    Channels, Executors, configuration, connected, control, go_on, keeper, once, ports, settings,
};

/// Runs the instrument: it aligns, then holds the result without end, also across a loss of supply.
#[embassy_executor::task]
pub async fn align(executors: Executors, wires: VehicleWires, link: Link) {
    static CHANNELS: StaticCell<Channels<InertialSample>> = StaticCell::new();
    let channels = connected(&CHANNELS, executors, &wires.outlets, link);
    let flash = wires.outlets.flash;
    go_on(begin(executors, wires, channels), flash, channels).await;
}

/// Spawns what runs above the thread; the rest is for the thread. Not inlined, so that what is made on the way is in no
/// frame of the program.
///
/// # Errors
/// Why nothing begins.
#[inline(never)]
fn begin(
    executors: Executors,
    wires: VehicleWires,
    channels: &'static Channels<InertialSample>,
) -> Result<&'static mut Session, NotBegun> {
    let VehicleWires { converters, accelerometer, outlets } = wires;
    let settings = settings::load(&outlets, settings::vehicle)?;
    let clocks = channels.shared.clocks;
    let session = session(&settings, clocks)?;
    let sensors = ports::triad((converters, &settings.gyro), accelerometer)?;
    let keeping = settings.holds.then(|| {
        let keeper = keeper(&configuration::keeper(&settings, clocks));
        Keeping { keeper, policy: configuration::policy(&settings, clocks) }
    });
    executors.acquisition.spawn(once(acquisition(sensors, channels)));
    executors.control.spawn(once(keep(keeping, channels)));
    Ok(session)
}

/// Acquisition in a vehicle.
#[embassy_executor::task]
async fn acquisition(mut sensors: Triad, channels: &'static Channels<InertialSample>) {
    let configuration = configuration::vehicle();
    acquire(&mut TriadAcquisition::new(&mut sensors, &configuration, channels)).await;
}

/// Keeper in a vehicle.
#[embassy_executor::task]
async fn keep(keeping: Option<Keeping<'static>>, channels: &'static Channels<InertialSample>) {
    let shared = &channels.shared;
    control(&mut Strapdown::new(shared), keeping, shared).await;
}

/// Creates the session at its final place in memory.
///
/// # Errors
/// A procedure that is none.
fn session(
    settings: &Settings<VehicleSchedule>,
    clocks: Timebase,
) -> Result<&'static mut Session, SetupError> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let procedure = configuration::driving_procedure(settings, clocks);
    procedure.check()?;
    let setting = || configuration::driving_setting(settings, clocks);
    Ok(SESSION.init_with(|| Session::of(setting(), procedure)))
}
