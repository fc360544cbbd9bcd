//! The board on a platform that turns all the time, with what it keeps in its flash.

use embassy_embedded_hal::adapter::BlockingAsync;
use embassy_executor::Spawner;
use embassy_stm32::Peri;
use embassy_stm32::flash::{Blocking, Flash};
use embassy_stm32::peripherals::FLASH;
use firmware::run::run_storing;
use firmware::storage::{FlashStore, Today, prepare};
use orientation::session::rotating::{Session, check};
use sequential_storage::map::MapConfig;
use static_cell::StaticCell;

use crate::wiring::Wiring;
use crate::{Seams, configuration, ports, sample, tell};

/// The board's own flash. The program lies in its lower bank and runs on while the upper one is erased.
type Store = FlashStore<BlockingAsync<Flash<'static, Blocking>>>;

/// Where in it couplings are kept: the last two pages of 1 MiB, which no image reaches (`memory.x`).
const KEPT: core::ops::Range<u32> = 0xF_F000..0x10_0000;

/// A board has no clock of the day: however old a coupling is, it is used.
const TODAY: Today = Today { date: None, longest: None };

/// Runs the instrument to its conclusion and goes on telling it.
#[embassy_executor::task]
pub async fn align(spawner: Spawner, wiring: Wiring) {
    let Wiring { sensors, motor, link, motor_enable: _enabled, flash } = wiring;
    let seams = sample(spawner, sensors);
    let mut store = store(flash);
    let Some(session) = session(&mut store, seams).await else { return };
    let mut outputs = ports::outputs(motor, link);
    let platform = configuration::platform();
    let health = run_storing(&mut outputs, &platform, session, &mut store, seams).await;
    tell(&health, &mut outputs.link, &seams.shared).await;
}

fn store(flash: Peri<'static, FLASH>) -> Store {
    let flash = BlockingAsync::new(Flash::new_blocking(flash));
    FlashStore::new(flash, const { MapConfig::new(KEPT) })
}

/// The session, made where it stays, with what was kept for it.
async fn session(store: &mut Store, seams: &Seams) -> Option<&'static mut Session> {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let mut setting = configuration::turning_setting();
    let mut procedure = configuration::turning_procedure();
    if let Err(error) = check(&procedure) {
        defmt::error!("board: no session: {}", error);
        return None;
    }
    prepare(store, TODAY, (&mut setting, &mut procedure), &seams.shared).await;
    Some(SESSION.init_with(|| Session::of(setting, procedure)))
}
