//! Program of the board on a stage that stands at positions.

use embassy_executor::Spawner;
use firmware::run::run;
use orientation::session::procedure::ProcedureError;
use orientation::session::{Prepared, Session};
use static_cell::StaticCell;

use crate::wiring::Wiring;
use crate::{configuration, ports, sample, tell};

/// Runs the instrument to its conclusion, then reports it without end.
#[embassy_executor::task]
pub async fn align(spawner: Spawner, wiring: Wiring) {
    let session = match session() {
        Ok(session) => session,
        Err(error) => return defmt::error!("board: no session: {}", error),
    };
    let Wiring { sensors, motor, link, motor_enable: _enabled, flash: _ } = wiring;
    let channels = sample(spawner, sensors);
    let mut outputs = ports::outputs(motor, link);
    let health = run(&mut outputs, &configuration::instrument(), session, channels).await;
    tell(&health, &mut outputs.link, &channels.shared).await;
}

/// Creates the session at its final place in memory.
fn session() -> Result<&'static mut Session, ProcedureError> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let prepared = Prepared::new(configuration::setting(), configuration::procedure())?;
    Ok(SESSION.init_with(|| Session::from(prepared)))
}
