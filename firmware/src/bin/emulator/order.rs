//! What to run, as the host says it in the last word of the image's command line: `SEED`, or
//! `SEED/brief` for the short run at the highest sample rate, or `SEED/survey` for one that learns its
//! gyro's noise first.

use core::mem::MaybeUninit;

use firmware::simulated::scenario::Scenario;
use semihosting::sys::arm_compat::sys_get_cmdline_uninit;

/// Bytes of the longest command line; the emulator begins it with the image's path.
const LONGEST: usize = 4096;

/// What to run.
pub struct Order {
    /// What fixes everything random.
    pub seed: u64,
    /// The run.
    pub scenario: Scenario,
}

/// The host's order; `None` where there is none.
#[inline(never)]
pub fn from_host() -> Option<Order> {
    let mut line = [MaybeUninit::uninit(); LONGEST];
    let line = sys_get_cmdline_uninit(&mut line).ok()?;
    let line = line.split(|&byte| byte == 0).next()?;
    let word = str::from_utf8(line.rsplit(|&byte| byte == b' ').next()?).ok()?;
    let (seed, kind) = word.split_once('/').unwrap_or((word, ""));
    let seed = seed.parse().ok()?;
    let scenario = match kind {
        "" => Scenario::usual(seed),
        "brief" => Scenario::brief(seed),
        "survey" => Scenario::surveying(seed),
        _ => return None,
    };
    Some(Order { seed, scenario })
}
