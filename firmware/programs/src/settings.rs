//! Settings of the instrument: those of a record in the last two pages of the flash, or the factory settings of the image
//! ([`firmware::settings`]). No image reaches these pages; the log of a start says which settings hold.
//!
//! With a record that must not be used, or cannot be read, nothing begins: log and link say why. Pages that hold something
//! else than a store are erased, which the log says, too.

use drivers::fault::Fault;
use embassy_futures::block_on;
use embassy_stm32::uid::uid;
use firmware::kept_lines::Weight;
use firmware::not_begun::NotBegun;
use firmware::ports::Store as _;
use firmware::settings;
use firmware::settings::{CarrierSchedule, Output, Serial, Settings};
use orientation::earth::Latitude;
use orientation::units::Radians;
use orientation::words::Rounded;

use stm32::UpperBank;
use stm32::wiring::Outlets;

/// Settings of the record in the flash, or those of the image where there is none; logs which. Pages that hold no
/// store are erased, which is logged, too.
///
/// # Errors
/// Settings that must not be used.
pub fn load<C: CarrierSchedule>(outlets: &Outlets) -> Result<Settings<C>, NotBegun> {
    let mut store = outlets.flash.store();
    // Nothing else runs yet that the thread would keep waiting, and no task needs room for these futures.
    let taken_over = block_on(store.take_over());
    if taken_over != Ok(false) {
        tell_of_erasure(outlets, taken_over);
    }
    let (settings, source) = match block_on(settings::load(&mut store, &serial()))? {
        Some(settings) => (settings, "a record in flash"),
        None => (Settings::default(), "the image"),
    };
    settings.check()?;
    tell_of_settings(&settings, source);
    Ok(settings)
}

/// What the link sends by the record in the flash, of any carrier and board; the factory settings where it does not say so.
/// Nothing else runs yet.
#[must_use]
pub fn output(flash: UpperBank) -> Output {
    let mut record = [0; settings::BYTES];
    let length = block_on(flash.store().read(settings::SLOT, &mut record)).ok().flatten();
    let found = length.and_then(|length| Output::from_record(&record[..length]));
    found.unwrap_or_default()
}

/// Serial number of the controller, which no other has (RM0351, 49.1).
pub fn serial() -> Serial {
    Serial(uid())
}

/// Logs that pages held no store, and whether they were erased for one.
fn tell_of_erasure(outlets: &Outlets, taken_over: Result<bool, Fault>) {
    outlets.log.keep(Weight::Outcome, || {
        if let Err(fault) = taken_over {
            defmt::error!(
                "board: the flash holds no store, and cannot be erased for one: {}",
                fault
            );
        } else {
            defmt::warn!("board: the flash held no store, and was erased for one");
        }
    });
}

/// Logs which settings hold.
fn tell_of_settings<C: CarrierSchedule>(settings: &Settings<C>, source: &str) {
    let carrier = C::PLATFORM.name();
    if let Some(latitude) = settings.latitude {
        let latitude = Rounded::<4>(Radians(latitude.rad()).degrees());
        defmt::info!("board: carrier {}, latitude {}°, settings of {}", carrier, latitude, source);
    } else {
        defmt::info!("board: carrier {}, no latitude, settings of {}", carrier, source);
    }
}

/// Logs that the latitude is that of a satellite receiver.
pub fn tell_of_receiver(latitude: Latitude) {
    let latitude = Rounded::<4>(Radians(latitude.rad()).degrees());
    defmt::info!("board: latitude {}° of a satellite receiver", latitude);
}
