//! Flash of the controller, for data that must outlast a loss of supply.

use embassy_embedded_hal::adapter::BlockingAsync;
use embassy_stm32::Peri;
use embassy_stm32::flash::{Blocking, FLASH_SIZE, Flash, MAX_ERASE_SIZE};
use embassy_stm32::peripherals::FLASH;
use firmware::storage::FlashStore;
use sequential_storage::map::MapConfig;

/// Store in flash. The program lies in the lower bank, so that interrupts are served while the
/// upper one is erased; the tasks wait meanwhile, and samples are lost.
pub type Store<'d> = FlashStore<BlockingAsync<Flash<'d, Blocking>>>;

/// Range of the store: the last two pages, which no image reaches (`memory.x`).
const KEPT: core::ops::Range<u32> = (FLASH_SIZE - 2 * MAX_ERASE_SIZE) as u32..FLASH_SIZE as u32;

/// The store in the controller's flash.
pub fn store(flash: Peri<'_, FLASH>) -> Store<'_> {
    let flash = BlockingAsync::new(Flash::new_blocking(flash));
    FlashStore::new(flash, const { MapConfig::new(KEPT) })
}
