//! Program of the board on a platform that rotates continuously, with the axis misalignment stored
//! in flash.

use embassy_executor::Spawner;
use firmware::acquire::{acquire, on_stage};
use firmware::keep::NotKept;
use firmware::log::DefmtLog;
use firmware::ports::{NoBase, NoRecorder};
use firmware::run::navigate;
use firmware::storage::{Today, load_calibration, save_calibration};
use firmware::turntable::Turntable;
use orientation::alignment::rotating::session::{Session, check};
use static_cell::StaticCell;

use crate::flash::{Store, store};
use crate::ports::Inputs;
use crate::wiring::{Outlets, TurntableWires};
use crate::{Channels, configuration, ports, report_conclusion};

/// Date of the day, which a board does not know: an axis misalignment of any age is used.
const TODAY: Today = Today { date: None, longest: None };

/// Runs the instrument to its conclusion, then reports it without end.
#[embassy_executor::task]
pub async fn align(spawner: Spawner, wires: TurntableWires) {
    static CHANNELS: StaticCell<Channels> = StaticCell::new();
    let TurntableWires { converter, accelerometer, axes, motor_enable: _enabled, outlets, .. } =
        wires;
    let Outlets { mut link, flash } = outlets;
    let channels: &'static Channels = CHANNELS.init_with(|| Channels::new(&DefmtLog));
    let inputs = ports::inputs(converter, accelerometer, ports::encoder(axes.encoder), NoBase);
    spawner.spawn(defmt::unwrap!(acquisition(inputs, channels)));
    let mut store = store(flash);
    let Some(session) = session(&mut store, channels).await else { return };
    let mut motor = ports::motor(axes.motor);
    let mut platform = Turntable::new(&mut motor, &configuration::platform(), &channels.shared);
    let outside = (&mut link, &mut NoRecorder);
    let health = navigate(&mut platform, session, NotKept, &(), outside, channels).await;
    save_calibration(&mut store, session, channels).await;
    report_conclusion(&health, &mut link, &channels.shared).await;
}

/// Task that acquires samples for ever.
#[embassy_executor::task]
async fn acquisition(mut inputs: Inputs<NoBase>, channels: &'static Channels) {
    acquire(&mut on_stage(&mut inputs, &configuration::instrument(), channels)).await;
}

/// Creates the session at its final place in memory, with the stored axis misalignment.
async fn session(store: &mut Store, channels: &Channels) -> Option<&'static mut Session> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let mut setting = configuration::turning_setting();
    let mut procedure = configuration::turning_procedure();
    if let Err(error) = check(&procedure) {
        defmt::error!("board: no session: {}", error);
        return None;
    }
    load_calibration(store, TODAY, (&mut setting, &mut procedure), &channels.shared).await;
    Some(SESSION.init_with(|| Session::of(setting, procedure)))
}
