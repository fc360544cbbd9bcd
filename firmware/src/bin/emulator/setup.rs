//! The parts of a run in static memory: the simulated board, its ports, the channels and the
//! session.
//!
//! Every kind of run has its variant of one `enum`, so the kinds share the same memory, and a part
//! that is built lies where it stays.

use core::cell::RefCell;

use firmware::acquire::{TriadAcquisition, acquire, on_stage};
use firmware::configuration::{
    Configuration, KeepConfiguration, TurntableConfiguration, VehicleConfiguration,
};
use firmware::keep::Keeping;
use firmware::mechanism::Strapdown;
use firmware::ports::{NoRecorder, Ports};
use firmware::run::navigate;
use firmware::shared::Channels;
use firmware::simulated::vehicle::{KnownPlace, SimulatedTriad};
use firmware::simulated::{Chips, SimulatedPorts, SimulatedSensors};
use firmware::stage::Stage;
use firmware::turntable::Turntable;
use hal_mock::vehicle::board::VehicleBoard;
use orientation::alignment::rotating::session as rotating;
use orientation::alignment::rotating::turn::Stretch;
use orientation::alignment::stepwise::session::Session;
use orientation::alignment::stops::session as stops;
use orientation::attitude as keep;
use orientation::attitude::Keeper;
use orientation::signal::InertialSample;
use static_cell::StaticCell;

use crate::meter::Meter;
use crate::outside::{Log, Metering, NoLink};
use crate::results;

/// The simulated board of an instrument on a stage or on a turntable.
pub type StageRig = RefCell<Chips<'static>>;
/// The simulated board of a strapdown instrument in a vehicle.
pub type VehicleRig = RefCell<VehicleBoard<'static>>;
/// The sensors of an instrument on a stage or on a turntable.
pub type StageInputs = SimulatedSensors<'static, Chips<'static>, Metering>;
/// The motor, link and recorder of an instrument on a stage or on a turntable.
pub type StageOutputs = SimulatedPorts<'static, Chips<'static>, Metering, NoLink, NoRecorder>;
/// The gyros and accelerometers of an instrument in a vehicle.
pub type VehicleInputs = SimulatedTriad<'static, VehicleBoard<'static>, Metering>;
/// The position aiding of an instrument in a vehicle.
pub type Place = KnownPlace<'static, 'static>;
/// The attitude keeper of a vehicle, without aiding and without memory over a loss of supply.
pub type VehicleKeeping = Keeping<'static, (), ()>;
/// The channels of an instrument on a stage or on a turntable.
type StageSeams = Channels<'static>;
/// The channels of an instrument in a vehicle, which carry inertial samples.
type VehicleSeams = Channels<'static, InertialSample>;

/// The simulated board of either kind of run.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
enum Rig {
    Stage(StageRig),
    Vehicle(VehicleRig),
}

/// The sensors, the other ports and the channels of either kind of run.
enum Parts {
    Stage(StageInputs, StageOutputs, StageSeams),
    Vehicle(VehicleInputs, Place, VehicleSeams),
}

/// The session of any kind of run, the largest object in memory.
#[expect(clippy::large_enum_variant, reason = "there is one, and it stays where it is")]
pub enum AnySession {
    /// A session of multi-position alignment.
    Stepwise(Session),
    /// A session of continuous rotation.
    Turning(rotating::Session),
    /// A session of inertial-frame alignment.
    Stops(stops::Session),
}

/// The board of this run.
static RIG: StaticCell<Rig> = StaticCell::new();
/// The observer of this run.
static LOG: StaticCell<Log> = StaticCell::new();
/// Ports and channels of this run.
static PARTS: StaticCell<Parts> = StaticCell::new();
/// The session of this run.
static SESSION: StaticCell<AnySession> = StaticCell::new();
/// The attitude keeper of this run.
static KEEPER: StaticCell<Keeper> = StaticCell::new();

/// Builds the board of a stage with its ports and channels in static memory; [`None`] if a board of
/// another kind is there already.
///
/// May be called once: a second call panics, as the memory is taken.
#[inline(never)]
pub fn stage(
    board: impl FnOnce() -> Chips<'static>,
    inputs: impl FnOnce(&'static StageRig) -> StageInputs,
    outputs: impl FnOnce(&'static StageRig) -> StageOutputs,
    meter: &'static Meter,
) -> Option<(&'static mut StageInputs, &'static mut StageOutputs, &'static StageSeams)> {
    let Rig::Stage(rig) = RIG.init_with(|| Rig::Stage(RefCell::new(board()))) else { return None };
    let log = LOG.init(Log(meter));
    let parts = PARTS.init_with(|| Parts::Stage(inputs(rig), outputs(rig), Channels::new(log)));
    let Parts::Stage(inputs, outputs, channels) = parts else { return None };
    Some((inputs, outputs, channels))
}

/// Builds the board of a vehicle with its ports and channels in static memory; [`None`] if a board
/// of another kind is there already.
///
/// May be called once: a second call panics, as the memory is taken.
#[inline(never)]
pub fn vehicle(
    board: impl FnOnce() -> VehicleBoard<'static>,
    inputs: impl FnOnce(&'static VehicleRig) -> VehicleInputs,
    place: impl FnOnce(&'static VehicleRig) -> Place,
    meter: &'static Meter,
) -> Option<(&'static mut VehicleInputs, &'static mut Place, &'static VehicleSeams)> {
    let rig = RIG.init_with(|| Rig::Vehicle(RefCell::new(board())));
    let Rig::Vehicle(rig) = rig else { return None };
    let log = LOG.init(Log(meter));
    let parts = PARTS.init_with(|| Parts::Vehicle(inputs(rig), place(rig), Channels::new(log)));
    let Parts::Vehicle(inputs, place, channels) = parts else { return None };
    Some((inputs, place, channels))
}

/// Builds the session in static memory. Not inlined, so that the temporary copy on the stack is gone
/// when the session runs.
///
/// May be called once: a second call panics, as the memory is taken.
#[inline(never)]
pub fn session(session: impl FnOnce() -> AnySession) -> &'static mut AnySession {
    SESSION.init_with(session)
}

/// Builds the attitude keeper of a vehicle, without aiding from outside and without memory.
#[inline(never)]
pub fn keeping(setting: &keep::Setting, configuration: &KeepConfiguration) -> VehicleKeeping {
    Keeping::new(KEEPER.init_with(|| Keeper::new(setting)), configuration, (), ())
}

/// The sampling half of an instrument: sensors, configuration and channels.
pub enum Sampling {
    /// Sampling on a stage or on a turntable.
    Stage(&'static mut StageInputs, Configuration, &'static StageSeams),
    /// Sampling in a vehicle.
    Vehicle(&'static mut VehicleInputs, VehicleConfiguration, &'static VehicleSeams),
}

impl Sampling {
    /// Samples for ever; never returns.
    pub async fn run(self) {
        match self {
            Self::Stage(inputs, configuration, channels) => {
                acquire(&mut on_stage(inputs, &configuration, channels)).await;
            }
            Self::Vehicle(inputs, configuration, channels) => {
                acquire(&mut TriadAcquisition::new(inputs, &configuration, channels)).await;
            }
        }
    }
}

/// The processing half of an instrument: session, ports and channels.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
pub enum Running {
    /// Multi-position alignment on a stage.
    Stepwise(&'static mut Session, &'static mut StageOutputs, Configuration, &'static StageSeams),
    /// Continuous rotation on a turntable.
    Turning(&'static mut rotating::Session, &'static mut StageOutputs, &'static StageSeams),
    /// Inertial-frame alignment from stop to stop in a vehicle.
    Stops(&'static mut stops::Session, &'static mut Place, VehicleKeeping, &'static VehicleSeams),
}

impl Running {
    /// Runs the session to its conclusion and gives the session back.
    pub async fn run(self) -> Finished {
        match self {
            Self::Stepwise(session, outputs, configuration, channels) => {
                let Ports { actuator, link, recorder } = outputs;
                let mut stage = Stage::new(actuator, &configuration.stage, &channels.shared);
                let aligned = (&mut *session as _, &mut () as _);
                navigate(&mut stage, aligned, link, recorder, &mut (), channels).await;
                Finished::Stepwise(session)
            }
            Self::Turning(session, outputs, channels) => {
                let Ports { actuator, link, recorder } = outputs;
                let tolerances = TurntableConfiguration::default();
                let mut platform = Turntable::new(actuator, &tolerances, &channels.shared);
                let aligned = (&mut *session as _, &mut () as _);
                navigate(&mut platform, aligned, link, recorder, &mut (), channels).await;
                Finished::Turning(session)
            }
            Self::Stops(session, place, mut keeping, channels) => {
                let mut body = Strapdown::new(&channels.shared);
                let aligned = (&mut *session as _, place as _);
                let (link, recorder) = (&mut NoLink, &mut NoRecorder);
                navigate(&mut body, aligned, link, recorder, &mut keeping, channels).await;
                Finished::Stops(session)
            }
        }
    }
}

/// A session that has concluded.
pub enum Finished {
    /// A session of multi-position alignment.
    Stepwise(&'static Session),
    /// A session of continuous rotation.
    Turning(&'static rotating::Session),
    /// A session of inertial-frame alignment.
    Stops(&'static stops::Session),
}

impl Finished {
    /// Logs the dwells, turns or stops and the outcome; [`None`] if the session has not concluded.
    pub fn log(&self, seed: u64) -> Option<()> {
        let verdict = match self {
            Self::Stepwise(session) => {
                session.dwells().iter().zip(1..).for_each(|(dwell, number)| {
                    results::dwell(number, dwell);
                });
                session.conclusion()?.verdict
            }
            Self::Turning(session) => {
                let stretches = session.turn_accumulator().stretches().iter();
                stretches.flat_map(Stretch::turns).zip(1..).for_each(|(turn, number)| {
                    results::turn(number, turn);
                });
                session.conclusion()?.verdict
            }
            Self::Stops(session) => {
                session.stops().iter().zip(1..).for_each(|(stop, number)| {
                    results::stop(number, stop);
                });
                session.conclusion()?.verdict
            }
        };
        results::outcome(seed, &verdict);
        Some(())
    }
}
