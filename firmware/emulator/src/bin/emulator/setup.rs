//! The parts of a run in static memory: the simulated board, its ports, the channels and the method.
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
use firmware::shared::{Channels, LatestAngle};
use firmware::spin::configuration::SpinConfiguration;
use firmware::stage::Stage;
use firmware::turntable::Turntable;
use hal_mock::gimbal::board::GimbalBoard;
use hal_mock::spin::board::SpinBoard;
use hal_mock::vehicle::board::VehicleBoard;
use orientation::alignment::{Method, rotating, stepwise, stops};
use orientation::attitude::Keeper;
use orientation::roll::Flight;
use orientation::signal::{InertialSample, Sample, SpinSample, Timed};
use simulated::fault::Injection;
use simulated::mount::{FramePorts, FrameSensors, FramesScenario};
use simulated::scenario::Scenario;
use simulated::spin::{Course, SimulatedSpin, SpinScenario};
use simulated::trace::{AZIMUTH, Trace};
use simulated::turntable::TurntableScenario;
use simulated::vehicle::{self, SimulatedTriad, VehicleAiding, VehicleScenario};
use simulated::{self, Chips, SimulatedPorts, SimulatedSensors, Wires, scenario, turntable};
use static_cell::StaticCell;

use crate::job::Job;
use crate::log::row;
use crate::meter::Meter;
use crate::outside::{Log, Metering, NoLink};

/// Injection without faults, for every carrier.
static HEALTHY: Injection = Injection::NONE;

/// The motor, link and recorder of a stage or a turntable.
type StageOutputs = SimulatedPorts<'static, Metering, NoLink, NoRecorder>;
/// The motors, link and recorder of a two-frame mount.
type FrameOutputs = FramePorts<'static, Metering, NoLink, NoRecorder>;

/// The simulated board of any carrier.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
enum Rig {
    Stage(RefCell<Chips<'static>>),
    Frames(RefCell<GimbalBoard<'static>>),
    Vehicle(RefCell<VehicleBoard<'static>>),
    Spin(RefCell<SpinBoard<'static>>),
}

/// The sensors, the other ports and the channels of any carrier.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
enum Parts {
    Stage(SimulatedSensors<'static, Metering>, StageOutputs, Channels<'static>),
    Frames(
        FrameSensors<'static, Metering>,
        FrameOutputs,
        (FramesConfiguration, Frames<LatestAngle>),
        Channels<'static>,
    ),
    Vehicle(
        SimulatedTriad<'static, Metering>,
        VehicleAiding<'static, 'static>,
        Channels<'static, InertialSample>,
    ),
    Spin(SimulatedSpin<'static, Metering>, SpinConfiguration, Channels<'static, SpinSample>),
}

/// The method of any carrier, the largest object in memory.
#[expect(clippy::large_enum_variant, reason = "there is one, and it stays where it is")]
enum AnyMethod {
    Stepwise(stepwise::Session),
    Rotating(rotating::Session),
    Stops(stops::Session),
    Flight(Flight),
}

static RIG: StaticCell<Rig> = StaticCell::new();
static COURSE: StaticCell<Course> = StaticCell::new();
static LOG: StaticCell<Log> = StaticCell::new();
static PARTS: StaticCell<Parts> = StaticCell::new();
static METHOD: StaticCell<AnyMethod> = StaticCell::new();
static KEEPER: StaticCell<Keeper> = StaticCell::new();

/// Builds a part in static memory and takes out its variant. Not inlined, so that temporary copies on
/// the stack are gone when the method runs.
macro_rules! built {
    ($cell:ident, $pattern:pat => $found:expr, $build:expr) => {{
        #[inline(never)]
        fn place<T>(cell: &'static StaticCell<T>, build: impl FnOnce() -> T) -> &'static mut T {
            cell.init_with(build)
        }
        let $pattern = place(&$cell, || $build) else { return None };
        $found
    }};
}

/// The sampling half of an instrument.
pub enum Sampling {
    /// On a stage or on a turntable.
    Stage(
        &'static mut SimulatedSensors<'static, Metering>,
        Configuration,
        &'static Channels<'static>,
    ),
    /// On a two-frame mount.
    Frames(
        &'static mut FrameSensors<'static, Metering>,
        Configuration,
        &'static (FramesConfiguration, Frames<LatestAngle>),
        &'static Channels<'static>,
    ),
    /// In a vehicle.
    Vehicle(
        &'static mut SimulatedTriad<'static, Metering>,
        VehicleConfiguration,
        &'static Channels<'static, InertialSample>,
    ),
    /// On a spinning body.
    Spin(
        &'static mut SimulatedSpin<'static, Metering>,
        &'static SpinConfiguration,
        &'static Channels<'static, SpinSample>,
    ),
}

impl Sampling {
    /// Samples for ever; never returns.
    pub async fn run(self) {
        match self {
            Self::Stage(inputs, configuration, channels) => {
                acquire(&mut acquire::on_stage(inputs, &configuration, channels)).await;
            }
            Self::Frames(inputs, configuration, (frames, latest), channels) => {
                acquire(&mut acquire::on_mount(inputs, &configuration, frames, latest, channels))
                    .await;
            }
            Self::Vehicle(inputs, configuration, channels) => {
                acquire(&mut TriadAcquisition::new(inputs, &configuration, channels)).await;
            }
            Self::Spin(inputs, configuration, channels) => {
                acquire(&mut SpinAcquisition::new(inputs, configuration, channels)).await;
            }
        }
    }
}

/// The processing half of an instrument.
pub enum Running {
    /// Multi-position alignment on a stage.
    Stage(
        &'static mut stepwise::Session,
        &'static mut StageOutputs,
        Configuration,
        &'static Channels<'static>,
    ),
    /// Multi-position alignment on a two-frame mount.
    Frames(
        &'static mut stepwise::Session,
        &'static mut FrameOutputs,
        &'static (FramesConfiguration, Frames<LatestAngle>),
        &'static Channels<'static>,
    ),
    /// Continuous rotation on a turntable.
    Turntable(
        &'static mut rotating::Session,
        &'static mut StageOutputs,
        &'static Channels<'static>,
    ),
    /// Inertial-frame alignment from stop to stop in a vehicle.
    Vehicle(
        &'static mut stops::Session,
        &'static VehicleAiding<'static, 'static>,
        Keeping<'static, ()>,
        &'static Channels<'static, InertialSample>,
    ),
    /// Tracking of the roll of a spinning body.
    Spin(&'static mut Flight, &'static Channels<'static, SpinSample>),
}

/// Navigates with a method, and logs what it found.
async fn run<M: Mechanism, S: Timed, T: Method<S> + Trace>(
    mechanism: &mut M,
    method: &mut T,
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
            row(AZIMUTH, &[azimuth.angle, azimuth.sigma].map(f64::to_bits));
        }
        Some(Err(reason)) => println!("reason {}", reason),
        None => {}
    }
}

impl Running {
    /// Runs the instrument to its end.
    pub async fn run(self) -> Finished {
        match self {
            Self::Stage(session, outputs, configuration, channels) => {
                let shared = &channels.shared;
                let mut stage = Stage::new(&mut outputs.actuator, &configuration.stage, shared);
                run(&mut stage, session, None, &(), channels).await;
                Finished::Stepwise(session)
            }
            Self::Frames(session, outputs, (frames, latest), channels) => {
                let shared = &channels.shared;
                let mut gimbal = Gimbal::new(&mut outputs.actuator, frames, latest, shared);
                run(&mut gimbal, session, None, &(), channels).await;
                Finished::Stepwise(session)
            }
            Self::Turntable(session, outputs, channels) => {
                let tolerances = TurntableConfiguration::default();
                let shared = &channels.shared;
                let mut platform = Turntable::new(&mut outputs.actuator, &tolerances, shared);
                run(&mut platform, session, None, &(), channels).await;
                Finished::Rotating(session)
            }
            Self::Vehicle(session, aiding, keeping, channels) => {
                let mut body = Strapdown::new(&channels.shared);
                run(&mut body, session, Some(keeping), aiding, channels).await;
                Finished::Stops(session)
            }
            Self::Spin(flight, channels) => {
                run(&mut Strapdown::new(&channels.shared), flight, None, &(), channels).await;
                Finished::Flight(flight)
            }
        }
    }
}

/// A method that has come to its end.
pub enum Finished {
    /// Multi-position alignment.
    Stepwise(&'static stepwise::Session),
    /// Continuous rotation.
    Rotating(&'static rotating::Session),
    /// Inertial-frame alignment.
    Stops(&'static stops::Session),
    /// Tracking of a roll.
    Flight(&'static Flight),
}

impl Finished {
    /// Logs what was found.
    pub fn log(&self) {
        match self {
            Self::Stepwise(session) => log::<Sample, _>(*session),
            Self::Rotating(session) => log::<Sample, _>(*session),
            Self::Stops(session) => log::<InertialSample, _>(*session),
            Self::Flight(flight) => log::<SpinSample, _>(*flight),
        }
    }
}

impl Job {
    /// Builds the whole run at its final place in memory; `None` where the scenario does not allow a
    /// start.
    pub fn begin(&self, meter: &'static Meter) -> Option<(Sampling, Running)> {
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

/// Builds a multi-position alignment on a stage.
#[inline(never)]
fn on_stage(scenario: &Scenario, (around, log): Outside<'_>) -> Option<(Sampling, Running)> {
    let prepared = scenario.prepared()?;
    let session = built!(METHOD, AnyMethod::Stepwise(session) => session,
        AnyMethod::Stepwise(prepared.into()));
    let rig = built!(RIG, Rig::Stage(rig) => &*rig,
        Rig::Stage(RefCell::new(simulated::board(scenario, None, &HEALTHY))));
    let wires = Wires(rig, around);
    let (inputs, outputs, channels) = built!(PARTS, Parts::Stage(i, o, c) => (i, o, &*c), Parts::Stage(
            wires.sensors(scenario, scenario::FORCE),
            wires.ports(Motor::default(), NoLink, NoRecorder),
            Channels::new(log)));
    let configuration = scenario.configuration();
    Some((
        Sampling::Stage(inputs, configuration, channels),
        Running::Stage(session, outputs, configuration, channels),
    ))
}

/// Builds a multi-position alignment on a two-frame mount.
#[inline(never)]
fn on_mount(scenario: &FramesScenario, (around, log): Outside<'_>) -> Option<(Sampling, Running)> {
    let prepared = scenario.prepared()?;
    let frames = scenario.frames().ok()?;
    let session = built!(METHOD, AnyMethod::Stepwise(session) => session,
        AnyMethod::Stepwise(prepared.into()));
    let rig = built!(RIG, Rig::Frames(rig) => &*rig,
        Rig::Frames(RefCell::new(scenario.board(None, &HEALTHY))));
    let wires = Wires(rig, around);
    let (inputs, outputs, mount, channels) = built!(PARTS, Parts::Frames(i, o, m, c) => (i, o, &*m, &*c), Parts::Frames(
            wires.frame_sensors(scenario),
            wires.frame_ports(NoLink, NoRecorder),
            (frames, Frames::unread()),
            Channels::new(log)));
    Some((
        Sampling::Frames(inputs, scenario.base.configuration(), mount, channels),
        Running::Frames(session, outputs, mount, channels),
    ))
}

/// Builds an alignment on a rotating platform.
#[inline(never)]
fn on_turntable(
    scenario: &TurntableScenario,
    (around, log): Outside<'_>,
) -> Option<(Sampling, Running)> {
    let (setting, procedure) = scenario.checked()?;
    let session = built!(METHOD, AnyMethod::Rotating(session) => session,
        AnyMethod::Rotating(rotating::Session::of(setting, procedure)));
    let rig = built!(RIG, Rig::Stage(rig) => &*rig,
        Rig::Stage(RefCell::new(scenario.board(None, &HEALTHY))));
    let wires = Wires(rig, around);
    let (inputs, outputs, channels) = built!(PARTS, Parts::Stage(i, o, c) => (i, o, &*c), Parts::Stage(
            wires.sensors(&scenario.base, turntable::FORCE),
            wires.ports(turntable::motor(), NoLink, NoRecorder),
            Channels::new(log)));
    Some((
        Sampling::Stage(inputs, scenario.base.configuration(), channels),
        Running::Turntable(session, outputs, channels),
    ))
}

/// Builds an alignment in a vehicle.
#[inline(never)]
fn in_vehicle(
    scenario: &VehicleScenario,
    (around, log): Outside<'_>,
) -> Option<(Sampling, Running)> {
    let (setting, procedure) = scenario.checked()?;
    let session = built!(METHOD, AnyMethod::Stops(session) => session,
        AnyMethod::Stops(stops::Session::of(setting, procedure)));
    let setting = scenario.keeper()?;
    let keeper = KEEPER.init_with(|| Keeper::new(&setting));
    let rig = built!(RIG, Rig::Vehicle(rig) => &*rig,
        Rig::Vehicle(RefCell::new(scenario.board(&vehicle::BRIEF, &[], &HEALTHY))));
    let wires = Wires(rig, around);
    let (inputs, aiding, channels) = built!(PARTS, Parts::Vehicle(i, a, c) => (i, &*a, &*c), Parts::Vehicle(
            wires.triad(scenario),
            VehicleAiding::new(rig, scenario),
            Channels::new(log)));
    let keeping = Keeping { keeper, policy: scenario.policy(), store: () };
    Some((
        Sampling::Vehicle(inputs, scenario.configuration(), channels),
        Running::Vehicle(session, aiding, keeping, channels),
    ))
}

/// Builds the tracking of the roll of a spinning body.
#[inline(never)]
fn on_spinning_body(
    scenario: &SpinScenario,
    (around, log): Outside<'_>,
) -> Option<(Sampling, Running)> {
    let configuration = scenario.configuration()?;
    let flight = built!(METHOD, AnyMethod::Flight(flight) => flight,
        AnyMethod::Flight(scenario.flight()));
    let course = &*COURSE.init_with(|| scenario.course(None));
    let rig = built!(RIG, Rig::Spin(rig) => &*rig,
        Rig::Spin(RefCell::new(scenario.board(course, &HEALTHY))));
    let wires = Wires(rig, around);
    let (inputs, configuration, channels) = built!(PARTS, Parts::Spin(i, s, c) => (i, &*s, &*c), Parts::Spin(
            wires.spinning(),
            configuration,
            Channels::new(log)));
    Some((Sampling::Spin(inputs, configuration, channels), Running::Spin(flight, channels)))
}
