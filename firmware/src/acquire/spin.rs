//! Samples of three gyros and two accelerometers on a body in fast rotation.
//!
//! All five are analogue sensors behind synchronised converters, so that forces and rates belong to
//! one moment: a conversion is a mean, and belongs to its middle. From middle to middle a gyro has
//! turned by half of either conversion. A lost conversion shows in the next sample's time.

use core::convert::Infallible;

use embassy_time::Duration;
use orientation::device::Device;
use orientation::error::Refusal;
use orientation::signal::SpinSample;
use orientation::units::{AngleIncrement, Instant, SpinForce};

use super::in_step::{Group, middle};
use super::outlet::Outlet;
use crate::ports::{Code, InStep, Observer, Quantity, SpinSensors};
use crate::shared::Channels;
use crate::spin::configuration::{CHANNELS, GYROS, SpinConfiguration};

/// Names of the sensors in the log.
const NAMES: [Device; CHANNELS] = [
    Device::ForwardGyro,
    Device::UpGyro,
    Device::RightGyro,
    Device::UpAccelerometer,
    Device::RightAccelerometer,
];

/// Acquisition of the sensors of a spinning body.
pub struct SpinAcquisition<'a, C, O> {
    /// Converters of all sensors.
    converters: Group<'a, C, O, CHANNELS, Code>,
    /// Scale factors and rates.
    configuration: &'a SpinConfiguration,
    /// Outlet of samples.
    outlet: Outlet<'a, O, SpinSample>,
    /// Rotation of the gyros in the previous conversion, in steps of an increment.
    before: Option<[i32; GYROS]>,
    /// Remaining half steps.
    carried: [i64; GYROS],
}

impl<'a, C: InStep<Code>, O: Observer> SpinAcquisition<'a, C, O> {
    /// Takes the sensors; nothing is started yet.
    pub fn new(
        SpinSensors(converters): &'a mut SpinSensors<C>,
        configuration: &'a SpinConfiguration,
        channels: &'a Channels<'a, O, SpinSample>,
    ) -> Self {
        let (rate, period) = (configuration.sample_rate, configuration.period());
        Self {
            converters: Group::new(converters, NAMES, rate, period, &channels.shared),
            configuration,
            outlet: Outlet::new(period, channels),
            before: None,
            carried: [0; GYROS],
        }
    }

    /// Samples until a sensor is given up; returns the reason.
    pub async fn run(&mut self) -> Refusal {
        match self.sample_for_ever().await {
            Ok(never) => match never {},
            Err(reason) => reason,
        }
    }

    /// Starts the sensors and samples without end.
    async fn sample_for_ever(&mut self) -> Result<Infallible, Refusal> {
        self.converters.start().await?;
        loop {
            if let Some(sample) = self.sample().await? {
                self.outlet.hand_over(sample);
            }
        }
    }

    /// Takes the next sample; none where a reading was lost.
    async fn sample(&mut self) -> Result<Option<SpinSample>, Refusal> {
        let Some(times) = self.converters.conversions().await? else { return Ok(None) };
        let time = middle(times);
        let codes = self.converters.values().await?;
        if !self.converters.are_in_step(times, time).await? {
            return Ok(None);
        }
        let Some(codes) = codes else { return Ok(None) };
        self.outlet.judge(time);
        let half = Duration::from_micros(self.configuration.half_period().into());
        let time = Instant((time - half).as_micros());
        Ok(Some(SpinSample { time, turned: self.turned(&codes), force: self.force(&codes) }))
    }

    /// Rotation of the gyros since the middle of the previous conversion; for the first one as much
    /// as in a whole conversion.
    fn turned(&mut self, codes: &[Code; CHANNELS]) -> [AngleIncrement; GYROS] {
        let mut steps = [0; GYROS];
        for (axis, steps) in steps.iter_mut().enumerate() {
            *steps = self.configuration.gyros[axis].steps(codes[axis]);
        }
        let before = self.before.replace(steps).unwrap_or(steps);
        let mut turned = [AngleIncrement::default(); GYROS];
        for (axis, turned) in turned.iter_mut().enumerate() {
            *turned = between(before[axis], steps[axis], &mut self.carried[axis]);
        }
        turned
    }

    /// Specific forces up and right; [`None`] if one is saturated.
    fn force(&self, codes: &[Code; CHANNELS]) -> Option<[SpinForce; 2]> {
        let [_, _, _, up, right] = *codes;
        let [of_up, of_right] = &self.configuration.accelerometers;
        let force = [SpinForce(of_up.steps(up)), SpinForce(of_right.steps(right))];
        (!force.iter().any(|force| force.is_saturated())).then_some(force)
    }
}

/// Half of the sum of two increments; saturated where one of them is.
fn between(before: i32, now: i32, carried: &mut i64) -> AngleIncrement {
    for steps in [before, now] {
        if Code(steps).is_saturated() {
            return AngleIncrement(steps);
        }
    }
    let whole = i64::from(before) + i64::from(now) + *carried;
    *carried = whole & 1;
    AngleIncrement((whole >> 1) as i32)
}
