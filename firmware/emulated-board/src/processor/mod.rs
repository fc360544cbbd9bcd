//! The core: Unicorn executes the instructions, this module takes the exceptions and counts the time.
//!
//! Unicorn has neither interrupt controller nor exceptions of the M profile. So it is stopped between two blocks of
//! instructions where something is due; the registers are stacked and unstacked here as the Architecture Reference
//! Manual has it (B1.5.6 to B1.5.8). Floating-point registers are stacked at once instead of lazily, which takes the
//! same memory.

pub mod blocks;
pub mod exceptions;
pub mod faults;
mod protecting;
mod sleeping;
mod stacking;

use std::cell::RefCell;
use std::rc::Rc;

use thiserror::Error;
use unicorn_engine::{
    Arch, ArmCpuModel, HookType, MemType, Mode, Prot, RegisterARM, TlbEntry, TlbType, UcHookId,
    Unicorn, uc_error,
};

use self::blocks::Blocks;
use self::exceptions::{Masks, NOT_MASKABLE, Set};
use self::faults::Fault;
use crate::controller::protection::{Access, Level};
use crate::controller::{Controller, Memory, Refused, ResetReason};
use crate::image::Image;
use crate::time::Time;
use crate::{FLASH, FLASH_BYTES, RAM, RAM_BYTES, RAM2, RAM2_BYTES};

/// An address at which nothing is executed.
const NOWHERE: u64 = 0xF000_0000;
/// Size of a page that Unicorn maps, bytes.
const PAGE: usize = 4096;
/// What chance leaves in RAM before the start, so that a stack shows how deep it was.
pub const PAINT: u8 = 0xA5;

/// Something that the model does not know, and where the program asked for it.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Unknown {
    /// A register.
    #[error("{access} {address:#010x} near {place}: {reason}")]
    Register {
        /// What was tried: a read, or a write of a value.
        access: String,
        /// The address.
        address: u32,
        /// Function and line of the code.
        place: String,
        /// Why it is refused.
        reason: Refused,
    },
    /// The core stopped for a reason that is not modelled.
    #[error("the core stopped near {place}: {reason}")]
    Stopped {
        /// Function and line of the code.
        place: String,
        /// What Unicorn says.
        reason: String,
    },
}

/// Why the core does not go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Halt {
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
    /// It asked the model for something that it does not know.
    Lost(u32, Refused, Option<u32>),
}

/// What was counted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Exceptions that were taken.
    pub exceptions: u64,
    /// Time asleep.
    pub asleep: Time,
    /// The longest time with interrupts off, and the address at which it ended.
    pub masked: (Time, u32),
}

/// All that the hooks of Unicorn share with the program around it.
struct State {
    /// The controller.
    controller: Controller,
    /// Time until now.
    now: Time,
    /// Time of an instruction.
    instruction: Time,
    /// Cycles of an instruction.
    cycles: f64,
    /// When the controller next does something, or the core is to stop.
    due: Time,
    /// When the core is to stop.
    until: Time,
    /// What was executed.
    blocks: Blocks,
    /// The block that is being executed.
    current: Option<usize>,
    /// Whether an exception may have to be taken.
    is_pending: bool,
    /// An event that the next wait takes.
    event: bool,
    /// Since when interrupts are off.
    masked_since: Option<Time>,
    /// Number of the exception that is being handled.
    active: u32,
    /// Those that were pending when the core last looked.
    requested: Set,
    /// Who executes, for the protection of memory.
    level: Level,
    /// Whether a fault has locked the core up.
    is_locked: bool,
    /// What must be as it was before an access that faults.
    undone: Option<protecting::Undone>,
    /// Why the core is stopped.
    halt: Option<Halt>,
    /// Counts.
    counts: Counts,
}

impl State {
    /// Ends the block that was being executed, and says whether the core must stop before the next one.
    fn next(&mut self, address: u32, size: u32, uc: &mut Unicorn<'_, ()>) -> bool {
        let masks_changed = self.account();
        if masks_changed {
            self.watch_masks(uc, address);
        }
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
        self.current = Some(self.blocks.place(address, size, read));
        false
    }

    /// Counts the block that was executed; whether it may have changed the masks.
    fn account(&mut self) -> bool {
        let Some(block) = self.current.take().and_then(|place| self.blocks.all.get_mut(place))
        else {
            return false;
        };
        block.count += 1;
        self.event |= block.signals;
        self.now = self.now + self.instruction.times(block.offsets.len() as u64);
        if block.is_endless && self.due != Time::NEVER && self.due > self.now {
            // Nothing happens before something is due.
            block.count +=
                ((self.due - self.now).as_seconds() / self.instruction.as_seconds()) as u64;
            self.now = self.due;
        }
        block.masks
    }

    /// Looks what the controller has become.
    fn look(&mut self) {
        self.due = self.controller.due(self.now).min(self.until);
        self.is_pending = self.controller.exceptions.waits();
        let requested = self.controller.exceptions.requested();
        self.event |=
            self.controller.system.pending_is_event() && requested.has_other_than(self.requested);
        self.requested = requested;
        self.instruction = Time::seconds(self.cycles / self.controller.hertz() as f64);
    }

    /// Follows whether interrupts are off, and who executes.
    fn watch_masks(&mut self, uc: &Unicorn<'_, ()>, address: u32) {
        self.level = self.level(uc);
        if self.level.is_unprivileged && self.controller.system.protection.is_on() {
            self.halt.get_or_insert(Halt::Protecting);
        }
        match (masks(uc).all, self.masked_since) {
            (true, None) => self.masked_since = Some(self.now),
            (false, Some(since)) => {
                self.counts.masked = self.counts.masked.max((self.now - since, address));
                self.masked_since = None;
            }
            _ => {}
        }
    }

    /// Who executes.
    fn level(&self, uc: &Unicorn<'_, ()>) -> Level {
        let control = uc.reg_read(RegisterARM::CONTROL).unwrap_or(0);
        Level {
            is_unprivileged: self.active == 0 && control & 1 != 0,
            is_above_faults: self.controller.exceptions.is_locked(masks(uc)),
        }
    }

    /// Stops the core.
    fn halt(&mut self, uc: &mut Unicorn<'_, ()>, halt: Halt) {
        self.halt.get_or_insert(halt);
        let _ = uc.emu_stop();
    }
}

/// Where this controller has registers, modelled or not (RM0351, 2.2.2), with the size, bytes: system memory with the
/// unique identity, peripherals, external memories' controllers, the core's own. Accesses elsewhere are bus faults.
const REGISTERS: [(u32, u64); 4] = [
    (0x1FFF_0000, 0x0001_0000),
    (0x4000_0000, 0x2000_0000),
    (0xA000_0000, 0x0000_2000),
    (0xE000_0000, 0x0010_0000),
];

/// The masks of the core.
fn masks(uc: &Unicorn<'_, ()>) -> Masks {
    let read = |register| uc.reg_read(register).unwrap_or(0);
    Masks {
        all: read(RegisterARM::PRIMASK) & 1 != 0,
        faults: read(RegisterARM::FAULTMASK) & 1 != 0,
        base: read(RegisterARM::BASEPRI) as u8,
    }
}

/// The addresses that are not in RAM, of which every access succeeds. A hook that covers RAM halves the speed:
/// Unicorn then takes the long way for each write.
const WITHOUT_RAM: [(u32, u32); 3] =
    [(0, RAM2 - 1), (RAM2 + RAM2_BYTES as u32, RAM - 1), (RAM + RAM_BYTES as u32, u32::MAX)];

/// Has Unicorn tell pages of code from those of data. Each write to a page that may hold code takes a long way round
/// to look for code that it changes; it takes all RAM for such pages, since the default map of the core does.
fn split_accesses(uc: &mut Unicorn<'_, ()>) -> Result<(), uc_error> {
    uc.ctl_set_tlb_type(TlbType::VIRTUAL)?;
    let entry = |uc: &mut Unicorn<'_, ()>, paddr, kind| {
        if kind == MemType::FETCH {
            return Some(TlbEntry { paddr, perms: Prot::READ | Prot::EXEC });
        }
        protecting::forget_conditions(uc);
        Some(TlbEntry { paddr, perms: Prot::READ | Prot::WRITE })
    };
    uc.add_tlb_hook(1, 0, entry).map(|_| ())
}

/// The memory behind Unicorn.
struct Ram<'u, 'a>(&'u mut Unicorn<'a, ()>);

impl Memory for Ram<'_, '_> {
    fn read(&self, address: u32, bytes: &mut [u8]) -> bool {
        self.0.mem_read(address.into(), bytes).is_ok()
    }

    fn write(&mut self, address: u32, bytes: &[u8]) -> bool {
        is_ram(address) && self.0.mem_write(address.into(), bytes).is_ok()
    }
}

/// Whether an address is in RAM.
fn is_ram(address: u32) -> bool {
    let within = |start: u32, bytes: usize| {
        address.checked_sub(start).is_some_and(|at| (at as usize) < bytes)
    };
    within(RAM, RAM_BYTES) || within(RAM2, RAM2_BYTES)
}

/// The core with its memory and its controller.
pub struct Processor {
    uc: Unicorn<'static, ()>,
    state: Rc<RefCell<State>>,
    /// What holds accesses of data to the protection of memory, and between which addresses.
    protecting: Option<(UcHookId, (u32, u32))>,
    /// Whether there was a thread without privilege.
    was_unprivileged: bool,
    image: Rc<Image>,
}

impl Processor {
    /// A core before its start. An instruction takes so many cycles; RAM holds what chance left in it.
    ///
    /// # Errors
    /// What Unicorn says.
    pub fn new(
        image: Rc<Image>,
        mut controller: Controller,
        cycles: f64,
    ) -> Result<Self, uc_error> {
        let mut uc = Unicorn::new(Arch::ARM, Mode::MCLASS | Mode::THUMB)?;
        uc.ctl_set_cpu_model(ArmCpuModel::CORTEX_M4 as i32)?;
        let code = image.flash.len().next_multiple_of(PAGE);
        uc.mem_map(FLASH.into(), code as u64, Prot::READ | Prot::EXEC)?;
        uc.mem_write(FLASH.into(), &image.flash)?;
        split_accesses(&mut uc)?;
        uc.mem_map(RAM.into(), RAM_BYTES as u64, Prot::ALL)?;
        uc.mem_map(RAM2.into(), RAM2_BYTES as u64, Prot::ALL)?;
        controller.flash.array.burn(0, &image.flash);
        let state = Rc::new(RefCell::new(State {
            controller,
            now: Time::ZERO,
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
            undone: None,
            halt: None,
            counts: Counts::default(),
        }));
        let mut processor = Self { uc, state, protecting: None, was_unprivileged: false, image };
        processor.hook()?;
        processor.map_store(code)?;
        for (base, size) in REGISTERS {
            processor.map_registers(base, size)?;
        }
        processor.start();
        Ok(processor)
    }

    /// Hooks blocks, exceptions and faults.
    fn hook(&mut self) -> Result<(), uc_error> {
        let state = Rc::clone(&self.state);
        self.uc.add_block_hook(1, 0, move |uc, address, size| {
            if state.borrow_mut().next(address as u32, size, uc) {
                let _ = uc.emu_stop();
            }
        })?;
        let state = Rc::clone(&self.state);
        self.uc.add_intr_hook(move |uc, number| {
            let halt = match number {
                2 => Halt::Calling,
                3 => Halt::Faulting(Fault::PROTECTED_CODE),
                7 => Halt::Faulting(Fault::BREAKPOINT),
                8 => Halt::Returning,
                4 | 22 => Halt::Faulting(Fault::UNALIGNED),
                _ => Halt::Faulting(Fault::UNDEFINED),
            };
            state.borrow_mut().halt(uc, halt);
        })?;
        let state = Rc::clone(&self.state);
        self.uc.add_insn_invalid_hook(move |uc| {
            let mut state = state.borrow_mut();
            let wait = state.wait(uc);
            let is_thumb = uc.reg_read(RegisterARM::XPSR).unwrap_or(0) & 1 << 24 != 0;
            let fault = if is_thumb { Fault::UNDEFINED } else { Fault::NO_THUMB };
            state.halt(uc, wait.unwrap_or(Halt::Faulting(fault)));
            wait.is_some()
        })?;
        WITHOUT_RAM.into_iter().try_for_each(|(first, last)| self.hook_faults(first, last))
    }

    /// Hooks accesses that fault between two addresses.
    fn hook_faults(&mut self, first: u32, last: u32) -> Result<(), uc_error> {
        let state = Rc::clone(&self.state);
        let hook = move |uc: &mut Unicorn<'_, ()>, kind, address, _, _| {
            let address = address as u32;
            let fault = match kind {
                MemType::FETCH_UNMAPPED | MemType::FETCH_PROT => Fault::fetch(address),
                _ => Fault::bus(address),
            };
            state.borrow_mut().undo(uc, fault, None);
            false
        };
        let kinds = HookType::MEM_UNMAPPED | HookType::MEM_PROT;
        self.uc.add_mem_hook(kinds, first.into(), last.into(), hook).map(|_| ())
    }

    /// Maps the flash behind the image, which is read and written through the controller.
    fn map_store(&mut self, code: usize) -> Result<(), uc_error> {
        let (reads, writes) = (Rc::clone(&self.state), Rc::clone(&self.state));
        let read = move |uc: &mut Unicorn<'_, ()>, offset: u64, size: usize| {
            let mut state = reads.borrow_mut();
            let offset = code as u32 + offset as u32;
            loop {
                let now = state.now;
                match state.controller.flash.load(offset, size as u32, now) {
                    Ok(value) => {
                        if std::mem::take(&mut state.controller.flash.is_broken) {
                            state.controller.exceptions.pending.put(NOT_MASKABLE, true);
                            state.is_pending = true;
                        }
                        return value.into();
                    }
                    // The bus stalls until the bank can be read.
                    Err(until) => {
                        state.now = until;
                        state.controller.advance(&mut Ram(uc), until);
                    }
                }
            }
        };
        let write = move |uc: &mut Unicorn<'_, ()>, offset: u64, size: usize, value: u64| {
            let mut state = writes.borrow_mut();
            let offset = code as u32 + offset as u32;
            while let Some(until) = {
                let now = state.now;
                state.controller.flash.store(offset, value as u32, size as u32, now)
            } {
                state.now = until;
                state.controller.advance(&mut Ram(uc), until);
            }
            state.look();
        };
        let rest = (FLASH_BYTES - code) as u64;
        self.uc.mmio_map(u64::from(FLASH) + code as u64, rest, Some(read), Some(write))
    }

    /// Maps registers of the controller.
    fn map_registers(&mut self, base: u32, size: u64) -> Result<(), uc_error> {
        let (reads, writes) = (Rc::clone(&self.state), Rc::clone(&self.state));
        let read = move |uc: &mut Unicorn<'_, ()>, offset: u64, size: usize| {
            let mut state = reads.borrow_mut();
            let (address, at) = (base + offset as u32, (state.now, state.active));
            if state.is_barred(uc, address) {
                return 0;
            }
            let read = state.controller.read(&mut Ram(uc), address, size as u32, at);
            state.look();
            read.unwrap_or_else(|reason| {
                state.halt(uc, Halt::Lost(address, reason, None));
                0
            })
            .into()
        };
        let write = move |uc: &mut Unicorn<'_, ()>, offset: u64, size: usize, value: u64| {
            let mut state = writes.borrow_mut();
            let (address, now) = (base + offset as u32, state.now);
            if state.is_barred(uc, address) {
                return;
            }
            let was_watched = state.controller.system.protection.watched(false);
            let written =
                state.controller.write(&mut Ram(uc), address, (value as u32, size as u32), now);
            state.look();
            if let Err(reason) = written {
                state.halt(uc, Halt::Lost(address, reason, Some(value as u32)));
            }
            if was_watched != state.controller.system.protection.watched(false) {
                state.halt(uc, Halt::Protecting);
            }
        };
        self.uc.mmio_map(base.into(), size, Some(read), Some(write))
    }

    /// Executes until a moment.
    ///
    /// # Errors
    /// What the model does not know.
    pub fn run(&mut self, until: Time) -> Result<(), Unknown> {
        while self.now() < until {
            self.restart();
            self.protect();
            if self.is_locked() {
                self.idle(until);
                continue;
            }
            self.take_exceptions();
            self.execute(until)?;
            let halt = self.state.borrow_mut().halt.take();
            match halt {
                Some(Halt::Waiting) => self.wait(until),
                Some(Halt::Sleeping) => self.sleep(until),
                Some(Halt::Returning) => self.leave(),
                Some(Halt::Calling) => self.call(),
                Some(Halt::Faulting(fault)) => self.fault(fault),
                Some(Halt::Lost(address, reason, value)) => {
                    return Err(self.lost(address, reason, value));
                }
                Some(Halt::Protecting) | None => {}
            }
        }
        Ok(())
    }

    /// Executes instructions until something is due.
    fn execute(&mut self, until: Time) -> Result<(), Unknown> {
        {
            let mut state = self.state.borrow_mut();
            state.until = until;
            state.look();
        }
        let pc = self.get(RegisterARM::PC);
        let ended = self.uc.emu_start(pc | 1, NOWHERE, 0, 0);
        let mut state = self.state.borrow_mut();
        if ended.is_ok() && state.halt.is_none() {
            state.halt = state.wait(&self.uc);
        }
        if state.account() {
            let pc = self.get(RegisterARM::PC) as u32;
            state.watch_masks(&self.uc, pc);
        }
        match ended {
            Err(reason) if state.halt.is_none() => {
                drop(state);
                Err(Unknown::Stopped { place: self.place(), reason: format!("{reason:?}") })
            }
            _ => Ok(()),
        }
    }

    /// Whether a fault that could not be taken has locked the core up, until a reset.
    #[must_use]
    pub fn is_locked(&self) -> bool {
        self.state.borrow().is_locked
    }

    /// Time until now.
    pub fn now(&self) -> Time {
        self.state.borrow().now
    }

    /// Counts the longest time with interrupts off anew.
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

    /// Function and line of the code that is executed.
    pub fn place(&self) -> String {
        self.image.place(self.get(RegisterARM::PC) as u32)
    }

    /// What was asked for, and where.
    fn lost(&self, address: u32, reason: Refused, value: Option<u32>) -> Unknown {
        let access =
            value.map_or("a read of".to_owned(), |value| format!("a write of {value:#x} to"));
        Unknown::Register { access, address, place: self.place(), reason }
    }

    /// Starts again where a reset is due.
    fn restart(&mut self) {
        let reset = self.state.borrow().controller.reset;
        if let Some(reason) = reset {
            self.reset(reason);
        }
    }

    /// Resets controller and core. Where the supply was lost, RAM holds what chance leaves.
    pub fn reset(&mut self, reason: ResetReason) {
        {
            let mut state = self.state.borrow_mut();
            let now = state.now;
            state.controller.restart(reason, now);
            (state.halt, state.event, state.masked_since, state.active) = (None, false, None, 0);
            (state.level, state.is_locked, state.undone) = (Level::default(), false, None);
        }
        if reason == ResetReason::Supply {
            self.poke(RAM, &vec![PAINT; RAM_BYTES]);
        }
        self.start();
    }
}
