//! The ports of the instrument: traits for all that it needs from its board, implemented by chips,
//! links and logs.
//!
//! Every exchange must end within bounded time, except [`Gyro::ready`], which may wait for ever and
//! may be dropped at any time.

use drivers::data_ready::Edge;
use drivers::fault::Fault;
use embassy_time::Instant;
use orientation::alignment::{Azimuth, Method};
use orientation::attitude::Report;
use orientation::navigation::{self, aligner};
use orientation::signal::Sample;
use orientation::signal::sway::CoarseSensors;
use orientation::units::{Angle, AngularRate, Metres, MetresPerSecond, SpecificForce, Temperature};

use crate::check_ins::CheckIns;
use crate::event::Event;
use crate::storage::LogRecord;

/// A device that can be started, and started again after a failure.
pub trait Startable {
    /// Resets, identifies, tests and configures the device, regardless of its present state.
    ///
    /// # Errors
    /// The driver's fault: bus, checksum, identity, self-test, or a register that was not written.
    async fn start(&mut self) -> Result<(), Fault>;
}

/// The value of a converter: an angular rate, or a raw code whose unit another part knows.
pub trait Quantity: Copy + Default + PartialEq {
    /// Whether the value is at a limit of its range, the mark of a saturated sensor or converter.
    fn is_saturated(self) -> bool;
}

impl Quantity for AngularRate {
    fn is_saturated(self) -> bool {
        self.is_saturated()
    }
}

/// A raw code of a converter; at a limit of its range if the converter was saturated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Code(pub i32);

impl Quantity for Code {
    fn is_saturated(self) -> bool {
        self.0 == i32::MAX || self.0 == i32::MIN
    }
}

/// A value at a limit of the number range where its sensor or converter is saturated, so that the
/// loss is visible downstream.
#[must_use]
pub(crate) fn clipped(value: i32, is_clipped: bool) -> i32 {
    match (is_clipped, value < 0) {
        (false, _) => value,
        (true, false) => i32::MAX,
        (true, true) => i32::MIN,
    }
}

/// One conversion of the precise gyro, or of another sensor behind a converter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RateReading<V = AngularRate> {
    /// The rate, or the raw code; at a limit of its range if sensor or converter was saturated.
    pub rate: V,
    /// Whether this conversion has not been read before.
    pub is_new: bool,
}

/// The precise gyro, or another sensor behind a converter.
pub trait Gyro<V = AngularRate>: Startable {
    /// Waits until a conversion is ready that has not been read, and returns its end. The future may be dropped at
    /// any time without loss.
    async fn ready(&mut self) -> Result<Edge, Fault>;

    /// Reads the conversion that is ready.
    async fn read(&mut self) -> Result<RateReading<V>, Fault>;
}

/// A gyro that converts synchronously with others on the same clock: first all are armed, then the
/// conversions of all are begun one right after the other.
pub trait InStep<V = AngularRate>: Gyro<V> {
    /// Stops the conversions of a started gyro and prepares the synchronous begin.
    async fn arm(&mut self) -> Result<(), Fault>;

    /// Begins the conversions.
    async fn begin(&mut self) -> Result<(), Fault>;
}

/// How `N` converters in step are read together, each of which is a `C` and measures values `V`.
pub trait Together<C, V, const N: usize> {
    /// Waits until every converter has ended a conversion, and reads all. Where one ended more than `apart`, µs, before
    /// the others, it may have ended another one meanwhile. The future may be dropped while it waits.
    ///
    /// # Errors
    /// As [`Gyro::ready`].
    async fn next(&mut self, converters: [&mut C; N], apart: u64) -> Result<(), Fault>;

    /// End of the conversion of a converter that was read.
    fn end(&self, index: usize) -> Edge;

    /// What was read of a converter.
    ///
    /// # Errors
    /// As [`Gyro::read`].
    fn reading(&self, index: usize) -> Result<RateReading<V>, Fault>;

    /// The first converter whose conversion has not ended, where waiting was given up.
    fn awaited(&self) -> usize;

    /// How many conversions of every converter it reads and keeps although none is taken.
    fn room(&self) -> usize {
        0
    }
}

impl<T: Together<C, V, N>, C, V, const N: usize> Together<C, V, N> for &mut T {
    async fn next(&mut self, converters: [&mut C; N], apart: u64) -> Result<(), Fault> {
        (**self).next(converters, apart).await
    }

    fn end(&self, index: usize) -> Edge {
        (**self).end(index)
    }

    fn reading(&self, index: usize) -> Result<RateReading<V>, Fault> {
        (**self).reading(index)
    }

    fn awaited(&self) -> usize {
        (**self).awaited()
    }

    fn room(&self) -> usize {
        (**self).room()
    }
}

/// One reading of the accelerometer, in the axes of the platform, or of the base to which it is
/// fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForceReading {
    /// Specific force, µm/s² in its integer unit. On the platform: x along the sensitive axis, y
    /// 90° clockwise of it, z down. On the base: x forward, y right, z down.
    pub force: [SpecificForce; 3],
    /// Temperature of the chip.
    pub temperature: Temperature,
    /// Whether the reading is new since the one before.
    pub is_new: bool,
    /// Whether an axis was at the limit of its range.
    pub is_clipped: bool,
}

/// The accelerometer on the platform or on the base.
pub trait Accelerometer: Startable {
    /// Reads the latest output.
    async fn read(&mut self) -> Result<ForceReading, Fault>;
}

/// The absolute encoder of the stage.
pub trait Encoder: Startable {
    /// Reads the present angle.
    async fn read(&mut self) -> Result<Angle, Fault>;
}

/// One reading of the coarse inertial sensors on the base, on the axes forward, right, down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BaseReading {
    /// Angular rates about the axes.
    pub rate: [AngularRate; 3],
    /// Specific forces along the axes.
    pub force: [SpecificForce; 3],
    /// Whether any value was at the limit of its range.
    pub is_clipped: bool,
}

/// Coarse gyros and accelerometers on the base, which measure its sway.
pub trait BaseSensors: Startable {
    /// Reads the latest output; [`None`] if it has been read before.
    async fn read(&mut self) -> Result<Option<BaseReading>, Fault>;

    /// The stated noise and biases of these sensors.
    fn sensors(&self) -> CoarseSensors;

    /// Decimation: they are read once in this many samples of the precise gyro, ≥ 1, at least 1.5 times as often
    /// as they have a new output.
    fn divider(&self) -> u32;

    /// Nominal time between two outputs.
    fn output_period(&self) -> core::time::Duration;
}

/// A base without sensors: the gyro's rates are used without compensation of sway.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoBase;

/// The status of the stage's motor.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own; all combine")]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Stage angle by the motor's step count, rad, not wrapped.
    pub angle: f64,
    /// Whether the motor stands still.
    pub is_standing: bool,
    /// Whether the motor has reached its target.
    pub has_reached: bool,
    /// Whether a stall has stopped the motor.
    pub is_stalled: bool,
    /// Whether the index switch at the lower end of the travel is closed.
    pub at_index: bool,
    /// Stage angle by the motor's step count, rad, at which the index mark of a platform without
    /// ends began to close its switch since the reading before; [`None`] if it did not.
    pub mark: Option<f64>,
}

/// A request to the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Come to rest, whatever is known of the motor, and although it may have no current.
    Rest,
    /// Move to an angle by the motor's step count, rad, not wrapped.
    GoTo(f64),
    /// Turn at a rate, rad/s, clockwise positive, until another request or an end switch; permitted
    /// during a movement. A rate of zero brings the motor to rest by its ramp.
    Seek(f64),
    /// Set the step count to the angle at which the motor stands, rad.
    SetAngle(f64),
    /// Stop, and clear a stall so that the motor can turn again.
    Release,
    /// Read the motor's status.
    Look,
}

/// The motor of the stage. Angles are clockwise positive as seen from above.
pub trait Actuator: Startable {
    /// Executes a request, and returns the motor's status if the request was for it. Returns at
    /// once; a movement goes on.
    async fn execute(&mut self, request: Command) -> Result<Option<Motion>, Fault>;
}

/// Non-volatile storage of items, each in a slot of its own: calibrations, and the heading of a
/// vehicle at rest.
pub trait Store {
    /// Reads the latest item of a slot into the first bytes of `item`, and returns its length; [`None`] if the slot is
    /// empty.
    ///
    /// # Errors
    /// [`Fault::Checksum`] for an item that is damaged; [`Fault::Bus`] for one that is longer than there is room, and
    /// where the store cannot be read.
    async fn read(&mut self, slot: u8, item: &mut [u8]) -> Result<Option<usize>, Fault>;

    /// The latest item of a slot, which has this length; [`None`] if the slot is empty.
    ///
    /// # Errors
    /// As [`Self::read`]; [`Fault::Bus`] for an item of another length.
    async fn load<const N: usize>(&mut self, slot: u8) -> Result<Option<[u8; N]>, Fault> {
        let mut item = [0; N];
        match self.read(slot, &mut item).await? {
            None => Ok(None),
            Some(length) if length == N => Ok(Some(item)),
            Some(_) => Err(Fault::Bus),
        }
    }

    /// Stores an item in a slot. If the supply is lost during the write, the slot holds either the
    /// old or the new item.
    async fn save<const N: usize>(&mut self, slot: u8, item: &[u8; N]) -> Result<(), Fault>;

    /// Empties a slot, at once: nothing that takes long, as an erasure, is done for it. If the supply is lost
    /// meanwhile, the slot is empty or holds its item.
    async fn forget(&mut self, slot: u8) -> Result<(), Fault>;

    /// The record of the log beside the store that follows the one of this number; [`None`] where there is none, or no log.
    async fn record_after(&mut self, _number: u32) -> Option<LogRecord> {
        None
    }
}

impl<T: Store> Store for &mut T {
    async fn read(&mut self, slot: u8, item: &mut [u8]) -> Result<Option<usize>, Fault> {
        (**self).read(slot, item).await
    }

    async fn save<const N: usize>(&mut self, slot: u8, item: &[u8; N]) -> Result<(), Fault> {
        (**self).save(slot, item).await
    }

    async fn forget(&mut self, slot: u8) -> Result<(), Fault> {
        (**self).forget(slot).await
    }

    async fn record_after(&mut self, number: u32) -> Option<LogRecord> {
        (**self).record_after(number).await
    }
}

/// A store that keeps nothing.
impl Store for () {
    async fn read(&mut self, _: u8, _: &mut [u8]) -> Result<Option<usize>, Fault> {
        Ok(None)
    }

    async fn save<const N: usize>(&mut self, _: u8, _: &[u8; N]) -> Result<(), Fault> {
        Ok(())
    }

    async fn forget(&mut self, _: u8) -> Result<(), Fault> {
        Ok(())
    }
}

/// Aiding from outside: quantities that the instrument cannot measure, from an operator, another
/// vehicle's instrument, an odometer or a satellite receiver; [`None`] where they are unknown.
pub trait Aiding {
    /// A new azimuth of body x with its 1σ, at the time of the latest sample that was taken, a few
    /// milliseconds ago; [`None`] if there is none since the last call. Asked once a second. Its errors must be
    /// independent of those of the azimuths before: each is fused as a new one, so that what errs in the same way again and
    /// again, as two antennas do that are mounted askew, is to be given once, or with a σ for its number.
    fn azimuth(&self) -> Option<Azimuth> {
        None
    }

    /// Velocity over ground north and east. Asked once a second.
    fn velocity(&self) -> Option<[MetresPerSecond; 2]> {
        None
    }

    /// Displacement of the vehicle, north and east, from a point that stays the same. Asked at
    /// every stop until it is known.
    fn displacement(&self) -> Option<[Metres; 2]> {
        None
    }
}

/// No aiding from outside.
impl Aiding for () {}

/// A recorder of raw samples, and of what an alignment has come to. A slow recorder delays the
/// session; samples queue meanwhile.
pub trait Recorder<S = Sample> {
    /// Records one sample.
    async fn record(&mut self, _sample: &S) {}

    /// Records an alignment that is over.
    async fn conclude(&mut self, _method: &dyn Method<S>) {}
}

/// A recorder that discards every sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoRecorder;

impl<S> Recorder<S> for NoRecorder {}

/// A recorder that may be absent.
impl<S, R: Recorder<S>> Recorder<S> for Option<R> {
    async fn record(&mut self, sample: &S) {
        if let Some(recorder) = self {
            recorder.record(sample).await;
        }
    }

    async fn conclude(&mut self, method: &dyn Method<S>) {
        if let Some(recorder) = self {
            recorder.conclude(method).await;
        }
    }
}

/// Two recorders of the same samples.
impl<S, A: Recorder<S>, B: Recorder<S>> Recorder<S> for (A, B) {
    async fn record(&mut self, sample: &S) {
        self.0.record(sample).await;
        self.1.record(sample).await;
    }

    async fn conclude(&mut self, method: &dyn Method<S>) {
        self.0.conclude(method).await;
        self.1.conclude(method).await;
    }
}

/// The observer of the instrument: a log, or a test.
pub trait Observer {
    /// An event at a time of the instrument's clock.
    fn event(&self, at: Instant, event: &Event);

    /// The keeper's report, once a second.
    fn kept(&self, _: &Report) {}

    /// An input of the aligner beside its samples, before it is taken.
    fn aligns(&self, _: &aligner::Input) {}

    /// An input of the navigator, before it is taken.
    fn navigates(&self, _: &navigation::Input) {}

    /// A new reading of the coarse sensors on the base at a time of the instrument's clock.
    fn sensed(&self, _: Instant, _: &BaseReading) {}

    /// Where the parts check in; [`None`] without a watchdog.
    fn check_ins(&self) -> Option<&CheckIns> {
        None
    }
}

/// An observer that ignores everything.
impl Observer for () {
    fn event(&self, _: Instant, _: &Event) {}
}

/// A pair of values for the two frames of a mount.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frames<T> {
    /// Value of the outer frame.
    pub outer: T,
    /// Value of the inner frame.
    pub inner: T,
}

impl<T> Frames<T> {
    /// Applies a function to the values of both frames.
    pub fn map<U>(self, change: impl Fn(T) -> U) -> Frames<U> {
        Frames { outer: change(self.outer), inner: change(self.inner) }
    }
}

/// The sensors of an instrument on a stage, owned by acquisition.
#[derive(Debug)]
pub struct Sensors<G, A, E, B = NoBase> {
    /// The precise gyro.
    pub gyro: G,
    /// The accelerometer on the platform or on the base.
    pub accelerometer: A,
    /// The encoder of the stage, or [`Frames`] of encoders on a two-frame mount.
    pub encoder: E,
    /// The compensation of the base's sway by coarse sensors there, or [`NoBase`].
    pub base: B,
}

/// The sensors fixed to a vehicle (strapdown), owned by acquisition.
#[derive(Debug)]
pub struct VehicleSensors<G, A> {
    /// Gyros about the axes forward, right, down.
    pub gyros: [G; 3],
    /// Accelerometers along the same axes.
    pub accelerometer: A,
}

/// The sensors fixed to a spinning body, owned by acquisition.
#[derive(Debug)]
pub struct SpinSensors<C, R> {
    /// Converters of the gyros about x (forward), y (up at zero roll) and z (right at zero roll),
    /// then of the accelerometers along y and z.
    pub converters: [C; 5],
    /// How they are read.
    pub reader: R,
}
