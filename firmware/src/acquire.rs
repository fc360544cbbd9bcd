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
use orientation::units::{Angle, AngularRate, DEGREE, SpecificForce, TURN, Temperature};

use crate::calibration::Calibration;
use crate::configuration::Configuration;
use crate::event::Event;
use crate::guarded::Guarded;
use crate::patience::Symptom;
use crate::ports::{Accelerometer, Encoder, ForceReading, Gyro, Observer, RateReading, Sensors};
use crate::shared::Shared;
use crate::steady::{Base, Steady};
use crate::timeline::{Arrival, Timeline};

/// Periods without a conversion after which the gyro is silent.
const SILENCE: u32 = 8;
/// Equal readings in a row that are no chance: the last bits of both sensors are noise.
pub(crate) const STUCK: u32 = 64;
/// Longest time at the limit of the range, s: a slammed door is over by then.
const SATURATED_SECONDS: f64 = 5.0;

/// Faster than any stage, rad/s: a quarter of a turn a second.
const FASTEST: f64 = TURN / 4.0;
/// What a stage may jump by: play, ringing, a slipping magnet, rad.
const PLAY: f64 = DEGREE;

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

/// Says yes at first, then every so-manieth time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Every {
    divider: u32,
    left: u32,
}

impl Every {
    pub(crate) fn new(divider: u32) -> Self {
        Self { divider: divider.max(1), left: 0 }
    }

    pub(crate) fn is_due(&mut self) -> bool {
        let is_due = self.left == 0;
        self.left = if is_due { self.divider } else { self.left } - 1;
        is_due
    }
}

/// How far the stage can turn between two readings of its angle, in steps of an [`Angle`].
fn greatest_step(configuration: &Configuration) -> u32 {
    let seconds = f64::from(configuration.angle_divider) / configuration.sample_rate;
    Angle::from_rad(PLAY + FASTEST * seconds).0
}

/// The sensors of the stage path at work.
pub struct Acquisition<'a, G, A, E, S, O> {
    gyro: Guarded<'a, G>,
    accelerometer: Guarded<'a, A>,
    encoder: Guarded<'a, E>,
    steady: S,
    shared: &'a Shared<'a, O>,
    calibration: Calibration,
    timeline: Timeline,
    silence: Duration,
    forces_due: Every,
    angles_due: Every,
    /// The angle of the latest reading; none where it was lost.
    angle: Option<Angle>,
    rates: Row<AngularRate>,
    forces: Row<[SpecificForce; 3]>,
    rates_clipped: u32,
    forces_clipped: u32,
    longest_clipped: u32,
    greatest_step: u32,
    has_jumped: bool,
    /// Samples lost in a row because nobody took them.
    overflowed: u32,
}

impl<'a, G: Gyro, A: Accelerometer, E: Encoder, S: Steady, O: Observer>
    Acquisition<'a, G, A, E, S, O>
{
    /// Takes the sensors; nothing is started yet.
    pub fn new<B: Base<Steady<'a> = S>>(
        sensors: &'a mut Sensors<G, A, E, B>,
        configuration: &Configuration,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        let period = configuration.period();
        Self {
            gyro: Guarded::new(&mut sensors.gyro, Device::Gyro),
            accelerometer: Guarded::new(&mut sensors.accelerometer, Device::Accelerometer),
            encoder: Guarded::new(&mut sensors.encoder, Device::Encoder),
            steady: sensors.base.steady(),
            shared,
            calibration: Calibration::new(configuration.encoder),
            timeline: Timeline::new(period),
            silence: Duration::from_micros(u64::from(period) * u64::from(SILENCE)),
            forces_due: Every::new(configuration.force_divider),
            angles_due: Every::new(configuration.angle_divider),
            angle: None,
            rates: Row::new(),
            forces: Row::new(),
            rates_clipped: 0,
            forces_clipped: 0,
            longest_clipped: (SATURATED_SECONDS * configuration.sample_rate) as u32,
            greatest_step: greatest_step(configuration),
            has_jumped: false,
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
        self.encoder.start(self.shared).await?;
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
        let stage = self.angle().await?;
        let force = self.force().await?;
        let (Some(rate), Some(stage)) = (rate, stage) else { return Ok(None) };
        let rate = self.steady.steadied(rate, stage, self.shared).await?;
        self.judge(time);
        Ok(Some(Sample {
            time: orientation::units::Instant(time.as_micros()),
            stage,
            rate,
            force: force.map(|(force, _)| force),
            temperature: force.map(|(_, temperature)| temperature),
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

    /// The stage's angle, read anew with every so-manieth sample; none where that was lost.
    async fn angle(&mut self) -> Result<Option<Angle>, Refusal> {
        if self.angles_due.is_due() || self.angle.is_none() {
            let begun = Instant::now();
            let outcome = self.encoder.device.read().await;
            self.angle = match self.encoder.checked(begun, outcome) {
                Ok(shown) => Some(self.calibration.correct(shown)),
                Err(symptom) => self.encoder.mend(symptom, self.shared).await.map(|()| None)?,
            };
            self.angle = self.angle.filter(|angle| self.is_in_line(*angle));
        }
        Ok(self.angle)
    }

    /// Takes an angle, unless it is further from the one before than the stage can turn: such a one is
    /// lost, but the next is believed.
    fn is_in_line(&mut self, angle: Angle) -> bool {
        let (last, _) = self.shared.angle.get();
        let step = (angle - last).0.cast_signed().unsigned_abs();
        self.has_jumped =
            step > self.greatest_step && !self.has_jumped && self.timeline.has_begun();
        if self.has_jumped {
            self.shared.lose(Device::Encoder, Symptom::Jumped);
            return false;
        }
        self.shared.angle.set((angle, Instant::now()));
        if self.steady.is_decided() {
            self.shared.sensing.signal(());
        }
        true
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
        if self.forces.push(reading.force) >= STUCK {
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
