//! Takes the base's sway off the precise gyro's rates, on instruments that have a coarse IMU there.
//!
//! The base IMU is read with every so-manieth sample; between, its latest rate is held. Before the
//! sway was watched for long enough nothing is decided, and the stage is not told to begin. Then the
//! whole session is measured as it was decided.
//!
//! Decimator reading also goes to whoever keeps attitude and azimuth.
//!
//! A base IMU that is lost is started again like any other device. Where it is given up, a session
//! that does not need it goes on without it.

use core::future::ready;

use embassy_time::Instant;
use micromath::F32Ext;
use orientation::device::Device;
use orientation::error::Refusal;
use orientation::signal::sway::{Decision, Sway};
use orientation::units::{Angle, AngularRate, DEGREES_PER_RADIAN as DEGREES, SpecificForce, TURN};

use crate::acquire::{RepeatCounter, STUCK};
use crate::event::Event;
use crate::guarded::Guarded;
use crate::keep::RETRY;
use crate::pointing::Decimator;
use crate::ports::{BaseReading, BaseSensors, NoBase, Observer};
use crate::retry_budget::Symptom;
use crate::shared::Shared;

/// Time without a new reading after which the base IMU is silent, µs.
const SILENCE: u64 = 100_000;
/// Radians of one step of an [`Angle`].
const STEP: f32 = (TURN / 4_294_967_296.0) as f32;
/// Change of the stage's angle, in steps, for which its sine is kept: 2⁻¹⁴ of a turn, which turns
/// 0.04 % of a sway across the axis.
const KEPT: u32 = 1 << 18;

/// Whatever stands on the base: sensors, or nothing.
pub trait Base {
    /// What makes rates steady with it.
    type CompensatesSway<'a>: CompensatesSway
    where
        Self: 'a;

    /// Takes the sensors; nothing is started yet.
    fn steady(&mut self) -> Self::CompensatesSway<'_>;
}

/// What makes rates steady.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait CompensatesSway {
    /// Starts what it needs.
    async fn start<O: Observer>(&mut self, shared: &Shared<'_, O>) -> Result<(), Refusal>;

    /// Whether it is known what is to be done.
    fn is_decided(&self) -> bool;

    /// Reads what it needs; called with every sample.
    async fn follow<O: Observer>(&mut self, shared: &Shared<'_, O>) -> Result<(), Refusal>;

    /// What the latest [`Self::follow`] has read, and when; each reading once.
    fn reading(&mut self) -> Option<(Instant, BaseReading)>;

    /// Time between two readings, µs, of a precise gyro of that sample period, µs.
    fn period(&self, sample: u32) -> u32;

    /// Has all retry budget with it again.
    fn renew(&mut self);

    /// The rate along a level axis at this heading, less the sway.
    fn steadied(&mut self, rate: AngularRate, heading: Angle) -> AngularRate;
}

impl Base for NoBase {
    type CompensatesSway<'a> = NoBase;

    fn steady(&mut self) -> NoBase {
        NoBase
    }
}

/// Rates are taken as they are.
impl CompensatesSway for NoBase {
    fn start<O: Observer>(
        &mut self,
        _: &Shared<'_, O>,
    ) -> impl Future<Output = Result<(), Refusal>> {
        ready(Ok(()))
    }

    fn is_decided(&self) -> bool {
        true
    }

    fn follow<O: Observer>(
        &mut self,
        _: &Shared<'_, O>,
    ) -> impl Future<Output = Result<(), Refusal>> {
        ready(Ok(()))
    }

    fn reading(&mut self) -> Option<(Instant, BaseReading)> {
        None
    }

    fn period(&self, sample: u32) -> u32 {
        sample
    }

    fn renew(&mut self) {}

    fn steadied(&mut self, rate: AngularRate, _: Angle) -> AngularRate {
        rate
    }
}

impl<B: BaseSensors> Base for B {
    type CompensatesSway<'a>
        = SwayCompensation<'a, B>
    where
        B: 'a;

    fn steady(&mut self) -> SwayCompensation<'_, B> {
        SwayCompensation::new(self)
    }
}

/// Sensors on the base at work.
pub struct SwayCompensation<'a, B> {
    base: Guarded<'a, B>,
    due: Decimator,
    sway: Sway,
    /// When the latest new reading came.
    latest: Instant,
    /// Since when none has come: that time, or the latest start.
    silent: Instant,
    readings: RepeatCounter<[AngularRate; 3]>,
    /// The latest reading, for whoever keeps.
    fresh: Option<(Instant, BaseReading)>,
    /// The same where it was not held yet.
    held: Option<BaseReading>,
    /// Stage angle of [`Self::axis`].
    stage: Angle,
    /// Cosine and sine of that angle.
    axis: [f32; 2],
    /// Whether it was given up, and when.
    is_lost: bool,
    lost: Instant,
}

impl<'a, B: BaseSensors> SwayCompensation<'a, B> {
    fn new(device: &'a mut B) -> Self {
        let (sensors, divider) = (device.sensors(), device.divider());
        Self {
            base: Guarded::new(device, Device::Base),
            due: Decimator::new(divider),
            sway: Sway::new(sensors),
            latest: Instant::MIN,
            silent: Instant::MIN,
            readings: RepeatCounter::new(),
            fresh: None,
            held: None,
            stage: Angle(0),
            axis: [1.0, 0.0],
            is_lost: false,
            lost: Instant::MIN,
        }
    }

    fn is_swaying(&self) -> bool {
        matches!(self.sway.decision(), Decision::Swaying(..))
    }

    /// Takes a reading where there is a new one; what is to be mended where there ought to be.
    async fn read(&mut self) -> Result<(), Symptom> {
        let begun = Instant::now();
        let outcome = self.base.device.read().await;
        match self.base.checked(begun, outcome)? {
            Some(reading) => self.push(begun, reading),
            None if (begun - self.silent).as_micros() > SILENCE => Err(Symptom::Silent),
            None => {
                self.hold(begun);
                Ok(())
            }
        }
    }

    /// Goes on with the latest rates where one output falls between two readings, as it does now and then
    /// where both have nearly one rate; once, and without a force.
    fn hold(&mut self, at: Instant) {
        if let Some(reading) = self.held.take() {
            self.fresh = Some((at, BaseReading { is_clipped: true, ..reading }));
        }
    }

    /// A clipped reading is left out: the gap after it makes the estimate begin anew.
    fn push(&mut self, at: Instant, reading: BaseReading) -> Result<(), Symptom> {
        let BaseReading { rate, force, is_clipped } = reading;
        self.silent = at;
        if self.readings.push(rate) >= STUCK {
            self.readings = RepeatCounter::new();
            return Err(Symptom::Stuck);
        }
        self.fresh = Some((at, reading));
        self.held = Some(reading);
        if !is_clipped {
            self.turn(at, rate, force);
        }
        Ok(())
    }

    fn turn(&mut self, at: Instant, rate: [AngularRate; 3], force: [SpecificForce; 3]) {
        let seconds = (at - self.latest).as_micros() as f32 * 1e-6;
        self.latest = at;
        self.sway.push(seconds, rate, force);
    }

    /// Starts the sensors again where they must be; goes on without them where it can.
    async fn mend<O: Observer>(
        &mut self,
        symptom: Symptom,
        shared: &Shared<'_, O>,
    ) -> Result<(), Refusal> {
        let restarts = self.base.restarts();
        let outcome = self.base.mend(symptom, shared).await;
        if self.base.restarts() != restarts {
            self.silent = Instant::now();
        }
        match outcome {
            Err(reason) if self.is_swaying() && !shared.keep.is_kept.get() => Err(reason),
            Err(_) => {
                self.is_lost = true;
                self.lost = Instant::now();
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }

    /// Whether it is done without; while an azimuth is kept, it is tried again now and then.
    fn is_absent<O: Observer>(&mut self, shared: &Shared<'_, O>) -> bool {
        if self.is_lost && shared.keep.is_kept.get() && self.lost.elapsed() >= RETRY {
            self.renew();
        }
        self.is_lost
    }

    /// Tells what was decided, once.
    fn tell<O: Observer>(&self, shared: &Shared<'_, O>) {
        match self.sway.decision() {
            Decision::Watching => {}
            Decision::Still(size) => {
                shared.tell(Event::BaseStill(f64::from(size.angle) * DEGREES));
            }
            Decision::Swaying(size, noise) => {
                shared.sway.set(noise);
                let hertz = f64::from(size.rate / size.angle) / TURN;
                let [angle, left] =
                    [f64::from(size.angle), noise.angle_sigma()].map(|angle| angle * DEGREES);
                shared.tell(Event::BaseSways(angle, hertz, left));
            }
        }
    }

    /// What the sway adds at a stage angle, nrad/s.
    fn swaying(&mut self, stage: Angle) -> i32 {
        if (stage - self.stage).0.cast_signed().unsigned_abs() > KEPT {
            self.stage = stage;
            let theta = stage.0.cast_signed() as f32 * STEP;
            self.axis = [F32Ext::cos(theta), F32Ext::sin(theta)];
        }
        (self.sway.along(self.axis) * 1e9) as i32
    }
}

impl<B: BaseSensors> CompensatesSway for SwayCompensation<'_, B> {
    async fn start<O: Observer>(&mut self, shared: &Shared<'_, O>) -> Result<(), Refusal> {
        self.is_lost = self.base.start(shared).await.is_err();
        self.silent = Instant::now();
        Ok(())
    }

    fn is_decided(&self) -> bool {
        self.is_lost || self.sway.decision() != Decision::Watching
    }

    async fn follow<O: Observer>(&mut self, shared: &Shared<'_, O>) -> Result<(), Refusal> {
        if self.is_absent(shared) || !self.due.is_due() {
            return Ok(());
        }
        let was_decided = self.is_decided();
        if let Err(symptom) = self.read().await {
            self.mend(symptom, shared).await?;
        }
        if !was_decided {
            self.tell(shared);
        }
        Ok(())
    }

    fn reading(&mut self) -> Option<(Instant, BaseReading)> {
        self.fresh.take()
    }

    fn period(&self, sample: u32) -> u32 {
        self.due.divider * sample
    }

    fn renew(&mut self) {
        self.base.renew();
        self.is_lost = false;
    }

    fn steadied(&mut self, rate: AngularRate, heading: Angle) -> AngularRate {
        if rate.is_saturated() {
            return rate;
        }
        AngularRate(rate.0.saturating_sub(self.swaying(heading)))
    }
}
