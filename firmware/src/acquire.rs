//! Acquisition: on every conversion of the gyro one sample of the stage path, or none and the reason.
//!
//! The conversion sets the time; encoder and accelerometer are read right after it, with every
//! so-manieth sample: between, the stage cannot have turned far, and the force is only averaged. A
//! sample goes out only whole: without a good rate and a good angle there is none, and its absence
//! shows in the next one's time.

use drivers::fault::Fault;
use embassy_time::{Duration, Instant, with_timeout};
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::signal::Sample;
use orientation::units::{AngularRate, SpecificForce, Temperature};

use crate::configuration::Configuration;
use crate::event::Event;
use crate::guarded::Guarded;
use crate::patience::Symptom;
use crate::pointing::{Every, Pointing};
use crate::ports::{Accelerometer, ForceReading, Gyro, Observer, RateReading};
use crate::shared::Shared;
use crate::steady::Steady;
use crate::timeline::{Arrival, Timeline};

/// Periods without a conversion after which the gyro is silent.
const SILENCE: u32 = 8;
/// Equal readings in a row that are no chance: the last bits of both sensors are noise.
pub(crate) const STUCK: u32 = 64;
/// Longest time at the limit of the range, s: a slammed door is over by then.
const SATURATED_SECONDS: f64 = 5.0;

/// A force with the temperature at which it was measured.
type Force = ([SpecificForce; 3], Temperature);

/// How often something came in a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<T> {
    last: Option<T>,
    count: u32,
}

impl<T: Copy + PartialEq> Row<T> {
    pub(crate) const fn new() -> Self {
        Self { last: None, count: 0 }
    }

    /// How often this value has come in a row before.
    pub(crate) fn push(&mut self, value: T) -> u32 {
        self.count = if self.last.replace(value) == Some(value) { self.count + 1 } else { 0 };
        self.count
    }
}

/// The sensors of the stage path at work.
pub struct Acquisition<'a, G, A, P, S, O> {
    gyro: Guarded<'a, G>,
    accelerometer: Guarded<'a, A>,
    pointing: P,
    steady: S,
    shared: &'a Shared<'a, O>,
    timeline: Timeline,
    silence: Duration,
    forces_due: Every,
    rates: Row<AngularRate>,
    forces: Row<[SpecificForce; 3]>,
    rates_clipped: u32,
    forces_clipped: u32,
    longest_clipped: u32,
    /// Samples lost in a row because nobody took them.
    overflowed: u32,
}

impl<'a, G: Gyro, A: Accelerometer, P: Pointing, S: Steady, O: Observer>
    Acquisition<'a, G, A, P, S, O>
{
    /// Takes the sensors; nothing is started yet.
    pub fn new(
        gyro: &'a mut G,
        accelerometer: &'a mut A,
        pointing: P,
        steady: S,
        configuration: &Configuration,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        let period = configuration.period();
        Self {
            gyro: Guarded::new(gyro, Device::Gyro),
            accelerometer: Guarded::new(accelerometer, Device::Accelerometer),
            pointing,
            steady,
            shared,
            timeline: Timeline::new(period),
            silence: Duration::from_micros(u64::from(period) * u64::from(SILENCE)),
            forces_due: Every::new(configuration.force_divider),
            rates: Row::new(),
            forces: Row::new(),
            rates_clipped: 0,
            forces_clipped: 0,
            longest_clipped: (SATURATED_SECONDS * configuration.sample_rate) as u32,
            overflowed: 0,
        }
    }

    /// Samples until a sensor is given up; gives the reason.
    pub async fn run(&mut self) -> Refusal {
        match self.sample_for_ever().await {
            Ok(never) => match never {},
            Err(reason) => reason,
        }
    }

    async fn sample_for_ever(&mut self) -> Result<core::convert::Infallible, Refusal> {
        self.accelerometer.start(self.shared).await?;
        self.pointing.start().await?;
        self.steady.start(self.shared).await?;
        self.gyro.start(self.shared).await?;
        loop {
            if let Some(sample) = self.sample().await? {
                self.hand_over(sample);
            }
        }
    }

    /// Queues a sample for the session, and tells of it where it cannot.
    fn hand_over(&mut self, sample: Sample) {
        self.shared.count(|health| health.samples += 1);
        if self.shared.samples.try_send(sample).is_err() {
            self.overflowed += 1;
            self.shared.count(|health| health.overflowed += 1);
        } else if self.overflowed > 0 {
            self.shared.tell(Event::Overflowed(self.overflowed));
            self.overflowed = 0;
        }
    }

    /// The next sample, or none where a reading was lost.
    async fn sample(&mut self) -> Result<Option<Sample>, Refusal> {
        let Some(time) = self.conversion().await? else { return Ok(None) };
        let rate = self.rate().await?;
        self.steady.follow(self.shared).await?;
        if !self.steady.is_decided() {
            self.shared.count(|health| health.samples += 1);
            return Ok(None);
        }
        let shown = self.pointing.read().await?;
        let force = self.force().await?;
        let (Some(rate), Some(shown)) = (rate, shown) else { return Ok(None) };
        self.judge(time);
        let aim = self.pointing.aim(shown);
        Ok(Some(Sample {
            time: orientation::units::Instant(time.as_micros()),
            stage: aim.heading,
            rate: self.steady.steadied(rate, aim.heading),
            force: force.map(|(force, _)| force),
            temperature: force.map(|(_, temperature)| temperature),
            elevation: aim.elevation.filter(|_| force.is_some()),
        }))
    }

    /// Waits for a conversion; its time.
    async fn conversion(&mut self) -> Result<Option<Instant>, Refusal> {
        let outcome = with_timeout(self.silence, self.gyro.device.ready()).await;
        let symptom = match outcome {
            Ok(Ok(())) => return Ok(Some(Instant::now())),
            Ok(Err(fault)) => Symptom::Chip(fault),
            Err(_) => Symptom::Silent,
        };
        self.gyro.mend(symptom, self.shared).await.map(|()| None)
    }

    async fn rate(&mut self) -> Result<Option<AngularRate>, Refusal> {
        let begun = Instant::now();
        let outcome = self.gyro.device.read().await;
        match self.judge_rate(begun, outcome)? {
            Ok(rate) => Ok(rate),
            Err(symptom) => self.gyro.mend(symptom, self.shared).await.map(|()| None),
        }
    }

    /// A new rate, none where it is not new, or what is to be mended.
    fn judge_rate(
        &mut self,
        begun: Instant,
        outcome: Result<RateReading, Fault>,
    ) -> Result<Result<Option<AngularRate>, Symptom>, Refusal> {
        let RateReading { rate, is_new } = match self.gyro.checked(begun, outcome) {
            Ok(reading) => reading,
            Err(symptom) => return Ok(Err(symptom)),
        };
        if !is_new {
            return Ok(Ok(None));
        }
        self.judge_saturation(rate)?;
        if self.rates.push(rate) >= STUCK && !rate.is_saturated() {
            self.rates = Row::new();
            return Ok(Err(Symptom::Stuck));
        }
        Ok(Ok(Some(rate)))
    }

    fn judge_saturation(&mut self, rate: AngularRate) -> Result<(), Refusal> {
        self.rates_clipped = if rate.is_saturated() { self.rates_clipped + 1 } else { 0 };
        if self.rates_clipped <= self.longest_clipped {
            return Ok(());
        }
        Err(self.shared.give_up(Device::Gyro, Trouble::Saturated))
    }

    /// Force and temperature with every so-manieth sample.
    async fn force(&mut self) -> Result<Option<Force>, Refusal> {
        if !self.forces_due.is_due() {
            return Ok(None);
        }
        let begun = Instant::now();
        let outcome = self.accelerometer.device.read().await;
        match self.judge_force(begun, outcome)? {
            Ok(force) => Ok(force),
            Err(symptom) => self.accelerometer.mend(symptom, self.shared).await.map(|()| None),
        }
    }

    /// A force, none where it is old or clipped, or what is to be mended. Old outputs and equal ones
    /// show an accelerometer that has stopped; one that stays at its limit is of no use.
    fn judge_force(
        &mut self,
        begun: Instant,
        outcome: Result<ForceReading, Fault>,
    ) -> Result<Result<Option<Force>, Symptom>, Refusal> {
        let reading = match self.accelerometer.checked(begun, outcome) {
            Ok(reading) => reading,
            Err(symptom) => return Ok(Err(symptom)),
        };
        let clipped = self.forces_clipped + self.forces_due.divider;
        self.forces_clipped = if reading.is_clipped { clipped } else { 0 };
        if self.forces_clipped > self.longest_clipped {
            return Err(self.shared.give_up(Device::Accelerometer, Trouble::Saturated));
        }
        if self.forces.push(reading.force) >= STUCK && !reading.is_clipped {
            self.forces = Row::new();
            return Ok(Err(Symptom::Stuck));
        }
        let usable = reading.is_new && !reading.is_clipped;
        Ok(Ok(usable.then_some((reading.force, reading.temperature))))
    }

    /// Counts and tells samples that are missing or beside their time.
    fn judge(&mut self, time: Instant) {
        match self.timeline.judge(time) {
            Arrival::InTime => {}
            Arrival::Late(microseconds) => {
                self.shared.count(|health| health.late += 1);
                self.shared.tell(Event::Late(microseconds));
            }
            Arrival::Missing(count) => {
                self.shared.count(|health| health.missing = health.missing.saturating_add(count));
                self.shared.tell(Event::Missing(count));
            }
        }
    }
}
