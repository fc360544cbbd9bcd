//! What to run, as the host says it in the last word of the image's command line: `SEED`, or
//! `SEED/brief` for the short run at the highest sample rate, `SEED/survey` for one that learns its
//! gyro's noise first, `SEED/turning` for one on a platform that turns all the time.

use core::cell::RefCell;
use core::mem::MaybeUninit;

use firmware::configuration::Configuration;
use firmware::ports::NoRecorder;
use firmware::simulated::fault::Plan;
use firmware::simulated::scenario::Scenario;
use firmware::simulated::turntable::{self, TurntableScenario};
use firmware::simulated::{self, Chips};
use semihosting::sys::arm_compat::sys_get_cmdline_uninit;

use crate::outside::{Metering, NoLink};
use crate::sitting::Sitting;
use crate::{Inputs, Outputs, Rig};

/// Bytes of the longest command line; the emulator begins it with the image's path.
const LONGEST: usize = 4096;

/// What to run.
#[expect(clippy::large_enum_variant, reason = "there is one")]
pub enum Order {
    /// An alignment in positions.
    Stepwise(Scenario),
    /// One on a turning platform.
    Turning(TurntableScenario),
}

impl Order {
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
            _ => None,
        }
    }

    /// Site, gyro and seed.
    pub fn base(&self) -> &Scenario {
        match self {
            Self::Stepwise(scenario) => scenario,
            Self::Turning(scenario) => &scenario.base,
        }
    }

    /// What the board is told of its devices.
    pub fn configuration(&self) -> Configuration {
        match self {
            Self::Stepwise(scenario) => scenario.configuration(),
            Self::Turning(scenario) => scenario.configuration(),
        }
    }

    /// The session, made where it stays; `None` where the scenario lets it not begin.
    pub fn session(&self) -> Option<&'static mut Sitting> {
        match self {
            Self::Stepwise(scenario) => scenario.prepared().map(Sitting::stepwise),
            Self::Turning(scenario) => {
                scenario.checked().map(|(setting, procedure)| Sitting::turning(&setting, procedure))
            }
        }
    }

    /// The simulated board.
    pub fn board(&self, plan: &'static Plan) -> Chips<'static> {
        match self {
            Self::Stepwise(scenario) => simulated::board(scenario, plan),
            Self::Turning(scenario) => scenario.board(plan),
        }
    }

    /// Its sensors.
    pub fn inputs(&self, rig: &'static Rig, metering: &Metering) -> Inputs {
        match self {
            Self::Stepwise(scenario) => simulated::sensors(rig, scenario, metering),
            Self::Turning(scenario) => turntable::sensors(rig, scenario, metering),
        }
    }

    /// Its other ports.
    pub fn outputs(&self, rig: &'static RefCell<Chips<'static>>, metering: &Metering) -> Outputs {
        match self {
            Self::Stepwise(_) => simulated::ports(rig, metering, NoLink, NoRecorder),
            Self::Turning(_) => turntable::ports(rig, metering, NoLink, NoRecorder),
        }
    }
}
