//! What is kept over a loss of supply: how the gyro feels the platform's own rate, one coupling for each
//! speed, with date and temperature; and the heading of a vehicle at rest.
//!
//! A coupling is found by uneven turns. One that is fresh enough spares them. Images that keep nothing
//! pay nothing for it.

use drivers::fault::Fault;
use embedded_storage_async::nor_flash::NorFlash;
use orientation::align::rotating::Setting;
use orientation::align::rotating::coupling::{BYTES, Coupling};
use orientation::align::rotating::solution::SPEEDS;
use orientation::keep;
use orientation::session::rotating::{Procedure, Session};
use orientation::units::DEGREES_PER_RADIAN as DEGREES;
use orientation::words;
use orientation::words::Rounded;
use sequential_storage::cache::{Cache, Uncached};
use sequential_storage::map::{MapConfig, MapStorage};

use crate::date::Day;
use crate::event::Event;
use crate::ports::{CalibrationStore, HeadingStore, Observer};
use crate::shared::Shared;

/// Bytes for the longest item: key and coupling or heading, in whole words of flash.
const BUFFER: usize = (1 + LONGEST).next_multiple_of(32);
/// Bytes of the longer of both.
const LONGEST: usize = if BYTES > HEADING_BYTES { BYTES } else { HEADING_BYTES };
/// Bytes of a heading.
const HEADING_BYTES: usize = keep::restart::Remembered::BYTES;

/// Couplings in the pages of a flash that are set aside for them. What is written comes beside what was
/// there before: until it is there whole, the old one counts.
pub struct FlashStore<F: NorFlash> {
    map: MapStorage<u8, F, Cache<Uncached, Uncached, Uncached, u8>>,
    buffer: [u8; BUFFER],
}

impl<F: NorFlash> FlashStore<F> {
    /// Takes a flash with a range of at least two of its pages, which `MapConfig::new` checks, in a
    /// constant when the image is built.
    pub const fn new(flash: F, range: MapConfig<F>) -> Self {
        Self { map: MapStorage::new(flash, range, Cache::new_uncached()), buffer: [0; BUFFER] }
    }

    /// The flash again.
    pub fn into_flash(self) -> F {
        self.map.destroy().0
    }
}

impl<F: NorFlash> CalibrationStore for FlashStore<F> {
    async fn load(&mut self, slot: u8) -> Result<Option<[u8; BYTES]>, Fault> {
        let found = self.map.fetch_item::<[u8; BYTES]>(&mut self.buffer, &slot).await;
        found.map_err(|_| Fault::Bus)
    }

    async fn save(&mut self, slot: u8, bytes: &[u8; BYTES]) -> Result<(), Fault> {
        let kept = self.map.store_item(&mut self.buffer, &slot, bytes).await;
        kept.map_err(|_| Fault::Bus)
    }
}

/// The slot of the heading, beside those of the speeds.
const HEADING: u8 = 0x80;

impl<F: NorFlash> HeadingStore for FlashStore<F> {
    async fn load_heading(&mut self) -> Result<Option<[u8; HEADING_BYTES]>, Fault> {
        let found = self.map.fetch_item::<[u8; HEADING_BYTES]>(&mut self.buffer, &HEADING);
        found.await.map_err(|_| Fault::Bus)
    }

    async fn save_heading(&mut self, bytes: &[u8; HEADING_BYTES]) -> Result<(), Fault> {
        let kept = self.map.store_item(&mut self.buffer, &HEADING, bytes).await;
        kept.map_err(|_| Fault::Bus)
    }
}

/// What the outside says of the time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Today {
    /// Seconds since 1970; none where nobody knows.
    pub date: Option<u64>,
    /// How old a coupling may be, s; none for however old.
    pub longest: Option<u64>,
}

impl Today {
    /// Whether a coupling is fresh. One without date, or where today's is not known, is not, unless it may
    /// be however old; one from the future never.
    #[must_use]
    pub fn is_fresh(&self, coupling: &Coupling) -> bool {
        let known = |date: u64| Some(date).filter(|date| *date > 0);
        match (self.date, known(coupling.date), self.longest) {
            (Some(today), Some(found), longest) => {
                let age = today.checked_sub(found);
                age.is_some_and(|age| longest.is_none_or(|longest| age <= longest))
            }
            (_, _, longest) => longest.is_none(),
        }
    }
}

/// How far from a speed a coupling may have been found, relative: the motor's clock is off by some
/// hundredths, and not always by the same.
const SAME_SPEED: f64 = 0.1;

/// The couplings of these speeds, rad/s, where for each of them one was kept that is sound, fresh and of
/// that speed; else none: then the platform is to turn unevenly first.
///
/// # Errors
/// The store's.
pub async fn recall<S: CalibrationStore>(
    store: &mut S,
    speeds: &[f64],
    today: Today,
) -> Result<Option<[Option<Coupling>; SPEEDS]>, Fault> {
    let mut couplings = [None; SPEEDS];
    for ((slot, place), speed) in (0..).zip(&mut couplings).zip(speeds) {
        let is_near = |found: f64| (found - speed).abs() < SAME_SPEED * speed;
        let found = store.load(slot).await?.as_ref().and_then(Coupling::from_bytes);
        *place = found.filter(|found| today.is_fresh(found) && is_near(found.frequency));
        if place.is_none() {
            return Ok(None);
        }
    }
    Ok(Some(couplings))
}

/// Keeps the couplings that a session has found, by their speeds; those of a session that found none
/// stay.
///
/// # Errors
/// The store's.
pub async fn keep<S: CalibrationStore>(
    store: &mut S,
    found: impl Iterator<Item = Coupling>,
) -> Result<(), Fault> {
    for (slot, coupling) in (0..).zip(found) {
        store.save(slot, &coupling.to_bytes()).await?;
    }
    Ok(())
}

/// Before a session: dates what it will find and, where its procedure has no uneven turns, gives it what
/// was kept. Tells what was recalled.
pub async fn load_calibration<S: CalibrationStore, O: Observer>(
    store: &mut S,
    today: Today,
    (setting, procedure): (&mut Setting, &mut Procedure),
    shared: &Shared<'_, O>,
) {
    procedure.date = today.date.unwrap_or_default();
    if procedure.uneven_turns > 0 {
        return;
    }
    match recall(store, &procedure.speeds, today).await {
        Ok(Some(couplings)) => {
            setting.couplings = couplings;
            for coupling in couplings.iter().flatten() {
                shared.tell(Event::Recalled(coupling.into()));
            }
        }
        Ok(None) => shared.tell(Event::NothingRecalled),
        Err(fault) => shared.tell(Event::CalibrationUnreadable(fault)),
    }
}

/// After a session: keeps the couplings that it found, if north was found with them, and tells it. What
/// could not be trusted for north is not trusted for the next time.
pub async fn save_calibration<S: CalibrationStore, O: Observer>(
    store: &mut S,
    session: &Session,
    shared: &Shared<'_, O>,
) {
    if session.conclusion().is_none_or(|conclusion| conclusion.verdict.is_err()) {
        return;
    }
    match keep(store, session.couplings()).await {
        Ok(()) => {
            session
                .couplings()
                .for_each(|found| shared.tell(Event::CalibrationSaved((&found).into())));
        }
        Err(fault) => shared.tell(Event::CalibrationNotSaved(fault)),
    }
}

/// What is told of a stored coupling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remembered {
    /// How far the gyro's axis stands above the platform, °.
    pub angle: f64,
    /// Rate of the platform at which it was found, °/s.
    pub rate: f64,
    /// The day.
    pub day: Day,
    /// Temperature then, °C.
    pub temperature: f32,
}

impl From<&Coupling> for Remembered {
    fn from(coupling: &Coupling) -> Self {
        Self {
            angle: coupling.angle() * DEGREES,
            rate: coupling.frequency * DEGREES,
            day: Day::of(coupling.date),
            temperature: coupling.temperature,
        }
    }
}

words! { Remembered:
    Self { angle, rate, day, temperature } =>
        "gyro's axis {}° above the platform at {} °/s, found on {} at {} °C",
        Rounded::<4>(angle), Rounded::<2>(rate), day, Rounded::<1>(f64::from(temperature));
}
