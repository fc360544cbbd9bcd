//! Settings of the image: latitude, the precise gyro, and the schedules of the carriers. **Edit this file**
//! before flashing, and [`crate::configuration`] for everything else.
//!
//! A record of settings in the last two pages of the flash ([`firmware::settings`]), which no image reaches,
//! takes the place of all of them; the log of a start says which hold. With a record that must not be used,
//! or cannot be read, nothing begins: log and link say why. Pages that hold something else than a store are
//! erased, which the log says, too.
//!
//! | what | where to get it |
//! |---|---|
//! | [`LATITUDE`] | a map; 0.01° is near enough |
//! | [`GYRO_SCALE`], [`GYRO_SCALE_SIGMA`], [`GYRO_LIMIT`] | the gyro's test sheet, and the amplifier between it and the converter |
//! | [`GYRO_N`], [`GYRO_B`], [`GYRO_K`] | the gyro's data sheet; better `meridian allan` of a record at rest, or a [`SURVEY`] on the board |
//! | [`BIAS_SIGMA`] | in a vehicle, and where the result is held: the gyro's data sheet |
//! | [`HOLDS`] | once the azimuth is known: a choice |
//! | [`ACCURACY`] | how good the azimuth must be; on a stage also how long that may take |
//! | [`POSITIONS`], [`DWELL`], [`SURVEY`] | on a stage: how long it measures; on two frames the dwell alone |
//! | [`PASSES`] | on two frames: how often each heading is taken |
//! | [`HALF`] | on a stage or two frames: what is known of the azimuth beforehand |
//! | [`SPEEDS`], [`MODULATED_TURNS`] | on a turning platform: how fast it is to turn |
//! | [`STOPS`], [`STOP`], [`REALIGNS`] | in a vehicle: how often it stops, and a choice |
//! | [`LAUNCH`] | on a spinning body: how the flight starts |
//!
//! Too small a σ here makes σ of the azimuth too small: if it is uncertain, take the greater one.

use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use embassy_futures::block_on;
use firmware::kept_lines::Weight;
use firmware::not_begun::NotBegun;
use firmware::settings;
use firmware::settings::{
    CarrierSchedule, Gyro, Settings, SpinSchedule, StageSchedule, TurntableSchedule,
    TwoFrameSchedule, VehicleSchedule,
};
use orientation::alignment::rotating::session::Procedure as Turning;
use orientation::alignment::stepwise::setting::Half;
use orientation::attitude;
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::units::{DEGREE, Radians, RadiansPerSecond, Seconds, TURN};
use orientation::words::Rounded;

use crate::configuration::{CONVERTER, period};
use crate::wiring::Outlets;

/// Geodetic latitude, °, north positive; up to ±85°, beyond which no azimuth is determined.
const LATITUDE: f64 = 47.58;
const _: () = assert!(-85.0 <= LATITUDE && LATITUDE <= 85.0);

/// Rate beyond which the gyro's own output may saturate, °/s: 97 % of its range.
const GYRO_LIMIT: f64 = 0.97 * 40.0;
/// Scale factor of the gyro at the converter's input, V per °/s, negative where it is mounted
/// upside down. The converter's range is ±2.5 V.
const GYRO_SCALE: f64 = 0.05;
// A scale factor that the converter's codes cannot have does not compile.
const _: () =
    assert!(Scale::new(GYRO_SCALE / DEGREE, INTERNAL_REFERENCE_VOLTS, CONVERTER.gain).is_some());

/// Angle random walk N of the gyro, °/√h (OIUS-1000 class).
const GYRO_N: f64 = 0.001;
/// Bias instability B of the gyro, °/h.
const GYRO_B: f64 = 0.007;
/// Rate random walk K of the gyro, °/h/√h.
const GYRO_K: f64 = 0.0;
/// Standard deviation of the gyro's scale factor, 1σ, relative.
const GYRO_SCALE_SIGMA: f64 = 5e-4;
/// Standard deviation of the gyro's bias from switch-on to switch-on, 1σ, °/h.
const BIAS_SIGMA: f64 = 0.5;

/// Required 1σ of the azimuth, °, and the time allowed on a stage, s, from the end of the survey or
/// else from the beginning. `None`: the session ends with its schedule.
const ACCURACY: Option<(f64, f64)> = None;
/// Greatest 1σ of the azimuth that is accepted where none is required, °.
const ACCEPTED_SIGMA: f64 = 10.0;
/// Whether azimuth, pitch and roll are held without end after the alignment: on a stage, two frames or a
/// turntable by the LSM6DSL of the board itself, in a vehicle by its precise gyros.
const HOLDS: bool = true;

/// Length of a survey at rest before the alignment, s, in which the gyro's noise is measured; the
/// plan then follows from it, with the total time of the dwells below. `None`: the noise configured
/// above is used. An hour shows B and K, ten minutes N.
const SURVEY: Option<f64> = None;
/// Positions on the full circle; the first is repeated at the end.
const POSITIONS: u8 = 24;
/// Time at each position.
const DWELL: Seconds = Seconds(10.0);
/// Number of times that the four headings of two frames are taken, each for a dwell.
const PASSES: u8 = 6;
/// Half of the circle in which the azimuth is known to lie; two positions require it.
const HALF: Option<Half> = None;

/// Speeds of a rotating platform, turns per second: one for a gyro, two for a molecular-electronic
/// sensor.
const SPEEDS: &[f64] = &[0.137];
/// Rate-modulated turns before those at constant rate, to measure the axis misalignment; zero to
/// use the misalignment stored in flash. `None`: the default number.
const MODULATED_TURNS: Option<u32> = None;

/// Number of stops of a vehicle after which the session concludes, at least two; three with
/// different headings make the gyros' biases observable.
const STOPS: u8 = 3;
/// Time for which the vehicle is to stand at each stop.
const STOP: Seconds = Seconds(60.0);
/// Whether a vehicle realigns once the azimuth is known; the last stop of an alignment is the first
/// of the next.
const REALIGNS: bool = true;

/// Course and pitch at the start of the flight, °: no sensor on the body measures them.
const LAUNCH: [f64; 2] = [0.0, 0.0];

/// Latitude that the image states.
#[expect(clippy::expect_used, reason = "an image that states none is a mistake of the program")]
fn latitude() -> Latitude {
    Latitude::from_degrees(LATITUDE).expect("the image states a latitude")
}

/// Settings of the image with a schedule.
fn of_image<C>(schedule: C) -> Settings<C> {
    let errors = attitude::Gyro {
        noise: GyroNoise::from_field_units(GYRO_N, GYRO_B, GYRO_K, 0.0),
        bias_sigma: RadiansPerSecond::from_degrees_per_hour(BIAS_SIGMA),
        scale_sigma: GYRO_SCALE_SIGMA,
    };
    let limit = RadiansPerSecond(GYRO_LIMIT * DEGREE);
    Settings {
        latitude: latitude(),
        gyro: Gyro { volts_per_rad_per_s: GYRO_SCALE / DEGREE, limit, errors },
        required_sigma: Radians(ACCURACY.map_or(ACCEPTED_SIGMA, |(sigma, _)| sigma) * DEGREE),
        holds: HOLDS,
        schedule,
    }
}

/// Settings of the image on a stage.
pub fn stage() -> Settings<StageSchedule> {
    let (survey, allowed) = (SURVEY.map(Seconds), ACCURACY.map(|(_, seconds)| Seconds(seconds)));
    of_image(StageSchedule { positions: POSITIONS, dwell: DWELL, survey, allowed, half: HALF })
}

/// Settings of the image on two frames.
pub fn two_frame() -> Settings<TwoFrameSchedule> {
    of_image(TwoFrameSchedule { passes: PASSES, dwell: DWELL, half: HALF })
}

/// Settings of the image on a rotating platform, with the default number of turns at constant rate.
pub fn turntable() -> Settings<TurntableSchedule> {
    let mut speeds = [RadiansPerSecond::default(); SPEEDS.len()];
    speeds.iter_mut().zip(SPEEDS).for_each(|(speed, hertz)| speed.0 = hertz * TURN);
    let Turning { speeds, turns, modulated_turns, .. } = Turning::new(&speeds, period());
    let modulated_turns = MODULATED_TURNS.unwrap_or(modulated_turns);
    of_image(TurntableSchedule { speeds, turns, modulated_turns })
}

/// Settings of the image in a vehicle.
pub fn vehicle() -> Settings<VehicleSchedule> {
    of_image(VehicleSchedule { stops: STOPS, stop: STOP, realigns: REALIGNS })
}

/// Settings of the image on a spinning body.
pub fn spin() -> Settings<SpinSchedule> {
    let [course, pitch] = LAUNCH.map(Radians::from_degrees);
    of_image(SpinSchedule { course, pitch })
}

/// Settings of the record in the flash, or those of the image where there is none; logs which. Pages that hold no
/// store are erased, which is logged, too.
///
/// # Errors
/// Settings that must not be used.
pub fn load<C: CarrierSchedule>(
    Outlets { flash, log, .. }: &Outlets,
    of_image: fn() -> Settings<C>,
) -> Result<Settings<C>, NotBegun> {
    let mut store = flash.store();
    // Nothing else runs yet that the thread would keep waiting, and no task needs room for these futures.
    let taken_over = block_on(store.take_over());
    if taken_over != Ok(false) {
        log.keep(Weight::Outcome, || {
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
    let (settings, source) = match block_on(settings::load(&mut store))? {
        Some(settings) => (settings, "a record in flash"),
        None => (of_image(), "the image"),
    };
    settings.check()?;
    let latitude = Rounded::<4>(Radians(settings.latitude.rad()).degrees());
    let carrier = C::PLATFORM.name();
    defmt::info!("board: carrier {}, latitude {}°, settings of {}", carrier, latitude, source);
    Ok(settings)
}
