//! Serial buses that are polled, and never hang.
//!
//! A transfer has at most a few dozen bytes: it takes longer to set up direct memory access for one than to poll
//! it, and since a transaction never yields, a sample is taken in one go. embassy sets up pins and clocks; the
//! bytes go through the registers here (RM0351, chapter 42).
//!
//! **Each transfer ends.** A transfer that has not come to its end within a multiple of its time is given up: the peripheral
//! is reset with all that its buffers hold, and the next transfer finds it as new. The turns of the loop that
//! waits are counted, so that an interrupt or a task of higher priority takes nothing of that time.
//!
//! **Mode and clock** belong to a device, and are written where the latest device had others. The interface
//! stays enabled between transfers, and drives the clock at its idle level.
//!
//! Between the fall of a select line and the first edge of the clock lie `SELECTED` cycles. Between two transactions of a
//! device lie more than the 180 ns that a TMC5160 asks for.

use core::mem::forget;

use cortex_m::asm::delay;
use embassy_stm32::gpio::Output;
use embassy_stm32::mode::Blocking;
use embassy_stm32::pac::spi::Spi as Registers;
use embassy_stm32::pac::spi::regs::Cr1;
use embassy_stm32::pac::spi::vals::{Br, Cpha, Cpol, Ds, Frxth, Mstr};
use embassy_stm32::pac::{RCC, SPI1, SPI2};
use embassy_stm32::spi::mode::Master;
use embassy_stm32::spi::{Mode, Phase, Polarity, Spi};
use embassy_time::{Duration, block_for};
use embedded_hal_async::spi::{Error, ErrorKind, ErrorType, Operation, SpiDevice};
use firmware::platform::Platform;

use crate::{PLATFORM, chain};

/// Bytes that each of the two buffers of the interface holds.
const BUFFER: usize = 4;

/// Bytes that are transferred between two looks at the operations of a transaction.
const PIECE: usize = 16;

/// Cycles from the fall of a select line to the first edge of the clock, at least: 125 ns at 64 MHz, where no chip here asks
/// for more than 100 ns (MT6835).
const SELECTED: u32 = 8;

/// Turns of the waiting loop, each of at least four cycles, for each cycle of the bus clock's divider: a byte
/// takes eight bus clocks, and is given up after more than twice that.
const TURNS: u16 = 4;

/// A transfer did not come to its end within its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hung;

impl Error for Hung {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

/// A serial bus of the controller. The devices of one executor need no lock, since a transaction never yields;
/// those of an executor that another one on the same bus interrupts are [uninterrupted](Device::uninterrupted).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bus {
    /// SPI1.
    First,
    /// SPI2.
    Second,
}

impl Bus {
    /// Leaves a bus as embassy has set it up, with its pins and its clock, to its devices.
    #[must_use]
    pub fn taken(self, set_up: Spi<'static, Blocking, Master>) -> Self {
        // To drop it would take pins and clock away.
        forget(set_up);
        self
    }

    /// The registers.
    const fn registers(self) -> Registers {
        match self {
            Self::First => SPI1,
            Self::Second => SPI2,
        }
    }

    /// Prepares the interface for these settings, where it has others.
    fn configure(self, control: Cr1) {
        if self.registers().cr1().read() != control {
            self.set(control, false);
        }
    }

    /// Prepares the interface for these settings, and for direct memory access, until its next reset.
    pub(crate) fn configure_for_memory_access(self, control: Cr1) {
        self.set(control, true);
    }

    /// Has the interface transfer words of eight bits with these settings.
    fn set(self, control: Cr1, is_by_memory_access: bool) {
        let registers = self.registers();
        let mut off = control;
        off.set_spe(false);
        registers.cr1().write_value(off);
        registers.cr2().write(|words| {
            words.set_ds(Ds::BITS8);
            words.set_frxth(Frxth::QUARTER);
            words.set_rxdmaen(is_by_memory_access);
            words.set_txdmaen(is_by_memory_access);
        });
        registers.cr1().write_value(control);
    }

    /// Resets the interface, which a transfer that hangs leaves with bytes in its buffers.
    pub(crate) fn reset(self) {
        for is_reset in [true, false] {
            match self {
                Self::First => RCC.apb2rstr().modify(|bits| bits.set_spi1rst(is_reset)),
                Self::Second => RCC.apb1rstr1().modify(|bits| bits.set_spi2rst(is_reset)),
            }
        }
    }

    /// Sends bytes and puts in their place what comes back meanwhile, within so many turns of waiting.
    fn exchange(self, bytes: &mut [u8], mut turns: u16) -> Result<(), Hung> {
        let registers = self.registers();
        let (mut sent, mut received) = (0, 0);
        let mut status = registers.sr().read();
        while received < bytes.len() || status.bsy() {
            // Not more bytes are under way than the receiving buffer holds, so that none is lost.
            let may_send = status.txe() && sent - received < BUFFER;
            if let Some(byte) = bytes.get(sent).filter(|_| may_send) {
                registers.dr8().write_value(*byte);
                sent += 1;
            } else if let Some(byte) = bytes.get_mut(received).filter(|_| status.rxne()) {
                *byte = registers.dr8().read();
                received += 1;
            } else {
                turns = turns.checked_sub(1).ok_or(Hung)?;
            }
            status = registers.sr().read();
        }
        Ok(())
    }
}

/// A device on a bus, with its mode, its clock and its select line.
pub struct Device {
    bus: Bus,
    /// Line that selects the device, active low.
    select: Output<'static>,
    /// Settings of the bus for this device.
    control: Cr1,
    /// Turns of waiting within which a byte must pass.
    turns: u16,
    /// Whether its transactions run within critical sections.
    is_uninterrupted: bool,
}

impl Device {
    /// A device with a mode and the greatest clock that it allows, Hz, on a bus that divides `clock`, Hz.
    #[must_use]
    pub fn new(bus: Bus, select: Output<'static>, mode: Mode, limit: u32, clock: u32) -> Self {
        let (divider, turns) = divider(limit, clock);
        let mut control = Cr1::default();
        control.set_mstr(Mstr::MASTER);
        control.set_ssm(true);
        control.set_ssi(true);
        control.set_br(divider);
        control.set_cpol(match mode.polarity {
            Polarity::IdleLow => Cpol::IDLE_LOW,
            Polarity::IdleHigh => Cpol::IDLE_HIGH,
        });
        control.set_cpha(match mode.phase {
            Phase::CaptureOnFirstTransition => Cpha::FIRST_EDGE,
            Phase::CaptureOnSecondTransition => Cpha::SECOND_EDGE,
        });
        control.set_spe(true);
        Self { bus, select, control, turns, is_uninterrupted: false }
    }

    /// The device with transactions that nothing interrupts, as it must be where a task of higher priority has another
    /// device on the same bus. Five bytes of a TMC5160 take 20 µs.
    #[must_use]
    pub fn uninterrupted(self) -> Self {
        Self { is_uninterrupted: true, ..self }
    }

    /// Settings of the bus for this device.
    pub(crate) const fn control(&self) -> Cr1 {
        self.control
    }

    /// Performs a transaction.
    fn transact(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Hung> {
        if PLATFORM == Platform::Spin {
            chain::make_way(self.bus);
        }
        self.bus.configure(self.control);
        self.select.set_low();
        delay(SELECTED);
        let outcome = operations.iter_mut().try_for_each(|operation| self.perform(operation));
        if outcome.is_err() {
            self.bus.reset();
        }
        self.select.set_high();
        outcome
    }

    /// Exchanges bytes in place.
    fn exchange(&self, bytes: &mut [u8]) -> Result<(), Hung> {
        // No transaction is so long that this saturates; the turn more is for an empty one.
        let turns = self.turns.saturating_mul(bytes.len() as u16 + 1);
        self.bus.exchange(bytes, turns)
    }

    /// Performs one operation of a transaction.
    fn perform(&self, operation: &mut Operation<'_, u8>) -> Result<(), Hung> {
        match operation {
            Operation::TransferInPlace(bytes) => self.exchange(bytes),
            Operation::Write(sent) => self.copied(&mut [], sent),
            Operation::Read(received) => self.copied(received, &[]),
            Operation::Transfer(received, sent) => self.copied(received, sent),
            Operation::DelayNs(nanoseconds) => {
                block_for(Duration::from_nanos(u64::from(*nanoseconds)));
                Ok(())
            }
        }
    }

    /// Exchanges bytes of two places piece by piece; zeros are sent where nothing is to be sent.
    fn copied(&self, received: &mut [u8], sent: &[u8]) -> Result<(), Hung> {
        let length = received.len().max(sent.len());
        for begin in (0..length).step_by(PIECE) {
            let mut piece = [0; PIECE];
            let piece = &mut piece[..PIECE.min(length - begin)];
            let rest = sent.get(begin..).unwrap_or_default();
            piece.iter_mut().zip(rest).for_each(|(byte, sent)| *byte = *sent);
            self.exchange(piece)?;
            let rest = received.get_mut(begin..).unwrap_or_default();
            rest.iter_mut().zip(piece).for_each(|(received, byte)| *received = *byte);
        }
        Ok(())
    }
}

impl ErrorType for Device {
    type Error = Hung;
}

impl SpiDevice for Device {
    /// Never yields.
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Hung> {
        if self.is_uninterrupted {
            critical_section::with(|_| self.transact(operations))
        } else {
            self.transact(operations)
        }
    }
}

/// Smallest divider that takes a clock, Hz, to a limit, Hz, or below it, and the turns of waiting that it leaves a
/// byte.
const fn divider(limit: u32, clock: u32) -> (Br, u16) {
    let mut bits = 0;
    while bits < Br::DIV256.to_bits() && clock >> (bits + 1) > limit {
        bits += 1;
    }
    (Br::from_bits(bits), TURNS << (bits + 1))
}
