//! The map of memory: both parts of RAM, what is in them before a program writes it, and where registers are.

use unicorn_engine::{Prot, Unicorn};

use crate::controller::Memory;
use crate::{RAM, RAM_BYTES, RAM2, RAM2_BYTES};

/// What RAM holds after the supply came up. It is undefined on a chip (RM0351, 2.4); one value shows how deep the stack
/// has been.
pub const RAM_FILL: u8 = 0xA5;

/// Both parts of RAM: where each begins, and its size in bytes.
pub(super) const RAMS: [(u32, usize); 2] = [(RAM, RAM_BYTES), (RAM2, RAM2_BYTES)];

/// Where this controller has registers, modelled or not (RM0351, 2.2.2), with the size, bytes: system memory with the
/// unique identity, peripherals, external memories' controllers, the core's own. Accesses elsewhere are bus faults.
pub(super) const REGISTERS: [(u32, u64); 4] = [
    (0x1FFF_0000, 0x0001_0000),
    (0x4000_0000, 0x2000_0000),
    (0xA000_0000, 0x0000_2000),
    (0xE000_0000, 0x0010_0000),
];

/// Where devices begin in the default map of memory (B3.1): what is mapped from here on are registers.
pub(super) const DEVICES: u32 = 0x4000_0000;

/// Has accesses of devices held to their alignment, or no longer: Unicorn takes their registers for protected.
pub(super) fn watch_devices(uc: &mut Unicorn<'_, ()>, are_watched: bool) {
    let allowed = if are_watched { Prot::NONE } else { Prot::READ | Prot::WRITE };
    for (base, size) in REGISTERS.into_iter().filter(|(base, _)| *base >= DEVICES) {
        let _ = uc.mem_protect(base.into(), size, allowed);
    }
}

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
pub(super) fn is_ram(address: u32) -> bool {
    RAMS.iter()
        .any(|(start, bytes)| address.checked_sub(*start).is_some_and(|at| (at as usize) < *bytes))
}
