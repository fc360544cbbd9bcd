//! What to run, as the host says it in the last word of the image's command line: `SEED`, or
//! `SEED/brief` for the short run at the highest sample rate, `SEED/survey` for one that learns its
//! gyro's noise first, `SEED/turning` for one on a platform that turns all the time, `SEED/stops` for one
//! in a vehicle, which goes on keeping what it found.

use core::mem::MaybeUninit;

use firmware::ports::{NoRecorder, VehiclePorts};
use firmware::simulated;
use firmware::simulated::fault::Injection;
use firmware::simulated::scenario::Scenario;
use firmware::simulated::turntable::{self, TurntableScenario};
use firmware::simulated::vehicle::{self, KnownPlace, VehicleScenario};
use semihosting::sys::arm_compat::sys_get_cmdline_uninit;

use crate::meter::Meter;
use crate::outside::{Metering, NoLink};
use crate::setup::{self, Running, Sampling};

/// Bytes of the longest command line; the emulator begins it with the image's path.
const LONGEST: usize = 4096;

/// Nothing goes wrong here.
static HEALTHY: Injection = Injection::NONE;

/// What to run.
pub enum Job {
    /// An alignment in positions.
    Stepwise(Scenario),
    /// One on a turning platform.
    Turning(TurntableScenario),
    /// One in a vehicle.
    Stops(VehicleScenario),
}

impl Job {
    /// The host's; `None` where there is none.
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

    /// Site, gyro and seed.
    pub fn base(&self) -> &Scenario {
        match self {
            Self::Stepwise(scenario) => scenario,
            Self::Turning(scenario) => &scenario.base,
            Self::Stops(scenario) => &scenario.base,
        }
    }

    /// Everything that is to run, made where it stays; `None` where the scenario lets it not begin.
    pub fn begin(&self, meter: &'static Meter) -> Option<(Sampling, Running)> {
        match self {
            Self::Stepwise(scenario) => stepwise(scenario, meter),
            Self::Turning(scenario) => turning(scenario, meter),
            Self::Stops(scenario) => driving(scenario, meter),
        }
    }
}

fn stepwise(scenario: &Scenario, meter: &'static Meter) -> Option<(Sampling, Running)> {
    let session = setup::stepwise(scenario.prepared()?)?;
    let around = Metering(meter);
    let (inputs, outputs, channels) = setup::stage(
        || simulated::board(scenario, &HEALTHY),
        |rig| simulated::sensors(rig, scenario, &around),
        |rig| simulated::ports(rig, &around, NoLink, NoRecorder),
        meter,
    )?;
    let configuration = scenario.configuration();
    Some((
        Sampling::Stage(inputs, configuration, channels),
        Running::Stepwise(session, outputs, configuration, channels),
    ))
}

fn turning(scenario: &TurntableScenario, meter: &'static Meter) -> Option<(Sampling, Running)> {
    let (setting, procedure) = scenario.checked()?;
    let session = setup::turning(&setting, procedure)?;
    let around = Metering(meter);
    let (inputs, outputs, channels) = setup::stage(
        || scenario.board(&HEALTHY),
        |rig| turntable::sensors(rig, scenario, &around),
        |rig| turntable::ports(rig, &around, NoLink, NoRecorder),
        meter,
    )?;
    Some((
        Sampling::Stage(inputs, scenario.configuration(), channels),
        Running::Turning(session, outputs, channels),
    ))
}

fn driving(scenario: &VehicleScenario, meter: &'static Meter) -> Option<(Sampling, Running)> {
    let (setting, procedure) = scenario.checked()?;
    let session = setup::driving(&setting, procedure)?;
    let keeping = setup::keeping(&scenario.keeper()?, &scenario.keeping());
    let around = Metering(meter);
    let (inputs, outputs, channels) = setup::vehicle(
        || scenario.board(&vehicle::BRIEF, &[], &HEALTHY),
        |rig| vehicle::sensors(rig, scenario, &around),
        |rig| VehiclePorts {
            position_aiding: KnownPlace::new(rig, scenario.place, scenario.base.seed),
            link: NoLink,
            recorder: NoRecorder,
        },
        meter,
    )?;
    Some((
        Sampling::Vehicle(inputs, scenario.configuration(), channels),
        Running::Stops(session, outputs, keeping, channels),
    ))
}
