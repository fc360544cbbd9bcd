//! Settings of an instrument, which a record in its store states without a new image: what it sends, its latitude, the
//! precise gyro, the schedule of its carrier, and what was measured of it. Without a record the factory settings hold,
//! which are the defaults.
//!
//! | file | what it is |
//! |---|---|
//! | `output.rs` | what the link sends, and how often |
//! | `schedule.rs` | schedules of the carriers |
//! | `calibration.rs` | calibrations of the carriers |
//! | `factory.rs` | factory settings |
//! | `board.rs` | those of a board at work |
//! | `record.rs` | the record, its versions, and why one is refused |
//! | `names.rs` | every setting by a name, in its user's unit |

mod board;
mod calibration;
mod factory;
mod names;
mod output;
mod record;
mod schedule;

pub use board::{BoardSettings, SharedSettings};
pub use calibration::{
    Analogue, Calibration, Felt, FramesCalibration, Geometry, PlatformCalibration, SpinCalibration,
    TurntableCalibration, VehicleCalibration,
};
pub use names::{
    CALIBRATIONS, EditError, Editable, Entry, LONGEST, List, NONE, Named, Start, Stated,
};
pub use output::{FASTEST, Format, ITEMS, Item, Output};
pub use record::{BYTES, FIRST_BYTES, SLOT, Serial, SettingsError, VERSION, load, save};
pub use schedule::{
    CarrierSchedule, FirstVehicleSchedule, SpinSchedule, StageSchedule, TurntableSchedule,
    TwoFrameSchedule, VehicleSchedule,
};

use core::f64::consts::PI;

use drivers::ads1262::configuration::Gain;
use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use orientation::alignment::setup::{Quantity, SetupError, check_ranges};
use orientation::alignment::site::Site;
use orientation::attitude;
use orientation::earth::{EARTH_RATE, HIGHEST_LATITUDE, Latitude};
use orientation::noise::model::StatedNoise;
use orientation::units::{
    ARCSECOND, AngularRate, DEGREE, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, DEGREES_PER_RADIAN,
    Radians, RadiansPerSecond,
};
use serde::{Deserialize, Serialize};

use names::{DEGREES, PARTS, Unit, put};

/// Least and greatest limit of a gyro, rad/s: below the Earth rate there is nothing to measure, and an
/// [`AngularRate`] holds no more.
const LIMITS: [f64; 2] = [EARTH_RATE, i32::MAX as f64 * 1e-9];
/// Least and greatest 1σ of an azimuth that may be required, rad: from 2″, which no gyro here reaches, to half a turn.
const REQUIRED: [f64; 2] = [1e-5, PI];
/// Least and greatest magnitude of a scale factor, V per rad/s: a code of the converter is then 2³⁰ or
/// 2⁻³² nrad/s, the limits of a [`Scale`].
const SCALE_FACTORS: [f64; 2] =
    [INTERNAL_REFERENCE_VOLTS * 1e9 / (1_u64 << 61) as f64, INTERNAL_REFERENCE_VOLTS * 1e9 * 2.0];
/// Latitude, °, to a centimetre.
const LATITUDE: Unit = Unit { places: 7, si: DEGREE };
/// Scale factor of a gyro: V per °/s, to a billionth of the usual tenth.
const GYRO_SCALE: Unit = Unit { places: 10, si: DEGREES_PER_RADIAN };
/// Limit of a gyro, °/s.
const GYRO_LIMIT: Unit = Unit { places: 4, si: DEGREE };
/// Q of a gyro, ″; N, °/√h, to a thousandth of the best; B, °/h; K, °/h/√h; R, °/h².
const GYRO_NOISE: [Unit; 5] = [
    Unit { places: 5, si: ARCSECOND },
    Unit { places: 7, si: DEGREE_PER_SQRT_HOUR },
    Unit { places: 6, si: DEGREE_PER_HOUR },
    Unit { places: 6, si: DEGREE_PER_HOUR / 60.0 },
    Unit { places: 6, si: DEGREE_PER_HOUR / 3600.0 },
];
/// σ of a gyro's bias, °/h.
const GYRO_BIAS: Unit = Unit { places: 5, si: DEGREE_PER_HOUR };

/// Settings of an instrument on the carrier of the schedule `C`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Settings<C: CarrierSchedule> {
    /// What the link sends.
    pub output: Output,
    /// Geodetic latitude, up to ±85°; [`None`] until it is stated. A spinning body does not use it, and nothing else
    /// begins without one.
    pub latitude: Option<Latitude>,
    /// Whether an alignment begins at power-on without an order.
    pub starts: bool,
    /// The precise gyro, in a vehicle each of the three. A spinning body has others.
    pub gyro: Gyro,
    /// Greatest standard deviation of the azimuth that is accepted, 1σ.
    pub required_sigma: Radians,
    /// Whether azimuth, pitch and roll are held without end after the alignment. A spinning body's are
    /// not.
    pub holds: bool,
    /// Schedule of the session.
    pub schedule: C,
    /// What was measured of the instrument.
    pub calibration: C::Calibration,
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
    /// Site of an alignment with these settings at this latitude, theirs; what they do not state is that of an ideal
    /// instrument ([`Site::at`]).
    #[must_use]
    pub fn site(&self, latitude: Latitude) -> Site {
        let attitude::Gyro { noise, scale_sigma, .. } = self.gyro.errors;
        let ideal = Site::at(latitude);
        let felt = self.calibration.felt();
        Site {
            noise: StatedNoise::Whole(noise),
            scale_sigma,
            g_sensitivity: felt.map_or(ideal.g_sensitivity, |felt| felt.g_sensitivity),
            g_sensitivity_sigma: felt
                .map_or(ideal.g_sensitivity_sigma, |felt| felt.g_sensitivity_sigma),
            accelerometer_bias_sigma: felt
                .map_or(ideal.accelerometer_bias_sigma, |felt| felt.force_bias_sigma),
            required_sigma: self.required_sigma,
            ..ideal
        }
    }

    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`], which names the first field that is not.
    pub fn check(&self) -> Result<(), SetupError> {
        self.output.check()?;
        let Gyro { limit, errors, .. } = self.gyro;
        let latitude = self.latitude.unwrap_or(Latitude::EQUATOR);
        check_ranges(&[
            ("latitude", latitude.rad(), [-HIGHEST_LATITUDE, HIGHEST_LATITUDE]),
            ("limit", limit.0, LIMITS),
            ("bias_sigma", errors.bias_sigma.0, [0.0, LIMITS[1]]),
            ("scale_sigma", errors.scale_sigma, [0.0, 1.0]),
            ("required_sigma", self.required_sigma.0, REQUIRED),
        ])?;
        self.gyro.scale(Gain::X1)?;
        self.site(latitude).check()?;
        self.schedule.check()?;
        self.calibration.check()
    }
}

impl Named for Gyro {
    fn list(&mut self, list: &mut List<'_>) {
        let attitude::Gyro { noise, bias_sigma, scale_sigma } = &mut self.errors;
        let [q, n, b, k, r] = GYRO_NOISE;
        list.number("gyro_scale", GYRO_SCALE, &mut self.volts_per_rad_per_s);
        list.number("gyro_scale_sigma", PARTS, scale_sigma);
        list.number("gyro_limit", GYRO_LIMIT, &mut self.limit.0);
        list.number("gyro_q", q, &mut noise.quantisation.0);
        list.number("gyro_n", n, &mut noise.angle_random_walk.0);
        list.number("gyro_b", b, &mut noise.bias_instability.0);
        list.number("gyro_k", k, &mut noise.rate_random_walk.0);
        list.number("gyro_r", r, &mut noise.rate_ramp.0);
        list.number("gyro_bias_sigma", GYRO_BIAS, &mut bias_sigma.0);
    }
}

/// Lists a latitude.
fn list_latitude(list: &mut List<'_>, latitude: &mut Option<Latitude>) {
    let value = latitude.map_or(f64::NAN, |latitude| Radians(latitude.rad()).degrees());
    list.optional("latitude", LATITUDE, value, &mut |stated| {
        *latitude = stated.and_then(Latitude::from_degrees);
        latitude.is_some() == stated.is_some()
    });
}

impl<C: CarrierSchedule> Named for Settings<C> {
    /// Lists those that its carrier uses.
    fn list(&mut self, list: &mut List<'_>) {
        self.output.list(list);
        list.flag("autostart", &mut self.starts);
        if C::PLATFORM.has_azimuth() {
            list_latitude(list, &mut self.latitude);
            list.number("accuracy", DEGREES, &mut self.required_sigma.0);
            list.flag("hold", &mut self.holds);
            self.gyro.list(list);
        }
        self.schedule.list(list);
        self.calibration.list(list);
    }
}

impl<C: CarrierSchedule> Editable for Settings<C> {
    fn set(&mut self, name: &str, value: f64) -> Result<(), EditError> {
        let mut changed = self.clone();
        let si = put(&mut changed, name, value)?;
        changed.check().map_err(|error| EditError::of(error, value * si, si))?;
        *self = changed;
        Ok(())
    }

    fn checksum(&self) -> u32 {
        self.checksum()
    }

    fn to_record(&self, serial: &Serial) -> Result<[u8; BYTES], SettingsError> {
        self.to_record(serial)
    }

    fn restore(&mut self) {
        *self = Self::default();
    }

    fn carrier(&self) -> &'static str {
        C::PLATFORM.name()
    }

    fn output(&self) -> Output {
        self.output
    }

    fn start(&self) -> Start {
        let needs_latitude = C::PLATFORM.has_azimuth();
        Start { stated: self.latitude, needs_latitude, is_at_power_on: self.starts }
    }
}
