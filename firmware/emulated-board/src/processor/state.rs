//! What the hooks of Unicorn share with the program around it: controller, time, counts, and why the core stops.

use unicorn_engine::{RegisterARM, Unicorn};

use super::blocks::{Blocks, Effects};
use super::checks::first_fault;
use super::memory::{Ram, watch_devices};
use super::protecting::Checkpoint;
use crate::controller::protection::{Access, Level};
use crate::controller::{Controller, Refused};
use crate::exceptions::{Masks, PRIORITY_MASK, Set};
use crate::faults::Fault;
use crate::time::Time;

/// How many executions of each block have their accesses of devices held to alignment. All of them would cost a sixth of
/// the speed.
const WATCHED_EXECUTIONS: u64 = 16;

/// Why the core does not go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Halt {
    /// It waits for an event.
    Waiting,
    /// It waits for an interrupt.
    Sleeping,
    /// It returns from an exception.
    Returning,
    /// It calls the supervisor.
    Calling,
    /// It faults.
    Faulting(Fault),
    /// It changes where memory is protected, or from whom.
    Protecting,
    /// Within the block that it begins, it comes to an instruction at this address that faults.
    Approaching(u32),
    /// It asked the controller for something that the model does not know.
    Refused {
        /// The address of the register.
        address: u32,
        /// What was written to it; none of a read.
        written: Option<u32>,
        /// Why it is refused.
        reason: Refused,
    },
}

/// What was counted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Exceptions that were taken.
    pub exceptions: u64,
    /// Time asleep.
    pub asleep: Time,
    /// The longest time with interrupts held back, and the address at which it ended.
    pub masked: (Time, u32),
    /// The lowest value of the main stack pointer that was seen.
    pub lowest_stack: Option<u32>,
}

/// How accesses are held to their alignment.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Alignment {
    /// Registers that are known to be aligned to a word, as bits; none where the core begins to execute.
    pub(super) known: u16,
    /// Whether accesses of devices are watched.
    watches_devices: bool,
}

/// All that the hooks of Unicorn share with the program around it.
pub(super) struct State {
    /// The controller.
    pub(super) controller: Controller,
    /// Time until now.
    pub(super) now: Time,
    /// The clock for which the time of an instruction holds, Hz.
    pub(super) hertz: u64,
    /// Time of an instruction.
    pub(super) instruction: Time,
    /// Cycles of an instruction.
    pub(super) cycles: f64,
    /// When the controller next does something, or the core is to stop.
    pub(super) due: Time,
    /// When the core is to stop.
    pub(super) until: Time,
    /// What was executed.
    pub(super) blocks: Blocks,
    /// The block that is being executed.
    pub(super) current: Option<usize>,
    /// Whether an exception may have to be taken.
    pub(super) is_pending: bool,
    /// An event that the next wait takes.
    pub(super) event: bool,
    /// Since when interrupts are held back, all of them or those below a priority.
    pub(super) masked_since: Option<Time>,
    /// Number of the exception that is being handled.
    pub(super) active: u32,
    /// Those that were pending when the core last looked.
    pub(super) requested: Set,
    /// Who executes, for the protection of memory.
    pub(super) level: Level,
    /// Whether a fault has locked the core up.
    pub(super) is_locked: bool,
    /// Registers and memory before an access that faults.
    pub(super) checkpoint: Option<Checkpoint>,
    /// How accesses are held to their alignment.
    pub(super) alignment: Alignment,
    /// Why the core is stopped.
    pub(super) halt: Option<Halt>,
    /// Counts.
    pub(super) counts: Counts,
}

impl State {
    /// The state of a core that has not started.
    pub(super) fn new(controller: Controller, cycles: f64) -> Self {
        Self {
            controller,
            now: Time::ZERO,
            hertz: 0,
            instruction: Time::ZERO,
            cycles,
            due: Time::ZERO,
            until: Time::ZERO,
            blocks: Blocks::default(),
            current: None,
            is_pending: false,
            event: false,
            masked_since: None,
            active: 0,
            requested: Set::default(),
            level: Level::default(),
            is_locked: false,
            checkpoint: None,
            alignment: Alignment::default(),
            halt: None,
            counts: Counts::default(),
        }
    }

    /// Forgets what a reset ends.
    pub(super) fn reset(&mut self) {
        (self.halt, self.event, self.masked_since, self.active) = (None, false, None, 0);
        (self.level, self.is_locked, self.checkpoint) = (Level::default(), false, None);
    }

    /// Ends the block that was being executed, and says whether the core must stop before the one at this address.
    pub(super) fn begin_block(
        &mut self,
        address: u32,
        size: u32,
        uc: &mut Unicorn<'_, ()>,
    ) -> bool {
        self.end_block(address, uc);
        if self.now >= self.due {
            let now = self.now;
            self.controller.advance(&mut Ram(uc), now);
            self.look();
        }
        let is_over = self.now >= self.until;
        if is_over || self.halt.is_some() || self.controller.reset.is_some() {
            return true;
        }
        if self.is_pending && self.controller.exceptions.next(masks(uc)).is_some() {
            return true;
        }
        let protection = &self.controller.system.protection;
        if protection.is_on() && !protection.allows(address, 2, Access::Fetch, self.level) {
            self.halt = Some(Halt::Faulting(Fault::PROTECTED_CODE));
            return true;
        }
        let read = |bytes: &mut [u8]| {
            let _ = uc.mem_read(address.into(), bytes);
        };
        let place = self.blocks.place(address, size, read);
        self.current = Some(place);
        self.faults(place, (address, size), uc)
    }

    /// Checks what Unicorn does not check of a block, at an address and of so many bytes; whether it faults.
    fn faults(
        &mut self,
        place: usize,
        (address, size): (u32, u32),
        uc: &mut Unicorn<'_, ()>,
    ) -> bool {
        let is_watched = self.blocks.all[place].count < WATCHED_EXECUTIONS;
        if is_watched != self.alignment.watches_devices {
            self.alignment.watches_devices = is_watched;
            watch_devices(uc, is_watched);
        }
        let is_unit_on = self.controller.system.is_float_unit_on();
        let checks = self.blocks.all[place].checks;
        if checks.fault(self.alignment.known, uc, is_unit_on).is_none() {
            self.alignment.known = checks.aligned_after(self.alignment.known);
            return false;
        }
        self.current = None;
        let mut bytes = vec![0; size as usize];
        let _ = uc.mem_read(address.into(), &mut bytes);
        self.halt = first_fault(&bytes, uc, is_unit_on).map(|(offset, fault)| match offset {
            0 => Halt::Faulting(fault),
            _ => Halt::Approaching(address + u32::from(offset)),
        });
        true
    }

    /// Ends the block that was being executed, before an address: counts it, and follows what it may have done.
    pub(super) fn end_block(&mut self, address: u32, uc: &mut Unicorn<'_, ()>) {
        let Effects { masks, grows_stack, .. } = self.account();
        if masks {
            self.watch_masks(uc, address);
        }
        if grows_stack {
            self.watch_stack(uc);
        }
    }

    /// Counts the block that was executed; what it may have done.
    fn account(&mut self) -> Effects {
        let Some(block) = self.current.take().and_then(|place| self.blocks.all.get_mut(place))
        else {
            return Effects::default();
        };
        block.count += 1;
        self.event |= block.effects.signals;
        self.now = self.now + self.instruction.times(block.offsets.len() as u64);
        if block.is_endless && self.due != Time::NEVER && self.due > self.now {
            // Nothing happens before something is due.
            block.count +=
                ((self.due - self.now).as_seconds() / self.instruction.as_seconds()) as u64;
            self.now = self.due;
        }
        block.effects
    }

    /// Follows how deep the stack is.
    pub(super) fn watch_stack(&mut self, uc: &Unicorn<'_, ()>) {
        let pointer = uc.reg_read(RegisterARM::MSP).unwrap_or(0) as u32;
        let lowest = self.counts.lowest_stack.get_or_insert(pointer);
        *lowest = pointer.min(*lowest);
    }

    /// Looks what the controller has become.
    pub(super) fn look(&mut self) {
        self.due = self.controller.due(self.now).min(self.until);
        self.is_pending = self.controller.exceptions.waits();
        let requested = self.controller.exceptions.requested();
        self.event |=
            self.controller.system.pending_is_event() && requested.has_other_than(self.requested);
        self.requested = requested;
        if self.hertz != self.controller.hertz() {
            self.hertz = self.controller.hertz();
            self.instruction = Time::seconds(self.cycles / self.hertz as f64);
        }
    }

    /// Follows whether interrupts are off, and who executes. Of a base priority only the bits that there are stay.
    pub(super) fn watch_masks(&mut self, uc: &mut Unicorn<'_, ()>, address: u32) {
        let mut masks = masks(uc);
        if masks.base & !PRIORITY_MASK != 0 {
            masks.base &= PRIORITY_MASK;
            let _ = uc.reg_write(RegisterARM::BASEPRI, masks.base.into());
        }
        self.level = self.level(uc, masks);
        if self.level.is_unprivileged && self.controller.system.protection.is_on() {
            self.halt.get_or_insert(Halt::Protecting);
        }
        match (masks.all || masks.base != 0, self.masked_since) {
            (true, None) => self.masked_since = Some(self.now),
            (false, Some(since)) => {
                self.counts.masked = self.counts.masked.max((self.now - since, address));
                self.masked_since = None;
            }
            _ => {}
        }
    }

    /// Who executes.
    pub(super) fn level(&self, uc: &Unicorn<'_, ()>, masks: Masks) -> Level {
        let control = uc.reg_read(RegisterARM::CONTROL).unwrap_or(0);
        Level {
            is_unprivileged: self.active == 0 && control & 1 != 0,
            is_above_faults: self.controller.exceptions.is_locked(masks),
        }
    }

    /// Stops the core.
    pub(super) fn halt(&mut self, uc: &mut Unicorn<'_, ()>, halt: Halt) {
        self.halt.get_or_insert(halt);
        let _ = uc.emu_stop();
    }
}

/// The masks of the core.
pub(super) fn masks(uc: &Unicorn<'_, ()>) -> Masks {
    let read = |register| uc.reg_read(register).unwrap_or(0);
    Masks {
        all: read(RegisterARM::PRIMASK) & 1 != 0,
        faults: read(RegisterARM::FAULTMASK) & 1 != 0,
        base: read(RegisterARM::BASEPRI) as u8,
    }
}
