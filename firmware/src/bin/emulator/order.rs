//! What to run, as the host says it in the last word of the image's command line: `SEED`, or
//! `SEED/brief` for the short run at the highest sample rate.

use core::mem::MaybeUninit;

use semihosting::sys::arm_compat::sys_get_cmdline_uninit;

/// Bytes of the longest command line; the emulator begins it with the image's path.
const LONGEST: usize = 4096;

/// What to run.
pub struct Order {
    /// What fixes everything random.
    pub seed: u64,
    /// Whether it is the short run.
    pub is_brief: bool,
}

/// The host's order; `None` where there is none.
#[inline(never)]
pub fn from_host() -> Option<Order> {
    let mut line = [MaybeUninit::uninit(); LONGEST];
    let line = sys_get_cmdline_uninit(&mut line).ok()?;
    let line = line.split(|&byte| byte == 0).next()?;
    let word = str::from_utf8(line.rsplit(|&byte| byte == b' ').next()?).ok()?;
    let (seed, is_brief) = word.strip_suffix("/brief").map_or((word, false), |seed| (seed, true));
    Some(Order { seed: seed.parse().ok()?, is_brief })
}
