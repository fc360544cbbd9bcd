//! The core: Unicorn executes the instructions, this module takes the exceptions and counts the time.
//!
//! Unicorn has neither interrupt controller nor exceptions of the M profile. So it is stopped between two blocks of
//! instructions where something is due; the registers are stacked and unstacked here as the Architecture Reference
//! Manual has it (B1.5.6 to B1.5.8). Floating-point registers are stacked at once instead of lazily, which takes the
//! same memory.

pub mod blocks;
mod checks;
mod debugging;
mod entry;
mod frame;
mod hooks;
mod instructions;
pub mod memory;
mod protecting;
mod registers;
mod returning;
mod sleeping;
mod state;

use std::cell::RefCell;
use std::rc::Rc;

use hal_mock::flash::Bank;
use thiserror::Error;
use unicorn_engine::{Arch, ArmCpuModel, Mode, Prot, RegisterARM, UcHookId, Unicorn, uc_error};

use self::memory::{RAMS, Ram};
pub use self::state::Counts;
use self::state::{Halt, State};
use crate::FLASH;
use crate::controller::{Controller, Refused, ResetReason};
use crate::faults::Fault;
use crate::image::Image;
use crate::time::Time;

/// An address at which nothing is executed, since it is odd.
const NOWHERE: u64 = 0xFFFF_FFFF;
/// Size of a page that Unicorn maps, bytes.
const PAGE: usize = 4096;
/// Bit of the status of the core: the instructions are those of Thumb.
const THUMB: u64 = 1 << 24;

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
    /// A core before its start. An instruction takes so many cycles; RAM is filled with [`memory::RAM_FILL`].
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
        for (start, bytes) in RAMS {
            uc.mem_map(start.into(), bytes as u64, Prot::ALL)?;
        }
        Ram(&mut uc).fill();
        hooks::split_accesses(&mut uc)?;
        controller.flash.array.burn(0, &image.flash);
        controller.flash.program = Some(Bank::Lower);
        let state = Rc::new(RefCell::new(State::new(controller, cycles)));
        let mut processor = Self { uc, state, protecting: None, was_unprivileged: false, image };
        processor.hook()?;
        processor.map_store(code)?;
        processor.map_registers()?;
        processor.start();
        Ok(processor)
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
            self.execute(until, NOWHERE)?;
            let halt = self.state.borrow_mut().halt.take();
            self.resume(halt, until)?;
        }
        Ok(())
    }

    /// Does what the core has stopped for.
    fn resume(&mut self, halt: Option<Halt>, until: Time) -> Result<(), Unknown> {
        match halt {
            Some(Halt::Waiting) => self.wait(until),
            Some(Halt::Sleeping) => self.sleep(until),
            Some(Halt::Returning) => return self.leave(),
            Some(Halt::Calling) => self.call(),
            Some(Halt::Faulting(fault)) => self.fault(fault),
            Some(Halt::Approaching(address)) => return self.approach(address, until),
            Some(Halt::Refused { address, written, reason }) => {
                return Err(self.refused(address, written, reason));
            }
            Some(Halt::Protecting) | None => {}
        }
        Ok(())
    }

    /// Executes the instructions of a block before this address. No code that was translated for it stays: it stops
    /// there, or goes on.
    fn approach(&mut self, address: u32, until: Time) -> Result<(), Unknown> {
        let _ = self.uc.ctl_flush_tb();
        self.execute(until, address.into())?;
        let _ = self.uc.ctl_flush_tb();
        let halt = self.state.borrow_mut().halt.take();
        self.resume(halt, until)
    }

    /// Executes instructions until something is due, or to an address.
    fn execute(&mut self, until: Time, end: u64) -> Result<(), Unknown> {
        if self.get(RegisterARM::XPSR) & THUMB == 0 {
            self.state.borrow_mut().halt = Some(Halt::Faulting(Fault::NO_THUMB));
            return Ok(());
        }
        {
            let mut state = self.state.borrow_mut();
            (state.until, state.alignment.known) = (until, 0);
            state.look();
        }
        let pc = self.get(RegisterARM::PC);
        let ended = self.uc.emu_start(pc | 1, end, 0, 0);
        let mut state = self.state.borrow_mut();
        if ended.is_ok() && state.halt.is_none() {
            state.halt = state.wait(&self.uc);
        }
        state.end_block(self.uc.reg_read(RegisterARM::PC).unwrap_or(0) as u32, &mut self.uc);
        match ended {
            Err(reason) if state.halt.is_none() => {
                drop(state);
                Err(Unknown::Stopped { place: self.place(), reason: format!("{reason:?}") })
            }
            _ => Ok(()),
        }
    }

    /// What was asked for, and where.
    fn refused(&self, address: u32, value: Option<u32>, reason: Refused) -> Unknown {
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

    /// Resets controller and core. RAM stays, but where the supply had to fall to the least at which the controller works.
    pub fn reset(&mut self, reason: ResetReason) {
        {
            let mut state = self.state.borrow_mut();
            let now = state.now;
            state.controller.restart(reason, now);
            state.reset();
        }
        let keeps = self.with_controller(|controller| controller.flash.resets_before_ram_is_lost());
        if reason == ResetReason::Supply && !keeps {
            Ram(&mut self.uc).fill();
        }
        self.start();
    }

    /// Switches the supply off, and on again: RAM is lost.
    pub fn switch_off(&mut self) {
        self.reset(ResetReason::Supply);
        Ram(&mut self.uc).fill();
    }
}
