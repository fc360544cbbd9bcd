//! Program of the board on a stage that stands at positions.

use embassy_executor::Spawner;
use firmware::ports::NoRecorder;
use firmware::run::navigate;
use firmware::stage::Stage;
use orientation::alignment::setup::SetupError;
use orientation::alignment::stepwise::session::{Prepared, Session};
use static_cell::StaticCell;

use crate::wiring::Wiring;
use crate::{configuration, ports, report_conclusion, sample};

/// Runs the instrument to its conclusion, then reports it without end.
#[embassy_executor::task]
pub async fn align(spawner: Spawner, wiring: Wiring) {
    let session = match session() {
        Ok(session) => session,
        Err(error) => return defmt::error!("board: no session: {}", error),
    };
    let Wiring { sensors, motor, mut link, motor_enable: _enabled, flash: _ } = wiring;
    let channels = sample(spawner, sensors);
    let mut motor = ports::motor(motor);
    let mut stage = Stage::new(&mut motor, &configuration::instrument().stage, &channels.shared);
    let health =
        navigate(&mut stage, (session, &mut ()), &mut link, &mut NoRecorder, &mut (), channels)
            .await;
    report_conclusion(&health, &mut link, &channels.shared).await;
}

/// Creates the session at its final place in memory.
fn session() -> Result<&'static mut Session, SetupError> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let prepared = Prepared::new(configuration::setting(), configuration::procedure())?;
    Ok(SESSION.init_with(|| Session::from(prepared)))
}
