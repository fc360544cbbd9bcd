//! The I²C side of the simulated chips: `embedded-hal-async` in front, transfers behind.
//!
//! A transfer takes the time of its bits at the bus clock; the chip sees it when it begins. A chip that
//! is not addressed, or not ready, does not acknowledge.
//!
//! A chip answers condition by condition and byte by byte ([`I2cChip::start`] to [`I2cChip::stop`]); a
//! transfer ([`I2cChip::transfer`]) is a run of these without a pause, so that both ways go through the
//! same registers and the same checks.

use core::cell::RefCell;

use embassy_time::{Duration, Instant, Timer};
use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use heapless::Vec;

use crate::chip::Single;
use crate::violation::Violations;

/// Bytes of the longest write, and of the longest read.
const LONGEST: usize = 64;

/// One transfer as a chip sees it: bytes written, then, after a repeated start, bytes read.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<'a> {
    /// When the start condition came.
    pub now: Instant,
    /// Bus clock, Hz.
    pub hertz: u32,
    /// The 7-bit address.
    pub address: u8,
    /// The bytes from the controller; the register comes first.
    pub sent: &'a [u8],
}

impl Transfer<'_> {
    /// When the reply's byte number `index`, from 0, goes over the bus, to the next microsecond.
    pub(crate) fn time_of(&self, index: usize) -> Instant {
        self.now + bits(bit_times(self.sent.len()) + bit_times(index), self.hertz)
    }
}

/// A start condition, the first one or a repeated one, and the address that follows.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// When the condition came.
    pub now: Instant,
    /// Bus clock, Hz.
    pub hertz: u32,
    /// The 7-bit address.
    pub address: u8,
    /// Whether bytes are read; otherwise they are written.
    pub is_read: bool,
}

/// A chip on an I²C bus in an environment `E`.
pub trait I2cChip<E> {
    /// When the chip next does something of itself, such as a conversion.
    fn next_event(&self) -> Option<Instant>;

    /// Does what is due at [`Self::next_event`].
    fn event(&mut self, environment: &mut E);

    /// Takes a start condition with an address; returns whether the chip acknowledged. All events up to then
    /// have happened.
    fn start(&mut self, environment: &mut E, start: &Start) -> bool;

    /// Takes a byte that the controller writes; returns whether the chip acknowledged. It belongs to `since`:
    /// when the transfer began, later by all pauses in it.
    fn write(&mut self, environment: &mut E, byte: u8, since: Instant) -> bool;

    /// Gives the byte that the controller begins to read at `at`.
    fn read(&mut self, environment: &mut E, at: Instant) -> u8;

    /// Takes the stop condition of a transfer that belongs to `since`.
    fn stop(&mut self, environment: &mut E, since: Instant);

    /// Takes a transfer and answers it into `reply`; returns whether it acknowledged all. All events up to the
    /// beginning of the transfer have happened.
    fn transfer(&mut self, environment: &mut E, transfer: &Transfer, reply: &mut [u8]) -> bool {
        let Transfer { now, hertz, address, sent } = *transfer;
        let mut start = Start { now, hertz, address, is_read: false };
        let mut is_acknowledged = true;
        if !sent.is_empty() || reply.is_empty() {
            is_acknowledged = self.start(environment, &start)
                && sent.iter().all(|byte| self.write(environment, *byte, now));
        }
        if is_acknowledged && !reply.is_empty() {
            start.is_read = true;
            is_acknowledged = self.start(environment, &start);
        }
        if is_acknowledged {
            for (index, byte) in reply.iter_mut().enumerate() {
                *byte = self.read(environment, transfer.time_of(index));
            }
        }
        self.stop(environment, now);
        is_acknowledged
    }

    /// Loses its supply for a moment and starts again at `now` with its reset values.
    fn power_cycle(&mut self, now: Instant);

    /// What was done to the chip that its data sheet forbids.
    fn violations(&self) -> &Violations;
}

impl<C: I2cChip<E>, E> Single<C, E> {
    /// Lets the chip do everything that is due until `now`, that moment included.
    pub(crate) fn pass(&mut self, now: Instant) {
        while self.chip.next_event().is_some_and(|at| at <= now) {
            self.chip.event(&mut self.environment);
        }
    }

    /// Does what is due before a transfer and has the chip take it; returns whether it acknowledged.
    fn transfer(&mut self, transfer: &Transfer, reply: &mut [u8]) -> bool {
        self.pass(transfer.now);
        self.chip.transfer(&mut self.environment, transfer, reply)
    }
}

/// The bus of one chip.
#[derive(Debug)]
pub struct I2cPort<'a, C, E> {
    /// The chip on the bus, with its environment.
    rig: &'a RefCell<Single<C, E>>,
    /// Bus clock, Hz.
    hertz: u32,
}

impl<'a, C, E> I2cPort<'a, C, E> {
    /// The bus with a clock of `hertz` (> 0).
    #[must_use]
    pub const fn new(rig: &'a RefCell<Single<C, E>>, hertz: u32) -> Self {
        Self { rig, hertz }
    }
}

impl<C, E> ErrorType for I2cPort<'_, C, E> {
    type Error = ErrorKind;
}

impl<C: I2cChip<E>, E> I2c for I2cPort<'_, C, E> {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), ErrorKind> {
        let (sent, wanted) = flatten(operations)?;
        let mut reply = [0; LONGEST];
        let reply = &mut reply[..wanted];
        let transfer = Transfer { now: Instant::now(), hertz: self.hertz, address, sent: &sent };
        let is_acknowledged = self.rig.borrow_mut().transfer(&transfer, reply);
        let read = if wanted > 0 { bit_times(wanted) } else { 0 };
        let times = if is_acknowledged { bit_times(sent.len()) + read } else { bit_times(0) };
        Timer::after(bits(times + 1, self.hertz)).await;
        if !is_acknowledged {
            return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        }
        distribute(operations, reply);
        Ok(())
    }
}

/// Bit times of a start, an address and `bytes` bytes, each with its acknowledge.
const fn bit_times(bytes: usize) -> usize {
    1 + 9 * (1 + bytes)
}

/// Time of `count` bits, rounded up to microseconds.
fn bits(count: usize, hertz: u32) -> Duration {
    Duration::from_micros((count as u64 * 1_000_000).div_ceil(u64::from(hertz)))
}

/// All bytes that are written, and how many are to be read after them: no chip here is read first.
fn flatten(operations: &[Operation<'_>]) -> Result<(Vec<u8, LONGEST>, usize), ErrorKind> {
    let (mut sent, mut wanted) = (Vec::new(), 0);
    for operation in operations {
        match operation {
            Operation::Write(bytes) if wanted == 0 => {
                sent.extend_from_slice(bytes).map_err(|_| ErrorKind::Overrun)?;
            }
            Operation::Write(_) => return Err(ErrorKind::Other),
            Operation::Read(bytes) => wanted += bytes.len(),
        }
    }
    if wanted > LONGEST { Err(ErrorKind::Overrun) } else { Ok((sent, wanted)) }
}

/// Hands the reply out to the operations that read.
fn distribute(operations: &mut [Operation<'_>], reply: &[u8]) {
    let mut rest = reply;
    for operation in operations {
        if let Operation::Read(bytes) = operation {
            let (own, later) = rest.split_at(bytes.len());
            bytes.copy_from_slice(own);
            rest = later;
        }
    }
}
