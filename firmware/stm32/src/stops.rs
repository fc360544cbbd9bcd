//! Program of the board in a vehicle that drives from stop to stop, and holds azimuth, pitch and
//! roll afterwards.

use embassy_executor::Spawner;
use firmware::acquire::{TriadAcquisition, acquire};
use firmware::keep::Keeping;
use firmware::log::DefmtLog;
use firmware::mechanism::Strapdown;
use firmware::ports::NoRecorder;
use firmware::run::navigate;
use orientation::alignment::stops::session::Session;
use orientation::signal::InertialSample;
use static_cell::StaticCell;

use crate::flash::store;
use crate::ports::Triad;
use crate::wiring::{Outlets, VehicleWires};
use crate::{Channels, begun, configuration, keeper, ports, report_conclusion};

/// Runs the instrument: it aligns, then holds the result without end, also across a loss of supply.
#[embassy_executor::task]
pub async fn align(spawner: Spawner, wires: VehicleWires) {
    static CHANNELS: StaticCell<Channels<InertialSample>> = StaticCell::new();
    let Some(session) = session() else { return };
    let VehicleWires { converters, accelerometer, outlets } = wires;
    let Outlets { mut link, flash } = outlets;
    let channels: &'static Channels<_> = CHANNELS.init_with(|| Channels::new(&DefmtLog));
    let triad = ports::triad(converters, accelerometer);
    spawner.spawn(defmt::unwrap!(acquisition(triad, channels)));
    let policy = configuration::policy();
    let keeping =
        Some(Keeping { keeper: keeper(&configuration::keeper()), policy, store: store(flash) });
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
fn session() -> Option<&'static mut Session> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let procedure = configuration::driving_procedure();
    begun(procedure.check())?;
    Some(SESSION.init_with(|| Session::of(configuration::driving_setting(), procedure)))
}
