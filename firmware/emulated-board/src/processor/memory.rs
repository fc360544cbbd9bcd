//! The memory that Unicorn has: flash with the image, both parts of RAM, and what is in RAM before a program writes it.

use unicorn_engine::Unicorn;

use crate::controller::Memory;
use crate::{RAM, RAM_BYTES, RAM2, RAM2_BYTES};

/// What RAM holds after the supply came up. It is undefined on a chip (RM0351, 2.4); one value shows how deep the stack
/// has been.
pub const RAM_FILL: u8 = 0xA5;

/// Both parts of RAM: where each begins, and its size in bytes.
pub(super) const RAMS: [(u32, usize); 2] = [(RAM, RAM_BYTES), (RAM2, RAM2_BYTES)];

/// The memory behind Unicorn.
pub(super) struct Ram<'u, 'a>(pub(super) &'u mut Unicorn<'a, ()>);

impl Memory for Ram<'_, '_> {
    fn read(&self, address: u32, bytes: &mut [u8]) -> bool {
        self.0.mem_read(address.into(), bytes).is_ok()
    }

    fn write(&mut self, address: u32, bytes: &[u8]) -> bool {
        is_ram(address) && self.0.mem_write(address.into(), bytes).is_ok()
    }
}

impl Ram<'_, '_> {
    /// Fills all RAM with what it holds after the supply came up.
    pub(super) fn fill(&mut self) {
        for (start, bytes) in RAMS {
            self.write(start, &vec![RAM_FILL; bytes]);
        }
    }
}

/// Whether an address is in RAM.
fn is_ram(address: u32) -> bool {
    RAMS.iter()
        .any(|(start, bytes)| address.checked_sub(*start).is_some_and(|at| (at as usize) < *bytes))
}
