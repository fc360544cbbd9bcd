//! Compensation of the base's sway: subtracts the base's rate from the precise gyro's, on
//! instruments with a coarse inertial measurement unit on the base.
//!
//! The base unit is read once in every `divider` samples, more often than it has a new output, so that none is
//! left out; between, its latest rate is held. Until the sway has been observed for long enough, no decision is
//! taken and no alignment begins. The decision then holds for that alignment. For another one the estimator
//! begins anew: what it took for biases while the vehicle drove is in the rate that it would subtract, which
//! turns with the stage as the Earth rate does.
//!
//! Each reading also goes to the attitude keeper.
//!
//! ```text
//!  acquisition ─asks─▶ Compensation ─wanted─▶ BaseUnit ─▶ sensors
//!              ◀─reading, rate less sway─┘ ◀─reading─┘
//! ```
//!
//! The sensors are read, and started again where they fail, beside acquisition, which waits for a
//! reading until the next conversion at the longest: a bus that hangs costs no other sensor a sample.
//! If the base unit is given up, acquisition continues without it; an alignment from whose samples the sway is
//! subtracted ends.

use core::cell::{Cell, RefCell};
use core::convert::Infallible;
use core::future::{pending, poll_fn};
use core::task::Poll;

use embassy_time::Instant;
use micromath::F32Ext;
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::signal::sway::{CoarseSensors, Decision, Sway, SwayNoise};
use orientation::units::{self, Angle, AngularRate, DEGREES_PER_RADIAN as DEGREES, TURN};

use crate::event::Event;
use crate::guarded::Guarded;
use crate::output_clock::{Output, OutputClock};
use crate::pointing::Decimator;
use crate::ports::{BaseReading, BaseSensors, NoBase};
use crate::repeat_counter::RepeatCounter;
use crate::retry_budget::{RETRY, Symptom};
use crate::shared::Shared;

/// Time without a new reading after which the base unit counts as silent, µs.
const SILENCE: u64 = 100_000;
/// Number of identical successive outputs that is not chance: that noise leaves the last bits of all three gyros as
/// they are.
const STUCK: u32 = 32;
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

    /// What acquisition compensates with, if there are sensors, and the future that reads them beside
    /// acquisition. It is to be polled wherever acquisition is, before it and again where a reading is
    /// wanted then.
    fn parts<'s>(
        &'s mut self,
        shared: &'s Shared<'_>,
    ) -> (Option<&'s Compensation>, impl Future<Output = Infallible> + 's);

    /// Time between two outputs, µs, for a precise gyro with the sampling period `sample`, µs.
    fn period(&self, sample: u32) -> u32 {
        sample
    }

    /// Restores the full retry budget of the sensors.
    fn renew(&mut self) {}
}

impl CompensatesSway for NoBase {
    fn parts<'s>(
        &'s mut self,
        _: &'s Shared<'_>,
    ) -> (Option<&'s Compensation>, impl Future<Output = Infallible> + 's) {
        (None, pending())
    }
}

/// What the base unit does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unit {
    /// Nothing.
    Idle,
    /// It is asked for a reading.
    Wanted,
    /// It takes a reading, or starts the sensors again.
    Busy,
}

/// What is known of the sway, and what acquisition and the base unit tell each other.
pub struct Compensation {
    /// Whether the sway is observed and subtracted at all.
    compensates: bool,
    /// Decimation of the readings.
    due: Cell<Decimator>,
    /// Estimator of the sway.
    sway: RefCell<Sway>,
    /// The latest output with its time, for the attitude keeper.
    fresh: Cell<Option<(Output, BaseReading)>>,
    /// A stage angle with its cosine and sine.
    axis: Cell<(Angle, [f32; 2])>,
    /// Time at which the base unit was given up.
    lost: Cell<Option<Instant>>,
    /// What the base unit does.
    unit: Cell<Unit>,
}

impl Compensation {
    /// Nothing is known of the sway yet.
    fn new(sensors: CoarseSensors, divider: u32, compensates: bool) -> Self {
        Self {
            compensates,
            due: Cell::new(Decimator::new(divider)),
            sway: RefCell::new(Sway::new(sensors)),
            fresh: Cell::new(None),
            axis: Cell::new((Angle(0), [1.0, 0.0])),
            lost: Cell::new(None),
            unit: Cell::new(Unit::Idle),
        }
    }

    /// Whether the decision for or against the compensation has been taken.
    pub(crate) fn is_decided(&self) -> bool {
        !self.compensates
            || self.lost.get().is_some()
            || self.sway.borrow().decision != Decision::Watching
    }

    /// Asks for a reading where one is due, at one of two moments of every sample: before its angle is
    /// read if the readings are subtracted, after it if they are only kept, since on a platform that
    /// turns the angle must not be late. A base unit that is still busy is not asked; returns whether it
    /// was.
    pub(crate) fn asks(&self, is_angle_read: bool, shared: &Shared<'_>) -> bool {
        if self.compensates == is_angle_read || self.is_absent(shared) {
            return false;
        }
        let mut due = self.due.get();
        let is_due = due.is_due();
        self.due.set(due);
        let asks = is_due && self.unit.get() == Unit::Idle;
        if asks {
            self.unit.set(Unit::Wanted);
        }
        asks
    }

    /// Whether the base unit was asked, and has not been polled since then.
    pub(crate) fn is_wanted(&self) -> bool {
        self.unit.get() == Unit::Wanted
    }

    /// Waits for the reading that was asked for.
    pub(crate) async fn answered(&self) {
        self.until(|unit| unit == Unit::Idle).await;
    }

    /// Waits for a state of the base unit. Acquisition and base unit are polled together, so neither
    /// wakes the other.
    async fn until(&self, is_so: fn(Unit) -> bool) {
        poll_fn(|_| if is_so(self.unit.get()) { Poll::Ready(()) } else { Poll::Pending }).await;
    }

    /// The latest output and its time; each is returned once.
    pub(crate) fn reading(&self) -> Option<(Output, BaseReading)> {
        self.fresh.take()
    }

    /// The rate along a horizontal axis at this heading, less the sway.
    pub(crate) fn compensated(&self, rate: AngularRate, heading: Angle) -> AngularRate {
        if rate.is_saturated() || !self.compensates {
            return rate;
        }
        AngularRate(rate.0.saturating_sub(self.swaying(heading)))
    }

    /// Contribution of the sway to the gyro's rate at a stage angle, nrad/s.
    fn swaying(&self, stage: Angle) -> i32 {
        let (last, mut axis) = self.axis.get();
        if (stage - last).0.cast_signed().unsigned_abs() > KEPT {
            let theta = stage.0.cast_signed() as f32 * STEP;
            axis = [F32Ext::cos(theta), F32Ext::sin(theta)];
            self.axis.set((stage, axis));
        }
        (self.sway.borrow().along(axis) * 1e9) as i32
    }

    /// Whether the base unit is out of use. While an azimuth is kept, it is tried again every 10 s.
    fn is_absent(&self, shared: &Shared<'_>) -> bool {
        let lost = self.lost.get();
        lost.is_some_and(|lost| !shared.is_holding() || lost.elapsed() < RETRY)
    }

    /// Begins to observe the sway anew where that is wanted.
    fn begin_anew(&self, shared: &Shared<'_>) {
        if shared.wants_sway() && self.sway.borrow().decision != Decision::Watching {
            self.sway.borrow_mut().begin_anew();
        }
    }

    /// Continues without the sensors; a sway that they have not observed by now stays unmeasured.
    fn lose(&self, shared: &Shared<'_>) {
        if !self.is_decided() || shared.wants_sway() {
            shared.observe_sway(SwayNoise::UNMEASURED);
        }
        self.lost.set(Some(Instant::now()));
    }

    /// Reports the decision; called when the decision may have been taken.
    fn report(&self, shared: &Shared<'_>) {
        let (noise, event) = match self.sway.borrow().decision {
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
        shared.observe_sway(noise);
        shared.report(event);
    }
}

/// The compensation of sway by coarse sensors on the base.
pub struct SwayCompensation<'a, B> {
    /// The sensors.
    unit: BaseUnit<'a, B>,
    /// What is known by them.
    compensation: Compensation,
}

impl<'a, B: BaseSensors> SwayCompensation<'a, B> {
    /// Takes the base unit; nothing is started yet.
    pub fn new(device: &'a mut B) -> Self {
        Self::with(device, true)
    }

    /// Takes a base unit whose readings are for the attitude keeper alone: the alignment begins at
    /// once, and nothing is subtracted.
    pub fn for_keeping(device: &'a mut B) -> Self {
        Self::with(device, false)
    }

    fn with(device: &'a mut B, compensates: bool) -> Self {
        let compensation = Compensation::new(device.sensors(), device.divider(), compensates);
        Self { unit: BaseUnit::new(device), compensation }
    }
}

/// The base unit with the checks of its readings.
struct BaseUnit<'a, B> {
    /// The base unit with its retry budget.
    base: Guarded<'a, B>,
    /// Times of the outputs.
    clock: OutputClock,
    /// Time of the latest output that was not saturated.
    latest: units::Instant,
    /// Begin of the present silence: the latest new reading or the latest start.
    silent: Instant,
    /// Counter of identical readings, by which a stuck unit is found.
    readings: RepeatCounter<[AngularRate; 3]>,
}

impl<'a, B: BaseSensors> BaseUnit<'a, B> {
    /// Takes the device.
    fn new(device: &'a mut B) -> Self {
        let period = device.output_period().as_secs_f32();
        Self {
            base: Guarded::new(device, Device::Base),
            clock: OutputClock::new(1e6 * period),
            latest: units::Instant(0),
            silent: Instant::MIN,
            readings: RepeatCounter::new(),
        }
    }

    /// Takes readings whenever they are wanted.
    async fn serve(&mut self, known: &Compensation, shared: &Shared<'_>) -> Infallible {
        // A reading that was under way when acquisition last ended is lost.
        known.unit.set(Unit::Idle);
        loop {
            known.until(|unit| unit == Unit::Wanted).await;
            known.unit.set(Unit::Busy);
            if known.lost.take().is_some() {
                self.base.renew();
            }
            self.take(known, shared).await;
            known.unit.set(Unit::Idle);
        }
    }

    /// Takes a reading, and starts the sensors again where they fail.
    async fn take(&mut self, known: &Compensation, shared: &Shared<'_>) {
        known.begin_anew(shared);
        let was_decided = known.is_decided();
        if let Err(symptom) = self.read(known, shared).await {
            self.mend(symptom, known, shared).await;
        }
        if !was_decided {
            known.report(shared);
        }
    }

    /// Takes a reading if there is a new one.
    ///
    /// # Errors
    /// The symptom of a unit that gives no reading for 100 ms, fails on the bus, or is stuck.
    async fn read(&mut self, known: &Compensation, shared: &Shared<'_>) -> Result<(), Symptom> {
        let begun = Instant::now();
        let time = shared.clocks.instant(units::Instant(begun.as_micros()));
        let outcome = self.base.device.read().await;
        match self.base.checked(outcome)? {
            Some(reading) => {
                shared.observer.sensed(begun, &reading);
                self.silent = begun;
                let output = self.clock.take(time);
                self.push(output, reading, known)
            }
            None if (begun - self.silent).as_micros() > SILENCE => Err(Symptom::Silent),
            None => {
                self.clock.look(time);
                Ok(())
            }
        }
    }

    /// Passes an output to the estimator of sway. A saturated reading is omitted; the gap after it
    /// makes the estimator begin anew.
    fn push(
        &mut self,
        output: Output,
        reading: BaseReading,
        known: &Compensation,
    ) -> Result<(), Symptom> {
        let BaseReading { rate, force, is_clipped } = reading;
        if self.readings.push(rate) >= STUCK {
            self.readings = RepeatCounter::new();
            return Err(Symptom::Stuck);
        }
        known.fresh.set(Some((output, reading)));
        if !is_clipped {
            let seconds = output.time.0.saturating_sub(self.latest.0) as f32 * 1e-6;
            self.latest = output.time;
            known.sway.borrow_mut().push(seconds, rate, force);
        }
        Ok(())
    }

    /// Starts the sensors again where necessary. Where they are given up, an alignment ends from whose samples
    /// their readings are being subtracted.
    async fn mend(&mut self, symptom: Symptom, known: &Compensation, shared: &Shared<'_>) {
        let outcome = self.base.mend(symptom, shared).await;
        if outcome != Ok(false) {
            self.silent = Instant::now();
            self.clock.restart();
        }
        let Err(reason) = outcome else { return };
        known.lose(shared);
        let is_swaying = matches!(known.sway.borrow().decision, Decision::Swaying(..));
        if known.compensates && is_swaying && !shared.is_idle() {
            shared.fail(reason);
        }
    }
}

impl<B: BaseSensors> CompensatesSway for SwayCompensation<'_, B> {
    async fn start(&mut self, shared: &Shared<'_>) -> Result<(), Refusal> {
        self.compensation.lost.set(None);
        if self.unit.base.start(shared).await.is_err() {
            self.compensation.lose(shared);
        }
        self.unit.silent = Instant::now();
        self.unit.clock.restart();
        Ok(())
    }

    fn parts<'s>(
        &'s mut self,
        shared: &'s Shared<'_>,
    ) -> (Option<&'s Compensation>, impl Future<Output = Infallible> + 's) {
        (Some(&self.compensation), self.unit.serve(&self.compensation, shared))
    }

    fn period(&self, _: u32) -> u32 {
        self.unit.base.device.output_period().subsec_micros()
    }

    fn renew(&mut self) {
        self.unit.base.renew();
        self.compensation.lost.set(None);
    }
}
