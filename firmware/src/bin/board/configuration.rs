//! What this board must be told before it is flashed: **edit this file**, the link takes no commands.
//!
//! | what | where to get it |
//! |---|---|
//! | [`CARRIER`] | what carries the gyro: a stage, a platform on a slip ring, a vehicle with three, or a spinning body with three |
//! | [`LATITUDE`] | a map; 0.01° is near enough |
//! | [`GYRO_SCALE`], [`GYRO_SCALE_SIGMA`], [`GYRO_LIMIT`] | the gyro's test sheet, and the amplifier between it and the converter |
//! | [`GYRO_N`], [`GYRO_B`], [`GYRO_K`] | the gyro's data sheet; better `meridian allan` of a record at rest, or a [`SURVEY`] on the board |
//! | [`G_SENSITIVITY`] | the test sheet, or a calibration with the axis up and down |
//! | [`SPEEDS`], [`SENSOR`], [`UNEVEN_TURNS`] | of a turning platform: how fast it is to turn, and what turns |
//! | [`STOPS`], [`BIAS_SIGMA`], [`FORCE_CALIBRATED_SIGMA`] | in a vehicle: how many stops, and what the test sheets promise |
//! | [`REALIGNS`], [`ALIGNS_ALWAYS`] | in a vehicle, once the azimuth is known: a choice |
//! | [`SPIN_GYROS`], [`SPIN_FORCES`], [`SPIN_WALK`], [`SPIN_SCALE_SIGMA`], [`SPIN_BIAS_SIGMA`] | on a spinning body: the test sheets of its analogue sensors |
//! | [`ENCODER`] | a calibration of the stage; until then zero, a greater [`ENCODER_SIGMA`], and in [`instrument`] a greater `stage.agreement` |
//!
//! Too small a σ here is too small a σ of the azimuth: in doubt take the greater one.

use drivers::ads1262::configuration::{Configuration as Converter, DataRate, Filter, Gain};
use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use embassy_time::Duration;
use firmware::calibration::Harmonics;
use firmware::configuration::{
    Alignment, Configuration, KeepConfiguration, Realignment, TurntableConfiguration,
    VehicleConfiguration,
};
use firmware::spin::configuration::{Channel, SpinConfiguration};
use orientation::align::rotating::{self, Sensor};
use orientation::align::setting::Setting;
use orientation::align::stops;
use orientation::earth::Latitude;
use orientation::keep::{self, spin};
use orientation::noise::model::GyroNoise;
use orientation::planner::Rotation;
use orientation::planner::order::Order;
use orientation::session::procedure::{CONVERTER_TOLERANCE, Procedure};
use orientation::session::rotating::Procedure as Turning;
use orientation::session::schedule::Schedule;
use orientation::session::stops::Procedure as Driving;
use orientation::session::survey::Survey;
use orientation::units::{AngularRate, DEGREE, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, TURN};

/// What carries the gyro.
#[derive(Clone, Copy, PartialEq, Eq)]
#[expect(dead_code, reason = "whoever edits this file chooses one")]
pub enum Carrier {
    /// A stage that stands at positions.
    Stage,
    /// A platform on a slip ring, which turns all the time.
    Turntable,
    /// A vehicle that goes from stop to stop, with three gyros.
    Vehicle,
    /// A body in fast rotation about its long axis, with three gyros and two accelerometers.
    SpinningBody,
}

/// The one of this board. What the others need is not in the image.
pub const CARRIER: Carrier = Carrier::Stage;

/// Geodetic latitude, °, north positive; up to ±85°, beyond there is no north to find.
const LATITUDE: f64 = 47.58;
const _: () = assert!(-85.0 <= LATITUDE && LATITUDE <= 85.0);

/// Rate beyond which the gyro's own output may clip, °/s: 97 % of its range.
const GYRO_LIMIT: f64 = 0.97 * 40.0;
/// Scale factor of the gyro at the converter's input, V per °/s, negative where it is mounted upside
/// down. The converter takes ±2.5 V.
const GYRO_SCALE: f64 = 0.05;

/// N, angle random walk, °/√h (OIUS-1000 class).
const GYRO_N: f64 = 0.001;
/// B, bias instability, °/h.
const GYRO_B: f64 = 0.007;
/// K, rate random walk, °/h/√h.
const GYRO_K: f64 = 0.0;
/// 1σ of the scale factor, relative.
const GYRO_SCALE_SIGMA: f64 = 5e-4;
/// g-sensitivity along the gyro's axis and 90° clockwise of it, °/h/g.
const G_SENSITIVITY: [f64; 2] = [0.0, 0.0];
/// 1σ of each, °/h/g.
const G_SENSITIVITY_SIGMA: f64 = 0.1;

/// 1σ of the accelerometer's biases, m/s²: the ADXL355's offset is 25 mg at most (data sheet rev. C,
/// table 1).
const FORCE_BIAS_SIGMA: f64 = 0.0083 * 9.80665;

/// The encoder's error over a turn, rad.
const ENCODER: Harmonics = Harmonics { first: [0.0; 2], second: [0.0; 2] };
/// 1σ of what is left of it as it turns the azimuth, rad.
const ENCODER_SIGMA: f64 = 0.05 * DEGREE;

/// The converter: samples a second, filter and gain.
pub const CONVERTER: Converter =
    Converter { rate: DataRate::Sps400, filter: Filter::Sinc1, gain: Gain::X1 };
/// The rate of the converter's codes; does not compile where the scale factor is none.
pub const SCALE: Scale =
    match Scale::new(GYRO_SCALE / DEGREE, INTERNAL_REFERENCE_VOLTS, CONVERTER.gain) {
        Some(scale) => scale,
        None => unreachable!(),
    };
/// The rate beyond which the gyro may clip.
pub const LIMIT: AngularRate = AngularRate((GYRO_LIMIT * DEGREE * 1e9) as i32);

/// How long the board stands still first to know its gyro, s: it then plans by what it found, for as
/// long as the dwells below would take. `None`: it believes what stands above. An hour shows B and K,
/// ten minutes N.
const SURVEY: Option<f64> = None;
/// 1σ of the azimuth until which it goes on, °, and the time allowed, s, from the end of the survey or
/// else from the beginning. `None`: it ends with its schedule.
const ACCURACY: Option<(f64, f64)> = None;
/// Positions on the full circle, to the first of which the stage comes once more at the end.
const POSITIONS: usize = 24;
/// Time at each, s.
const DWELL: f64 = 10.0;
/// How long the stage takes to turn: 1.20 s for 15°, 18.41 s for 360°, and a look around.
const ROTATION: Rotation = Rotation { rest: 0.75, speed: 0.35, wraps: false };
/// For how long the stage rings after an arrival, s.
const RINGING: f64 = 0.25;

/// What is known of place and instrument.
pub fn setting() -> Setting {
    let latitude = defmt::unwrap!(Latitude::from_degrees(LATITUDE));
    Setting {
        noise: GyroNoise::from_field_units(GYRO_N, GYRO_B, GYRO_K, 0.0),
        white_known: true,
        scale_sigma: GYRO_SCALE_SIGMA,
        g_sensitivity: G_SENSITIVITY.map(|part| part * DEGREE_PER_HOUR),
        g_sensitivity_sigma: G_SENSITIVITY_SIGMA * DEGREE_PER_HOUR,
        accelerometer_bias_sigma: FORCE_BIAS_SIGMA,
        encoder_sigma: ENCODER_SIGMA,
        required_sigma: ACCURACY.map_or(10.0, |(sigma, _)| sigma) * DEGREE,
        ..Setting::at(latitude)
    }
}

/// How the session goes about it.
pub fn procedure() -> Procedure {
    let schedule = Schedule::closed_circle(POSITIONS, DWELL);
    let plan_seconds = schedule.seconds();
    let procedure = Procedure::new(schedule, 1.0 / CONVERTER.rate.hertz());
    let mut procedure =
        Procedure { settle_seconds: RINGING, period_tolerance: CONVERTER_TOLERANCE, ..procedure };
    if let Some(seconds) = SURVEY {
        let orders = &Order::COMPARED;
        procedure = procedure.after(Survey {
            seconds,
            rotation: ROTATION,
            orders,
            shortest: 2.0,
            plan_seconds,
        });
    }
    match ACCURACY {
        Some((_, seconds)) => procedure.until_accurate(seconds),
        None => procedure,
    }
}

/// What the instrument is told of its devices.
pub fn instrument() -> Configuration {
    let rate = CONVERTER.rate.hertz();
    Configuration { encoder: ENCODER, ..Configuration::at(rate) }
}

/// On a turning platform: turns a second, one speed of a gyro, two of a molecular-electronic sensor.
const SPEEDS: &[f64] = &[0.137];
/// What kind of sensor turns: [`Sensor::GYRO`] or [`Sensor::MOLECULAR`].
const SENSOR: Sensor = Sensor::GYRO;
/// Uneven turns before the even ones, to know how the sensor feels the platform; none where what the
/// flash keeps of them is to do. `None`: as many as are usual.
const UNEVEN_TURNS: Option<u32> = None;

/// 1σ of the encoder's zero on a turning platform, as it turns the azimuth, rad: without an index no turn shows it.
const ENCODER_ZERO_SIGMA: f64 = 0.15 * DEGREE;

/// What is known of place and instrument on a turning platform.
pub fn turning_setting() -> rotating::Setting {
    let encoder_zero_sigma = ENCODER_ZERO_SIGMA;
    rotating::Setting { encoder_zero_sigma, ..rotating::Setting::new(setting(), SENSOR) }
}

/// How the session goes about it there.
pub fn turning_procedure() -> Turning {
    let mut speeds = [0.0; SPEEDS.len()];
    speeds.iter_mut().zip(SPEEDS).for_each(|(speed, hertz)| *speed = hertz * TURN);
    let usual = Turning::new(&speeds, 1.0 / CONVERTER.rate.hertz());
    Turning { uneven_turns: UNEVEN_TURNS.unwrap_or(usual.uneven_turns), ..usual }
}

/// What the instrument is told of the platform.
pub fn platform() -> TurntableConfiguration {
    TurntableConfiguration::default()
}

/// In a vehicle: stops after which it concludes, two at least; three with different headings tell the
/// gyros' biases.
const STOPS: usize = 3;
/// 1σ of the gyros' biases from start to start, °/h.
const BIAS_SIGMA: f64 = 0.5;
/// 1σ of the accelerometers' biases once they are calibrated, m/s²: there they are tilt.
const FORCE_CALIBRATED_SIGMA: f64 = 1e-4 * 9.80665;
/// Noise of the accelerometers, m/s²/√Hz: 25 µg/√Hz (ADXL355 data sheet, table 1) and outputs not read.
const FORCE_NOISE: f64 = 1.2 * 25e-6 * 9.80665;

/// What is known of place and instrument in a vehicle.
pub fn driving_setting() -> stops::Setting {
    let common = Setting { accelerometer_bias_sigma: FORCE_CALIBRATED_SIGMA, ..setting() };
    stops::Setting {
        bias_sigma: Some(BIAS_SIGMA * DEGREE_PER_HOUR),
        force_noise: FORCE_NOISE,
        ..stops::Setting::new(common)
    }
}

/// How the session goes about it there.
pub fn driving_procedure() -> Driving {
    Driving::new(STOPS, 1.0 / CONVERTER.rate.hertz())
}

/// What the instrument is told of its devices there.
pub fn vehicle() -> VehicleConfiguration {
    VehicleConfiguration::at(CONVERTER.rate.hertz())
}

/// In a vehicle, once the azimuth is known: whether the board aligns itself anew, every stop that ends an
/// alignment being the first of the next.
const REALIGNS: bool = true;
/// Whether it looks for north where it knows it already, because it stands as it stood before a restart.
const ALIGNS_ALWAYS: bool = true;

/// What the keeper is told of place and gyros.
pub fn keeper() -> keep::Setting {
    let latitude = defmt::unwrap!(Latitude::from_degrees(LATITUDE));
    let period = 1.0 / CONVERTER.rate.hertz();
    keep::Setting {
        force_bias_sigma: FORCE_CALIBRATED_SIGMA,
        ..keep::Setting::precise(latitude, period, kept_gyro())
    }
}

/// A gyro as the keeper knows it.
fn kept_gyro() -> keep::Gyro {
    keep::Gyro {
        noise: GyroNoise::from_field_units(GYRO_N, GYRO_B, GYRO_K, 0.0),
        bias_sigma: BIAS_SIGMA * DEGREE_PER_HOUR,
        scale_sigma: GYRO_SCALE_SIGMA,
    }
}

/// How the instrument goes on after its alignment: for ever.
pub fn keeping() -> KeepConfiguration {
    KeepConfiguration {
        hold: Duration::MAX,
        realignment: if REALIGNS { Realignment::BetweenStops } else { Realignment::Never },
        knows_stops: true,
        alignment: if ALIGNS_ALWAYS { Alignment::Always } else { Alignment::UnlessKnown },
        beside: kept_gyro(),
        precise: kept_gyro(),
    }
}

/// On a spinning body: V per rad/s of the gyros about x, y and z, and the rates beyond which they may clip,
/// rad/s.
const SPIN_GYROS: [(f64, f64); 3] = [(2.0 / 700.0, 680.0), (0.1, 19.0), (0.1, 19.0)];
/// V per m/s² of the accelerometers along y and z, and the forces beyond which they may clip, m/s².
const SPIN_FORCES: [(f64, f64); 2] = [(2e-4, 9700.0); 2];
/// N of the gyro about x, °/√h, 1σ of its scale factor, and of its bias, °/h.
const SPIN_WALK: f64 = 0.5;
const SPIN_SCALE_SIGMA: f64 = 1e-3;
const SPIN_BIAS_SIGMA: f64 = 200.0;
/// Course and pitch when the flight begins, °: nothing on the body tells them.
const LAUNCH: [f64; 2] = [0.0, 0.0];

/// The converters of a spinning body: the next rate above the paper's 10 kHz.
pub const SPIN_CONVERTER: Converter =
    Converter { rate: DataRate::Sps14400, filter: Filter::Sinc1, gain: Gain::X1 };

/// What is known of its gyro about x.
pub fn spin_setting() -> spin::Setting {
    spin::Setting {
        sample_seconds: 1.0 / SPIN_CONVERTER.rate.hertz(),
        angle_random_walk: SPIN_WALK * DEGREE_PER_SQRT_HOUR,
        scale_sigma: SPIN_SCALE_SIGMA,
        bias_sigma: SPIN_BIAS_SIGMA * DEGREE_PER_HOUR,
        method: spin::Method::PhaseLocked,
    }
}

/// Course and pitch at first, rad.
pub fn launch() -> [f64; 2] {
    LAUNCH.map(|angle| angle * DEGREE)
}

/// What the instrument is told of its sensors; none where a scale factor is none.
pub fn spinning() -> Option<SpinConfiguration> {
    let sample_rate = SPIN_CONVERTER.rate.hertz();
    let [x, y, z] = SPIN_GYROS.map(|(volts, limit)| Channel::gyro(volts, limit, sample_rate));
    let [up, right] = SPIN_FORCES.map(|(volts, limit)| Channel::accelerometer(volts, limit));
    Some(SpinConfiguration { sample_rate, gyros: [x?, y?, z?], accelerometers: [up?, right?] })
}
