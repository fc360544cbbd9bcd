//! Compensation of the base's sway: subtracts the base's rate from the precise gyro's, on
//! instruments with a coarse inertial measurement unit on the base.
//!
//! The base unit is read once in every `divider` samples; between, its latest rate is held. Until
//! the sway has been observed for long enough, no decision is taken and the session does not begin.
//! The decision then holds for the whole session.
//!
//! Each reading also goes to the attitude keeper.
//!
//! A base unit that fails is started again as any other device. If it is given up, a session that
//! does not need it continues without it.

use embassy_time::Instant;
use micromath::F32Ext;
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::signal::sway::{Decision, Sway, SwayNoise};
use orientation::units::{Angle, AngularRate, DEGREES_PER_RADIAN as DEGREES, TURN};

use crate::event::Event;
use crate::guarded::Guarded;
use crate::pointing::Decimator;
use crate::ports::{BaseReading, BaseSensors, NoBase};
use crate::repeat_counter::{RepeatCounter, STUCK};
use crate::retry_budget::{RETRY, Symptom};
use crate::shared::Shared;

/// Time without a new reading after which the base unit counts as silent, µs.
const SILENCE: u64 = 100_000;
/// Step of an [`Angle`], rad.
const STEP: f32 = (TURN / 4_294_967_296.0) as f32;
/// Change of the stage's angle, in steps, below which its sine is not computed again: 2⁻¹⁴ of a
/// turn, by which a sway across the axis is resolved with an error of 0.04 %.
const KEPT: u32 = 1 << 18;

/// The compensation of the base's sway. Without sensors there is nothing to read, and rates are used
/// as measured; the methods do so unless they are implemented.
pub trait CompensatesSway {
    /// Starts the sensors.
    ///
    /// # Errors
    /// A device without which the session cannot run is given up.
    async fn start(&mut self, _shared: &Shared<'_>) -> Result<(), Refusal> {
        Ok(())
    }

    /// Whether the decision for or against the compensation has been taken.
    fn is_decided(&self) -> bool {
        true
    }

    /// Reads the sensors at one of two moments of every sample: before its angle is read if their
    /// readings are subtracted, after it if they are only kept, since on a platform that turns the
    /// angle must not be late.
    ///
    /// # Errors
    /// The sensors are given up while their readings are being subtracted.
    async fn follow(&mut self, _is_angle_read: bool, _: &Shared<'_>) -> Result<(), Refusal> {
        Ok(())
    }

    /// The reading of the latest [`Self::follow`] and its time; each reading is returned once.
    fn reading(&mut self) -> Option<(Instant, BaseReading)> {
        None
    }

    /// Time between two readings, µs, for a precise gyro with the sampling period `sample`, µs.
    fn period(&self, sample: u32) -> u32 {
        sample
    }

    /// Restores the full retry budget of the sensors.
    fn renew(&mut self) {}

    /// The rate along a horizontal axis at this heading, less the sway.
    fn compensated(&mut self, rate: AngularRate, _heading: Angle) -> AngularRate {
        rate
    }
}

impl CompensatesSway for NoBase {}

/// The compensation of sway by coarse sensors on the base.
pub struct SwayCompensation<'a, B> {
    /// The base unit with its retry budget.
    base: Guarded<'a, B>,
    /// Decimation of its readings.
    due: Decimator,
    /// Estimator of the sway.
    sway: Sway,
    /// Time of the latest new reading that was not saturated.
    latest: Instant,
    /// Begin of the present silence: the latest new reading or the latest start.
    silent: Instant,
    /// Counter of identical readings, by which a stuck unit is found.
    readings: RepeatCounter<[AngularRate; 3]>,
    /// The latest reading with its time, for the attitude keeper.
    fresh: Option<(Instant, BaseReading)>,
    /// The latest reading, until it has been held once.
    held: Option<BaseReading>,
    /// Stage angle to which `axis` belongs.
    stage: Angle,
    /// Cosine and sine of that angle.
    axis: [f32; 2],
    /// Whether the sway is observed and subtracted at all.
    compensates: bool,
    /// Time at which the base unit was given up.
    lost: Option<Instant>,
}

impl<'a, B: BaseSensors> SwayCompensation<'a, B> {
    /// Takes the base unit; nothing is started yet.
    pub fn new(device: &'a mut B) -> Self {
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
            compensates: true,
            lost: None,
        }
    }

    /// Takes a base unit whose readings are for the attitude keeper alone: the alignment begins at
    /// once, and nothing is subtracted.
    pub fn for_keeping(device: &'a mut B) -> Self {
        Self { compensates: false, ..Self::new(device) }
    }

    /// Reads the sensors where a reading is due, and starts them again where they fail.
    ///
    /// # Errors
    /// The sensors are given up while their readings are being subtracted.
    async fn take(&mut self, shared: &Shared<'_>) -> Result<(), Refusal> {
        if self.is_absent(shared) || !self.due.is_due() {
            return Ok(());
        }
        let was_decided = self.is_decided();
        if let Err(symptom) = self.read(shared).await {
            self.mend(symptom, shared).await?;
        }
        if !was_decided {
            self.report(shared);
        }
        Ok(())
    }

    /// Takes a reading if there is a new one.
    ///
    /// # Errors
    /// The symptom of a unit that gives no reading for 100 ms, fails on the bus, or is stuck.
    async fn read(&mut self, shared: &Shared<'_>) -> Result<(), Symptom> {
        let begun = Instant::now();
        let outcome = self.base.device.read().await;
        match self.base.checked(outcome)? {
            Some(reading) => {
                shared.observer.sensed(begun, &reading);
                self.push(begun, reading)
            }
            None if (begun - self.silent).as_micros() > SILENCE => Err(Symptom::Silent),
            None => {
                self.hold(begun);
                Ok(())
            }
        }
    }

    /// Repeats the latest rates for the keeper where no new output falls between two readings,
    /// which happens now and then when both rates are nearly equal. Repeats once only, and marks
    /// the specific force as invalid.
    fn hold(&mut self, at: Instant) {
        if let Some(reading) = self.held.take() {
            self.fresh = Some((at, BaseReading { is_clipped: true, ..reading }));
        }
    }

    /// Passes a reading to the estimator of sway. A saturated reading is omitted; the gap after it
    /// makes the estimator begin anew.
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
            let seconds = (at - self.latest).as_micros() as f32 * 1e-6;
            self.latest = at;
            self.sway.push(seconds, rate, force);
        }
        Ok(())
    }

    /// Starts the sensors again where necessary, and continues without them where the session
    /// permits.
    ///
    /// # Errors
    /// The sensors are given up although their readings are being subtracted in an alignment.
    async fn mend(&mut self, symptom: Symptom, shared: &Shared<'_>) -> Result<(), Refusal> {
        let outcome = self.base.mend(symptom, shared).await;
        if outcome != Ok(false) {
            self.silent = Instant::now();
        }
        let is_subtracted = self.compensates && matches!(self.sway.decision, Decision::Swaying(..));
        match outcome {
            Err(reason) if is_subtracted && !shared.is_holding() => return Err(reason),
            Err(_) => self.lose(shared),
            Ok(_) => {}
        }
        Ok(())
    }

    /// Continues without the sensors; a sway that they have not observed by now stays unmeasured.
    fn lose(&mut self, shared: &Shared<'_>) {
        if !self.is_decided() {
            shared.sway.set(SwayNoise::UNMEASURED);
        }
        self.lost = Some(Instant::now());
    }

    /// Whether the base unit is out of use. While an azimuth is kept, it is tried again every 10 s.
    fn is_absent(&mut self, shared: &Shared<'_>) -> bool {
        if self.lost.is_some_and(|lost| shared.is_holding() && lost.elapsed() >= RETRY) {
            self.renew();
        }
        self.lost.is_some()
    }

    /// Reports the decision; called when the decision may have been taken.
    fn report(&self, shared: &Shared<'_>) {
        let (noise, event) = match self.sway.decision {
            Decision::Watching => return,
            Decision::Still(size) => {
                (SwayNoise::NONE, Event::BaseStill(f64::from(size.angle) * DEGREES))
            }
            Decision::Swaying(size, noise) => {
                let hertz = f64::from(size.rate / size.angle) / TURN;
                let [angle, left] =
                    [f64::from(size.angle), noise.angle_sigma().0].map(|angle| angle * DEGREES);
                (noise, Event::BaseSways(angle, hertz, left))
            }
        };
        shared.sway.set(noise);
        shared.report(event);
    }

    /// Contribution of the sway to the gyro's rate at a stage angle, nrad/s.
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
    async fn start(&mut self, shared: &Shared<'_>) -> Result<(), Refusal> {
        self.lost = None;
        if self.base.start(shared).await.is_err() {
            self.lose(shared);
        }
        self.silent = Instant::now();
        Ok(())
    }

    fn is_decided(&self) -> bool {
        !self.compensates || self.lost.is_some() || self.sway.decision != Decision::Watching
    }

    async fn follow(&mut self, is_angle_read: bool, shared: &Shared<'_>) -> Result<(), Refusal> {
        if self.compensates == is_angle_read { Ok(()) } else { self.take(shared).await }
    }

    fn reading(&mut self) -> Option<(Instant, BaseReading)> {
        self.fresh.take()
    }

    fn period(&self, sample: u32) -> u32 {
        self.due.divider * sample
    }

    fn renew(&mut self) {
        self.base.renew();
        self.lost = None;
    }

    fn compensated(&mut self, rate: AngularRate, heading: Angle) -> AngularRate {
        if rate.is_saturated() || !self.compensates {
            return rate;
        }
        AngularRate(rate.0.saturating_sub(self.swaying(heading)))
    }
}
