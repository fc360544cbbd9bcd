//! Samples of one gyro that a stage or a platform turns.
//!
//! The conversion sets the time; encoder and accelerometer are read right after it, with every
//! so-manieth sample: between, the stage cannot have turned far, and the force is only averaged.
//! Without a good rate and a good angle there is no sample.

use core::convert::Infallible;

use embassy_time::Duration;
use orientation::device::Device;
use orientation::error::Refusal;
use orientation::signal::Sample;
use orientation::units::AngularRate;

use super::forces::Forces;
use super::outlet::Outlet;
use super::rates::{Rates, silence};
use crate::configuration::Configuration;
use crate::pointing::Pointing;
use crate::ports::{Accelerometer, Gyro, Observer};
use crate::shared::Seams;
use crate::steady::Steady;

/// The sensors of the stage path at work.
pub struct Acquisition<'a, G, A, P, S, O> {
    rates: Rates<'a, G>,
    forces: Forces<'a, A>,
    pointing: P,
    steady: S,
    outlet: Outlet<'a, O, Sample>,
    silence: Duration,
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
        seams: &'a Seams<'a, O>,
    ) -> Self {
        let period = configuration.period();
        let Configuration { sample_rate, force_divider, .. } = *configuration;
        Self {
            rates: Rates::new(gyro, Device::Gyro, sample_rate),
            forces: Forces::new(accelerometer, force_divider, sample_rate),
            pointing,
            steady,
            outlet: Outlet::new(period, seams),
            silence: silence(period),
        }
    }

    /// Samples until a sensor is given up; gives the reason.
    pub async fn run(&mut self) -> Refusal {
        match self.sample_for_ever().await {
            Ok(never) => match never {},
            Err(reason) => reason,
        }
    }

    async fn sample_for_ever(&mut self) -> Result<Infallible, Refusal> {
        let shared = self.outlet.shared;
        self.forces.start(shared).await?;
        self.pointing.start().await?;
        self.steady.start(shared).await?;
        self.rates.gyro.start(shared).await?;
        loop {
            if let Some(sample) = self.sample().await? {
                self.outlet.hand_over(sample);
            }
        }
    }

    /// The next sample, or none where a reading was lost.
    async fn sample(&mut self) -> Result<Option<Sample>, Refusal> {
        let shared = self.outlet.shared;
        let time = match self.rates.conversion(self.silence).await {
            Ok(time) => time,
            Err(symptom) => return self.rates.gyro.mend(symptom, shared).await.map(|()| None),
        };
        let rate = self.rate().await?;
        self.steady.follow(shared).await?;
        if !self.steady.is_decided() {
            shared.count(|health| health.samples += 1);
            return Ok(None);
        }
        let shown = self.pointing.read().await?;
        let force = self.forces.read(shared).await?.filter(|reading| !reading.is_clipped);
        let (Some(rate), Some(shown)) = (rate, shown) else { return Ok(None) };
        self.outlet.judge(time);
        let aim = self.pointing.aim(shown);
        Ok(Some(Sample {
            time: orientation::units::Instant(time.as_micros()),
            stage: aim.heading,
            rate: self.steady.steadied(rate, aim.heading),
            force: force.map(|reading| reading.force),
            temperature: force.map(|reading| reading.temperature),
            elevation: aim.elevation.filter(|_| force.is_some()),
        }))
    }

    async fn rate(&mut self) -> Result<Option<AngularRate>, Refusal> {
        let shared = self.outlet.shared;
        match self.rates.read(shared).await? {
            Ok(rate) => Ok(rate),
            Err(symptom) => self.rates.gyro.mend(symptom, shared).await.map(|()| None),
        }
    }
}
