//! Job of the image, given by the host as the last word of the command line: `SEED`, or
//! `SEED/brief` for the short run at the highest sample rate, `SEED/survey` for one with a noise
//! survey first, `SEED/turning` for one on a continuously rotating platform, `SEED/stops` for one
//! in a vehicle, which then holds its result.

use core::mem::MaybeUninit;

use drivers::tmc5160::configuration::Configuration as Motor;
use firmware::ports::NoRecorder;
use firmware::simulated::fault::Injection;
use firmware::simulated::scenario::{self, Scenario};
use firmware::simulated::turntable::{self, TurntableScenario};
use firmware::simulated::vehicle::{self, KnownPlace, VehicleScenario};
use firmware::simulated::{self, Wires};
use orientation::alignment::rotating::session as rotating;
use orientation::alignment::stepwise::session::Session;
use orientation::alignment::stops::session as stops;
use semihosting::sys::arm_compat::sys_get_cmdline_uninit;

use crate::meter::Meter;
use crate::outside::{Metering, NoLink};
use crate::setup::{self, AnySession, Running, Sampling};

/// Length of the longest command line, bytes; the emulator begins it with the image's path.
const LONGEST: usize = 4096;

/// Injection without faults, for every carrier.
static HEALTHY: Injection = Injection::NONE;

/// Kind of run, with its scenario.
pub enum Job {
    /// A multi-position alignment.
    Stepwise(Scenario),
    /// An alignment on a rotating platform.
    Turning(TurntableScenario),
    /// An alignment in a vehicle.
    Stops(VehicleScenario),
}

impl Job {
    /// Job that the host requests; `None` without a valid one.
    #[inline(never)]
    pub fn from_host() -> Option<Self> {
        let mut line = [MaybeUninit::uninit(); LONGEST];
        let line = sys_get_cmdline_uninit(&mut line).ok()?;
        let line = line.split(|&byte| byte == 0).next()?;
        let word = str::from_utf8(line.rsplit(|&byte| byte == b' ').next()?).ok()?;
        let (seed, kind) = word.split_once('/').unwrap_or((word, ""));
        let seed = seed.parse().ok()?;
        match kind {
            "" => Some(Self::Stepwise(Scenario::usual(seed))),
            "brief" => Some(Self::Stepwise(Scenario::brief(seed))),
            "survey" => Some(Self::Stepwise(Scenario::surveying(seed))),
            "turning" => Some(Self::Turning(TurntableScenario::brief(seed))),
            "stops" => Some(Self::Stops(VehicleScenario::brief(seed))),
            _ => None,
        }
    }

    /// Scenario with site, gyro and seed.
    pub fn base(&self) -> &Scenario {
        match self {
            Self::Stepwise(scenario) => scenario,
            Self::Turning(scenario) => &scenario.base,
            Self::Stops(scenario) => &scenario.base,
        }
    }

    /// Builds the whole run at its final place in memory; `None` where the scenario does not allow
    /// a start.
    pub fn begin(&self, meter: &'static Meter) -> Option<(Sampling, Running)> {
        match self {
            Self::Stepwise(scenario) => stepwise(scenario, meter),
            Self::Turning(scenario) => turning(scenario, meter),
            Self::Stops(scenario) => driving(scenario, meter),
        }
    }
}

/// Builds a run in positions.
fn stepwise(scenario: &Scenario, meter: &'static Meter) -> Option<(Sampling, Running)> {
    let prepared = scenario.prepared()?;
    let session = setup::session(|| AnySession::Stepwise(Session::from(prepared)));
    let AnySession::Stepwise(session) = session else { return None };
    let around = Metering(meter);
    let (inputs, outputs, channels) = setup::stage(
        || simulated::board(scenario, None, &HEALTHY),
        |rig| Wires(rig, &around).sensors(scenario, scenario::FORCE),
        |rig| Wires(rig, &around).ports(Motor::default(), NoLink, NoRecorder),
        meter,
    )?;
    let configuration = scenario.configuration();
    Some((
        Sampling::Stage(inputs, configuration, channels),
        Running::Stepwise(session, outputs, configuration, channels),
    ))
}

/// Builds a run on a rotating platform.
fn turning(scenario: &TurntableScenario, meter: &'static Meter) -> Option<(Sampling, Running)> {
    let (setting, procedure) = scenario.checked()?;
    let session = || AnySession::Turning(rotating::Session::of(setting, procedure));
    let AnySession::Turning(session) = setup::session(session) else { return None };
    let around = Metering(meter);
    let (inputs, outputs, channels) = setup::stage(
        || scenario.board(&HEALTHY),
        |rig| Wires(rig, &around).sensors(&scenario.base, turntable::FORCE),
        |rig| Wires(rig, &around).ports(turntable::motor(), NoLink, NoRecorder),
        meter,
    )?;
    Some((
        Sampling::Stage(inputs, scenario.base.configuration(), channels),
        Running::Turning(session, outputs, channels),
    ))
}

/// Builds a run in a vehicle.
fn driving(scenario: &VehicleScenario, meter: &'static Meter) -> Option<(Sampling, Running)> {
    let (setting, procedure) = scenario.checked()?;
    let session = || AnySession::Stops(stops::Session::of(setting, procedure));
    let AnySession::Stops(session) = setup::session(session) else { return None };
    let keeping = setup::keeping(&scenario.keeper()?, &scenario.keeping());
    let around = Metering(meter);
    let (inputs, place, channels) = setup::vehicle(
        || scenario.board(&vehicle::BRIEF, &[], &HEALTHY),
        |rig| Wires(rig, &around).triad(scenario),
        |rig| KnownPlace::new(rig, scenario.place, scenario.base.seed),
        meter,
    )?;
    Some((
        Sampling::Vehicle(inputs, scenario.configuration(), channels),
        Running::Stops(session, place, keeping, channels),
    ))
}
