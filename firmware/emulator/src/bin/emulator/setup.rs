//! The parts of a run in static memory: the simulated board with the channels, and the two halves of
//! the instrument.
//!
//! Every carrier has its variant of one `enum`, so the carriers share the same memory, and a part
//! that is built lies where it stays.

use core::cell::RefCell;

use defmt::println;
use drivers::tmc5160::configuration::Configuration as Motor;
use firmware::acquire::{self, SpinAcquisition, TriadAcquisition, acquire};
use firmware::configuration::{
    Configuration, FramesConfiguration, TurntableConfiguration, VehicleConfiguration,
};
use firmware::gimbal::Gimbal;
use firmware::keep::Keeping;
use firmware::mechanism::{Mechanism, Strapdown};
use firmware::ports::{Aiding, Frames, NoRecorder};
use firmware::run::navigate;
use firmware::shared::Channels;
use firmware::spin::configuration::SpinConfiguration;
use firmware::stage::Stage;
use firmware::turntable::Turntable;
use hal_mock::gimbal::board::GimbalBoard;
use hal_mock::spin::plant::SpinBoard;
use hal_mock::vehicle::plant::VehicleBoard;
use orientation::alignment::stepwise::session::Prepared;
use orientation::alignment::{Method, rotating, stepwise, stops};
use orientation::attitude::Keeper;
use orientation::navigation::Policy;
use orientation::roll::Flight;
use orientation::signal::{InertialSample, Sample, SpinSample, Timed};
use simulated::fault::Injection;
use simulated::mount::{FrameSensors, FramesScenario};
use simulated::scenario::Scenario;
use simulated::spin::{Course, SimulatedSpin, SpinScenario};
use simulated::trace::{AZIMUTH, Trace};
use simulated::turntable::TurntableScenario;
use simulated::vehicle::{self, SimulatedTriad, VehicleAiding, VehicleScenario};
use simulated::{self, Chips, SimulatedMotor, SimulatedSensors, Wires, scenario, turntable};
use static_cell::StaticCell;

use crate::job::Job;
use crate::log::row;
use crate::meter::Meter;
use crate::outside::{Log, Metering, NoLink};

/// Injection without faults, for every carrier.
static HEALTHY: Injection = Injection::NONE;

/// The motor of an axis.
type AxisMotor = SimulatedMotor<'static, Metering>;
/// The channels between the two halves of an instrument.
type Lines<S = Sample> = &'static Channels<'static, S>;

/// What both halves of an instrument use: the simulated board of a carrier, and the channels.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
enum Ground {
    Stage(RefCell<Chips<'static>>, Channels<'static>),
    Frames(RefCell<GimbalBoard<'static>>, FramesConfiguration, Channels<'static>),
    Vehicle(RefCell<VehicleBoard<'static>>, Channels<'static, InertialSample>),
    Spin(RefCell<SpinBoard<'static>>, Channels<'static, SpinSample>),
}

/// The method of any carrier, the largest object in memory.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
enum AnyMethod {
    Stepwise(stepwise::Session),
    Rotating(rotating::Session),
    Stops(stops::Session),
    Flight(Flight),
}

/// The sampling half of an instrument: sensors, configuration and channels.
pub enum Sampling {
    /// On a stage or on a turntable.
    Stage(SimulatedSensors<'static, Metering>, Configuration, Lines),
    /// On a two-frame mount.
    Frames(FrameSensors<'static, Metering>, Configuration, &'static FramesConfiguration, Lines),
    /// In a vehicle.
    Vehicle(SimulatedTriad<'static, Metering>, VehicleConfiguration, Lines<InertialSample>),
    /// On a spinning body.
    Spin(SimulatedSpin<'static, Metering>, SpinConfiguration, Lines<SpinSample>),
}

impl Sampling {
    /// Samples for ever; never returns.
    pub async fn run(&mut self) {
        match self {
            Self::Stage(sensors, configuration, channels) => {
                acquire(&mut acquire::on_stage(sensors, configuration, channels)).await;
            }
            Self::Frames(sensors, configuration, frames, channels) => {
                acquire(&mut acquire::on_mount(sensors, configuration, frames, channels)).await;
            }
            Self::Vehicle(sensors, configuration, channels) => {
                acquire(&mut TriadAcquisition::new(sensors, configuration, channels)).await;
            }
            Self::Spin(sensors, configuration, channels) => {
                acquire(&mut SpinAcquisition::new(sensors, configuration, channels)).await;
            }
        }
    }
}

/// The processing half of an instrument: mechanism, channels and method.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
pub enum Running {
    /// Multi-position alignment on a stage.
    Stage(AxisMotor, Configuration, Lines, &'static mut stepwise::Session),
    /// Multi-position alignment on a two-frame mount.
    Frames(Frames<AxisMotor>, &'static FramesConfiguration, Lines, &'static mut stepwise::Session),
    /// Continuous rotation on a turntable.
    Turntable(AxisMotor, Lines, &'static mut rotating::Session),
    /// Inertial-frame alignment from stop to stop in a vehicle, which then holds its result.
    Vehicle(
        VehicleAiding<'static, 'static>,
        (Keeper, Policy),
        Lines<InertialSample>,
        &'static mut stops::Session,
    ),
    /// Tracking of the roll of a spinning body.
    Spin(Lines<SpinSample>, &'static mut Flight),
}

impl Running {
    /// Runs the instrument to its end.
    pub async fn run(&mut self) {
        match self {
            Self::Stage(motor, configuration, channels, session) => {
                let mut stage = Stage::new(motor, &configuration.stage, &channels.shared);
                run(&mut stage, *session, None, &(), channels).await;
            }
            Self::Frames(motors, frames, channels, session) => {
                let mut gimbal = Gimbal::new(motors, frames, &channels.shared);
                run(&mut gimbal, *session, None, &(), channels).await;
            }
            Self::Turntable(motor, channels, session) => {
                let tolerances = TurntableConfiguration::default();
                let mut platform = Turntable::new(motor, &tolerances, &channels.shared);
                run(&mut platform, *session, None, &(), channels).await;
            }
            Self::Vehicle(aiding, (keeper, policy), channels, session) => {
                let keeping = Keeping { keeper, policy: *policy, store: () };
                let mut body = Strapdown::new(&channels.shared);
                run(&mut body, *session, Some(keeping), aiding, channels).await;
            }
            Self::Spin(channels, flight) => {
                run(&mut Strapdown::new(&channels.shared), *flight, None, &(), channels).await;
            }
        }
    }

    /// Logs what was found.
    pub fn log(&self) {
        match self {
            Self::Stage(.., session) | Self::Frames(.., session) => log::<Sample, _>(*session),
            Self::Turntable(.., session) => log::<Sample, _>(*session),
            Self::Vehicle(.., session) => log::<InertialSample, _>(*session),
            Self::Spin(_, flight) => log::<SpinSample, _>(*flight),
        }
    }
}

/// Navigates with a method.
async fn run<M: Mechanism, S: Timed>(
    mechanism: &mut M,
    method: &mut dyn Method<S>,
    keeping: Option<Keeping<'_, ()>>,
    aiding: &dyn Aiding,
    channels: &Channels<'_, S>,
) {
    let outside = (&mut NoLink, &mut NoRecorder);
    navigate(mechanism, method, keeping, aiding, outside, channels).await;
}

/// Logs the rows of a method and its verdict. Values are the bits of 64-bit numbers, without any
/// rounding.
fn log<S, T: Method<S> + Trace>(method: &T) {
    method.trace(&mut row);
    match method.verdict() {
        Some(Ok(solution)) => {
            let azimuth = solution.azimuth;
            row(AZIMUTH, &[azimuth.angle.0, azimuth.sigma.0].map(f64::to_bits));
        }
        Some(Err(reason)) => println!("reason {}", reason),
        None => {}
    }
}

/// The two halves of an instrument at their final place in memory.
type Halves = (&'static mut Sampling, &'static mut Running);

static METHOD: StaticCell<AnyMethod> = StaticCell::new();
static GROUND: StaticCell<Ground> = StaticCell::new();
static COURSE: StaticCell<Course> = StaticCell::new();
static LOG: StaticCell<Log> = StaticCell::new();
static SAMPLING: StaticCell<Sampling> = StaticCell::new();
static RUNNING: StaticCell<Running> = StaticCell::new();

/// Builds a part in static memory. Not inlined, so that temporary copies on the stack are gone when
/// the method runs.
#[inline(never)]
fn place<T>(cell: &'static StaticCell<T>, build: impl FnOnce() -> T) -> &'static mut T {
    cell.init_with(build)
}

impl Job {
    /// Builds the whole run at its final place in memory; `None` where the scenario does not allow a
    /// start.
    pub fn begin(&self, meter: &'static Meter) -> Option<Halves> {
        let outside = (&Metering(meter), &*LOG.init(Log(meter)));
        match self {
            Self::Stage(scenario) => on_stage(scenario, outside),
            Self::Frames(scenario) => on_mount(scenario, outside),
            Self::Turntable(scenario) => on_turntable(scenario, outside),
            Self::Vehicle(scenario) => in_vehicle(scenario, outside),
            Self::Spin(scenario) => on_spinning_body(scenario, outside),
        }
    }
}

/// The meter around every port, and the observer.
type Outside<'m> = (&'m Metering, &'static Log);

/// Builds the session of a multi-position alignment.
#[inline(never)]
fn stepwise(prepared: impl FnOnce() -> Option<Prepared>) -> Option<&'static mut stepwise::Session> {
    let prepared = prepared()?;
    match place(&METHOD, || AnyMethod::Stepwise(prepared.into())) {
        AnyMethod::Stepwise(session) => Some(session),
        _ => None,
    }
}

/// Builds a multi-position alignment on a stage.
#[inline(never)]
fn on_stage(scenario: &Scenario, (around, log): Outside<'_>) -> Option<Halves> {
    let session = stepwise(|| scenario.prepared())?;
    let board = || RefCell::new(simulated::board(scenario, None, &HEALTHY));
    let ground = place(&GROUND, || Ground::Stage(board(), Channels::new(log)));
    let Ground::Stage(board, channels) = &*ground else { return None };
    let wires = Wires(board, around);
    let sensors = || wires.sensors(scenario, scenario::FORCE);
    let motor = || wires.actuator(Motor::default());
    let configuration = scenario.configuration();
    Some((
        place(&SAMPLING, || Sampling::Stage(sensors(), configuration, channels)),
        place(&RUNNING, || Running::Stage(motor(), configuration, channels, session)),
    ))
}

/// Builds a multi-position alignment on a two-frame mount.
#[inline(never)]
fn on_mount(scenario: &FramesScenario, (around, log): Outside<'_>) -> Option<Halves> {
    let session = stepwise(|| scenario.prepared())?;
    let frames = scenario.frames().ok()?;
    let board = || RefCell::new(scenario.board(None, &HEALTHY));
    let ground = place(&GROUND, || Ground::Frames(board(), frames, Channels::new(log)));
    let Ground::Frames(board, frames, channels) = &*ground else { return None };
    let wires = Wires(board, around);
    let sensors = || wires.frame_sensors(scenario);
    let configuration = scenario.base.configuration();
    Some((
        place(&SAMPLING, || Sampling::Frames(sensors(), configuration, frames, channels)),
        place(&RUNNING, || Running::Frames(wires.actuators(), frames, channels, session)),
    ))
}

/// Builds an alignment on a rotating platform.
#[inline(never)]
fn on_turntable(scenario: &TurntableScenario, (around, log): Outside<'_>) -> Option<Halves> {
    let (setting, procedure) = scenario.checked()?;
    let method = place(&METHOD, || AnyMethod::Rotating(rotating::Session::of(setting, procedure)));
    let AnyMethod::Rotating(session) = method else { return None };
    let board = || RefCell::new(scenario.board(None, &HEALTHY));
    let ground = place(&GROUND, || Ground::Stage(board(), Channels::new(log)));
    let Ground::Stage(board, channels) = &*ground else { return None };
    let wires = Wires(board, around);
    let sensors = || wires.sensors(&scenario.base, turntable::FORCE);
    let motor = || wires.actuator(turntable::motor());
    let configuration = scenario.base.configuration();
    Some((
        place(&SAMPLING, || Sampling::Stage(sensors(), configuration, channels)),
        place(&RUNNING, || Running::Turntable(motor(), channels, session)),
    ))
}

/// Builds an alignment in a vehicle.
#[inline(never)]
fn in_vehicle(scenario: &VehicleScenario, (around, log): Outside<'_>) -> Option<Halves> {
    let (setting, procedure) = scenario.checked()?;
    let method = place(&METHOD, || AnyMethod::Stops(stops::Session::of(setting, procedure)));
    let AnyMethod::Stops(session) = method else { return None };
    let setting = scenario.keeper()?;
    let board = || RefCell::new(scenario.board(&vehicle::BRIEF, &[], &HEALTHY));
    let ground = place(&GROUND, || Ground::Vehicle(board(), Channels::new(log)));
    let Ground::Vehicle(board, channels) = &*ground else { return None };
    let sensors = || Wires(board, around).triad(scenario);
    let aiding = || VehicleAiding::new(board, scenario);
    let keeping = || (Keeper::new(&setting), scenario.policy());
    Some((
        place(&SAMPLING, || Sampling::Vehicle(sensors(), scenario.configuration(), channels)),
        place(&RUNNING, || Running::Vehicle(aiding(), keeping(), channels, session)),
    ))
}

/// Builds the tracking of the roll of a spinning body.
#[inline(never)]
fn on_spinning_body(scenario: &SpinScenario, (around, log): Outside<'_>) -> Option<Halves> {
    let configuration = scenario.configuration()?;
    let method = place(&METHOD, || AnyMethod::Flight(scenario.flight()));
    let AnyMethod::Flight(flight) = method else { return None };
    let course = &*COURSE.init_with(|| scenario.course(None));
    let board = || RefCell::new(scenario.board(course, &HEALTHY));
    let ground = place(&GROUND, || Ground::Spin(board(), Channels::new(log)));
    let Ground::Spin(board, channels) = &*ground else { return None };
    let sensors = || Wires(board, around).spinning();
    Some((
        place(&SAMPLING, || Sampling::Spin(sensors(), configuration, channels)),
        place(&RUNNING, || Running::Spin(channels, flight)),
    ))
}
