//! The bus side of the simulated chips: `embedded-hal-async` in front, transactions behind.
//!
//! A transaction takes the time of its bits at the bus clock; the chip sees it when select falls.

use core::cell::RefCell;
use core::convert::Infallible;

use embassy_time::{Duration, Instant, Timer};
use embedded_hal::digital::ErrorType as PinErrorType;
use embedded_hal_async::digital::Wait;
use embedded_hal_async::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use heapless::Vec;

use crate::chip::{Rig, Select, Transaction, bus_time};

/// Bytes of the longest transaction.
const LONGEST: usize = 64;

/// One chip of a rig behind its select line. Of any rig, so that there is one copy of each driver.
pub struct SpiPort<'a> {
    /// The chips on the bus.
    rig: &'a RefCell<dyn Rig + 'a>,
    /// Select line of the chip that answers.
    select: Select,
    /// Bus clock, Hz.
    hertz: u32,
}

impl<'a> SpiPort<'a> {
    /// The chip at `select`, with a bus clock of `hertz` (> 0).
    #[must_use]
    pub const fn new(rig: &'a RefCell<dyn Rig + 'a>, select: Select, hertz: u32) -> Self {
        Self { rig, select, hertz }
    }
}

impl ErrorType for SpiPort<'_> {
    type Error = ErrorKind;
}

impl SpiDevice for SpiPort<'_> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let (sent, pause) = flatten(operations)?;
        let mut reply = [0; LONGEST];
        let reply = &mut reply[..sent.len()];
        let transaction = Transaction { now: Instant::now(), hertz: self.hertz, sent: &sent };
        self.rig.borrow_mut().transact(self.select, &transaction, reply);
        Timer::after(bus_time(sent.len(), self.hertz) + pause).await;
        distribute(operations, reply);
        Ok(())
    }
}

/// Bytes that the controller sends in an operation.
pub(crate) fn sent<'o>(operation: &'o Operation<'_, u8>) -> &'o [u8] {
    match operation {
        Operation::Write(bytes) | Operation::Transfer(_, bytes) => bytes,
        Operation::TransferInPlace(bytes) => bytes,
        Operation::Read(_) | Operation::DelayNs(_) => &[],
    }
}

/// Bytes that the controller receives in an operation.
pub(crate) fn received<'o>(operation: &'o mut Operation<'_, u8>) -> &'o mut [u8] {
    match operation {
        Operation::Read(bytes)
        | Operation::Transfer(bytes, _)
        | Operation::TransferInPlace(bytes) => bytes,
        Operation::Write(_) | Operation::DelayNs(_) => &mut [],
    }
}

/// Number of bytes on the wire in an operation.
pub(crate) fn length(operation: &Operation<'_, u8>) -> usize {
    match operation {
        Operation::Read(bytes) => bytes.len(),
        Operation::Transfer(read, written) => read.len().max(written.len()),
        other => sent(other).len(),
    }
}

/// All bytes of a transaction in a row, zeros where only the reply counts, and the pauses in it.
fn flatten(operations: &[Operation<'_, u8>]) -> Result<(Vec<u8, LONGEST>, Duration), ErrorKind> {
    let (mut bytes, mut pause) = (Vec::new(), 0);
    for operation in operations {
        let end = bytes.len() + length(operation);
        bytes.extend_from_slice(sent(operation)).map_err(|_| ErrorKind::Overrun)?;
        bytes.resize(end, 0).map_err(|_| ErrorKind::Overrun)?;
        if let Operation::DelayNs(nanoseconds) = operation {
            pause += u64::from(*nanoseconds);
        }
    }
    Ok((bytes, Duration::from_micros(pause.div_ceil(1000))))
}

/// Hands the reply out to the operations that read.
fn distribute(operations: &mut [Operation<'_, u8>], reply: &[u8]) {
    let mut rest = reply;
    for operation in operations {
        let (own, later) = rest.split_at(length(operation));
        let bytes = received(operation);
        bytes.copy_from_slice(&own[..bytes.len()]);
        rest = later;
    }
}

/// The data-ready line of one chip of a rig.
pub struct ReadyPin<'a> {
    /// The chips of the board.
    rig: &'a RefCell<dyn Rig + 'a>,
    /// Whose line it is.
    select: Select,
}

impl<'a> ReadyPin<'a> {
    /// The data-ready line of the chip at `select`, which is active low.
    #[must_use]
    pub const fn new(rig: &'a RefCell<dyn Rig + 'a>, select: Select) -> Self {
        Self { rig, select }
    }

    /// Waits until the line next becomes active; for ever where it does not.
    async fn next_edge(&self) {
        let line = self.rig.borrow_mut().ready_line(self.select, Instant::now());
        match line.next {
            Some(at) => Timer::at(at).await,
            None => core::future::pending().await,
        }
        // What the chip does until then belongs to this wait.
        self.rig.borrow_mut().ready_line(self.select, Instant::now());
    }
}

impl PinErrorType for ReadyPin<'_> {
    type Error = Infallible;
}

/// The lines of all chips here are active low: falling is becoming ready.
impl Wait for ReadyPin<'_> {
    async fn wait_for_high(&mut self) -> Result<(), Infallible> {
        core::future::pending().await
    }

    async fn wait_for_low(&mut self) -> Result<(), Infallible> {
        let active = self.rig.borrow_mut().ready_line(self.select, Instant::now()).active;
        if !active {
            self.next_edge().await;
        }
        Ok(())
    }

    async fn wait_for_rising_edge(&mut self) -> Result<(), Infallible> {
        core::future::pending().await
    }

    async fn wait_for_falling_edge(&mut self) -> Result<(), Infallible> {
        self.next_edge().await;
        Ok(())
    }

    async fn wait_for_any_edge(&mut self) -> Result<(), Infallible> {
        self.wait_for_falling_edge().await
    }
}
