//! What the instrument needs from its board: the traits that chips, links and logs implement.
//!
//! Nothing in here waits for ever but [`Gyro::ready`], which may be dropped at any time.

use drivers::fault::Fault;
use embassy_time::Instant;
use orientation::align::rotating::coupling::BYTES;
use orientation::keep::restart::Remembered;
use orientation::keep::{Handover, Report};
use orientation::session::{Session, rotating, stops};
use orientation::signal::Sample;
use orientation::signal::sway::CoarseSensors;
use orientation::units::{Angle, AngularRate, SpecificForce, Temperature};

use crate::event::Event;

/// A device that can be started, and started again when it is lost.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait Startable {
    /// Resets, identifies, tests and configures the device, whatever state it is in.
    async fn start(&mut self) -> Result<(), Fault>;
}

/// What a converter shows: a rate, or a code where its unit belongs to somebody else.
pub trait Quantity: Copy + Default + PartialEq {
    /// Whether the value stands at a limit of its range, where a sensor or its converter clips.
    fn is_saturated(self) -> bool;
}

impl Quantity for AngularRate {
    fn is_saturated(self) -> bool {
        self.is_saturated()
    }
}

/// A converter's own code; at a limit where it clipped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Code(pub i32);

impl Quantity for Code {
    fn is_saturated(self) -> bool {
        self.0 == i32::MAX || self.0 == i32::MIN
    }
}

/// One conversion of the precise gyro, or of another sensor behind a converter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RateReading<V = AngularRate> {
    /// The rate; at a limit of its range where the converter clipped.
    pub rate: V,
    /// Whether nobody has read this conversion before.
    pub is_new: bool,
}

/// The precise gyro, or another sensor behind a converter.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait Gyro<V = AngularRate>: Startable {
    /// Waits until a conversion is ready. Safe to drop.
    async fn ready(&mut self) -> Result<(), Fault>;

    /// Reads that conversion.
    async fn read(&mut self) -> Result<RateReading<V>, Fault>;
}

/// A gyro that converts in step with others: all are armed, then all begun, one right after the other.
/// Their clocks are one.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait InStep<V = AngularRate>: Gyro<V> {
    /// Ends conversions and makes ready for others, of a gyro that was started.
    async fn arm(&mut self) -> Result<(), Fault>;

    /// Begins conversions.
    async fn begin(&mut self) -> Result<(), Fault>;
}

/// One reading of the accelerometer, in the axes of the platform, or of the base it is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForceReading {
    /// Specific force. On the platform x along the sensitive axis, y 90° clockwise of it, z down; on
    /// the base forward, right, down.
    pub force: [SpecificForce; 3],
    /// Temperature of the chip.
    pub temperature: Temperature,
    /// Whether it is new since the last reading.
    pub is_new: bool,
    /// Whether an axis stood at the limit of its range.
    pub is_clipped: bool,
}

/// The accelerometer on the platform, or on the base.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait Accelerometer: Startable {
    /// Reads the latest output.
    async fn read(&mut self) -> Result<ForceReading, Fault>;
}

/// The encoder of the stage.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait Encoder: Startable {
    /// Reads the angle now.
    async fn read(&mut self) -> Result<Angle, Fault>;
}

/// One reading of the coarse sensors on the base, on its axes forward, right, down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BaseReading {
    /// Rates about the axes.
    pub rate: [AngularRate; 3],
    /// Specific forces on the axes.
    pub force: [SpecificForce; 3],
    /// Whether anything stood at the limit of its range.
    pub is_clipped: bool,
}

/// Coarse gyros and accelerometers on the base.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait BaseSensors: Startable {
    /// Reads the latest output; none where it was read before.
    async fn read(&mut self) -> Result<Option<BaseReading>, Fault>;

    /// What is stated of them.
    fn sensors(&self) -> CoarseSensors;

    /// They are read with every so-manieth sample of the precise gyro, ≥ 1.
    fn divider(&self) -> u32;
}

/// A base without sensors: rates are taken as they are.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoBase;

/// What the stage's motor does.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own; all combine")]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Stage angle by the motor's own count, rad, not wrapped.
    pub angle: f64,
    /// Whether the motor stands.
    pub is_standing: bool,
    /// Whether it stands at its target.
    pub has_reached: bool,
    /// Whether it was stopped by a stall.
    pub is_stalled: bool,
    /// Whether the index, the switch at the lower end, is touched.
    pub at_index: bool,
}

/// The motor of the stage.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait Actuator: Startable {
    /// Sends the stage to an angle, rad, not wrapped, by the motor's count.
    async fn go_to(&mut self, angle: f64) -> Result<(), Fault>;

    /// Turns at a rate, rad/s, clockwise positive, until it is told otherwise or touches an end; also
    /// on the way. Zero has it come to rest by its ramp.
    async fn seek(&mut self, rate: f64) -> Result<(), Fault>;

    /// Declares the angle at which the motor stands, rad.
    async fn set_angle(&mut self, angle: f64) -> Result<(), Fault>;

    /// Stops where it is, and lets a motor that stalled turn again.
    async fn release(&mut self) -> Result<(), Fault>;

    /// What the motor does.
    async fn motion(&mut self) -> Result<Motion, Fault>;
}

/// Where calibrations are kept over a loss of supply.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait CalibrationStore {
    /// What was kept last in a slot, if anything was.
    async fn load(&mut self, slot: u8) -> Result<Option<[u8; BYTES]>, Fault>;

    /// Keeps something in a slot. Where the supply is lost meanwhile, a slot has what it had or what it
    /// was to have.
    async fn save(&mut self, slot: u8, bytes: &[u8; BYTES]) -> Result<(), Fault>;
}

/// Where the heading of a vehicle at rest is kept over a loss of supply.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait HeadingStore {
    /// What was kept last, if anything was.
    async fn load_heading(&mut self) -> Result<Option<[u8; Remembered::BYTES]>, Fault>;

    /// Keeps something. Where the supply is lost meanwhile, there is what was there or what was to be.
    async fn save_heading(&mut self, bytes: &[u8; Remembered::BYTES]) -> Result<(), Fault>;
}

impl<H: HeadingStore> HeadingStore for &mut H {
    async fn load_heading(&mut self) -> Result<Option<[u8; Remembered::BYTES]>, Fault> {
        (**self).load_heading().await
    }

    async fn save_heading(&mut self, bytes: &[u8; Remembered::BYTES]) -> Result<(), Fault> {
        (**self).save_heading(bytes).await
    }
}

/// Nothing is kept over a loss of supply.
impl HeadingStore for () {
    async fn load_heading(&mut self) -> Result<Option<[u8; Remembered::BYTES]>, Fault> {
        Ok(None)
    }

    async fn save_heading(&mut self, _: &[u8; Remembered::BYTES]) -> Result<(), Fault> {
        Ok(())
    }
}

/// Who tells the keeper what it cannot measure: an operator, another vehicle's instrument, an odometer.
/// Asked once a second.
pub trait Aiding {
    /// An azimuth of body x at this moment, with its 1σ, where there is one that was not told before.
    fn azimuth(&mut self) -> Option<Handover>;

    /// Speed over the ground north and east, m/s, where it is known.
    fn velocity(&mut self) -> Option<[f64; 2]>;
}

/// Nobody tells anything.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoOutside;

impl Aiding for NoOutside {
    fn azimuth(&mut self) -> Option<Handover> {
        None
    }

    fn velocity(&mut self) -> Option<[f64; 2]> {
        None
    }
}

/// Where raw samples are kept. It may take its time: samples then queue.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait Recorder<S = Sample> {
    /// Keeps one sample.
    async fn record(&mut self, sample: &S);
}

/// A recorder that keeps nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoRecorder;

impl<S> Recorder<S> for NoRecorder {
    async fn record(&mut self, _: &S) {}
}

/// What knows where the vehicle is: a satellite receiver, an odometer, a map.
pub trait PositionAiding {
    /// How far north and east the vehicle stands of where it stood first, m; none where that is not
    /// known, or not yet. Asked at every stop until it is.
    fn displacement(&mut self) -> Option<[f64; 2]>;
}

/// Nobody knows where the vehicle is.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoWhereabouts;

impl PositionAiding for NoWhereabouts {
    fn displacement(&mut self) -> Option<[f64; 2]> {
        None
    }
}

/// Who is told what happens.
pub trait Observer {
    /// Something happened.
    fn event(&self, at: Instant, event: &Event);

    /// The session has taken one more dwell.
    fn progress(&self, _: &Session) {}

    /// The session on a turning platform has taken one more turn.
    fn turned(&self, _: &rotating::Session) {}

    /// The session in a vehicle has begun or ended a stop.
    fn stopped(&self, _: &stops::Session) {}

    /// What the keeper reports, once a second.
    fn kept(&self, _: &Report) {}
}

/// Nobody is told.
impl Observer for () {
    fn event(&self, _: Instant, _: &Event) {}
}

impl<O: Observer> Observer for &O {
    fn event(&self, at: Instant, event: &Event) {
        (**self).event(at, event);
    }

    fn progress(&self, session: &Session) {
        (**self).progress(session);
    }

    fn turned(&self, session: &rotating::Session) {
        (**self).turned(session);
    }

    fn stopped(&self, session: &stops::Session) {
        (**self).stopped(session);
    }

    fn kept(&self, report: &Report) {
        (**self).kept(report);
    }
}

/// What a two-frame mount has twice.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frames<T> {
    /// Of the outer frame.
    pub outer: T,
    /// Of the inner frame.
    pub inner: T,
}

impl<T> Frames<T> {
    /// The same with something done to both.
    pub fn map<U>(self, change: impl Fn(T) -> U) -> Frames<U> {
        Frames { outer: change(self.outer), inner: change(self.inner) }
    }
}

/// The sensors of the stage path, which acquisition owns.
#[derive(Debug)]
pub struct Sensors<G, A, E, B = NoBase> {
    /// The precise gyro.
    pub gyro: G,
    /// The accelerometer on the platform.
    pub accelerometer: A,
    /// The encoder of the stage; [`Frames`] of a mount with two.
    pub encoder: E,
    /// Coarse sensors on the base, where there are any.
    pub base: B,
}

impl<G, A, E> Sensors<G, A, E> {
    /// The same with sensors on the base.
    pub fn with_base<B>(self, base: B) -> Sensors<G, A, E, B> {
        let Self { gyro, accelerometer, encoder, base: NoBase } = self;
        Sensors { gyro, accelerometer, encoder, base }
    }
}

/// The sensors that are fixed to a vehicle, which acquisition owns.
#[derive(Debug)]
pub struct VehicleSensors<G, A> {
    /// Gyros about the axes forward, right, down.
    pub gyros: [G; 3],
    /// Accelerometers on the same axes.
    pub accelerometer: A,
}

/// The sensors that are fixed to a spinning body, which acquisition owns.
#[derive(Debug)]
pub struct SpinSensors<C>(
    /// Converters of the gyros about x (forward), y (up at roll zero) and z (right there), then of the
    /// accelerometers along y and z.
    pub [C; 5],
);

/// What else a board on a spinning body offers.
#[derive(Debug)]
pub struct SpinPorts<L, R> {
    /// Where status lines go.
    pub link: L,
    /// Where raw samples go.
    pub recorder: R,
}

/// What else a board in a vehicle offers: there is nothing to turn, who drives is told by link and log.
#[derive(Debug)]
pub struct VehiclePorts<W, L, R> {
    /// What knows where the vehicle is.
    pub position_aiding: W,
    /// Where status lines go.
    pub link: L,
    /// Where raw samples go.
    pub recorder: R,
}

/// What else a board offers.
#[derive(Debug)]
pub struct Ports<M, L, R> {
    /// The motor of the stage; [`Frames`] of a mount with two.
    pub actuator: M,
    /// Where status lines go.
    pub link: L,
    /// Where raw samples go.
    pub recorder: R,
}
