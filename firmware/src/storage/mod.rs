//! Data kept over a loss of supply: the axis misalignment of the gyro on a turntable, one for each
//! speed, with date and temperature; the heading of a vehicle at rest; and the [`settings`](crate::settings). Apart from
//! them, a [`Ring`] of what the log has told.
//!
//! The axis misalignment is estimated by rate-modulated turns; a recent one makes these turns
//! unnecessary. Images without storage contain none of this code.

mod flash;
mod ring;

pub use flash::FlashStore;
pub use ring::{CONTENT, LogRecord, PAGE, Pages, Ring, Row, record_after, records};

use drivers::fault::Fault;
use embassy_futures::select::select;
use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::mutex::Mutex;
use orientation::alignment::Method;
use orientation::alignment::rotating::Setting;
use orientation::alignment::rotating::misalignment::AxisMisalignment;
use orientation::alignment::rotating::session::Procedure;
use orientation::alignment::rotating::turn::SPEEDS;
use orientation::signal::Sample;
use orientation::units::RadiansPerSecond;

use crate::event::Event;
use crate::ports::{Recorder, Store};
use crate::shared::{Channels, Shared, discard};

/// A store that several parts of an instrument use, one after the other.
pub type SharedStore<T> = Mutex<NoopRawMutex, T>;

impl<T: Store> Store for &SharedStore<T> {
    async fn read(&mut self, slot: u8, item: &mut [u8]) -> Result<Option<usize>, Fault> {
        self.lock().await.read(slot, item).await
    }

    async fn save<const N: usize>(&mut self, slot: u8, item: &[u8; N]) -> Result<(), Fault> {
        self.lock().await.save(slot, item).await
    }

    async fn forget(&mut self, slot: u8) -> Result<(), Fault> {
        self.lock().await.forget(slot).await
    }

    async fn record_after(&mut self, number: u32) -> Option<LogRecord> {
        self.lock().await.record_after(number).await
    }
}

/// The slot of the heading; the slots of axis misalignments are the indices of speeds, that of the
/// settings is [`settings::SLOT`](crate::settings::SLOT).
pub const HEADING: u8 = 0x80;

/// The date, and the permitted age of a calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Today {
    /// Seconds since 1970-01-01; [`None`] if the date is unknown.
    pub date: Option<u64>,
    /// Largest age of an axis misalignment, s; [`None`] for any age.
    pub longest: Option<u64>,
}

impl Today {
    /// Whether an axis misalignment is recent enough. If its date or today's is unknown, only where
    /// any age is permitted; one with a date in the future never is.
    #[must_use]
    pub fn is_fresh(&self, misalignment: &AxisMisalignment) -> bool {
        let known = |date: u64| Some(date).filter(|date| *date > 0);
        match (self.date, known(misalignment.date), self.longest) {
            (Some(today), Some(found), longest) => {
                let age = today.checked_sub(found);
                age.is_some_and(|age| longest.is_none_or(|longest| age <= longest))
            }
            (_, _, longest) => longest.is_none(),
        }
    }
}

/// Largest relative difference between the speed of a stored axis misalignment and the requested
/// one. The motor's clock is off by some hundredths, and not constant.
const SAME_SPEED: f64 = 0.1;

/// Reads the axis misalignments for these speeds, rad/s. [`None`] unless each speed has one that is
/// intact, recent and of that speed; rate-modulated turns are needed then.
///
/// # Errors
/// The fault of the store.
pub async fn recall<S: Store>(
    store: &mut S,
    speeds: &[RadiansPerSecond],
    today: Today,
) -> Result<Option<[Option<AxisMisalignment>; SPEEDS]>, Fault> {
    let mut misalignments = [None; SPEEDS];
    for ((slot, place), speed) in (0..).zip(&mut misalignments).zip(speeds) {
        let is_near = |found: f64| (found - speed.0).abs() < SAME_SPEED * speed.0;
        let found = store.load(slot).await?.as_ref().and_then(AxisMisalignment::from_bytes);
        *place = found.filter(|found| today.is_fresh(found) && is_near(found.frequency.0));
        if place.is_none() {
            return Ok(None);
        }
    }
    Ok(Some(misalignments))
}

/// Stores the axis misalignments of a session by the index of their speed. Without any, those
/// stored before stay.
///
/// # Errors
/// The fault of the store.
pub async fn keep<S: Store>(
    store: &mut S,
    found: impl Iterator<Item = AxisMisalignment>,
) -> Result<(), Fault> {
    for (slot, misalignment) in (0..).zip(found) {
        store.save(slot, &misalignment.to_bytes()).await?;
    }
    Ok(())
}

/// Prepares a session: sets its date and, if its procedure has no rate-modulated turns, gives it
/// the stored axis misalignments. Reports what is used.
pub async fn load_calibration<S: Store>(
    store: &mut S,
    today: Today,
    (setting, procedure): (&mut Setting, &mut Procedure),
    shared: &Shared<'_>,
) {
    procedure.date = today.date.unwrap_or_default();
    if procedure.modulated_turns > 0 {
        return;
    }
    match recall(store, &procedure.speeds, today).await {
        Ok(Some(misalignments)) => {
            setting.misalignments = misalignments;
            for misalignment in misalignments.iter().flatten() {
                shared.report(Event::Recalled(misalignment.into()));
            }
        }
        Ok(None) => shared.report(Event::NothingRecalled),
        Err(fault) => shared.report(Event::CalibrationUnreadable(fault)),
    }
}

/// Stores the axis misalignments of every alignment that has found an azimuth with them, and reports
/// it. An alignment without an azimuth stores none. Samples are discarded meanwhile.
pub struct CalibrationStore<'c, T> {
    /// Store that outlasts a loss of supply.
    pub store: T,
    /// Channels of the instrument.
    pub channels: &'c Channels<'c>,
}

impl<T: Store> Recorder for CalibrationStore<'_, T> {
    async fn conclude(&mut self, method: &dyn Method<Sample>) {
        if !matches!(method.verdict(), Some(Ok(_))) {
            return;
        }
        let Self { store, channels } = self;
        let found = || (0..SPEEDS).map_while(|speed| method.misalignment(speed));
        let saved = async {
            match keep(store, found()).await {
                Ok(()) => found().for_each(|found| {
                    channels.shared.report(Event::CalibrationSaved((&found).into()));
                }),
                Err(fault) => channels.shared.report(Event::CalibrationNotSaved(fault)),
            }
        };
        select(saved, discard(channels)).await;
    }
}
