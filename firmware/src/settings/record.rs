//! The record of an instrument's settings in its store.
//!
//! It has 248 bytes, nearly as many as an item of a store can have, so that later versions with more fields are of the same
//! size:
//!
//! | bytes | content |
//! |---|---|
//! | 0 | version of the layout, [`VERSION`] |
//! | 1 | carrier: its index in [`Platform::ALL`] |
//! | 2…13 | [`Serial`] of the controller to whose board it belongs |
//! | 14… | [`Settings`] as postcard serialises them: the fields in their order, [`Output`] first, an `f64` as eight bytes and an `f32` as four, little-endian, an integer of more than a byte as a variable-length one, an option or a choice behind its index |
//! | …243 | zeros |
//! | 244…247 | CRC-32 (IEEE 802.3) of all bytes before it, little-endian |
//!
//! A record that is damaged, of a later version, for another carrier, of another board, or out of range is refused as a
//! whole: an instrument must not begin with other values than its user believes in. What the link sends can be read from a
//! record of any carrier and board, so that the link says there why nothing begins.
//!
//! A record of version 1 has 192 bytes, no serial number and no output, and of the settings those of [`First`] alone. It is
//! read as settings whose other fields are the defaults.

use core::fmt;

use drivers::fault::Fault;
use orientation::alignment::setup::SetupError;
use orientation::checksum::crc32_of_bytes;
use orientation::earth::Latitude;
use orientation::units::Radians;
use orientation::words;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::{CarrierSchedule, Gyro, Output, Settings};
use crate::platform::Platform;
use crate::ports::Store;

/// Version of the record's layout.
pub const VERSION: u8 = 2;
/// Size of a record of version 2 and later ones, bytes.
pub const BYTES: usize = 248;
/// Size of a record of version 1, bytes.
pub const FIRST_BYTES: usize = 192;
/// The slot of the record in the store.
pub const SLOT: u8 = 0x81;

/// Size of the checksum at a record's end, bytes.
const CHECKSUM: usize = 4;
/// Size of a serial number, bytes.
const SERIAL: usize = 12;
// A checksum is that of whole words, and the length of an item is a byte.
const _: () = assert!(BYTES.is_multiple_of(4) && FIRST_BYTES.is_multiple_of(4) && BYTES < 256);

/// Serial number of a board's controller, which no other has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Serial(pub [u8; SERIAL]);

impl fmt::Display for Serial {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(formatter, "{byte:02X}"))
    }
}

/// What a record of version 1 states.
#[derive(Deserialize)]
struct First<S> {
    latitude: Latitude,
    gyro: Gyro,
    required_sigma: Radians,
    holds: bool,
    schedule: S,
}

impl<C: CarrierSchedule> From<First<C::First>> for Settings<C> {
    /// The images of that version began at power-on, sent what is usual, and had no calibrations in their records.
    fn from(first: First<C::First>) -> Self {
        Self {
            output: Output::default(),
            latitude: Some(first.latitude),
            starts: true,
            gyro: first.gyro,
            required_sigma: first.required_sigma,
            holds: first.holds,
            schedule: first.schedule.into(),
            calibration: C::Calibration::default(),
        }
    }
}

impl<C: CarrierSchedule> Settings<C> {
    /// Record of these settings for the board whose controller has this serial number.
    ///
    /// # Errors
    /// [`SettingsError::OutOfRange`]; [`SettingsError::Layout`] for a schedule of another crate that
    /// does not fit.
    pub fn to_record(&self, serial: &Serial) -> Result<[u8; BYTES], SettingsError> {
        self.check().map_err(SettingsError::OutOfRange)?;
        let mut record = [0; BYTES];
        let (header, content) = record[..BYTES - CHECKSUM].split_at_mut(2 + SERIAL);
        header[..2].copy_from_slice(&[VERSION, C::PLATFORM as u8]);
        header[2..].copy_from_slice(&serial.0);
        postcard::to_slice(self, content).map_err(|_| SettingsError::Layout)?;
        let checksum = crc32_of_bytes(&record[..BYTES - CHECKSUM]);
        record[BYTES - CHECKSUM..].copy_from_slice(&checksum.to_le_bytes());
        Ok(record)
    }

    /// Checksum of what counts from the next start on: of all but what the link sends.
    pub(super) fn checksum(&self) -> u32 {
        let mut content = [0; BYTES];
        let settings = Self { output: Output::default(), ..self.clone() };
        // It fits, as it does into a record.
        let _ = postcard::to_slice(&settings, &mut content);
        crc32_of_bytes(&content)
    }

    /// Settings of a record of any version, for the board whose controller has this serial number.
    ///
    /// # Errors
    /// Every [`SettingsError`] but those of a store.
    pub fn from_record(record: &[u8], serial: &Serial) -> Result<Self, SettingsError> {
        let Opened { version, carrier, rest } = Opened::new(record)?;
        let settings: Self = match (version, record.len()) {
            (1, FIRST_BYTES) => {
                check_carrier(carrier, C::PLATFORM)?;
                whole::<First<C::First>>(rest)?.into()
            }
            (VERSION, BYTES) => {
                check_carrier(carrier, C::PLATFORM)?;
                let (owner, content) = rest.split_at(SERIAL);
                if *owner != serial.0 {
                    return Err(SettingsError::OtherBoard);
                }
                whole(content)?
            }
            (1 | VERSION, _) => return Err(SettingsError::Layout),
            _ => return Err(SettingsError::UnknownVersion(version)),
        };
        settings.check().map_err(SettingsError::OutOfRange)?;
        Ok(settings)
    }
}

impl Output {
    /// What the link is to send by a record of any carrier and any board; [`None`] for one that is damaged, that does not
    /// say so, or of a version that is not known.
    #[must_use]
    pub fn from_record(record: &[u8]) -> Option<Self> {
        let Opened { version, rest, .. } = Opened::new(record).ok()?;
        if (version, record.len()) != (VERSION, BYTES) {
            return None;
        }
        let (output, _): (Self, _) = postcard::take_from_bytes(rest.get(SERIAL..)?).ok()?;
        output.check().is_ok().then_some(output)
    }
}

/// A record whose checksum is right.
struct Opened<'r> {
    version: u8,
    /// Index of the carrier.
    carrier: u8,
    /// What is between them and the checksum.
    rest: &'r [u8],
}

impl<'r> Opened<'r> {
    /// Opens a record of any version.
    ///
    /// # Errors
    /// [`SettingsError::Damaged`].
    fn new(record: &'r [u8]) -> Result<Self, SettingsError> {
        let is_known = matches!(record.len(), FIRST_BYTES | BYTES);
        let Some((sound, checksum)) = record.split_last_chunk().filter(|_| is_known) else {
            return Err(SettingsError::Damaged);
        };
        match *sound {
            [version, carrier, ref rest @ ..]
                if crc32_of_bytes(sound) == u32::from_le_bytes(*checksum) =>
            {
                Ok(Self { version, carrier, rest })
            }
            _ => Err(SettingsError::Damaged),
        }
    }
}

/// What postcard has serialised into these bytes, with zeros behind it.
fn whole<T: DeserializeOwned>(content: &[u8]) -> Result<T, SettingsError> {
    let (whole, rest) = postcard::take_from_bytes(content).map_err(|_| SettingsError::Layout)?;
    if rest.iter().any(|byte| *byte != 0) {
        return Err(SettingsError::Layout);
    }
    Ok(whole)
}

/// Refuses the carrier of a record unless it is the instrument's own.
fn check_carrier(carrier: u8, own: Platform) -> Result<(), SettingsError> {
    match Platform::ALL.get(usize::from(carrier)) {
        Some(found) if *found == own => Ok(()),
        Some(found) => Err(SettingsError::OtherCarrier { found: *found, own }),
        None => Err(SettingsError::Layout),
    }
}

/// Settings of the record in a store of the board whose controller has this serial number; [`None`] if it has none.
///
/// # Errors
/// [`SettingsError`], if there is a record that must not be used, or if the store does not show
/// whether there is one.
pub async fn load<C: CarrierSchedule>(
    store: &mut impl Store,
    serial: &Serial,
) -> Result<Option<Settings<C>>, SettingsError> {
    let mut record = [0; BYTES];
    let length = store.read(SLOT, &mut record).await.map_err(SettingsError::Unreadable)?;
    length.map(|length| Settings::from_record(&record[..length], serial)).transpose()
}

/// Writes the record of settings into a store of that board; it takes the place of an earlier one.
///
/// # Errors
/// [`SettingsError::OutOfRange`] and [`SettingsError::NotSaved`]; an earlier record stays then.
pub async fn save<C: CarrierSchedule>(
    store: &mut impl Store,
    settings: &Settings<C>,
    serial: &Serial,
) -> Result<(), SettingsError> {
    let record = settings.to_record(serial)?;
    store.save(SLOT, &record).await.map_err(SettingsError::NotSaved)
}

/// Reason for which settings are not used, or not saved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingsError {
    /// The store cannot be read, so that it is unknown whether there is a record.
    Unreadable(Fault),
    /// The store does not take the record.
    NotSaved(Fault),
    /// The record has another length, or fails its checksum.
    Damaged,
    /// The record has this version, which the image does not know.
    UnknownVersion(u8),
    /// The record is for another carrier.
    OtherCarrier {
        /// Carrier of the record.
        found: Platform,
        /// Carrier of the instrument.
        own: Platform,
    },
    /// The record is for another board, and has the calibrations of the instrument there.
    OtherBoard,
    /// The record is sound, but its content has not the layout of its version.
    Layout,
    /// A quantity is out of its range.
    OutOfRange(SetupError),
}

impl core::error::Error for SettingsError {}

words! { SettingsError:
    Self::Unreadable(fault) => "the store that may have a record cannot be read: {}", fault;
    Self::NotSaved(fault) => "the store does not take the record: {}", fault;
    Self::Damaged => "the record fails its checksum";
    Self::UnknownVersion(version) =>
        "the record has version {}, and this image knows versions 1 to {} alone", version, VERSION;
    Self::OtherCarrier { found, own } =>
        "the record is for the carrier {}, and this image for {}", found.name(), own.name();
    Self::OtherBoard => "the record is for another board, and has the calibrations of that one";
    Self::Layout => "the record has not the layout of its version";
    Self::OutOfRange(error) => "{}", error;
}
