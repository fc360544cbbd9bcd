//! The store in the flash of the STM32L475: the supply is lost at any moment, at random moments, and other programs
//! have used the pages before.
//!

mod contents;
mod cuts;
mod forgetting;
mod remains;
mod sequences;

use crate::settings::{SERIAL, first_record_of_stops, settings, vehicle};
use drivers::fault::Fault;
use firmware::ports::Store as _;
use firmware::settings::{self, Settings, SettingsError, VehicleSchedule};
use firmware::storage::{FlashStore, HEADING};
use hal_mock::flash::nor::PoweredFlash;
use hal_mock::flash::{Cells, Flash, PAGE, SIZE, Times};
use host::virtual_time::run;
use orientation::alignment::rotating::misalignment::{AxisMisalignment, BYTES};
use orientation::attitude::restart::Remembered;
use orientation::units::{Radians, RadiansPerSecond, Seconds};

/// The flash of a board, behind its driver.
type Board = PoweredFlash<Box<Cells>>;
/// First byte of the store: it has the last two pages, as on the board (`firmware/stm32/src/flash.rs`).
const FIRST: u32 = (SIZE - 2 * PAGE) as u32;

/// An erased flash. The seed decides what a loss of supply does to it.
fn erased(seed: u64) -> Board {
    let cells: Box<Cells> = vec![0; size_of::<Cells>()].try_into().expect("as long as the cells");
    PoweredFlash::new(Flash::erased(cells, Times::TYPICAL, seed), seed)
}

/// The store in this flash. It keeps nothing in memory from one access to the next.
fn store(flash: &mut Board) -> FlashStore<&mut Board> {
    FlashStore::new(flash, FIRST)
}

/// A kind of item that the instrument stores. Each item is known by a number.
trait Item<const N: usize> {
    /// The stored form of the item of this number.
    fn bytes(number: u64) -> [u8; N];
    /// The number of a stored form; [`None`] if it is none.
    fn number(bytes: &[u8; N]) -> Option<u64>;
}

/// The heading of a vehicle at rest.
struct Heading;

impl Item<{ Remembered::BYTES }> for Heading {
    fn bytes(number: u64) -> [u8; Remembered::BYTES] {
        Remembered {
            azimuth: Radians(number as f64),
            sigma: Radians(0.01),
            pitch: Radians(0.02),
            roll: Radians(-0.03),
            rates: [4e-5, 5e-5, -6e-5].map(RadiansPerSecond),
            rest: Seconds(60.0),
        }
        .to_bytes()
    }

    fn number(bytes: &[u8; Remembered::BYTES]) -> Option<u64> {
        Remembered::from_bytes(bytes).map(|heading| heading.azimuth.0 as u64)
    }
}

/// The axis misalignment at a speed.
struct Misalignment;

impl Item<BYTES> for Misalignment {
    fn bytes(number: u64) -> [u8; BYTES] {
        AxisMisalignment {
            sine: 0.01,
            quadrature: Seconds(1e-6),
            sine_sigma: 1e-6,
            quadrature_sigma: Seconds(1e-6),
            frequency: RadiansPerSecond(0.9),
            date: number,
            temperature: 21.5,
        }
        .to_bytes()
    }

    fn number(bytes: &[u8; BYTES]) -> Option<u64> {
        AxisMisalignment::from_bytes(bytes).map(|misalignment| misalignment.date)
    }
}

/// A stop of 10 s is the shortest: that of a record is as much longer as its number says.
const SHORTEST: f64 = 10.0;

/// The settings of a vehicle.
struct Record;

impl Item<{ settings::BYTES }> for Record {
    fn bytes(number: u64) -> [u8; settings::BYTES] {
        let schedule = VehicleSchedule { stop: Seconds(SHORTEST + number as f64), ..vehicle() };
        settings(schedule).to_record(&SERIAL).expect("they are in range")
    }

    fn number(bytes: &[u8; settings::BYTES]) -> Option<u64> {
        Some(number_of(&Settings::from_record(bytes, &SERIAL).ok()?))
    }
}

/// The number of the settings of a vehicle.
fn number_of(settings: &Settings<VehicleSchedule>) -> u64 {
    (settings.schedule.stop.0 - SHORTEST) as u64
}

/// The settings of a vehicle as version 1 of the record has them.
struct FirstRecord;

impl Item<{ settings::FIRST_BYTES }> for FirstRecord {
    fn bytes(number: u64) -> [u8; settings::FIRST_BYTES] {
        first_record_of_stops(SHORTEST + number as f64)
    }

    fn number(bytes: &[u8; settings::FIRST_BYTES]) -> Option<u64> {
        Some(number_of(&Settings::from_record(bytes, &SERIAL).ok()?))
    }
}

/// A slot of the store, with its kind of item.
#[derive(Clone, Copy)]
struct Slot {
    key: u8,
    save: fn(&mut Board, u8, u64) -> Result<(), Fault>,
    load: fn(&mut Board, u8) -> Result<Option<u64>, Fault>,
}

/// The slots that the instrument uses.
const SLOTS: [Slot; 4] = [
    Slot::of::<Heading, { Remembered::BYTES }>(HEADING),
    Slot::of::<Misalignment, BYTES>(0),
    Slot::of::<Misalignment, BYTES>(1),
    Slot::of::<Record, { settings::BYTES }>(settings::SLOT),
];

/// The slot of the record, into which one of version 1 is saved. A record of any version is loaded from it.
const BY_FIRST: Slot = Slot {
    key: settings::SLOT,
    save: save::<FirstRecord, { settings::FIRST_BYTES }>,
    load: load_settings,
};

/// The same, into which one of today is saved.
const BY_TODAY: Slot = Slot { save: save::<Record, { settings::BYTES }>, ..BY_FIRST };

/// The number of the settings in the store, as an instrument loads them.
fn load_settings(flash: &mut Board, _: u8) -> Result<Option<u64>, Fault> {
    match run(settings::load(&mut store(flash), &SERIAL)).expect("it ends") {
        Ok(found) => Ok(found.as_ref().map(number_of)),
        Err(SettingsError::Unreadable(fault)) => Err(fault),
        Err(error) => panic!("the record is whole: {error}"),
    }
}

impl Slot {
    const fn of<I: Item<N>, const N: usize>(key: u8) -> Self {
        Self { key, save: save::<I, N>, load: load::<I, N> }
    }

    fn save(&self, flash: &mut Board, number: u64) -> Result<(), Fault> {
        (self.save)(flash, self.key, number)
    }

    fn forget(&self, flash: &mut Board) -> Result<(), Fault> {
        run(store(flash).forget(self.key)).expect("it ends")
    }

    /// The number of the item in the slot, which is whole.
    fn load(&self, flash: &mut Board) -> Result<Option<u64>, Fault> {
        (self.load)(flash, self.key)
    }
}

fn save<I: Item<N>, const N: usize>(flash: &mut Board, key: u8, number: u64) -> Result<(), Fault> {
    run(store(flash).save(key, &I::bytes(number))).expect("it ends")
}

fn load<I: Item<N>, const N: usize>(flash: &mut Board, key: u8) -> Result<Option<u64>, Fault> {
    let found = run(store(flash).load::<N>(key)).expect("it ends")?;
    Ok(found.map(|bytes| I::number(&bytes).expect("the item is whole")))
}
