//! Job of the image, given by the host as the last word of the command line: `SEED/RUN`, with one of
//! the runs of [`Job::from_host`].

use core::mem::MaybeUninit;

use semihosting::sys::arm_compat::sys_get_cmdline_uninit;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::spin::SpinScenario;
use simulated::turntable::TurntableScenario;
use simulated::vehicle::VehicleScenario;
use static_cell::StaticCell;

/// Length of the longest command line, bytes; the emulator begins it with the image's path.
const LONGEST: usize = 4096;

/// Carrier, with its scenario.
#[expect(clippy::large_enum_variant, reason = "there is one, at the beginning")]
pub enum Job {
    /// A multi-position alignment on a stage.
    Stage(Scenario),
    /// A multi-position alignment on a two-frame mount.
    Frames(FramesScenario),
    /// An alignment on a rotating platform.
    Turntable(TurntableScenario),
    /// An alignment in a vehicle, which then holds its result.
    Vehicle(VehicleScenario),
    /// The roll of a spinning body.
    Spin(SpinScenario),
}

impl Job {
    /// Job that the host requests, in static memory; `None` without a valid one. Not inlined, so that
    /// its copies on the stack are gone when it runs.
    #[inline(never)]
    pub fn from_host() -> Option<&'static Self> {
        static JOB: StaticCell<Job> = StaticCell::new();
        let mut line = [MaybeUninit::uninit(); LONGEST];
        let line = sys_get_cmdline_uninit(&mut line).ok()?;
        let line = line.split(|&byte| byte == 0).next()?;
        let word = str::from_utf8(line.rsplit(|&byte| byte == b' ').next()?).ok()?;
        let (seed, run) = word.split_once('/')?;
        let seed = seed.parse().ok()?;
        Some(JOB.init(match run {
            "stage" => Self::Stage(Scenario::usual(seed)),
            "brief" => Self::Stage(Scenario::brief(seed)),
            "survey" => Self::Stage(Scenario::surveying(seed)),
            "two-frame" => Self::Frames(FramesScenario::brief(seed)),
            "turntable" => Self::Turntable(TurntableScenario::brief(seed)),
            "vehicle" => Self::Vehicle(VehicleScenario::brief(seed)),
            "spin" => Self::Spin(SpinScenario::brief(seed)),
            _ => return None,
        }))
    }

    /// Sample rate of the gyros, Hz.
    pub fn sample_rate(&self) -> f64 {
        match self {
            Self::Stage(scenario) => scenario.sample_rate_hz,
            Self::Frames(scenario) => scenario.base.sample_rate_hz,
            Self::Turntable(scenario) => scenario.base.sample_rate_hz,
            Self::Vehicle(scenario) => scenario.base.sample_rate_hz,
            Self::Spin(_) => simulated::spin::SAMPLE_RATE,
        }
    }
}
