//! Samples of three gyros and three accelerometers that are fixed to a vehicle.
//!
//! A conversion of each gyro makes a sample, so the three are synchronised. The rotation during a
//! lost conversion is unknown; such a sample is not passed on, and the jump in time reports the
//! loss to the session. A rate lasts for one period of the oscillator that feeds all three, whatever
//! the controller's clock shows.

use core::convert::Infallible;

use orientation::alignment::refusal::Refusal;
use orientation::device::TRIAD;
use orientation::navigation::Motion;
use orientation::signal::InertialSample;
use orientation::units::{AngularRate, SpecificForce};

use super::forces::Forces;
use super::in_step::Group;
use super::one_by_one::OneByOne;
use super::outlet::Outlet;
use super::{Source, increments};
use crate::configuration::{VehicleConfiguration, nanoseconds, period};
use crate::ports::{Accelerometer, ForceReading, InStep, VehicleSensors};
use crate::shared::Channels;

/// Acquisition of the sensors of a vehicle.
pub struct TriadAcquisition<'a, G, A> {
    gyros: Group<'a, G, OneByOne<AngularRate, 3>, 3>,
    forces: Forces<'a, A>,
    mean: Mean,
    outlet: Outlet<'a, InertialSample>,
    /// Sample period, ns.
    period: u32,
    /// Remainders of the rotation in whole steps, 10⁻¹⁸ rad.
    carried: [i64; 3],
}

impl<'a, G: InStep, A: Accelerometer> TriadAcquisition<'a, G, A> {
    /// Takes the sensors; nothing is started yet.
    pub fn new(
        sensors: &'a mut VehicleSensors<G, A>,
        configuration: &VehicleConfiguration,
        channels: &'a Channels<'a, InertialSample>,
    ) -> Self {
        let VehicleConfiguration { sample_rate, force_divider, forces } = *configuration;
        let period = period(sample_rate);
        let VehicleSensors { gyros, accelerometer } = sensors;
        Self {
            gyros: Group::new(
                (gyros, OneByOne::default()),
                TRIAD,
                sample_rate,
                period,
                &channels.shared,
            ),
            forces: Forces::new(accelerometer, force_divider, sample_rate),
            mean: Mean::of(forces),
            outlet: Outlet::new(period, period, channels),
            period: nanoseconds(sample_rate),
            carried: [0; 3],
        }
    }

    /// Takes the next sample; [`None`] where a reading was lost.
    ///
    /// # Errors
    /// A sensor is given up.
    async fn sample(&mut self) -> Result<Option<InertialSample>, Refusal> {
        let Some((end, rates)) = self.gyros.next().await? else { return Ok(None) };
        let shared = self.outlet.shared();
        let reading = match self.forces.read(shared).await {
            Ok(reading) => reading,
            Err(symptom) => self.forces.mend(symptom, shared).await?,
        };
        let force = reading.and_then(|reading| self.mean.push(reading));
        let Some(rates) = rates else { return Ok(None) };
        self.outlet.judge(end);
        let turned = increments(rates, self.period.into(), &mut self.carried);
        let sample = InertialSample { time: self.outlet.time(end), turned, force };
        shared.move_on(Motion::Moved(sample));
        Ok(Some(sample))
    }
}

impl<'a, G: InStep, A: Accelerometer> Source<'a> for TriadAcquisition<'a, G, A> {
    type Sample = InertialSample;

    fn outlet(&mut self) -> &mut Outlet<'a, InertialSample> {
        &mut self.outlet
    }

    async fn start(&mut self) -> Result<(), Refusal> {
        self.forces.accelerometer.start(self.outlet.shared()).await?;
        self.gyros.start().await
    }

    async fn run(&mut self) -> Result<Infallible, Refusal> {
        loop {
            if let Some(sample) = self.sample().await? {
                self.outlet.hand_over(sample);
            }
        }
    }

    fn renew(&mut self) {
        self.forces.renew();
        self.gyros.renew();
    }
}

/// Mean of a fixed number of successive forces.
#[derive(Clone, Copy, Debug)]
struct Mean {
    /// Number of forces of a mean.
    of: u32,
    /// Number of forces so far.
    count: u32,
    /// Sums of the forces, µm/s².
    sums: [i64; 3],
    /// Whether one of them was saturated.
    is_clipped: bool,
}

impl Mean {
    /// Mean before the first force.
    fn of(forces: u32) -> Self {
        Self { of: forces.max(1), count: 0, sums: [0; 3], is_clipped: false }
    }

    /// Adds a force; returns the mean, rounded towards zero, once there are enough forces and none
    /// was saturated.
    fn push(&mut self, reading: ForceReading) -> Option<[SpecificForce; 3]> {
        for (sum, part) in self.sums.iter_mut().zip(reading.force) {
            *sum += i64::from(part.0);
        }
        self.is_clipped |= reading.is_clipped;
        self.count += 1;
        if self.count < self.of {
            return None;
        }
        let Self { sums, count, is_clipped, .. } = core::mem::replace(self, Self::of(self.of));
        let mean = sums.map(|sum| SpecificForce((sum / i64::from(count)) as i32));
        (!is_clipped).then_some(mean)
    }
}
