//! What a debugger does: it reads and writes memory, has the core go on elsewhere, and asks what was executed.

use unicorn_engine::RegisterARM;

use super::Processor;
use super::blocks::Blocks;
use super::memory::Ram;
use super::state::Counts;
use crate::controller::{Controller, Memory};
use crate::time::Time;

impl Processor {
    /// Whether a fault that could not be taken has locked the core up, until a reset.
    #[must_use]
    pub fn is_locked(&self) -> bool {
        self.state.borrow().is_locked
    }

    /// Time until now.
    pub fn now(&self) -> Time {
        self.state.borrow().now
    }

    /// Counts the longest time with interrupts held back anew.
    pub fn forget_masked(&self) {
        self.state.borrow_mut().counts.masked = (Time::ZERO, 0);
    }

    /// What was counted.
    pub fn counts(&self) -> Counts {
        self.state.borrow().counts
    }

    /// What is done with the blocks that were executed.
    pub fn with_blocks<T>(&self, task: impl FnOnce(&Blocks) -> T) -> T {
        task(&self.state.borrow().blocks)
    }

    /// What is done with the controller.
    pub fn with_controller<T>(&self, task: impl FnOnce(&mut Controller) -> T) -> T {
        task(&mut self.state.borrow_mut().controller)
    }

    /// Reads memory as a debugger does; whether there is memory.
    pub fn peek(&self, address: u32, bytes: &mut [u8]) -> bool {
        self.uc.mem_read(address.into(), bytes).is_ok()
    }

    /// Writes memory as a debugger does; whether there is RAM.
    pub fn poke(&mut self, address: u32, bytes: &[u8]) -> bool {
        Ram(&mut self.uc).write(address, bytes)
    }

    /// Goes on at another address, as a debugger has it do.
    pub fn jump(&mut self, address: u32) {
        self.set(RegisterARM::PC, u64::from(address | 1));
    }

    /// Whether interrupts are held back.
    pub fn is_masked(&self) -> bool {
        self.state.borrow().masked_since.is_some()
    }

    /// Function and line of the code that is executed.
    pub fn place(&self) -> String {
        self.image.place(self.get(RegisterARM::PC) as u32)
    }
}
