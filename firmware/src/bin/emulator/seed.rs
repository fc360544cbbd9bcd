//! The seed of the run, which the host gives as the last word of the image's command line.

use core::mem::MaybeUninit;

use semihosting::sys::arm_compat::sys_get_cmdline_uninit;

/// Bytes of the longest command line; the emulator begins it with the image's path.
const LONGEST: usize = 4096;

/// The seed; `None` where there is no number.
#[inline(never)]
pub fn from_host() -> Option<u64> {
    let mut line = [MaybeUninit::uninit(); LONGEST];
    let line = sys_get_cmdline_uninit(&mut line).ok()?;
    let line = line.split(|&byte| byte == 0).next()?;
    let word = line.rsplit(|&byte| byte == b' ').next()?;
    str::from_utf8(word).ok()?.parse().ok()
}
