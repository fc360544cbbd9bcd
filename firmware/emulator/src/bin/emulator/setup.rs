//! The parts of a run in static memory: the method, and the simulated board with the channels.
//!
//! Every carrier has its variant of one `enum`, so the carriers share the same memory, and a part
//! that is built lies where it stays. Sensors and mechanism belong to the halves of the instrument,
//! which the tasks run.

use core::cell::RefCell;

use conversation::{Conversation, Deaf};
use defmt::println;
use drivers::tmc5160::configuration::Configuration as Motor;
use firmware::acquire::{SpinAcquisition, TriadAcquisition, acquire, on_mount, on_stage};
use firmware::configuration::{FramesConfiguration, TurntableConfiguration};
use firmware::gimbal::Gimbal;
use firmware::keep::Keeping;
use firmware::mechanism::{Mechanism, Strapdown};
use firmware::ports::{Aiding, NoBase, NoRecorder};
use firmware::run::{navigate, store};
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
use orientation::roll::Flight;
use orientation::signal::{InertialSample, Sample, SpinSample, Timed};
use simulated::fault::Injection;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::spin::{Course, SpinScenario};
use simulated::trace::{AZIMUTH, Trace};
use simulated::turntable::TurntableScenario;
use simulated::vehicle::{self, VehicleAiding, VehicleScenario};
use simulated::{self, Chips, Wires, scenario, turntable};
use static_cell::StaticCell;

use crate::job::Job;
use crate::log::row;
use crate::meter::Meter;
use crate::outside::{Log, Metering, NoLink};

/// Injection without faults, for every carrier.
static HEALTHY: Injection = Injection::NONE;

/// What both halves of an instrument use: the scenario of a carrier, its simulated board, and the
/// channels.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
pub enum Ground {
    /// A stage.
    Stage(&'static Scenario, RefCell<Chips<'static>>, Channels<'static>),
    /// A two-frame mount, with its geometry.
    Frames(
        (&'static FramesScenario, FramesConfiguration),
        RefCell<GimbalBoard<'static>>,
        Channels<'static>,
    ),
    /// A turntable.
    Turntable(&'static TurntableScenario, RefCell<Chips<'static>>, Channels<'static>),
    /// A vehicle.
    Vehicle(
        &'static VehicleScenario,
        RefCell<VehicleBoard<'static>>,
        Channels<'static, InertialSample>,
    ),
    /// A spinning body, with the configuration of its sensors.
    Spin(SpinConfiguration, RefCell<SpinBoard<'static>>, Channels<'static, SpinSample>),
}

impl Ground {
    /// The sampling half of the instrument: samples for ever; never returns.
    pub async fn sample(&'static self, around: Metering) {
        match self {
            Self::Stage(scenario, board, channels) => {
                let mut sensors = Wires(board, &around).sensors(scenario, scenario::FORCE, NoBase);
                let configuration = scenario.configuration();
                acquire(&mut on_stage(&mut sensors, &configuration, channels)).await;
            }
            Self::Frames((scenario, frames), board, channels) => {
                let mut sensors = Wires(board, &around).frame_sensors(scenario, NoBase);
                let configuration = scenario.base.configuration();
                acquire(&mut on_mount(&mut sensors, &configuration, frames, channels)).await;
            }
            Self::Turntable(TurntableScenario { base, .. }, board, channels) => {
                let mut sensors = Wires(board, &around).sensors(base, turntable::FORCE, NoBase);
                let configuration = base.configuration();
                acquire(&mut on_stage(&mut sensors, &configuration, channels)).await;
            }
            Self::Vehicle(scenario, board, channels) => {
                let mut sensors = Wires(board, &around).triad(scenario);
                let configuration = scenario.configuration();
                acquire(&mut TriadAcquisition::new(&mut sensors, &configuration, channels)).await;
            }
            Self::Spin(configuration, board, channels) => {
                let mut sensors = Wires(board, &around).spinning();
                acquire(&mut SpinAcquisition::new(&mut sensors, configuration, channels)).await;
            }
        }
    }
}

/// The method of any carrier, the largest object in memory.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
pub enum AnyMethod {
    /// Multi-position alignment on a stage or on a two-frame mount.
    Stepwise(stepwise::Session),
    /// Continuous rotation on a turntable.
    Rotating(rotating::Session),
    /// Inertial-frame alignment from stop to stop in a vehicle, with the keeper of its result.
    Stops(stops::Session, Keeper),
    /// Tracking of the roll of a spinning body.
    Flight(Flight),
}

impl AnyMethod {
    /// The processing half of the instrument: runs it to its end.
    pub async fn run(&mut self, ground: &'static Ground, around: Metering) {
        match (ground, self) {
            (Ground::Stage(scenario, board, channels), Self::Stepwise(session)) => {
                let mut motor = Wires(board, &around).actuator(Motor::default());
                let configuration = scenario.configuration().stage;
                let mut stage = Stage::new(&mut motor, &configuration, &channels.shared);
                run(&mut stage, session, None, &(), channels).await;
            }
            (Ground::Frames((_, frames), board, channels), Self::Stepwise(session)) => {
                let mut motors = Wires(board, &around).actuators();
                let mut gimbal = Gimbal::new(&mut motors, frames, &channels.shared);
                run(&mut gimbal, session, None, &(), channels).await;
            }
            (Ground::Turntable(_, board, channels), Self::Rotating(session)) => {
                let mut motor = Wires(board, &around).actuator(turntable::motor());
                let tolerances = TurntableConfiguration::default();
                let mut platform = Turntable::new(&mut motor, &tolerances, &channels.shared);
                run(&mut platform, session, None, &(), channels).await;
            }
            (Ground::Vehicle(scenario, board, channels), Self::Stops(session, keeper)) => {
                let keeping = Some(Keeping { keeper, policy: scenario.policy() });
                let aiding = VehicleAiding::new(board, scenario);
                let mut body = Strapdown::new(&channels.shared);
                run(&mut body, session, keeping, &aiding, channels).await;
            }
            (Ground::Spin(.., channels), Self::Flight(flight)) => {
                run(&mut Strapdown::new(&channels.shared), flight, None, &(), channels).await;
            }
            // Every method is built with the ground that it is for.
            _ => {}
        }
    }

    /// Logs what was found.
    pub fn log(&self) {
        match self {
            Self::Stepwise(session) => log::<Sample, _>(session),
            Self::Rotating(session) => log::<Sample, _>(session),
            Self::Stops(session, _) => log::<InertialSample, _>(session),
            Self::Flight(flight) => log::<SpinSample, _>(flight),
        }
    }
}

/// Navigates with a method.
async fn run<M: Mechanism, S: Timed>(
    mechanism: &mut M,
    method: &mut dyn Method<S>,
    keeping: Option<Keeping<'_>>,
    aiding: &dyn Aiding,
    channels: &Channels<'_, S>,
) {
    let shared = &channels.shared;
    let mut conversation = Conversation::new(NoLink, Deaf, shared);
    let beside = (store((), None, shared), conversation.until_over());
    navigate(mechanism, method, keeping, aiding, &mut NoRecorder, beside, channels).await;
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

static METHOD: StaticCell<AnyMethod> = StaticCell::new();
static GROUND: StaticCell<Ground> = StaticCell::new();
static COURSE: StaticCell<Course> = StaticCell::new();
static LOG: StaticCell<Log> = StaticCell::new();

/// The channels of the board's parts, whose world is a simulated one.
fn channels<S>(log: &'static Log) -> Channels<'static, S> {
    let mut channels = Channels::new(log);
    channels.shared.is_simulated = true;
    channels
}

/// Builds a part in static memory. Not inlined, so that temporary copies on the stack are gone when
/// the method runs.
#[inline(never)]
fn place<T>(cell: &'static StaticCell<T>, build: impl FnOnce() -> T) -> &'static mut T {
    cell.init_with(build)
}

/// What a run uses, at its final place in memory.
type Parts = (&'static Ground, &'static mut AnyMethod);

impl Job {
    /// Builds the whole run at its final place in memory; `None` where the scenario does not allow a
    /// start.
    pub fn begin(&'static self, meter: &'static Meter) -> Option<Parts> {
        let log = &*LOG.init(Log(meter));
        match self {
            Self::Stage(scenario) => for_stage(scenario, log),
            Self::Frames(scenario) => for_frames(scenario, log),
            Self::Turntable(scenario) => for_turntable(scenario, log),
            Self::Vehicle(scenario) => for_vehicle(scenario, log),
            Self::Spin(scenario) => for_spinning_body(scenario, log),
        }
    }
}

/// Builds the session of a multi-position alignment.
#[inline(never)]
fn stepwise(prepared: impl FnOnce() -> Option<Prepared>) -> Option<&'static mut AnyMethod> {
    let prepared = prepared()?;
    Some(place(&METHOD, || AnyMethod::Stepwise(prepared.into())))
}

/// Builds a multi-position alignment on a stage.
#[inline(never)]
fn for_stage(scenario: &'static Scenario, log: &'static Log) -> Option<Parts> {
    let method = stepwise(|| scenario.prepared())?;
    let board = || RefCell::new(simulated::board(scenario, None, &HEALTHY));
    Some((place(&GROUND, || Ground::Stage(scenario, board(), channels(log))), method))
}

/// Builds a multi-position alignment on a two-frame mount.
#[inline(never)]
fn for_frames(scenario: &'static FramesScenario, log: &'static Log) -> Option<Parts> {
    let method = stepwise(|| scenario.prepared())?;
    let mount = (scenario, scenario.frames().ok()?);
    let board = || RefCell::new(scenario.board(None, &HEALTHY));
    Some((place(&GROUND, || Ground::Frames(mount, board(), channels(log))), method))
}

/// Builds an alignment on a rotating platform.
#[inline(never)]
fn for_turntable(scenario: &'static TurntableScenario, log: &'static Log) -> Option<Parts> {
    let (setting, procedure) = scenario.checked()?;
    let method = place(&METHOD, || AnyMethod::Rotating(rotating::Session::of(setting, procedure)));
    let board = || RefCell::new(scenario.board(None, &HEALTHY));
    Some((place(&GROUND, || Ground::Turntable(scenario, board(), channels(log))), method))
}

/// Builds an alignment in a vehicle.
#[inline(never)]
fn for_vehicle(scenario: &'static VehicleScenario, log: &'static Log) -> Option<Parts> {
    let ((setting, procedure), keeper) = (scenario.checked()?, scenario.keeper()?);
    let session = || stops::Session::of(setting, procedure);
    let method = place(&METHOD, || AnyMethod::Stops(session(), Keeper::new(&keeper)));
    let board = || RefCell::new(scenario.board(&vehicle::BRIEF, &[], &HEALTHY));
    Some((place(&GROUND, || Ground::Vehicle(scenario, board(), channels(log))), method))
}

/// Builds the tracking of the roll of a spinning body.
#[inline(never)]
fn for_spinning_body(scenario: &'static SpinScenario, log: &'static Log) -> Option<Parts> {
    let configuration = scenario.configuration()?;
    let method = place(&METHOD, || AnyMethod::Flight(scenario.flight()));
    let course = &*COURSE.init_with(|| scenario.course(None));
    let board = || RefCell::new(scenario.board(course, &HEALTHY));
    Some((place(&GROUND, || Ground::Spin(configuration, board(), channels(log))), method))
}
