//! Program of the board in a vehicle that drives from stop to stop, and holds azimuth, pitch and
//! roll afterwards.

use embassy_executor::Spawner;
use firmware::acquire::{TriadAcquisition, acquire};
use firmware::keep::Keeping;
use firmware::log::DefmtLog;
use firmware::mechanism::Strapdown;
use firmware::ports::NoRecorder;
use firmware::run::navigate;
use firmware::settings::{Settings, VehicleSchedule};
use orientation::alignment::stops::session::Session;
use orientation::signal::InertialSample;
use static_cell::StaticCell;

use crate::flash::store;
use crate::ports::Triad;
use crate::wiring::{Outlets, VehicleWires};
use crate::{Channels, begun, configuration, keeper, ports, report_conclusion, settings};

/// Runs the instrument: it aligns, then holds the result without end, also across a loss of supply.
#[embassy_executor::task]
pub async fn align(spawner: Spawner, wires: VehicleWires) {
    static CHANNELS: StaticCell<Channels<InertialSample>> = StaticCell::new();
    let VehicleWires { converters, accelerometer, outlets } = wires;
    let Outlets { mut link, mut flash } = outlets;
    let Some(settings) = settings::load(&mut flash, settings::vehicle) else { return };
    let Some(session) = session(&settings) else { return };
    let channels: &'static Channels<_> = CHANNELS.init_with(|| Channels::new(&DefmtLog));
    let converters = (converters, &settings.gyro);
    let Some(triad) = ports::triad(converters, accelerometer) else { return };
    spawner.spawn(defmt::unwrap!(acquisition(triad, channels)));
    let keeping = settings.holds.then(|| {
        let keeper = keeper(&configuration::keeper(&settings));
        Keeping { keeper, policy: configuration::policy(&settings), store: store(flash) }
    });
    let mut body = Strapdown::new(&channels.shared);
    let outside = (&mut link, &mut NoRecorder);
    let health = navigate(&mut body, session, keeping, &(), outside, channels).await;
    report_conclusion(&health, &mut link, &channels.shared).await;
}

/// Task that acquires samples for ever.
#[embassy_executor::task]
async fn acquisition(mut triad: Triad, channels: &'static Channels<InertialSample>) {
    let configuration = configuration::vehicle();
    acquire(&mut TriadAcquisition::new(&mut triad, &configuration, channels)).await;
}

/// Creates the session at its final place in memory; logs why, if there is none.
fn session(settings: &Settings<VehicleSchedule>) -> Option<&'static mut Session> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let procedure = configuration::driving_procedure(settings);
    begun(procedure.check())?;
    Some(SESSION.init_with(|| Session::of(configuration::driving_setting(settings), procedure)))
}
