//! Waits for events and interrupts (ARMv7-M Architecture Reference Manual, B1.5.18 and B1.5.19).

use unicorn_engine::{RegisterARM, Unicorn};

use super::Processor;
use super::memory::Ram;
use super::state::{Halt, State, masks};
use crate::time::Time;

impl State {
    /// The wait that the core has just executed, at the end of the block; none where it was none.
    pub(super) fn wait(&self, uc: &Unicorn<'_, ()>) -> Option<Halt> {
        let block = self.blocks.all.get(self.current?)?;
        let last = block.address + u32::from(*block.offsets.last()?);
        if uc.reg_read(RegisterARM::PC).unwrap_or(0) as u32 != last + 2 {
            return None;
        }
        let mut half = [0; 2];
        uc.mem_read(last.into(), &mut half).ok()?;
        match u16::from_le_bytes(half) {
            0xBF20 => Some(Halt::Waiting),
            0xBF30 => Some(Halt::Sleeping),
            _ => None,
        }
    }
}

impl Processor {
    /// Waits for an event or a moment: an exception that is taken is one.
    pub(super) fn wait(&mut self, until: Time) {
        let masks = masks(&self.uc);
        self.pause(until, |state| state.event || state.controller.exceptions.next(masks).is_some());
        self.state.borrow_mut().event = false;
    }

    /// Sleeps until an interrupt or a moment: one that the mask of all holds back wakes too.
    pub(super) fn sleep(&mut self, until: Time) {
        let masks = masks(&self.uc);
        self.pause(until, |state| state.controller.exceptions.wakes(masks));
    }

    /// Lets time go by until something ends the wait; one that has not ended is repeated.
    fn pause(&mut self, until: Time, is_over: impl Fn(&State) -> bool) {
        let start = self.now();
        self.pass(until, &is_over);
        let mut state = self.state.borrow_mut();
        let slept = state.now - start;
        state.counts.asleep = state.counts.asleep + slept;
        let is_over = is_over(&state);
        drop(state);
        if !is_over {
            let pc = self.get(RegisterARM::PC);
            self.set(RegisterARM::PC, pc.wrapping_sub(2) | 1);
        }
    }

    /// Lets time go by while the core does nothing.
    pub(super) fn idle(&mut self, until: Time) {
        self.pass(until, &|_| false);
    }

    /// Lets the controller go on until something is so, a reset is due, or a moment.
    fn pass(&mut self, until: Time, is_over: &impl Fn(&State) -> bool) {
        let mut state = self.state.borrow_mut();
        while state.now < until && state.controller.reset.is_none() && !is_over(&state) {
            let now = state.now;
            let due = state.controller.due(now).min(until).max(now);
            state.now = due;
            state.controller.advance(&mut Ram(&mut self.uc), due);
            state.look();
        }
    }
}
