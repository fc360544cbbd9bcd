//! Samples of one gyro on a stage or a rotating platform.
//!
//! The conversion sets the time; encoder and accelerometer are read right after it, the
//! accelerometer with every n-th sample: between, the stage cannot have turned far, and the force
//! is only averaged. Without a valid rate and a valid angle there is no sample. The sensors on the base
//! start first; while one of these devices is started, or started again, they are read and passed on
//! all the same.

use core::convert::Infallible;
use core::future::poll_fn;
use core::pin::pin;
use core::task::Poll;

use embassy_time::{Duration, Instant, Ticker};
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::signal::Sample;

use super::Source;
use super::coarse::Coarse;
use super::forces::Forces;
use super::outlet::Outlet;
use super::rates::{Rates, silence};
use crate::configuration::{Configuration, FramesConfiguration, nanoseconds, period};
use crate::pointing::{FrameShafts, Pointing, Shaft};
use crate::ports::{Accelerometer, Encoder, ForceReading, Frames, Gyro, Sensors};
use crate::retry_budget::{RETRY, Symptom};
use crate::shared::{Channels, Shared};
use crate::sway::{CompensatesSway, Compensation};

/// The sensors of a stage or a turntable as a source of samples; nothing is started yet.
pub fn on_stage<'a, G: Gyro, A: Accelerometer, E: Encoder, B: CompensatesSway>(
    sensors: &'a mut Sensors<G, A, E, B>,
    configuration: &Configuration,
    channels: &'a Channels<'a>,
) -> impl Source<'a, Sample = Sample> {
    let Sensors { gyro, accelerometer, encoder, base } = sensors;
    let (harmonics, latest) = (configuration.encoder, &channels.shared.angles.outer);
    let shared = &channels.shared;
    let shaft = Shaft::new(encoder, Device::Encoder, harmonics, configuration, latest, shared);
    OnBase::new(gyro, accelerometer, shaft, base, configuration, channels)
}

/// The sensors of a two-frame mount as a source of samples; nothing is started yet.
pub fn on_mount<'a, G: Gyro, A: Accelerometer, E: Encoder, B: CompensatesSway>(
    sensors: &'a mut Sensors<G, A, Frames<E>, B>,
    configuration: &Configuration,
    frames: &FramesConfiguration,
    channels: &'a Channels<'a>,
) -> impl Source<'a, Sample = Sample> {
    let Sensors { gyro, accelerometer, encoder, base } = sensors;
    let shafts = FrameShafts::new(encoder, configuration, frames, &channels.shared);
    OnBase::new(gyro, accelerometer, shafts, base, configuration, channels)
}

/// Acquisition of the sensors of the stage path, and of those on the base beside it.
struct OnBase<'a, G, A, P, S> {
    acquisition: Acquisition<'a, G, A, P>,
    base: &'a mut S,
}

/// Acquisition of the sensors of the stage path.
struct Acquisition<'a, G, A, P> {
    rates: Rates<'a, G>,
    forces: Forces<'a, A>,
    pointing: P,
    coarse: Coarse,
    outlet: Outlet<'a, Sample>,
    silence: Duration,
}

impl<'a, G: Gyro, A: Accelerometer, P: Pointing, S: CompensatesSway> OnBase<'a, G, A, P, S> {
    /// Takes the sensors; nothing is started yet.
    fn new(
        gyro: &'a mut G,
        accelerometer: &'a mut A,
        pointing: P,
        base: &'a mut S,
        configuration: &Configuration,
        channels: &'a Channels<'a>,
    ) -> Self {
        let Configuration { sample_rate, force_divider, .. } = *configuration;
        let period = period(sample_rate);
        let acquisition = Acquisition {
            rates: Rates::new(gyro, Device::Gyro, sample_rate),
            forces: Forces::new(accelerometer, force_divider, sample_rate),
            pointing,
            coarse: Coarse::new(nanoseconds(sample_rate)),
            outlet: Outlet::new(period, base.period(period), channels),
            silence: silence(period),
        };
        Self { acquisition, base }
    }
}

impl<'a, G: Gyro, A: Accelerometer, P: Pointing, S: CompensatesSway> Source<'a>
    for OnBase<'a, G, A, P, S>
{
    type Sample = Sample;

    fn outlet(&mut self) -> &mut Outlet<'a, Sample> {
        &mut self.acquisition.outlet
    }

    /// Starts the sensors on the base, which carry attitude and heading alone until the others have
    /// started.
    async fn start(&mut self) -> Result<(), Refusal> {
        self.base.start(self.acquisition.outlet.shared()).await
    }

    /// Reads the sensors on the base beside the others, so that none waits for a bus of theirs that
    /// hangs.
    async fn run(&mut self) -> Result<Infallible, Refusal> {
        let Self { acquisition, base } = self;
        let (compensation, serving) = base.parts(acquisition.outlet.shared());
        let (mut serving, mut sampling) = (pin!(serving), pin!(acquisition.run(compensation)));
        poll_fn(|context| {
            loop {
                if let Poll::Ready(never) = serving.as_mut().poll(context) {
                    match never {}
                }
                if let Poll::Ready(ended) = sampling.as_mut().poll(context) {
                    return Poll::Ready(ended);
                }
                if !compensation.is_some_and(Compensation::is_wanted) {
                    return Poll::Pending;
                }
            }
        })
        .await
    }

    fn renew(&mut self) {
        self.acquisition.renew();
        self.base.renew();
    }
}

impl<G: Gyro, A: Accelerometer, P: Pointing> Acquisition<'_, G, A, P> {
    /// Restores the full retry budget of the precise gyro and the sensors beside it.
    fn renew(&mut self) {
        self.rates.renew();
        self.forces.renew();
        self.pointing.renew();
    }

    /// Starts the sensors, takes samples and hands them over without end.
    async fn run(&mut self, base: Option<&Compensation>) -> Result<Infallible, Refusal> {
        while let Err(reason) = self.start(base).await {
            self.do_without(reason, base).await?;
        }
        loop {
            match self.sample(base).await {
                Ok(Some(sample)) => self.outlet.hand_over(sample),
                Ok(None) => {}
                Err(reason) => self.do_without(reason, base).await?,
            }
        }
    }

    /// Starts the sensors beside those on the base.
    ///
    /// # Errors
    /// A sensor is given up.
    async fn start(&mut self, base: Option<&Compensation>) -> Result<(), Refusal> {
        let shared = self.outlet.shared();
        let starting = pin!(async {
            self.forces.accelerometer.start(shared).await?;
            self.pointing.start().await?;
            self.rates.gyro.start(shared).await
        });
        self.coarse.beside(starting, base, shared).await
    }

    /// The compensation by the base's sensors, where a coarse reading is asked for at one of the two moments of a
    /// sample. The caller waits for the reading until the next conversion at the longest.
    fn asked<'b>(
        &self,
        is_angle_read: bool,
        base: Option<&'b Compensation>,
    ) -> Option<&'b Compensation> {
        base.filter(|base| base.asks(is_angle_read, self.outlet.shared()))
    }

    /// Takes the next sample; [`None`] where a reading was lost.
    ///
    /// # Errors
    /// A sensor is given up.
    async fn sample(&mut self, base: Option<&Compensation>) -> Result<Option<Sample>, Refusal> {
        let shared = self.outlet.shared();
        let end = match self.rates.conversion(self.silence).await {
            Ok(end) => end,
            Err(symptom) => return self.mend_gyro(symptom, base).await.map(|()| None),
        };
        let ended = Instant::from_micros(end.at.0);
        let late = Instant::now() - ended;
        let rate = match self.rates.read(shared).await {
            Ok(rate) => rate,
            Err(symptom) => self.mend_gyro(symptom, base).await.map(|()| None)?,
        };
        self.coarse.turn(end, rate, shared.clocks);
        if let Some(base) = self.asked(false, base) {
            self.rates.until_next(base.answered()).await;
        }
        self.coarse.pass_on(base, shared);
        if shared.is_first() && !base.is_none_or(Compensation::is_decided) {
            shared.count(|health| health.samples += 1);
            return Ok(None);
        }
        // An angle belongs to the conversion with which it is read: where that is lost, it is read with the next.
        let shown = match rate {
            Some(_) => self.pointing.read(late).await,
            None => None,
        };
        if shown.is_none() {
            self.mend_pointing(base).await?;
        }
        let force = match self.forces.read(shared).await {
            Ok(force) => force.filter(|reading| !reading.is_clipped),
            Err(symptom) => self.mend_forces(symptom, base).await?,
        };
        if let Some(base) = self.asked(true, base) {
            self.rates.until_next(base.answered()).await;
        }
        self.coarse.pass_on(base, shared);
        let on_base = self.pointing.force_on_base();
        if let Some((reading, bias_sigma)) = force.zip(on_base) {
            self.coarse.feel(reading.force, bias_sigma, shared);
        }
        let (Some(rate), Some(shown)) = (rate, shown) else { return Ok(None) };
        self.outlet.judge(end);
        let aim = self.pointing.aim(shown);
        self.coarse.point(self.pointing.elevation());
        if let Some(reading) = force.filter(|_| on_base.is_none()) {
            self.coarse.compare(reading.force, aim.heading, shared);
        }
        Ok(Some(Sample {
            time: self.outlet.time(end),
            stage: aim.heading,
            rate: base.map_or(rate, |base| base.compensated(rate, aim.heading)),
            force: force.map(|reading| reading.force),
            temperature: force.map(|reading| reading.temperature),
            elevation: aim.elevation.filter(|_| force.is_some()),
        }))
    }

    /// Handles a symptom of the gyro, whose conversion is lost.
    ///
    /// # Errors
    /// The gyro is given up.
    async fn mend_gyro(
        &mut self,
        symptom: Symptom,
        base: Option<&Compensation>,
    ) -> Result<(), Refusal> {
        let shared = self.outlet.shared();
        let mending = pin!(self.rates.gyro.mend(symptom, shared));
        self.coarse.beside(mending, base, shared).await.map(|_| ())
    }

    /// Handles the symptom of an encoder that was read last, if there is one.
    ///
    /// # Errors
    /// The encoder is given up.
    async fn mend_pointing(&mut self, base: Option<&Compensation>) -> Result<(), Refusal> {
        let shared = self.outlet.shared();
        self.coarse.beside(pin!(self.pointing.mend()), base, shared).await
    }

    /// Handles a symptom of the accelerometer.
    ///
    /// # Errors
    /// The accelerometer is given up.
    async fn mend_forces(
        &mut self,
        symptom: Symptom,
        base: Option<&Compensation>,
    ) -> Result<Option<ForceReading>, Refusal> {
        let shared = self.outlet.shared();
        self.coarse.beside(pin!(self.forces.mend(symptom, shared)), base, shared).await
    }

    /// While an attitude is kept, continues with the coarse sensors alone until the body rests and
    /// the others may be tried again.
    async fn do_without(
        &mut self,
        reason: Refusal,
        base: Option<&Compensation>,
    ) -> Result<(), Refusal> {
        let shared = self.outlet.shared();
        if !shared.is_kept.get() {
            return Err(reason);
        }
        self.coarse.beside(pin!(pause(reason, shared)), base, shared).await;
        self.renew();
        Ok(())
    }
}

/// Waits until the body rests and sensors that were given up may be tried again; they are the reason for which the
/// alignment that runs, and any that begins meanwhile, ends.
async fn pause(reason: Refusal, shared: &Shared<'_>) {
    let until = Instant::now() + RETRY;
    let mut ticker = Ticker::every(shared.period.get());
    shared.without_sensors.set(Some(reason));
    shared.fail(reason);
    while Instant::now() < until || !shared.is_at_rest.get() {
        ticker.next().await;
        shared.count(|health| health.samples = health.samples.saturating_add(1));
    }
    shared.without_sensors.set(None);
}
