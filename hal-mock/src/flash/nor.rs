//! The flash as a program sees it through its driver (`firmware/stm32/src/flash.rs`, on that of embassy-stm32 0.6.0),
//! and a supply that is lost when the test wants it.
//!
//! The data cache is off while a row is programmed or a page erased, and emptied before it is on again. Rows before
//! a refused one stay written. Two differences: this one reads bytes anywhere, and tells what is not aligned from what
//! is beyond the end; and where the processor would stop, it returns an error, so that a test can go on.

use core::ops::DerefMut;
use core::time::Duration;

use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

use super::{Bank, Busy, Cells, Ecc, Flash, PAGE, ROW, Refused, SIZE};
use crate::noise::Generator;

/// The flash, the driver and the supply.
#[derive(Clone, Debug)]
pub struct PoweredFlash<M> {
    /// The flash behind the driver.
    pub flash: Flash<M>,
    /// Whether the driver's loads go through the data cache; otherwise straight to the flash, as if other loads
    /// had long since taken the lines.
    pub is_cached: bool,
    /// What follows an uncorrectable row.
    pub interrupt: Interrupt,
    /// When the supply is lost; [`None`] for never.
    pub loss: Option<Loss>,
    /// Rows programmed and pages erased since the supply came.
    pub operations: u32,
    /// Why the processor executes nothing: it has no supply.
    stopped: Option<Trouble>,
    /// The time: it passes while rows are programmed and pages erased.
    now: Duration,
    /// What decides at which moment of an operation the supply is lost.
    noise: Generator,
}

/// When the supply is lost, in operations since it came: a row programmed or a page erased is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// When so many operations are over, before the program takes notice of the last.
    After(u32),
    /// Within the operation after so many, at a random moment of it.
    Within(u32),
}

/// What the program's handler of the non-maskable interrupt does about an uncorrectable row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interrupt {
    /// It notes the row, so that the driver's read ends with an error.
    Notes,
    /// It clears the flag alone, and the program goes on with what was read.
    Returns,
}

/// Why an access fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A row was programmed already (the driver's `Prog`).
    Programmed,
    /// The access reaches beyond the end of the flash (the driver's `Size`).
    Size,
    /// The access is not in whole rows or pages (the driver's `Unaligned`).
    Unaligned,
    /// An operation is under way that was started past the driver.
    Busy,
    /// There is no supply.
    Supply,
    /// An uncorrectable row was read, which the interrupt's handler has noted.
    Uncorrectable,
}

impl NorFlashError for Trouble {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::Size => NorFlashErrorKind::OutOfBounds,
            Self::Unaligned => NorFlashErrorKind::NotAligned,
            _ => NorFlashErrorKind::Other,
        }
    }
}

impl<M: DerefMut<Target = Cells>> PoweredFlash<M> {
    /// A flash that is supplied, read past the data cache by a program whose handler notes uncorrectable
    /// rows. The seed decides at which moment of an operation the supply is lost.
    pub fn new(flash: Flash<M>, seed: u64) -> Self {
        Self {
            flash,
            is_cached: false,
            interrupt: Interrupt::Notes,
            loss: None,
            operations: 0,
            stopped: None,
            now: Duration::ZERO,
            noise: Generator::stream(seed, 2),
        }
    }

    /// The supply is lost, if it is not yet, and comes back: the program starts anew. No further loss is
    /// planned.
    pub fn restart(&mut self) {
        self.flash.lose_supply(self.now);
        self.loss = None;
        self.operations = 0;
        self.stopped = None;
    }

    /// Why the processor executes nothing; [`None`] while it executes the program.
    #[must_use]
    pub fn stopped(&self) -> Option<Trouble> {
        self.stopped
    }

    /// The time: the sum of all operations.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.now
    }

    /// Carries out an operation, or loses the supply before it, in it or after it.
    fn operate<E>(
        &mut self,
        start: impl FnOnce(&mut Flash<M>, Duration) -> Result<(), E>,
    ) -> Result<(), Trouble>
    where
        Trouble: From<E>,
    {
        self.pass(Loss::After(self.operations), self.now)?;
        self.flash.switch_cache(false);
        let done = self.carry_out(start);
        self.flash.reset_cache();
        self.flash.switch_cache(true);
        done?;
        self.operations += 1;
        self.pass(Loss::After(self.operations), self.now)
    }

    /// Carries out an operation beside the data cache.
    fn carry_out<E>(
        &mut self,
        start: impl FnOnce(&mut Flash<M>, Duration) -> Result<(), E>,
    ) -> Result<(), Trouble>
    where
        Trouble: From<E>,
    {
        start(&mut self.flash, self.now)?;
        if let Some(Busy { until }) = self.flash.busy(self.now) {
            let within = until.saturating_sub(self.now).mul_f64(self.noise.uniform());
            self.pass(Loss::Within(self.operations), self.now + within)?;
            self.now = until;
        }
        self.flash.busy(self.now);
        Ok(())
    }

    /// Passes a moment at which the supply may be lost.
    fn pass(&mut self, moment: Loss, at: Duration) -> Result<(), Trouble> {
        if self.stopped.is_none() && self.loss == Some(moment) {
            self.now = at;
            self.flash.lose_supply(at);
            self.stopped = Some(Trouble::Supply);
        }
        self.stopped.map_or(Ok(()), Err)
    }

    /// Reads the row of a byte.
    fn row(&mut self, offset: u32) -> Result<[u8; ROW], Trouble> {
        let read = if self.is_cached {
            self.flash.load(offset, self.now)?
        } else {
            self.flash.read(offset, self.now)?
        };
        if read.ecc == Ecc::Uncorrectable && self.interrupt == Interrupt::Notes {
            // The cache would not tell it again.
            self.flash.switch_cache(false);
            self.flash.reset_cache();
            self.flash.switch_cache(true);
            return Err(Trouble::Uncorrectable);
        }
        Ok(read.bytes)
    }
}

impl<M> ErrorType for PoweredFlash<M> {
    type Error = Trouble;
}

impl<M: DerefMut<Target = Cells>> ReadNorFlash for PoweredFlash<M> {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Trouble> {
        self.pass(Loss::After(self.operations), self.now)?;
        if offset as usize + bytes.len() > SIZE {
            return Err(Trouble::Size);
        }
        let mut row = None;
        for (offset, byte) in (offset..).zip(bytes) {
            let (at, place) = (offset - offset % ROW as u32, offset as usize % ROW);
            let (_, held) = match row.filter(|(held, _)| *held == at) {
                Some(row) => row,
                None => *row.insert((at, self.row(at)?)),
            };
            *byte = held[place];
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        SIZE
    }
}

impl<M: DerefMut<Target = Cells>> NorFlash for PoweredFlash<M> {
    const WRITE_SIZE: usize = ROW;
    const ERASE_SIZE: usize = PAGE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Trouble> {
        let page = PAGE as u32;
        if from > to || !from.is_multiple_of(page) || !to.is_multiple_of(page) {
            return Err(Trouble::Unaligned);
        }
        if to as usize > SIZE {
            return Err(Trouble::Size);
        }
        for start in (from..to).step_by(PAGE) {
            let bank = Bank::of(start);
            let index = ((start - bank.start()) / page) as u8;
            self.operate(|flash, now| flash.erase_page(bank, index, now))?;
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Trouble> {
        if offset as usize + bytes.len() > SIZE {
            return Err(Trouble::Size);
        }
        let (rows, []) = bytes.as_chunks::<ROW>() else { return Err(Trouble::Unaligned) };
        if !(offset as usize).is_multiple_of(ROW) {
            return Err(Trouble::Unaligned);
        }
        for (offset, row) in (offset..).step_by(ROW).zip(rows) {
            self.operate(|flash, now| flash.program(offset, *row, now))?;
        }
        Ok(())
    }
}

impl From<Refused> for Trouble {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Programmed => Self::Programmed,
            Refused::Unaligned => Self::Unaligned,
            Refused::OutOfBounds => Self::Size,
            Refused::Busy(_) => Self::Busy,
        }
    }
}

impl From<Busy> for Trouble {
    fn from(_: Busy) -> Self {
        Self::Busy
    }
}
