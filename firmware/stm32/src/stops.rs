//! Program of the board in a vehicle that drives from stop to stop, and holds azimuth, pitch and
//! roll afterwards.

use firmware::acquire::{TriadAcquisition, acquire};
use firmware::keep::Keeping;
use firmware::log::DefmtLog;
use firmware::mechanism::Strapdown;
use firmware::ports::NoRecorder;
use firmware::settings::{Settings, VehicleSchedule};
use orientation::alignment::stops::session::Session;
use orientation::signal::InertialSample;
use static_cell::StaticCell;

use crate::flash::store;
use crate::ports::Triad;
use crate::wiring::{Outlets, VehicleWires};
use crate::{
    Channels, Executors, begun, configuration, control, find_and_report, keeper, ports, settings,
};

/// Runs the instrument: it aligns, then holds the result without end, also across a loss of supply.
#[embassy_executor::task]
pub async fn align(executors: Executors, wires: VehicleWires) {
    static CHANNELS: StaticCell<Channels<InertialSample>> = StaticCell::new();
    let VehicleWires { converters, accelerometer, outlets } = wires;
    let Outlets { link, mut flash } = outlets;
    let Some(settings) = settings::load(&mut flash, settings::vehicle).await else { return };
    let Some(session) = session(&settings) else { return };
    let channels: &'static Channels<_> = CHANNELS.init_with(|| Channels::new(&DefmtLog));
    let converters = (converters, &settings.gyro);
    let Some(sensors) = ports::triad(converters, accelerometer) else { return };
    let keeping = settings.holds.then(|| {
        let keeper = keeper(&configuration::keeper(&settings));
        Keeping { keeper, policy: configuration::policy(&settings) }
    });
    executors.acquisition.spawn(defmt::unwrap!(acquisition(sensors, channels)));
    executors.control.spawn(defmt::unwrap!(keep(keeping, channels)));
    find_and_report(session, link, &mut NoRecorder, store(flash), channels).await;
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

/// Creates the session at its final place in memory; logs why, if there is none.
fn session(settings: &Settings<VehicleSchedule>) -> Option<&'static mut Session> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let procedure = configuration::driving_procedure(settings);
    begun(procedure.check())?;
    Some(SESSION.init_with(|| Session::of(configuration::driving_setting(settings), procedure)))
}
