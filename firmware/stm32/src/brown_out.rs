//! Level of the supply below which the controller is reset, as its option bytes have it.
//!
//! Delivered is the lowest level, 1.7 V, which is also the lowest supply at which the controller works: what is in RAM
//! then may be lost, and the converters (ADS1262, 2.7 V at least) have long stopped. With a level above both, a reset by
//! a low supply finds RAM as it was, and no reading below the converters' supply is taken.

use embassy_stm32::pac::FLASH;

use crate::flash::unlock;

/// Level 4: 2.8 V (RM0351, 3.4.1, `BOR_LEV`). The board's own supply is 3.3 V ± 5 %.
const LEVEL: u8 = 4;
/// The keys that unlock the option bytes, in their order (RM0351, 3.4.2).
const OPTION_KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];

/// Whether the level is set.
#[must_use]
pub fn is_set() -> bool {
    FLASH.optr().read().bor_lev() == LEVEL
}

/// Programs the level; the controller then loads it by a reset, so that this returns only where that fails.
pub fn set() {
    unlock();
    for key in OPTION_KEYS {
        FLASH.optkeyr().write_value(key);
    }
    FLASH.optr().modify(|options| options.set_bor_lev(LEVEL));
    FLASH.cr().modify(|control| control.set_optstrt(true));
    while FLASH.sr().read().bsy() {}
    FLASH.cr().modify(|control| control.set_obl_launch(true));
}
