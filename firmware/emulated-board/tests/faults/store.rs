//! A vehicle that stands with a heading in its store: it writes it anew ten seconds after its start.
//!
//! That is the shortest execution in which an image writes. The gyros' biases come back from start to start, so that
//! it believes the heading.

use std::cell::RefCell;
use std::rc::Rc;

use drivers::fault::Fault;
use emulated_board::wiring::board::Carrier;
use emulated_board::world::{Driver, SERIAL, World, at_once, erased, nothing, pages, store};
use firmware::platform::Platform;
use firmware::ports::Store as _;
use firmware::settings::{self, Settings, VehicleSchedule, save};
use firmware::storage::HEADING;
use hal_mock::flash::nor::{Loss, PoweredFlash, Trouble};
use hal_mock::flash::sequence::{Step, steps};
use hal_mock::flash::{Cells, Flash};
use hal_mock::vehicle::Stop;
use hal_mock::vehicle::scenario::Scenario as Day;
use orientation::alignment::rotating::misalignment;
use orientation::attitude::restart::Remembered;
use orientation::units::{Radians, RadiansPerSecond, Seconds};
use simulated::executed;
use simulated::scenario::{GyroClass, Scenario};
use simulated::vehicle::VehicleScenario;

/// 1σ of the gyros' biases from start to start by the settings, °/h. In this world they come back as they were, so that the
/// bound of 2 σ, by which one start in twenty is refused where they differ, is 5 σ of what the gyros' noise leaves here.
const BIAS_SIGMA_DEG_H: f64 = 0.05;
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

/// The vehicle.
fn scenario() -> VehicleScenario {
    let usual = executed::vehicle(1);
    let gyro = GyroClass { bias_sigma_deg_h: BIAS_SIGMA_DEG_H, ..usual.base.gyro };
    VehicleScenario { base: Scenario { gyro, ..usual.base }, ..usual }
}

/// The vehicle in its world, whose store holds the record of its settings and so many headings of earlier stops before
/// the latest one.
pub fn world(earlier: usize) -> World {
    let (carrier, items) = standing();
    let mut world = World::new(Platform::Vehicle, 1).expect("its settings are possible");
    world.store = pages(&items.kept(erased(0), earlier)).to_vec();
    world.carrier = carrier;
    world
}

/// The vehicle, which stands, and what it has in its store.
fn standing() -> (Rc<RefCell<dyn Carrier>>, Items) {
    let scenario = scenario();
    let Scenario { latitude_deg, azimuth_deg, .. } = scenario.base;
    let stop = Stop { seconds: STANDS_SECONDS, ..Stop::default() };
    // Chips borrow what goes on around them.
    let day: &'static Day = Box::leak(Box::new(Day::standing(latitude_deg, azimuth_deg, stop)));
    let board = scenario.board(&day.legs, &day.events, nothing());
    let items = Items::of(&scenario, board.plant.truth().gyro_bias_rad_s);
    (Rc::new(RefCell::new(board)), items)
}

/// What the vehicle has in its store.
struct Items {
    settings: Settings<VehicleSchedule>,
    heading: Remembered,
}

impl Items {
    /// Those of a vehicle, whose gyros have these biases, rad/s.
    fn of(scenario: &VehicleScenario, biases: [f64; 3]) -> Self {
        let settings = scenario.settings().expect("the latitude is one");
        Self { settings, heading: heading(scenario, biases) }
    }

    /// These with another heading.
    fn with(&self, heading: Remembered) -> Self {
        Self { settings: self.settings.clone(), heading }
    }

    /// A flash with the record of settings and the headings.
    fn kept(&self, flash: Driver, earlier: usize) -> Driver {
        let mut flash = self.saved(flash, RECORD);
        let before = self.with(Remembered { rest: Seconds(EARLIER_SECONDS), ..self.heading });
        for _ in 0..earlier {
            flash = before.saved(flash, 0);
        }
        self.saved(flash, 0)
    }

    /// The flash after an item was saved into the slot of this place. The supply may be lost meanwhile.
    fn saved(&self, flash: Driver, place: usize) -> Driver {
        let mut store = store(flash);
        let saved = at_once(async {
            match place {
                0 => store.save(HEADING, &self.heading.to_bytes()).await,
                RECORD => save(&mut store, &self.settings, &SERIAL).await.map_err(|_| Fault::Bus),
                // The vehicle never reads them.
                _ => store.save(place as u8 - 1, &[1; misalignment::BYTES]).await,
            }
        });
        let flash = store.into_flash();
        assert!(saved == Some(Ok(())) || flash.stopped().is_some(), "{saved:?}");
        flash
    }
}

/// The heading of the vehicle, which stands level.
fn heading(scenario: &VehicleScenario, biases: [f64; 3]) -> Remembered {
    let settings = scenario.settings().expect("the latitude is one");
    let latitude = settings.latitude.expect("it is stated");
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

/// How many headings are to be stored before the latest one, so that the next save changes pages, which erases one.
pub fn nearly_full() -> usize {
    let items = Items::of(&scenario(), [0.0; 3]);
    let operations = |earlier: usize| {
        let mut flash = items.kept(erased(0), earlier);
        flash.restart();
        items.saved(flash, 0).operations
    };
    (0..60).find(|earlier| operations(*earlier) > ROWS).expect("a page is full at some time")
}

/// Rows that a save of a heading writes where no page is changed: the heading, their sum, and its mark twice.
pub const ROWS: u32 = 12;
/// The row from which the saved heading holds: the first one of its mark.
pub const MARK: u32 = ROWS - 2;

/// The heading in the flash of a board, or none.
///
/// # Errors
/// The store cannot be read.
pub fn stored(flash: &Flash<Box<Cells>>) -> Result<Option<Remembered>, Fault> {
    let flash = PoweredFlash::new(flash.clone(), 0);
    let found =
        at_once(store(flash).load::<{ Remembered::BYTES }>(HEADING)).expect("it does not wait")?;
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

/// The places of the store's slots in a sequence: the heading, two axis misalignments, the record of settings.
const SLOTS: u32 = 4;
/// The place of the record.
const RECORD: usize = 3;

/// A flash after a random sequence of saves and losses of supply, before the next save of a heading, in which it is lost.
pub struct Interrupted {
    /// The flash before the save, as it starts.
    pub flash: Driver,
    /// The operation of the save in which the supply is lost.
    pub operation: u32,
    /// Which part of that operation is over then.
    pub reached: f64,
    /// What the loss leaves on the host.
    pub left: Driver,
    /// Whether what a board reads at its start can be read there.
    pub starts: bool,
}

impl Interrupted {
    /// That of a seed, with this heading saved at last. The steps are those of the host's tests, on a store that has the
    /// vehicle's record and heading; a loss without which the board could not start now is left out.
    pub fn new(seed: u64, saved: &Remembered) -> Self {
        let (_, items) = standing();
        let last = items.with(*saved);
        let mut flash = items.kept(erased(seed), 0);
        // The core reads its flash through the data cache.
        flash.is_cached = true;
        for step in steps(seed, SLOTS, true) {
            flash = match step {
                Step::Save(place) => items.saved(flash, place),
                Step::Load(_) => flash,
                Step::Restart => restarted(flash).0,
                Step::Cut(place, loss) => {
                    let start = restarted(flash).0;
                    let by = if place == 0 { &last } else { &items };
                    let lost = by.interrupted(&start, place, loss);
                    let is_lost = lost.stopped() == Some(Trouble::Supply);
                    if place == 0 && is_lost {
                        return last.cut(start, loss, lost);
                    }
                    let (after, starts) = restarted(lost);
                    assert!(starts, "a board starts from what a loss of supply leaves");
                    if place != 0 { after } else { items.saved(start, place) }
                }
            }
        }
        unreachable!("a sequence has no end")
    }
}

impl Items {
    /// The flash after a save into the slot of this place in which the supply may be lost.
    fn interrupted(&self, start: &Driver, place: usize, loss: Loss) -> Driver {
        let mut flash = start.clone();
        flash.loss = Some(loss);
        self.saved(flash, place)
    }

    /// The save of the heading in which the supply is lost, with what that leaves.
    fn cut(&self, flash: Driver, loss: Loss, lost: Driver) -> Interrupted {
        let at = |loss| self.interrupted(&flash, 0, loss).now();
        let (operation, reached) = match loss {
            Loss::After(0) => (0, 0.0),
            Loss::After(count) => (count - 1, 1.0),
            Loss::Within(operation) => {
                let begin = at(Loss::After(operation));
                let span = at(Loss::After(operation + 1)).saturating_sub(begin);
                (operation, lost.now().saturating_sub(begin).div_duration_f64(span))
            }
        };
        let starts = restarted(lost.clone()).1;
        Interrupted { flash, operation, reached, left: lost, starts }
    }
}

/// The flash after a start, which reads the record and the heading, and whether it can.
fn restarted(mut flash: Driver) -> (Driver, bool) {
    flash.restart();
    let mut store = store(flash);
    let record = at_once(store.load::<{ settings::BYTES }>(settings::SLOT));
    let heading = at_once(store.load::<{ Remembered::BYTES }>(HEADING));
    let starts = matches!((record, heading), (Some(Ok(_)), Some(Ok(_))));
    let mut flash = store.into_flash();
    flash.operations = 0;
    (flash, starts)
}

/// The 1σ of the azimuth in which the vehicle stands, °, where a line says that it was recalled.
pub fn recalled_sigma(line: &str) -> Option<f64> {
    line.split_once("azimuth 213.7° ± ")?.1.strip_suffix("° (1σ) recalled")?.parse().ok()
}

/// The 1σ of what is recalled, °: to the 0.06° that are stored each start adds the turn that gyros which come back to 0.05 °/h
/// would not show, 0.40° at this latitude, and 0.41° to 0.43° with their noise over both rests.
pub const RECALLED: core::ops::Range<f64> = 0.41..0.43;
/// The same after another start.
pub const RECALLED_AGAIN: core::ops::Range<f64> = 0.58..0.62;
