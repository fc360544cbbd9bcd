//! A vehicle that stands with a heading in its store: it writes it anew ten seconds after its start.
//!
//! That is the shortest execution in which an image writes. The gyros' biases come back from start to start, so that
//! it believes the heading.

use std::cell::RefCell;
use std::future::Future;
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use drivers::fault::Fault;
use emulated_board::controller::flash::STORE;
use emulated_board::world::World;
use firmware::platform::Platform;
use firmware::ports::Store;
use firmware::settings::save;
use firmware::storage::{FlashStore, HEADING};
use hal_mock::flash::nor::PoweredFlash;
use hal_mock::flash::{Cells, Flash, Times};
use hal_mock::vehicle::Stop;
use hal_mock::vehicle::scenario::Scenario as Day;
use orientation::attitude::restart::Remembered;
use orientation::units::{Radians, RadiansPerSecond, Seconds};
use sequential_storage::map::MapConfig;
use simulated::executed;
use simulated::fault::Injection;
use simulated::scenario::{GyroClass, Scenario};
use simulated::vehicle::VehicleScenario;

/// The flash of a board, behind its driver.
pub type Driver = PoweredFlash<Box<Cells>>;

/// 1σ of the gyros' biases from start to start, °/h.
const BIAS_SIGMA_DEG_H: f64 = 0.03;
/// For how long the vehicle stands, s.
const STANDS_SECONDS: f64 = 600.0;
/// The time at rest of the heading that was stored last before the start, by which it is known, s.
const OLD_SECONDS: f64 = 60.0;
/// That of every heading before it.
const EARLIER_SECONDS: f64 = 30.0;

/// What the store gives for the heading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Item {
    /// The one that was stored last before the start.
    Old,
    /// The one that the board saves.
    New,
    /// Another one, or none.
    Lost,
    /// The store cannot be read.
    Unreadable,
}

/// What a future gives that never waits.
fn at_once<T>(future: impl Future<Output = T>) -> T {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => panic!("the store waits"),
    }
}

/// The store in a flash.
fn store(flash: Driver) -> FlashStore<Driver> {
    FlashStore::new(flash, const { MapConfig::new(STORE) })
}

/// The vehicle.
fn scenario() -> VehicleScenario {
    let usual = executed::vehicle(1);
    let gyro = GyroClass { bias_sigma_deg_h: BIAS_SIGMA_DEG_H, ..usual.base.gyro };
    VehicleScenario { base: Scenario { gyro, ..usual.base }, ..usual }
}

/// The vehicle in its world, whose store holds the record of its settings and so many headings of earlier stops before
/// the latest one.
pub fn world(earlier: usize) -> World {
    let mut world = World::new(Platform::Vehicle, 1).expect("its settings are possible");
    let scenario = scenario();
    let Scenario { latitude_deg, azimuth_deg, .. } = scenario.base;
    let stop = Stop { seconds: STANDS_SECONDS, ..Stop::default() };
    // Chips borrow what goes on around them.
    let day: &'static Day = Box::leak(Box::new(Day::standing(latitude_deg, azimuth_deg, stop)));
    let board = scenario.board(&day.legs, &day.events, Box::leak(Box::new(Injection::NONE)));
    let flash = used(&scenario, board.plant.truth().gyro_bias_rad_s, earlier);
    world.store = flash.flash.bytes()[STORE.start as usize..STORE.end as usize].to_vec();
    world.carrier = Rc::new(RefCell::new(board));
    world
}

/// A flash with the record of settings and the headings.
fn used(scenario: &VehicleScenario, biases: [f64; 3], earlier: usize) -> Driver {
    let cells: Box<Cells> = vec![0; size_of::<Cells>()].try_into().expect("as long as the cells");
    let mut store = store(PoweredFlash::new(Flash::erased(cells, Times::TYPICAL, 0), 0));
    let settings = scenario.settings().expect("the latitude is one");
    at_once(save(&mut store, &settings)).expect("there is room");
    let latest = heading(scenario, biases);
    for _ in 0..earlier {
        let heading = Remembered { rest: Seconds(EARLIER_SECONDS), ..latest };
        at_once(store.save(HEADING, &heading.to_bytes())).expect("there is room");
    }
    at_once(store.save(HEADING, &latest.to_bytes())).expect("there is room");
    store.into_flash()
}

/// The heading of the vehicle, which stands level.
fn heading(scenario: &VehicleScenario, biases: [f64; 3]) -> Remembered {
    let latitude = scenario.settings().expect("the latitude is one").latitude;
    let azimuth = scenario.base.azimuth_deg.to_radians();
    let (north, down) = (latitude.horizontal_rate().0, latitude.vertical_rate().0);
    let rates = [north * azimuth.cos(), -north * azimuth.sin(), -down.abs()];
    Remembered {
        azimuth: Radians(azimuth),
        sigma: Radians(1e-3),
        pitch: Radians(0.0),
        roll: Radians(0.0),
        rates: std::array::from_fn(|axis| RadiansPerSecond(rates[axis] + biases[axis])),
        rest: Seconds(OLD_SECONDS),
    }
}

/// How many headings are to be stored before the latest one, so that the next save changes pages, which erases one; and
/// how many rows and pages that save writes and erases.
pub fn nearly_full() -> (usize, u32) {
    let (scenario, biases) = (scenario(), [0.0; 3]);
    let effort = |earlier: usize| {
        let mut flash = used(&scenario, biases, earlier);
        flash.restart();
        let mut store = store(flash);
        at_once(store.save(HEADING, &heading(&scenario, biases).to_bytes()))
            .expect("there is room");
        (earlier, store.into_flash().operations)
    };
    (0..60).map(effort).find(|(_, effort)| *effort > ROWS).expect("a page is full at some time")
}

/// Rows that a save of a heading writes where no page is changed.
pub const ROWS: u32 = 11;

/// The heading in the flash of a board, or none.
///
/// # Errors
/// The store cannot be read.
pub fn stored(flash: &Flash<Box<Cells>>) -> Result<Option<Remembered>, Fault> {
    let flash = PoweredFlash::new(flash.clone(), 0);
    let found = at_once(store(flash).load::<{ Remembered::BYTES }>(HEADING))?;
    Ok(found.as_ref().and_then(|bytes| Remembered::from_bytes(bytes)))
}

/// What the flash of a board gives for the heading.
pub fn item(flash: &Flash<Box<Cells>>) -> Item {
    match stored(flash) {
        Ok(Some(heading)) if heading.rest == Seconds(OLD_SECONDS) => Item::Old,
        Ok(Some(heading)) if heading.rest != Seconds(EARLIER_SECONDS) => Item::New,
        Ok(_) => Item::Lost,
        Err(_) => Item::Unreadable,
    }
}
