//! The board's own flash, where it keeps what must outlast a loss of supply.

use embassy_embedded_hal::adapter::BlockingAsync;
use embassy_stm32::Peri;
use embassy_stm32::flash::{Blocking, Flash};
use embassy_stm32::peripherals::FLASH;
use firmware::storage::FlashStore;
use sequential_storage::map::MapConfig;

/// The store. The program lies in the lower bank of the flash and runs on while the upper one is erased.
pub type Store = FlashStore<BlockingAsync<Flash<'static, Blocking>>>;

/// Where in it things are kept: the last two pages of 1 MiB, which no image reaches (`memory.x`).
const KEPT: core::ops::Range<u32> = 0xF_F000..0x10_0000;

/// The store in the board's flash.
pub fn store(flash: Peri<'static, FLASH>) -> Store {
    let flash = BlockingAsync::new(Flash::new_blocking(flash));
    FlashStore::new(flash, const { MapConfig::new(KEPT) })
}
