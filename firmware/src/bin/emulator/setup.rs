//! What a run needs: the simulated board, its ports, the channels and the session, in one place in memory for
//! every kind of run.

use core::cell::RefCell;

use firmware::configuration::{
    Configuration, KeepConfiguration, TurntableConfiguration, VehicleConfiguration,
};
use firmware::keep::Keeping;
use firmware::ports::{NoOutside, NoRecorder, VehiclePorts};
use firmware::run::{acquire, acquire_triad, run, run_rotating, run_stops_and_keep};
use firmware::shared::Channels;
use firmware::simulated::vehicle::{KnownPlace, SimulatedTriad};
use firmware::simulated::{Chips, SimulatedPorts, SimulatedSensors};
use hal_mock::vehicle::board::VehicleBoard;
use orientation::align;
use orientation::align::rotating::Setting;
use orientation::align::rotating::turn::Stretch;
use orientation::keep::{self, Keeper};
use orientation::session::{Prepared, Session, rotating, stops};
use orientation::signal::InertialSample;
use static_cell::StaticCell;

use crate::meter::Meter;
use crate::outside::{Log, Metering, NoLink};
use crate::results;

/// The simulated board of a stage.
pub type StageRig = RefCell<Chips<'static>>;
/// The simulated board of a vehicle.
pub type VehicleRig = RefCell<VehicleBoard<'static>>;
/// The sensors of a stage.
pub type StageInputs = SimulatedSensors<'static, Chips<'static>, Metering>;
/// Its other ports.
pub type StageOutputs = SimulatedPorts<'static, Chips<'static>, Metering, NoLink, NoRecorder>;
/// The sensors of a vehicle.
pub type VehicleInputs = SimulatedTriad<'static, VehicleBoard<'static>, Metering>;
/// Its other ports.
pub type VehicleOutputs = VehiclePorts<KnownPlace<'static, 'static>, NoLink, NoRecorder>;
/// What keeps in a vehicle.
pub type VehicleKeeping = Keeping<'static, NoOutside, ()>;
/// The channels of a stage.
type StageSeams = Channels<'static, Log>;
/// The channels of a vehicle.
type VehicleSeams = Channels<'static, Log, InertialSample>;

/// A board.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
enum Rig {
    Stage(StageRig),
    Vehicle(VehicleRig),
}

/// Its ports, and the channels.
enum Parts {
    Stage(StageInputs, StageOutputs, StageSeams),
    Vehicle(VehicleInputs, VehicleOutputs, VehicleSeams),
}

/// A session, the greatest piece of memory.
#[expect(clippy::large_enum_variant, reason = "there is one, and it stays where it is")]
enum AnySession {
    Stepwise(Session),
    Turning(rotating::Session),
    Stops(stops::Session),
}

static RIG: StaticCell<Rig> = StaticCell::new();
static LOG: StaticCell<Log> = StaticCell::new();
static PARTS: StaticCell<Parts> = StaticCell::new();
static SITTING: StaticCell<AnySession> = StaticCell::new();
static KEEPER: StaticCell<Keeper> = StaticCell::new();

/// The board of a stage with its ports.
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

/// The board of a vehicle with its ports.
#[inline(never)]
pub fn vehicle(
    board: impl FnOnce() -> VehicleBoard<'static>,
    inputs: impl FnOnce(&'static VehicleRig) -> VehicleInputs,
    outputs: impl FnOnce(&'static VehicleRig) -> VehicleOutputs,
    meter: &'static Meter,
) -> Option<(&'static mut VehicleInputs, &'static mut VehicleOutputs, &'static VehicleSeams)> {
    let rig = RIG.init_with(|| Rig::Vehicle(RefCell::new(board())));
    let Rig::Vehicle(rig) = rig else { return None };
    let log = LOG.init(Log(meter));
    let parts = PARTS.init_with(|| Parts::Vehicle(inputs(rig), outputs(rig), Channels::new(log)));
    let Parts::Vehicle(inputs, outputs, channels) = parts else { return None };
    Some((inputs, outputs, channels))
}

/// A session in positions. Not inlined: what it is made of on the stack is not to stay there.
#[inline(never)]
pub fn stepwise(prepared: Prepared) -> Option<&'static mut Session> {
    let sitting = SITTING.init_with(|| AnySession::Stepwise(Session::from(prepared)));
    if let AnySession::Stepwise(session) = sitting { Some(session) } else { None }
}

/// A session on a turning platform, whose procedure was checked.
#[inline(never)]
pub fn turning(
    setting: &Setting,
    procedure: rotating::Procedure,
) -> Option<&'static mut rotating::Session> {
    let session = || AnySession::Turning(rotating::Session::of(*setting, procedure));
    if let AnySession::Turning(session) = SITTING.init_with(session) { Some(session) } else { None }
}

/// A session in a vehicle.
#[inline(never)]
pub fn driving(
    setting: &align::stops::Setting,
    procedure: stops::Procedure,
) -> Option<&'static mut stops::Session> {
    let session = || AnySession::Stops(stops::Session::of(*setting, procedure));
    if let AnySession::Stops(session) = SITTING.init_with(session) { Some(session) } else { None }
}

/// What keeps in a vehicle.
#[inline(never)]
pub fn keeping(setting: &keep::Setting, configuration: &KeepConfiguration) -> VehicleKeeping {
    Keeping::new(KEEPER.init_with(|| Keeper::new(setting)), configuration, NoOutside, ())
}

/// Sensors that sample.
pub enum Sampling {
    /// Of a stage, or a turning platform.
    Stage(&'static mut StageInputs, Configuration, &'static StageSeams),
    /// Of a vehicle.
    Vehicle(&'static mut VehicleInputs, VehicleConfiguration, &'static VehicleSeams),
}

impl Sampling {
    /// Samples for ever.
    pub async fn run(self) {
        match self {
            Self::Stage(inputs, configuration, channels) => {
                acquire(inputs, &configuration, channels).await;
            }
            Self::Vehicle(inputs, configuration, channels) => {
                acquire_triad(inputs, &configuration, channels).await;
            }
        }
    }
}

/// An instrument that runs.
#[expect(clippy::large_enum_variant, reason = "there is one, in static memory")]
pub enum Running {
    /// On a stage.
    Stepwise(&'static mut Session, &'static mut StageOutputs, Configuration, &'static StageSeams),
    /// On a turning platform.
    Turning(&'static mut rotating::Session, &'static mut StageOutputs, &'static StageSeams),
    /// In a vehicle.
    Stops(
        &'static mut stops::Session,
        &'static mut VehicleOutputs,
        VehicleKeeping,
        &'static VehicleSeams,
    ),
}

impl Running {
    /// Runs to the session's conclusion.
    pub async fn run(self) -> Finished {
        match self {
            Self::Stepwise(session, outputs, configuration, channels) => {
                run(outputs, &configuration, session, channels).await;
                Finished::Stepwise(session)
            }
            Self::Turning(session, outputs, channels) => {
                run_rotating(outputs, &TurntableConfiguration::default(), session, channels).await;
                Finished::Turning(session)
            }
            Self::Stops(session, outputs, mut keeping, channels) => {
                run_stops_and_keep(outputs, session, &mut keeping, channels).await;
                Finished::Stops(session)
            }
        }
    }
}

/// A session that has concluded.
pub enum Finished {
    /// In positions.
    Stepwise(&'static Session),
    /// On a turning platform.
    Turning(&'static rotating::Session),
    /// In a vehicle.
    Stops(&'static stops::Session),
}

impl Finished {
    /// Logs what was found; `None` where nothing was.
    pub fn log(&self, seed: u64) -> Option<()> {
        match self {
            Self::Stepwise(session) => {
                session.dwells().iter().zip(1..).for_each(|(dwell, number)| {
                    results::dwell(number, dwell);
                });
                results::outcome(seed, &session.conclusion()?.verdict);
            }
            Self::Turning(session) => {
                let stretches = session.turn_accumulator().stretches().iter();
                stretches.flat_map(Stretch::turns).zip(1..).for_each(|(turn, number)| {
                    results::turn(number, turn);
                });
                results::outcome(seed, &session.conclusion()?.verdict);
            }
            Self::Stops(session) => {
                session.stops().iter().zip(1..).for_each(|(stop, number)| {
                    results::stop(number, stop);
                });
                results::outcome(seed, &session.conclusion()?.verdict);
            }
        }
        Some(())
    }
}
