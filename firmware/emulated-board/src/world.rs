//! The chips and the world of each carrier, with what its store holds beforehand.

use std::cell::RefCell;
use std::future::Future;
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use embassy_time::Instant;
use firmware::platform::Platform;
use firmware::settings::{CarrierSchedule, Serial, Settings, save};
use firmware::storage::FlashStore;
use hal_mock::flash::Cells;
use hal_mock::flash::nor::PoweredFlash;
use simulated::executed;
use simulated::fault::Injection;
use simulated::scenario::Scenario;
use simulated::vehicle::VehicleScenario;

use crate::controller::flash::{Flash, STORE};
use crate::controller::identity;
use crate::wiring::board::{
    BaseImu, Board, Carrier, FRAMES, Lines, ONE_LINE, SPIN, SPIN_LINES, STAGE, Selects, VEHICLE,
    VEHICLE_LINES,
};

/// Serial number of the board's controller, to which the records in its store belong.
pub const SERIAL: Serial = Serial(identity::NUMBER);

/// A carrier's chips and world.
pub struct World {
    /// The chips around the world.
    pub carrier: Rc<RefCell<dyn Carrier>>,
    /// Where they are connected.
    wires: (Selects, Lines),
    /// The IMU on the base under a platform.
    base: Option<BaseImu>,
    /// Whether the base does not move.
    pub is_at_rest: bool,
    /// The pages of the store.
    pub store: Vec<u8>,
    /// The true azimuth at a moment, °, or the true roll of a spinning body.
    pub truth_deg: Box<dyn Fn(Instant) -> f64>,
}

/// Keeps something for as long as the program runs: chips borrow what goes wrong with them.
fn keep<T>(kept: T) -> &'static T {
    Box::leak(Box::new(kept))
}

/// Nothing goes wrong with chips that borrow this.
pub fn nothing() -> &'static Injection {
    keep(Injection::NONE)
}

impl World {
    /// The world of a carrier by its seed, in which nothing goes wrong.
    ///
    /// # Errors
    /// Settings that the record does not take.
    pub fn new(platform: Platform, seed: u64) -> Result<Self, String> {
        match platform {
            Platform::Stage => Self::stepping(&executed::stage(seed)),
            Platform::Turntable => {
                let scenario = executed::turntable(seed);
                let carrier = scenario.board(None, nothing());
                Self::at_rest(carrier, (STAGE, ONE_LINE), scenario.settings(), &scenario.base)
            }
            Platform::TwoFrame => {
                let scenario = executed::two_frames(seed);
                let carrier = scenario.board(None, nothing());
                Self::at_rest(carrier, (FRAMES, ONE_LINE), scenario.settings(), &scenario.base)
            }
            Platform::Vehicle => Self::driving(&executed::vehicle(seed)),
            Platform::Spin => {
                let scenario = executed::spin(seed);
                let course = keep(scenario.course(None));
                let board = || scenario.board(course, nothing());
                let truth = board().plant;
                let world = Self::of(board(), (SPIN, SPIN_LINES), scenario.settings());
                world.map(|world| world.with(move |now| truth.truth_at(now).roll_rad))
            }
        }
    }

    /// The world of a vehicle's scenario, in which nothing goes wrong.
    ///
    /// # Errors
    /// Settings that the record does not take.
    pub fn driving(scenario: &VehicleScenario) -> Result<Self, String> {
        let day = keep(scenario.day(None));
        let board = || scenario.board(&day.legs, &day.events, nothing());
        let truth = board().plant;
        let world = Self::of(board(), (VEHICLE, VEHICLE_LINES), scenario.settings());
        world.map(|world| world.with(move |now| truth.truth_at(now).attitude.azimuth_rad))
    }

    /// The world of a stage's scenario, in which nothing goes wrong.
    ///
    /// # Errors
    /// Settings that the record does not take.
    pub fn stepping(scenario: &Scenario) -> Result<Self, String> {
        let carrier = simulated::board(scenario, None, nothing());
        Self::at_rest(carrier, (STAGE, ONE_LINE), scenario.settings(), scenario)
    }

    /// A world with the record of these settings in its store.
    fn of<C: CarrierSchedule>(
        carrier: impl Carrier + 'static,
        wires: (Selects, Lines),
        settings: Option<Settings<C>>,
    ) -> Result<Self, String> {
        let settings = settings.ok_or("the latitude is none")?;
        let store = stored(async |store| {
            let saved = save(store, &settings, &SERIAL).await;
            saved.map_err(|error| format!("the record of settings: {error}"))
        })?;
        let carrier = Rc::new(RefCell::new(carrier));
        let truth_deg = Box::new(|_| 0.0);
        Ok(Self { carrier, wires, base: None, is_at_rest: false, store, truth_deg })
    }

    /// As [`Self::of`], on the base at rest of this scenario, on which an IMU stands.
    fn at_rest<C: CarrierSchedule>(
        carrier: impl Carrier + 'static,
        wires: (Selects, Lines),
        settings: Option<Settings<C>>,
        base: &Scenario,
    ) -> Result<Self, String> {
        let world = Self::of(carrier, wires, settings)?;
        let azimuth_deg = base.azimuth_deg;
        let truth_deg = Box::new(move |_| azimuth_deg);
        let base = Some(simulated::base::rig(base, None));
        Ok(Self { base, is_at_rest: true, truth_deg, ..world })
    }

    /// The world with other pages in its store.
    #[must_use]
    pub fn with_store(self, store: Vec<u8>) -> Self {
        Self { store, ..self }
    }

    /// The world with the select lines of its chips at other pins.
    #[must_use]
    pub fn with_selects(self, selects: Selects) -> Self {
        Self { wires: (selects, self.wires.1), ..self }
    }

    /// The world with another IMU on its base.
    #[must_use]
    pub fn with_base(self, base: BaseImu) -> Self {
        Self { base: Some(base), ..self }
    }

    /// The world with a truth, rad.
    fn with(self, truth_rad: impl Fn(Instant) -> f64 + 'static) -> Self {
        let truth_deg = Box::new(move |now| truth_rad(now).to_degrees().rem_euclid(360.0));
        Self { truth_deg, ..self }
    }

    /// How many converters there are.
    #[must_use]
    pub const fn converters(&self) -> u64 {
        self.wires.1.len() as u64
    }

    /// The board with these chips on its pins.
    pub fn board(&mut self) -> Board {
        Board::new(Rc::clone(&self.carrier), self.wires, self.base.take())
    }
}

/// The flash of a controller of its own, behind a driver.
pub type Driver = PoweredFlash<Box<Cells>>;
/// The store of an image.
pub type Store = FlashStore<Driver>;

/// A flash of which all is erased. The seed decides when within an operation a supply is lost, and what that leaves.
pub fn erased(seed: u64) -> Driver {
    PoweredFlash::new(Flash::new(seed).array, seed)
}

/// The store in a flash.
pub fn store(flash: Driver) -> Store {
    FlashStore::new(flash, STORE.start)
}

/// The pages of the store in a flash.
pub fn pages(flash: &Driver) -> &[u8] {
    &flash.flash.bytes()[STORE.start as usize..STORE.end as usize]
}

/// The pages of a store into which this was written.
///
/// # Errors
/// What the writer says, or that it waits for something.
pub fn stored(
    write: impl AsyncFnOnce(&mut Store) -> Result<(), String>,
) -> Result<Vec<u8>, String> {
    let mut store = store(erased(0));
    at_once(write(&mut store)).ok_or("the store waits")??;
    Ok(pages(&store.into_flash()).to_vec())
}

/// The result of a future that never waits; none where it does.
pub fn at_once<T>(future: impl Future<Output = T>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => Some(result),
        Poll::Pending => None,
    }
}
