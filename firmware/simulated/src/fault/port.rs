//! What stands around the simulated ports: what every port may be wrapped in, and a recorder that hangs.

use drivers::data_ready::DataReady;
use embassy_time::{Duration, Instant, Timer};
use embedded_hal_async::digital::Wait;
use embedded_hal_async::i2c::{ErrorKind, I2c};
use embedded_hal_async::spi::SpiDevice;
use hal_mock::chip::Select;
use orientation::alignment::Method;

use firmware::ports::Recorder;

/// For how long a recorder that hangs takes no sample.
const HANG: Duration = Duration::from_millis(500);

/// What is put around the simulated ports: faults, or a meter.
pub trait PortWrapper {
    /// A serial bus with the wrapper around it.
    type Spi<S: SpiDevice>: SpiDevice;
    /// A pin of a data-ready line with the wrapper around it.
    type Line<W: Wait>: Wait;
    /// A data-ready line, whose edges have their times, with the wrapper around it.
    type Ready<D: DataReady>: DataReady;
    /// An I²C bus with the wrapper around it.
    type I2c<B: I2c<Error = ErrorKind>>: I2c<Error = ErrorKind>;

    /// Wraps the serial bus of a chip.
    fn spi<S: SpiDevice>(&self, select: Select, bus: S) -> Self::Spi<S>;

    /// Wraps the pin of a converter's data-ready line.
    fn line<W: Wait>(&self, select: Select, line: W) -> Self::Line<W>;

    /// Wraps the data-ready line of a converter.
    fn ready<D: DataReady>(&self, line: D) -> Self::Ready<D>;

    /// Wraps the I²C bus of the coarse IMU on the base.
    fn i2c<B: I2c<Error = ErrorKind>>(&self, bus: B) -> Self::I2c<B>;
}

/// A recorder that may hang once.
#[derive(Debug)]
pub struct FaultyRecorder<R> {
    recorder: R,
    hang: Option<Instant>,
}

impl<R> FaultyRecorder<R> {
    /// The recorder with the time when it hangs, or one that never does.
    pub const fn new(recorder: R, hang: Option<Instant>) -> Self {
        Self { recorder, hang }
    }
}

impl<S, R: Recorder<S>> Recorder<S> for FaultyRecorder<R> {
    async fn record(&mut self, sample: &S) {
        if self.hang.take_if(|at| Instant::now() >= *at).is_some() {
            Timer::after(HANG).await;
        }
        self.recorder.record(sample).await;
    }

    async fn conclude(&mut self, method: &dyn Method<S>) {
        self.recorder.conclude(method).await;
    }
}
