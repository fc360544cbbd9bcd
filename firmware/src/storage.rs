//! What is kept over a loss of supply: how the gyro feels the platform's own rate, one coupling for each
//! speed, with date and temperature.
//!
//! A coupling is found by uneven turns. One that is fresh enough spares them. Images that keep nothing
//! name nothing of this module and pay nothing for it.

use drivers::fault::Fault;
use embedded_storage_async::nor_flash::NorFlash;
use orientation::align::rotating::coupling::{BYTES, Coupling};
use orientation::align::rotating::solution::SPEEDS;
use sequential_storage::cache::{Cache, Uncached};
use sequential_storage::map::{MapConfig, MapStorage};

use crate::ports::CalibrationStore;

/// Bytes for the longest item: key and coupling, in whole words of flash.
const BUFFER: usize = (1 + BYTES).next_multiple_of(32);

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

/// The couplings of the first so many speeds, where each of them was kept, is sound and fresh; else none:
/// then the platform is to turn unevenly first.
///
/// # Errors
/// The store's.
pub async fn recall<S: CalibrationStore>(
    store: &mut S,
    speeds: usize,
    today: Today,
) -> Result<Option<[Option<Coupling>; SPEEDS]>, Fault> {
    let mut couplings = [None; SPEEDS];
    for (slot, place) in (0..).zip(couplings.iter_mut().take(speeds)) {
        let found = store.load(slot).await?.as_ref().and_then(Coupling::from_bytes);
        *place = found.filter(|coupling| today.is_fresh(coupling));
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
