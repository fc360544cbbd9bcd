//! Settings of an instrument, which a record in its store states without a new image: latitude, the
//! precise gyro, and the schedule of its carrier. Without a record the image's own settings hold.
//!
//! A record takes 192 bytes, so that later versions with more fields are of the same size:
//!
//! | bytes | content |
//! |---|---|
//! | 0 | version of the layout, [`VERSION`] |
//! | 1 | carrier: its index in [`Platform::ALL`] |
//! | 2… | [`Settings`] as postcard serialises it: the fields in their order, an `f64` as eight bytes little-endian, an integer of more than a byte as a variable-length one, an option or a choice behind its index |
//! | …187 | zeros |
//! | 188…191 | CRC-32 (IEEE 802.3) of all bytes before it, little-endian |
//!
//! A record that is damaged, of another version, for another carrier, or out of range is refused as a
//! whole: an instrument must not begin with other values than its user believes in.

mod output;
mod schedule;

pub use output::{FASTEST, Format, ITEMS, Item, Output};
pub use schedule::{
    CarrierSchedule, SpinSchedule, StageSchedule, TurntableSchedule, TwoFrameSchedule,
    VehicleSchedule,
};

use drivers::ads1262::configuration::Gain;
use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use drivers::fault::Fault;
use orientation::alignment::setup::{GREATEST, Quantity, SetupError, check_ranges};
use orientation::alignment::site::Site;
use orientation::attitude;
use orientation::checksum::crc32_of_bytes;
use orientation::earth::{EARTH_RATE, HIGHEST_LATITUDE, Latitude};
use orientation::noise::model::StatedNoise;
use orientation::units::{AngularRate, Radians, RadiansPerSecond};
use orientation::words;
use serde::{Deserialize, Serialize};

use crate::platform::Platform;
use crate::ports::Store;

/// Version of the record's layout.
pub const VERSION: u8 = 1;
/// Size of a record of any version, bytes.
pub const BYTES: usize = 192;
/// The slot of the record in the store.
pub const SLOT: u8 = 0x81;

/// Size of the checksum at a record's end, bytes.
const CHECKSUM: usize = 4;
/// Least and greatest limit of a gyro, rad/s: below the Earth rate there is nothing to measure, and an
/// [`AngularRate`] holds no more.
const LIMITS: [f64; 2] = [EARTH_RATE, i32::MAX as f64 * 1e-9];
/// Least and greatest magnitude of a scale factor, V per rad/s: a code of the converter is then 2³⁰ or
/// 2⁻³² nrad/s, the limits of a [`Scale`].
const SCALE_FACTORS: [f64; 2] =
    [INTERNAL_REFERENCE_VOLTS * 1e9 / (1_u64 << 61) as f64, INTERNAL_REFERENCE_VOLTS * 1e9 * 2.0];
// A checksum is that of whole words.
const _: () = assert!((BYTES - CHECKSUM).is_multiple_of(4));

/// Settings of an instrument on the carrier of the schedule `C`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings<C> {
    /// Geodetic latitude, up to ±85°. A spinning body does not use it.
    pub latitude: Latitude,
    /// The precise gyro, in a vehicle each of the three. A spinning body has others.
    pub gyro: Gyro,
    /// Greatest standard deviation of the azimuth that is accepted, 1σ.
    pub required_sigma: Radians,
    /// Whether azimuth, pitch and roll are held without end after the alignment. A spinning body's are
    /// not.
    pub holds: bool,
    /// Schedule of the session.
    pub schedule: C,
}

/// A precise gyro behind its converter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gyro {
    /// Scale factor at the converter's input, V per rad/s; negative where the axis is reversed. The
    /// converter's range is ±2.5 V.
    pub volts_per_rad_per_s: f64,
    /// Rate beyond which the gyro's own output may saturate, up to 2.1 rad/s.
    pub limit: RadiansPerSecond,
    /// Noise, and standard deviations of bias and scale factor.
    pub errors: attitude::Gyro,
}

impl Gyro {
    /// Scale of the codes of its converter, which has this gain and its internal reference.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`] for a scale factor of zero, or one that cannot be represented.
    pub fn scale(&self, gain: Gain) -> Result<Scale, SetupError> {
        let (name, value) = ("magnitude of volts_per_rad_per_s", self.volts_per_rad_per_s);
        let scale = Scale::new(value, INTERNAL_REFERENCE_VOLTS, gain);
        let quantity = Quantity { name, value: value.abs(), range: SCALE_FACTORS };
        scale.ok_or(SetupError::OutOfRange(quantity))
    }

    /// Rate beyond which its output may saturate.
    pub fn limit(&self) -> AngularRate {
        AngularRate((self.limit.0 * 1e9) as i32)
    }
}

impl<C: CarrierSchedule> Settings<C> {
    /// Site of an alignment with these settings; what they do not state is that of an ideal
    /// instrument ([`Site::at`]).
    #[must_use]
    pub fn site(&self) -> Site {
        let attitude::Gyro { noise, scale_sigma, .. } = self.gyro.errors;
        Site {
            noise: StatedNoise::Whole(noise),
            scale_sigma,
            required_sigma: self.required_sigma,
            ..Site::at(self.latitude)
        }
    }

    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`], which names the first field that is not.
    pub fn check(&self) -> Result<(), SetupError> {
        let Gyro { limit, errors, .. } = self.gyro;
        check_ranges(&[
            ("latitude", self.latitude.rad(), [-HIGHEST_LATITUDE, HIGHEST_LATITUDE]),
            ("limit", limit.0, LIMITS),
            ("bias_sigma", errors.bias_sigma.0, [0.0, GREATEST]),
        ])?;
        self.gyro.scale(Gain::X1)?;
        self.site().check()?;
        self.schedule.check()
    }

    /// Record of these settings.
    ///
    /// # Errors
    /// [`SettingsError::OutOfRange`]; [`SettingsError::Layout`] for a schedule of another crate that
    /// does not fit.
    pub fn to_record(&self) -> Result<[u8; BYTES], SettingsError> {
        self.check().map_err(SettingsError::OutOfRange)?;
        let mut record = [0; BYTES];
        let [version, carrier, content @ .., _, _, _, _] = &mut record;
        (*version, *carrier) = (VERSION, C::PLATFORM as u8);
        postcard::to_slice(self, content).map_err(|_| SettingsError::Layout)?;
        let checksum = crc32_of_bytes(&record[..BYTES - CHECKSUM]);
        record[BYTES - CHECKSUM..].copy_from_slice(&checksum.to_le_bytes());
        Ok(record)
    }

    /// Settings of a record.
    ///
    /// # Errors
    /// Every [`SettingsError`] but those of a store.
    pub fn from_record(record: &[u8]) -> Result<Self, SettingsError> {
        let record: &[u8; BYTES] = record.try_into().map_err(|_| SettingsError::Damaged)?;
        let [sound @ .., a, b, c, d] = record;
        if crc32_of_bytes(sound) != u32::from_le_bytes([*a, *b, *c, *d]) {
            return Err(SettingsError::Damaged);
        }
        let [version, carrier, content @ ..] = sound;
        if *version != VERSION {
            return Err(SettingsError::UnknownVersion(*version));
        }
        check_carrier(*carrier, C::PLATFORM)?;
        let (settings, rest): (Self, _) =
            postcard::take_from_bytes(content).map_err(|_| SettingsError::Layout)?;
        if rest.iter().any(|byte| *byte != 0) {
            return Err(SettingsError::Layout);
        }
        settings.check().map_err(SettingsError::OutOfRange)?;
        Ok(settings)
    }
}

/// Refuses the carrier of a record unless it is the instrument's own.
fn check_carrier(carrier: u8, own: Platform) -> Result<(), SettingsError> {
    match Platform::ALL.get(usize::from(carrier)) {
        Some(found) if *found == own => Ok(()),
        Some(found) => Err(SettingsError::OtherCarrier { found: *found, own }),
        None => Err(SettingsError::Layout),
    }
}

/// Settings of the record in a store; [`None`] if it has none.
///
/// # Errors
/// [`SettingsError`], if there is a record that must not be used, or if the store does not show
/// whether there is one.
pub async fn load<C: CarrierSchedule>(
    store: &mut impl Store,
) -> Result<Option<Settings<C>>, SettingsError> {
    let record: Option<[u8; BYTES]> = store.load(SLOT).await.map_err(SettingsError::Unreadable)?;
    record.map(|record| Settings::from_record(&record)).transpose()
}

/// Writes the record of settings into a store; it takes the place of an earlier one.
///
/// # Errors
/// [`SettingsError::OutOfRange`] and [`SettingsError::NotSaved`]; an earlier record stays then.
pub async fn save<C: CarrierSchedule>(
    store: &mut impl Store,
    settings: &Settings<C>,
) -> Result<(), SettingsError> {
    let record = settings.to_record()?;
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
        "the record has version {}, and this image knows version {} alone", version, VERSION;
    Self::OtherCarrier { found, own } =>
        "the record is for the carrier {}, and this image for {}", found.name(), own.name();
    Self::Layout => "the record has not the layout of its version";
    Self::OutOfRange(error) => "{}", error;
}
