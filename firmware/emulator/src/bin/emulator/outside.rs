//! The surroundings of the instrument in the emulator: metered ports of the simulated chips, the
//! log, and a link that discards every line.
//!
//! The emulator counts the instructions of the instrument, with those of the time driver, which it
//! tells beside them. Whatever the simulation, its buses and the log execute is booked on a separate
//! account (see [`Meter`]), so the counts can be compared with those of the board.

use core::convert::Infallible;
use core::future::poll_fn;
use core::pin::pin;

use drivers::data_ready::{DataReady, Edge};
use drivers::fault::Fault;
use embassy_time::Instant;
use embedded_hal_async::digital::Wait;
use embedded_hal_async::i2c::{self, I2c};
use embedded_hal_async::spi::{ErrorType as SpiErrorType, Operation, SpiDevice};
use embedded_io_async::{ErrorType, Read, Write};
use firmware::event::Event;
use firmware::log::DefmtLog;
use firmware::ports::Observer;
use hal_mock::chip::Select;
use orientation::alignment::{Progress, rotating, stepwise, stops};
use orientation::attitude::Report;
use simulated::fault::PortWrapper;
use simulated::trace::Trace as _;

use crate::clock;
use crate::log::row;
use crate::meter::Meter;

/// A simulated port whose instructions are booked on the simulation's account: on the board, bus
/// drivers and their interrupts take its place, so the cost of the simulated port says nothing
/// about the board.
pub struct Metered<T> {
    /// The wrapped port.
    port: T,
    /// The meter that keeps the two accounts.
    meter: &'static Meter,
}

/// Puts a meter around every simulated port.
pub struct Metering(pub &'static Meter);

impl PortWrapper for Metering {
    type Spi<S: SpiDevice> = Metered<S>;
    type Line<W: Wait> = W;
    type Ready<D: DataReady> = Metered<D>;
    type I2c<B: I2c<Error = i2c::ErrorKind>> = Metered<B>;

    fn spi<S: SpiDevice>(&self, _: Select, port: S) -> Metered<S> {
        Metered { port, meter: self.0 }
    }

    fn line<W: Wait>(&self, _: Select, pin: W) -> W {
        pin
    }

    fn ready<D: DataReady>(&self, port: D) -> Metered<D> {
        Metered { port, meter: self.0 }
    }

    fn i2c<B: I2c<Error = i2c::ErrorKind>>(&self, port: B) -> Metered<B> {
        Metered { port, meter: self.0 }
    }
}

/// Drives a simulation's future; its polls go to the simulation's account.
async fn outside<F: Future>(meter: &Meter, future: F) -> F::Output {
    let mut future = pin!(future);
    poll_fn(|context| meter.outside(|| future.as_mut().poll(context))).await
}

impl<T: SpiErrorType> SpiErrorType for Metered<T> {
    type Error = T::Error;
}

impl<T: SpiDevice> SpiDevice for Metered<T> {
    async fn transaction(
        &mut self,
        operations: &mut [Operation<'_, u8>],
    ) -> Result<(), Self::Error> {
        outside(self.meter, self.port.transaction(operations)).await
    }
}

impl<T: i2c::ErrorType> i2c::ErrorType for Metered<T> {
    type Error = T::Error;
}

impl<T: I2c> I2c for Metered<T> {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [i2c::Operation<'_>],
    ) -> Result<(), Self::Error> {
        outside(self.meter, self.port.transaction(address, operations)).await
    }
}

impl<T: DataReady> DataReady for Metered<T> {
    async fn edge(&mut self) -> Result<Edge, Fault> {
        outside(self.meter, self.port.edge()).await
    }
}

/// The observer of the emulated run: its printing by semihosting is booked on the emulator's
/// account, and the progress of the session is marked in the meter.
pub struct Log(pub &'static Meter);

impl Observer for Log {
    // Formatting and semihosting are booked on the simulation's account.
    fn event(&self, at: Instant, event: &Event) {
        self.0.outside(|| DefmtLog.event(at, event));
        if let Event::Alignment(progress) = event
            && is_step(progress)
        {
            self.0.mark(clock::now());
        }
    }

    fn kept(&self, report: &Report) {
        self.0.outside(|| report.trace(&mut row));
    }
}

/// Whether a dwell, a turn or a stop has ended, or a stop has begun, or the tracking of a roll has
/// changed.
fn is_step(progress: &Progress) -> bool {
    matches!(
        progress,
        Progress::Stepwise(stepwise::Progress::Dwelled(..))
            | Progress::Rotating(rotating::Progress::Turned(..))
            | Progress::Roll(_)
            | Progress::Stops(
                stops::Progress::Standing
                    | stops::Progress::Stopped(..)
                    | stops::Progress::MayDrive(..)
                    | stops::Progress::Driving
            )
    )
}

/// A link that accepts and discards every byte, and brings none: the emulated board has no serial port.
pub struct NoLink;

impl ErrorType for NoLink {
    type Error = Infallible;
}

impl Read for NoLink {
    async fn read(&mut self, _: &mut [u8]) -> Result<usize, Self::Error> {
        core::future::pending().await
    }
}

impl Write for NoLink {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
