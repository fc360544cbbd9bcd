//! What stands around the instrument here: metered simulated chips, its log, a link that nobody
//! reads.

use core::convert::Infallible;

use embassy_time::Instant;
use embedded_io_async::{ErrorType, Write};
use firmware::event::Event;
use firmware::log::DefmtLog;
use firmware::ports::Observer;
use hal_mock::chip::{ReadyLine, Rig, Select, Transaction};
use orientation::session::Session;

use crate::clock;
use crate::meter::Meter;

/// Simulated chips whose work is not the instrument's. What carries the bytes to them is counted as
/// the instrument's: it stands for the board's bus driver.
pub struct Metered<R> {
    rig: R,
    meter: &'static Meter,
}

impl<R> Metered<R> {
    /// Meters a rig.
    pub fn new(rig: R, meter: &'static Meter) -> Self {
        Self { rig, meter }
    }
}

impl<R: Rig> Rig for Metered<R> {
    fn transact(&mut self, select: Select, transaction: &Transaction, reply: &mut [u8]) {
        self.meter.outside(|| self.rig.transact(select, transaction, reply));
    }

    fn ready_line(&mut self, select: Select, now: Instant) -> ReadyLine {
        self.meter.outside(|| self.rig.ready_line(select, now))
    }

    fn power_cycle(&mut self, select: Select, now: Instant) {
        self.meter.outside(|| self.rig.power_cycle(select, now));
    }
}

/// The log; printing by semihosting is the emulator's work.
pub struct Log(pub &'static Meter);

impl Observer for Log {
    fn event(&self, at: Instant, event: &Event) {
        self.0.outside(|| DefmtLog.event(at, event));
    }

    fn progress(&self, _: &Session) {
        self.0.mark(clock::now());
    }
}

/// A link that takes everything.
pub struct NoLink;

impl ErrorType for NoLink {
    type Error = Infallible;
}

impl Write for NoLink {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
