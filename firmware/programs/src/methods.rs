//! What the methods are given: by the settings ([`firmware::settings`]) and by what is soldered
//! ([`stm32::configuration`]).

use firmware::configuration::{FramesConfiguration, TurntableConfiguration};
use firmware::ports::Frames;
use firmware::settings::{
    CarrierSchedule, FramesCalibration, Settings, SpinCalibration, SpinSchedule, StageSchedule,
    TurntableSchedule, TwoFrameSchedule, VehicleSchedule,
};
use firmware::spin::configuration::SpinConfiguration;
use orientation::alignment::rotating;
use orientation::alignment::rotating::session::Procedure as Turning;
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::mount::{ARRIVAL, MountError, TWO_FRAMES, azimuth_sigma};
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
use orientation::timebase::Timebase;
use orientation::units::{
    DEGREE, ForceNoise, MetresPerSecondSquared, Radians, RadiansPerSecond, Seconds,
};
use stm32::configuration::{BASE_NOISE, BASE_SIGMAS, SPIN_CONVERTER, base_period, period};

/// Rotation time of the stage: 1.20 s for 15° and 18.41 s for 360°, plus the settling check.
const ROTATION: Rotation =
    Rotation { rest: Seconds(0.75), speed: RadiansPerSecond(0.35), wraps: false };
/// Time for which the stage rings after an arrival.
const RINGING: Seconds = Seconds(0.25);

/// Site and instrument on a platform whose encoder has errors of this σ, 1σ.
fn site<C: CarrierSchedule>(
    settings: &Settings<C>,
    latitude: Latitude,
    encoder_sigma: Radians,
) -> Site {
    Site { encoder_sigma, ..settings.site(latitude) }
}

/// Site and instrument on a stage.
pub fn setting(settings: &Settings<StageSchedule>, latitude: Latitude) -> Setting {
    let site = site(settings, latitude, settings.calibration.encoder_sigma);
    Setting { half: settings.schedule.half, ..Setting::new(site) }
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
pub fn base_policy<C: CarrierSchedule>(
    settings: &Settings<C>,
    latitude: Latitude,
    clocks: Timebase,
) -> Policy {
    let [_, _, beside] = base_keeper(latitude, clocks).gyros;
    Policy {
        hold_seconds: Seconds(f64::INFINITY),
        realignment: Realignment::Never,
        knows_stops: false,
        skips_known: false,
        beside,
        precise: gyro(settings, clocks),
    }
}

/// Headings of a pass in their order, °: opposite ones follow each other, so that drift cancels.
const PASS: [f64; 4] = [0.0, 180.0, 90.0, 270.0];

/// Site and instrument on two frames.
pub fn mount_setting(settings: &Settings<TwoFrameSchedule>, latitude: Latitude) -> Setting {
    let FramesCalibration { platform, orthogonality_sigma, .. } = settings.calibration;
    let sigma = azimuth_sigma(orthogonality_sigma, platform.encoder_sigma, latitude);
    let site = site(settings, latitude, sigma);
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
pub fn frames(settings: &Settings<TwoFrameSchedule>) -> Result<FramesConfiguration, MountError> {
    let FramesCalibration { platform, inner, geometry, .. } = settings.calibration;
    let encoders = Frames { outer: platform.encoder, inner };
    FramesConfiguration::new(geometry.into(), encoders, platform.felt.force_bias_sigma)
}

/// Site and instrument on a rotating platform.
pub fn turning_setting(
    settings: &Settings<TurntableSchedule>,
    latitude: Latitude,
) -> rotating::Setting {
    let calibration = &settings.calibration;
    let site = site(settings, latitude, calibration.platform.encoder_sigma);
    let encoder_zero_sigma = calibration.encoder_zero_sigma;
    rotating::Setting { encoder_zero_sigma, ..rotating::Setting::new(site, calibration.sensor()) }
}

/// Procedure of the session on a rotating platform.
pub fn turning_procedure(settings: &Settings<TurntableSchedule>, clocks: Timebase) -> Turning {
    let TurntableSchedule { ref speeds, turns, modulated_turns } = settings.schedule;
    let period_tolerance = clocks.period_tolerance();
    Turning { turns, modulated_turns, period_tolerance, ..Turning::new(speeds, period()) }
}

/// Configuration of the platform's devices.
pub fn platform(settings: &Settings<TurntableSchedule>) -> TurntableConfiguration {
    let index = settings.calibration.index.map(|angle| angle.0);
    TurntableConfiguration { index, ..TurntableConfiguration::default() }
}

/// Noise of the accelerometers: 25 µg/√Hz (ADXL355 data sheet, table 1), raised for the
/// outputs that are not read.
const FORCE_NOISE: ForceNoise = ForceNoise(1.2 * 25e-6 * 9.80665);

/// Site and instrument in a vehicle.
pub fn driving_setting(
    settings: &Settings<VehicleSchedule>,
    latitude: Latitude,
    clocks: Timebase,
) -> stops::Setting {
    let site = settings.site(latitude);
    let site = Site { scale_sigma: clocks.with_scale(site.scale_sigma), ..site };
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

/// Errors of the precise gyro as its angles have them, with those of the clock over which they integrate.
fn gyro<C: CarrierSchedule>(settings: &Settings<C>, clocks: Timebase) -> keep::Gyro {
    let errors = settings.gyro.errors;
    keep::Gyro { scale_sigma: clocks.with_scale(errors.scale_sigma), ..errors }
}

/// Site and gyros for attitude and heading.
pub fn keeper(
    settings: &Settings<VehicleSchedule>,
    latitude: Latitude,
    clocks: Timebase,
) -> keep::Setting {
    keep::Setting {
        force_bias_sigma: settings.calibration.0.force_bias_sigma,
        ..keep::Setting::precise(latitude, period(), gyro(settings, clocks))
    }
}

/// Policy after the alignment: the azimuth is held without end.
pub fn policy(settings: &Settings<VehicleSchedule>, clocks: Timebase) -> Policy {
    let precise = gyro(settings, clocks);
    let VehicleSchedule { realigns, aligns_known, .. } = settings.schedule;
    Policy {
        hold_seconds: Seconds(f64::INFINITY),
        realignment: if realigns { Realignment::BetweenStops } else { Realignment::Never },
        knows_stops: true,
        skips_known: !aligns_known,
        beside: precise,
        precise,
    }
}

/// The flight to be tracked, by the properties of the gyro about x.
pub fn flight(settings: &Settings<SpinSchedule>, clocks: Timebase) -> Flight {
    let SpinCalibration { angle_random_walk, scale_sigma, bias_sigma, .. } = settings.calibration;
    let setting = spin::Setting {
        sample_seconds: Seconds(1.0 / SPIN_CONVERTER.rate.hertz()),
        period_tolerance: clocks.period_tolerance(),
        angle_random_walk,
        scale_sigma: clocks.with_scale(scale_sigma),
        bias_sigma,
        method: spin::Method::PhaseLocked,
    };
    let SpinSchedule { course, pitch } = settings.schedule;
    Flight::new(&setting, [course, pitch], None)
}

/// Configuration of the sensors; `None` where a scale factor is zero.
pub fn spinning(settings: &Settings<SpinSchedule>) -> Option<SpinConfiguration> {
    settings.calibration.configuration(SPIN_CONVERTER.rate.hertz())
}
