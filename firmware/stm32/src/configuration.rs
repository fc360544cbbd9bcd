//! Configuration of the instrument beside its settings, to be set before it is flashed: **edit this file**
//! and [`crate::settings`]; the link takes no commands. The carrier is chosen by a feature. No record in
//! the flash changes anything here.
//!
//! | what | where to get it |
//! |---|---|
//! | [`G_SENSITIVITY`] | the test sheet, or a calibration with the axis up and down |
//! | [`GEOMETRY`], [`ORTHOGONALITY_SIGMA`] | of two frames: their calibration |
//! | [`SENSOR`] | of a turning platform: what turns |
//! | [`FORCE_CALIBRATED_SIGMA`] | in a vehicle and on two frames: what the accelerometer's calibration leaves |
//! | [`ALIGNS_ALWAYS`] | in a vehicle, where the azimuth is known from before a restart: a choice |
//! | [`SPIN_GYROS`], [`SPIN_FORCES`], [`SPIN_WALK`], [`SPIN_SCALE_SIGMA`], [`SPIN_BIAS_SIGMA`] | on a spinning body: the test sheets of its analogue sensors |
//! | [`ENCODER`] | a calibration of the stage; until then zero, a greater [`ENCODER_SIGMA`], and in [`instrument`] a greater `stage.agreement` |
//!
//! Too small a σ here makes σ of the azimuth too small: if it is uncertain, take the greater one.

use drivers::ads1262::configuration::{Configuration as Converter, DataRate, Filter, Gain};
use drivers::lsm6dsl::registers::OutputRate as BaseRate;
use firmware::calibration::Harmonics;
use firmware::configuration::{
    Configuration, FramesConfiguration, TurntableConfiguration, VehicleConfiguration,
};
use firmware::platform::Platform;
use firmware::ports::Frames;
use firmware::settings::{
    CarrierSchedule, Settings, SpinSchedule, StageSchedule, TurntableSchedule, TwoFrameSchedule,
    VehicleSchedule,
};
use firmware::spin::configuration::{Channel, SpinConfiguration};
use orientation::alignment::rotating;
use orientation::alignment::rotating::Sensor;
use orientation::alignment::rotating::session::Procedure as Turning;
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::mount::{
    ARRIVAL, MountError, TWO_FRAMES, TwoFrame, azimuth_sigma,
};
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::procedure::Survey;
use orientation::alignment::stepwise::session::schedule::{Position, Schedule};
use orientation::alignment::stepwise::setting::Setting;
use orientation::alignment::stops;
use orientation::alignment::stops::session::Procedure as Driving;
use orientation::attitude as keep;
use orientation::earth::Latitude;
use orientation::navigation::{Policy, Realignment};
use orientation::noise::model::GyroNoise;
use orientation::planner::Rotation;
use orientation::planner::order::Order;
use orientation::roll::{self as spin, Flight};
use orientation::signal::sway::CoarseSensors;
use orientation::timebase::{Clock as Source, Timebase};
use orientation::units::{
    DEGREE, DEGREE_PER_SQRT_HOUR, ForceNoise, GSensitivity, MetresPerSecondSquared, Radians,
    RadiansPerRootSecond, RadiansPerSecond, Seconds,
};

use crate::wiring::Clock;

/// Platform of this instrument, by the feature that is chosen of this crate. Code for the others is not
/// in the image.
pub const PLATFORM: Platform = match [
    cfg!(feature = "stage"),
    cfg!(feature = "two-frame"),
    cfg!(feature = "turntable"),
    cfg!(feature = "vehicle"),
    cfg!(feature = "spin"),
] {
    [true, false, false, false, false] => Platform::Stage,
    [false, true, false, false, false] => Platform::TwoFrame,
    [false, false, true, false, false] => Platform::Turntable,
    [false, false, false, true, false] => Platform::Vehicle,
    [false, false, false, false, true] => Platform::Spin,
    [false, false, false, false, false] => {
        panic!("choose a carrier, as in `cargo board --features stage`")
    }
    _ => panic!("more than one carrier is chosen"),
};

/// g-sensitivity along the gyro's axis and 90° clockwise of it, °/h/g.
const G_SENSITIVITY: [f64; 2] = [0.0, 0.0];
/// Standard deviation of each g-sensitivity, 1σ, °/h/g.
const G_SENSITIVITY_SIGMA: f64 = 0.1;

/// Standard deviation of the accelerometer's biases, 1σ, m/s²: the ADXL355's offset is at most 25
/// mg (data sheet rev. C, table 1).
const FORCE_BIAS_SIGMA: MetresPerSecondSquared = MetresPerSecondSquared(0.0083 * 9.80665);

/// Harmonics of the encoder's error, rad.
const ENCODER: Harmonics = Harmonics { first: [0.0; 2], second: [0.0; 2] };
/// Standard deviation of the remaining encoder error as it enters the azimuth, 1σ.
const ENCODER_SIGMA: Radians = Radians::from_degrees(0.05);

/// Sample rate of the precise gyros: by the feature `sps2400` the next one that the converter has beyond 2 kHz.
const RATE: DataRate = if cfg!(feature = "sps2400") { DataRate::Sps2400 } else { DataRate::Sps400 };
/// Configuration of the converter: sample rate, filter and gain.
pub const CONVERTER: Converter = Converter { rate: RATE, filter: Filter::Sinc1, gain: Gain::X1 };
/// Rotation time of the stage: 1.20 s for 15° and 18.41 s for 360°, plus the settling check.
const ROTATION: Rotation =
    Rotation { rest: Seconds(0.75), speed: RadiansPerSecond(0.35), wraps: false };
/// Time for which the stage rings after an arrival.
const RINGING: Seconds = Seconds(0.25);

/// Frequency of the controller's oscillator MSI as the crystal locks it, and the nominal one by which
/// its time counts, Hz: 122 times 32 768 Hz for 4 MHz (RM0351, section 6.2.3).
const MSI_HERTZ: [u64; 2] = [122 * 32_768, 4_000_000];

/// Clocks of the instrument: an oscillator feeds the converters in a vehicle and on a spinning body, and
/// the controller has its crystal unless that is dead.
#[must_use]
pub fn timebase(Clock { has_crystal }: Clock) -> Timebase {
    let converter = match PLATFORM {
        Platform::Vehicle | Platform::Spin => Source::Crystal,
        Platform::Stage | Platform::TwoFrame | Platform::Turntable => Source::Converter,
    };
    if has_crystal {
        Timebase::new(converter, Source::Crystal, MSI_HERTZ)
    } else {
        Timebase::nominal(converter, Source::Controller)
    }
}

/// Sample period of the converter that takes the precise gyros.
pub fn period() -> Seconds {
    Seconds(1.0 / CONVERTER.rate.hertz())
}

/// Site and instrument.
fn site<C: CarrierSchedule>(settings: &Settings<C>) -> Site {
    Site {
        g_sensitivity: G_SENSITIVITY.map(GSensitivity::from_degrees_per_hour),
        g_sensitivity_sigma: GSensitivity::from_degrees_per_hour(G_SENSITIVITY_SIGMA),
        accelerometer_bias_sigma: FORCE_BIAS_SIGMA,
        encoder_sigma: ENCODER_SIGMA,
        ..settings.site()
    }
}

/// Site and instrument on a stage.
pub fn setting(settings: &Settings<StageSchedule>) -> Setting {
    Setting { half: settings.schedule.half, ..Setting::new(site(settings)) }
}

/// Procedure of the session on a stage.
pub fn procedure(settings: &Settings<StageSchedule>, clocks: Timebase) -> Procedure {
    let StageSchedule { positions, dwell, survey, allowed, .. } = settings.schedule;
    let schedule = Schedule::closed_circle(positions.into(), dwell);
    let plan_seconds = schedule.seconds();
    let mut procedure = dwelling(schedule, clocks);
    if let Some(seconds) = survey {
        let orders = &Order::COMPARED;
        procedure = procedure.after(Survey {
            seconds,
            rotation: ROTATION,
            orders,
            shortest: Seconds(2.0),
            plan_seconds,
        });
    }
    match allowed {
        Some(seconds) => procedure.until_accurate(seconds),
        None => procedure,
    }
}

/// Procedure of a session that dwells at the positions of a schedule.
fn dwelling(schedule: Schedule, clocks: Timebase) -> Procedure {
    Procedure {
        settle_seconds: RINGING,
        period_tolerance: clocks.period_tolerance(),
        ..Procedure::new(schedule, period())
    }
}

/// Decimation of the LSM6DSL of the board itself: read once in this many samples of the gyro, 200 times a
/// second, which finds every output of [`BASE_OUTPUT`]. By it the result is held on a stage, two frames or a
/// turntable, and the sway of the base is compensated: the board is fixed to the base, the chip's x axis forward,
/// y to the right, z down.
pub const BASE_DIVIDER: u32 = if cfg!(feature = "sps2400") { 12 } else { 2 };
/// Output rate of the LSM6DSL.
pub const BASE_OUTPUT: BaseRate = BaseRate::Hz104;
/// Noise densities of the LSM6DSL, m°/s/√Hz and µg/√Hz: those of its data sheet, raised by a twentieth
/// for its oscillator and for errors that successive dwells share.
const BASE_NOISE: [f64; 2] = [1.05 * 4.0, 1.05 * 90.0];
/// 1σ of the LSM6DSL's rates at rest, °/s, of its scale, relative, and of its accelerometers' biases,
/// m/s²: half of the zero-g level of ±40 mg (data sheet, `LA_TyOff`), since nothing calibrates them
/// before they are compared with the ADXL355.
const BASE_SIGMAS: (f64, f64, f64) = (3.0, 0.005, 20e-3 * 9.80665);
/// Distance of the board from the point about which the base sways, m.
const BASE_LEVER: f64 = 0.4;

/// Time between two outputs of the LSM6DSL, s.
fn base_period() -> f64 {
    1.0 / f64::from(BASE_OUTPUT.hertz())
}

/// Properties of the LSM6DSL, for the compensation of sway.
pub fn base_sensors() -> CoarseSensors {
    let [rate, force] = BASE_NOISE;
    let sample = 1.0 / CONVERTER.rate.hertz();
    let read = f64::from(BASE_DIVIDER) * sample;
    CoarseSensors {
        mismatch: BASE_SIGMAS.1 as f32,
        lever: BASE_LEVER as f32,
        ..CoarseSensors::of_densities(rate, force).read_in_periods(base_period(), read, sample)
    }
}

/// Site and gyros for attitude and heading on the base of a stage, two frames or a turntable.
pub fn base_keeper(latitude: Latitude, clocks: Timebase) -> keep::Setting {
    let (bias_deg_s, scale_sigma, force_bias_sigma) = BASE_SIGMAS;
    let usual = keep::Gyro::coarse();
    let walk = GyroNoise::from_field_units(BASE_NOISE[0] * 1e-3 * 60.0, 0.0, 0.0, 0.0);
    let noise = GyroNoise { angle_random_walk: walk.angle_random_walk, ..usual.noise };
    let scale_sigma = clocks.with_scale(scale_sigma);
    let gyro = keep::Gyro { noise, bias_sigma: RadiansPerSecond(bias_deg_s * DEGREE), scale_sigma };
    let force_bias_sigma = MetresPerSecondSquared(force_bias_sigma);
    let sample_seconds = Seconds(base_period());
    keep::Setting { latitude, gyros: [gyro; 3], force_bias_sigma, sample_seconds }
}

/// Policy after the alignment on a stage, two frames or a turntable: the azimuth is held without end, and its σ
/// grows; only a restart aligns anew.
pub fn base_policy<C>(settings: &Settings<C>, clocks: Timebase) -> Policy {
    let [_, _, beside] = base_keeper(settings.latitude, clocks).gyros;
    Policy {
        hold_seconds: Seconds(f64::INFINITY),
        realignment: Realignment::Never,
        knows_stops: false,
        skips_known: false,
        beside,
        precise: gyro(settings, clocks),
    }
}

/// Calibration of the two frames; until it is known a perfect mount, and a greater
/// [`ORTHOGONALITY_SIGMA`].
const GEOMETRY: TwoFrame = TwoFrame {
    azimuth: Radians(0.0),
    pitch: Radians(0.0),
    frames: Radians(0.0),
    gyro: Radians(0.0),
    outer_zero: Radians(0.0),
    inner_zero: Radians(0.0),
};
/// Standard deviation of each non-orthogonality that the calibration leaves, 1σ.
const ORTHOGONALITY_SIGMA: Radians = Radians::from_degrees(0.05);
/// Headings of a pass in their order, °: opposite ones follow each other, so that drift cancels.
const PASS: [f64; 4] = [0.0, 180.0, 90.0, 270.0];

/// Site and instrument on two frames.
pub fn mount_setting(settings: &Settings<TwoFrameSchedule>) -> Setting {
    let site = site(settings);
    let encoder_sigma = azimuth_sigma(ORTHOGONALITY_SIGMA, ENCODER_SIGMA, site.latitude);
    let accelerometer_bias_sigma = FORCE_CALIBRATED_SIGMA;
    let site = Site { accelerometer_bias_sigma, encoder_sigma, ..site };
    Setting { mount: TWO_FRAMES, half: settings.schedule.half, ..Setting::new(site) }
}

/// Procedure of the session on two frames.
pub fn mount_procedure(settings: &Settings<TwoFrameSchedule>, clocks: Timebase) -> Procedure {
    let TwoFrameSchedule { passes, dwell: seconds, .. } = settings.schedule;
    let pass = PASS.map(|heading| Position { angle: Radians::from_degrees(heading), seconds });
    let positions = core::iter::repeat_n(pass, passes.into()).flatten().collect();
    Procedure { arrival: ARRIVAL, ..dwelling(Schedule::Listed(positions), clocks) }
}

/// Geometry, encoders and drives of the two frames.
///
/// # Errors
/// A geometry with which an orientation is out of reach.
pub fn frames() -> Result<FramesConfiguration, MountError> {
    FramesConfiguration::new(
        GEOMETRY,
        Frames { outer: ENCODER, inner: ENCODER },
        FORCE_CALIBRATED_SIGMA,
    )
}

/// Configuration of the stage's devices.
pub fn instrument() -> Configuration {
    let rate = CONVERTER.rate.hertz();
    Configuration { encoder: ENCODER, ..Configuration::at(rate) }
}

/// Kind of sensor on the platform: [`Sensor::GYRO`] or [`Sensor::MOLECULAR`].
const SENSOR: Sensor = Sensor::GYRO;
/// Standard deviation of the encoder's zero on a rotating platform, as it enters the azimuth, 1σ,
/// rad: without an index no rotation shows it.
const ENCODER_ZERO_SIGMA: Radians = Radians::from_degrees(0.15);

/// Site and instrument on a rotating platform.
pub fn turning_setting(settings: &Settings<TurntableSchedule>) -> rotating::Setting {
    let encoder_zero_sigma = ENCODER_ZERO_SIGMA;
    rotating::Setting { encoder_zero_sigma, ..rotating::Setting::new(site(settings), SENSOR) }
}

/// Procedure of the session on a rotating platform.
pub fn turning_procedure(settings: &Settings<TurntableSchedule>, clocks: Timebase) -> Turning {
    let TurntableSchedule { ref speeds, turns, modulated_turns } = settings.schedule;
    let period_tolerance = clocks.period_tolerance();
    Turning { turns, modulated_turns, period_tolerance, ..Turning::new(speeds, period()) }
}

/// Configuration of the platform's devices.
pub fn platform() -> TurntableConfiguration {
    TurntableConfiguration::default()
}

/// Standard deviation of the accelerometers' biases after calibration, 1σ, m/s²: in a vehicle they
/// act as tilt.
const FORCE_CALIBRATED_SIGMA: MetresPerSecondSquared = MetresPerSecondSquared(1e-4 * 9.80665);
/// Noise of the accelerometers: 25 µg/√Hz (ADXL355 data sheet, table 1), raised for the
/// outputs that are not read.
const FORCE_NOISE: ForceNoise = ForceNoise(1.2 * 25e-6 * 9.80665);

/// Site and instrument in a vehicle.
pub fn driving_setting(settings: &Settings<VehicleSchedule>, clocks: Timebase) -> stops::Setting {
    let site = site(settings);
    let scale_sigma = clocks.with_scale(site.scale_sigma);
    let site = Site { accelerometer_bias_sigma: FORCE_CALIBRATED_SIGMA, scale_sigma, ..site };
    stops::Setting {
        bias_sigma: Some(settings.gyro.errors.bias_sigma),
        force_noise: FORCE_NOISE,
        ..stops::Setting::new(site)
    }
}

/// Procedure of the session in a vehicle.
pub fn driving_procedure(settings: &Settings<VehicleSchedule>, clocks: Timebase) -> Driving {
    let VehicleSchedule { stops, stop, .. } = settings.schedule;
    let period_tolerance = clocks.period_tolerance();
    Driving { stop_seconds: stop, period_tolerance, ..Driving::new(stops.into(), period()) }
}

/// Configuration of the vehicle's devices.
pub fn vehicle() -> VehicleConfiguration {
    VehicleConfiguration::at(CONVERTER.rate.hertz())
}

/// Whether an alignment runs although the azimuth is known from before a restart, since when the
/// vehicle has not moved.
const ALIGNS_ALWAYS: bool = true;

/// Errors of the precise gyro as its angles have them, with those of the clock over which they integrate.
fn gyro<C>(settings: &Settings<C>, clocks: Timebase) -> keep::Gyro {
    let errors = settings.gyro.errors;
    keep::Gyro { scale_sigma: clocks.with_scale(errors.scale_sigma), ..errors }
}

/// Site and gyros for attitude and heading.
pub fn keeper(settings: &Settings<VehicleSchedule>, clocks: Timebase) -> keep::Setting {
    keep::Setting {
        force_bias_sigma: FORCE_CALIBRATED_SIGMA,
        ..keep::Setting::precise(settings.latitude, period(), gyro(settings, clocks))
    }
}

/// Policy after the alignment: the azimuth is held without end.
pub fn policy(settings: &Settings<VehicleSchedule>, clocks: Timebase) -> Policy {
    let precise = gyro(settings, clocks);
    let realigns = settings.schedule.realigns;
    Policy {
        hold_seconds: Seconds(f64::INFINITY),
        realignment: if realigns { Realignment::BetweenStops } else { Realignment::Never },
        knows_stops: true,
        skips_known: !ALIGNS_ALWAYS,
        beside: precise,
        precise,
    }
}

/// Scale factors of a spinning body's gyros about x, y and z, V per rad/s, and rates beyond which
/// they may saturate, rad/s.
const SPIN_GYROS: [(f64, f64); 3] = [(2.0 / 700.0, 680.0), (0.1, 19.0), (0.1, 19.0)];
/// Scale factors of the accelerometers along y and z, V per m/s², and forces beyond which they may
/// saturate, m/s².
const SPIN_FORCES: [(f64, f64); 2] = [(2e-4, 9700.0); 2];
/// Angle random walk N of the gyro about x, °/√h.
const SPIN_WALK: f64 = 0.5;
/// Standard deviation of its scale factor, 1σ, relative.
const SPIN_SCALE_SIGMA: f64 = 1e-3;
/// Standard deviation of its bias, 1σ, °/h.
const SPIN_BIAS_SIGMA: f64 = 200.0;
/// Configuration of the converters of a spinning body: the next rate above the 10 kHz of Nekrasova
/// 2017.
pub const SPIN_CONVERTER: Converter =
    Converter { rate: DataRate::Sps14400, filter: Filter::Sinc1, gain: Gain::X1 };

/// The flight to be tracked, by the properties of the gyro about x.
pub fn flight(settings: &Settings<SpinSchedule>, clocks: Timebase) -> Flight {
    let setting = spin::Setting {
        sample_seconds: Seconds(1.0 / SPIN_CONVERTER.rate.hertz()),
        period_tolerance: clocks.period_tolerance(),
        angle_random_walk: RadiansPerRootSecond(SPIN_WALK * DEGREE_PER_SQRT_HOUR),
        scale_sigma: clocks.with_scale(SPIN_SCALE_SIGMA),
        bias_sigma: RadiansPerSecond::from_degrees_per_hour(SPIN_BIAS_SIGMA),
        method: spin::Method::PhaseLocked,
    };
    let SpinSchedule { course, pitch } = settings.schedule;
    Flight::new(&setting, [course, pitch], None)
}

/// Configuration of the sensors; `None` where a scale factor is zero.
pub fn spinning() -> Option<SpinConfiguration> {
    let sample_rate = SPIN_CONVERTER.rate.hertz();
    let [x, y, z] = SPIN_GYROS.map(|(volts, limit)| Channel::gyro(volts, limit, sample_rate));
    let [up, right] = SPIN_FORCES.map(|(volts, limit)| Channel::accelerometer(volts, limit));
    Some(SpinConfiguration { sample_rate, gyros: [x?, y?, z?], accelerometers: [up?, right?] })
}
