//! Samples of three gyros and three accelerometers that are fixed to a vehicle.
//!
//! A conversion of each gyro makes a sample, so the three convert in step: they have one clock and are
//! begun one right after the other, again whenever one of them had to be started. Whatever an axis has
//! turned in a conversion that was lost is not known to anybody; such a sample does not go out, and the
//! jump in time tells the session.

use core::cell::Cell;
use core::convert::Infallible;

use drivers::fault::Fault;
use embassy_futures::join::join3;
use embassy_time::{Duration, Instant, Timer, with_timeout};
use orientation::device::Device;
use orientation::error::Refusal;
use orientation::signal::InertialSample;
use orientation::units::{AngleIncrement, AngularRate, SpecificForce};

use super::forces::Forces;
use super::outlet::Outlet;
use super::rates::{Rates, silence};
use crate::configuration::VehicleConfiguration;
use crate::keep::Motion;
use crate::patience::Symptom;
use crate::ports::{Accelerometer, ForceReading, InStep, Observer, VehicleSensors};
use crate::shared::Seams;

/// The gyros' names in the log, forward, right, down.
const NAMES: [Device; 3] = [Device::ForwardGyro, Device::RightGyro, Device::DownGyro];

/// Conversions in a row that may be out of step: one lost edge of a data-ready line is no reason to
/// start anything again.
const STRAYS: u8 = 3;

/// What a conversion brought: when it ended, or what is wrong with the chip; none as long as it lasts.
type Arrival = Cell<Option<Result<Instant, Fault>>>;

/// The sensors of a vehicle at work.
pub struct TriadAcquisition<'a, G, A, O> {
    gyros: [Rates<'a, G>; 3],
    forces: Forces<'a, A>,
    mean: Mean,
    outlet: Outlet<'a, O, InertialSample>,
    period: Duration,
    silence: Duration,
    /// What was left over of the rotation in whole steps, 10⁻¹⁵ rad.
    carried: [i64; 3],
    /// When the latest conversions ended.
    latest: Option<Instant>,
    /// Conversions in a row that were out of step.
    strays: u8,
}

impl<'a, G: InStep, A: Accelerometer, O: Observer> TriadAcquisition<'a, G, A, O> {
    /// Takes the sensors; nothing is started yet.
    pub fn new(
        sensors: &'a mut VehicleSensors<G, A>,
        configuration: &VehicleConfiguration,
        seams: &'a Seams<'a, O, InertialSample>,
    ) -> Self {
        let period = configuration.period();
        let VehicleConfiguration { sample_rate, force_divider, forces, .. } = *configuration;
        let [forward, right, down] = &mut sensors.gyros;
        let [first, second, third] = NAMES;
        Self {
            gyros: [
                Rates::new(forward, first, sample_rate),
                Rates::new(right, second, sample_rate),
                Rates::new(down, third, sample_rate),
            ],
            forces: Forces::new(&mut sensors.accelerometer, force_divider, sample_rate),
            mean: Mean::of(forces),
            outlet: Outlet::new(period, seams),
            period: Duration::from_micros(period.into()),
            silence: silence(period),
            carried: [0; 3],
            latest: None,
            strays: 0,
        }
    }

    /// Samples; where a sensor is given up, tells why and tries again later if anybody keeps.
    pub async fn run_for_ever(&mut self) {
        loop {
            let Err(reason) = self.sample_for_ever().await;
            self.outlet.shared.fail(reason);
            self.outlet.shared.keep.rest().await;
            self.forces.renew();
            self.gyros.iter_mut().for_each(Rates::renew);
        }
    }

    async fn sample_for_ever(&mut self) -> Result<Infallible, Refusal> {
        let shared = self.outlet.shared;
        self.forces.start(shared).await?;
        for rates in &mut self.gyros {
            rates.gyro.start(shared).await?;
        }
        self.begin().await;
        loop {
            if let Some(sample) = self.sample().await? {
                shared.move_on(Motion::Moved(sample));
                self.outlet.hand_over(sample);
            }
        }
    }

    /// Has all gyros begin to convert in step. One that fails to will be found silent.
    async fn begin(&mut self) {
        for rates in &mut self.gyros {
            if let Err(fault) = rates.gyro.device.arm().await {
                self.outlet.shared.lose(rates.name, Symptom::Chip(fault));
            }
        }
        for rates in &mut self.gyros {
            if let Err(fault) = rates.gyro.device.begin().await {
                self.outlet.shared.lose(rates.name, Symptom::Chip(fault));
            }
        }
        self.strays = 0;
    }

    /// The next sample, or none where a reading was lost.
    async fn sample(&mut self) -> Result<Option<InertialSample>, Refusal> {
        let Some(times) = self.conversions().await? else { return Ok(None) };
        let time = middle(times);
        let lasted = self.lasted(time);
        let rates = self.rates().await?;
        if !self.are_in_step(times, time).await? {
            return Ok(None);
        }
        let reading = self.forces.read(self.outlet.shared).await?;
        let force = reading.and_then(|reading| self.mean.push(reading));
        let Some(rates) = rates else { return Ok(None) };
        self.outlet.judge(time);
        Ok(Some(InertialSample {
            time: orientation::units::Instant(time.as_micros()),
            turned: self.turned(rates, lasted),
            force,
        }))
    }

    /// Waits for a conversion of every gyro; when each ended.
    async fn conversions(&mut self) -> Result<Option<[Instant; 3]>, Refusal> {
        let arrivals = [const { Arrival::new(None) }; 3];
        {
            let [first, second, third] = &arrivals;
            let [forward, right, down] = &mut self.gyros;
            let all = join3(arrive(forward, first), arrive(right, second), arrive(down, third));
            // Who did not come is seen below.
            let _ = with_timeout(self.silence, all).await;
        }
        let mut times = [Instant::MIN; 3];
        for (axis, (time, arrival)) in times.iter_mut().zip(&arrivals).enumerate() {
            *time = match arrival.get() {
                Some(Ok(at)) => at,
                Some(Err(fault)) => return self.mend(axis, Symptom::Chip(fault)).await,
                None => return self.mend(axis, Symptom::Silent).await,
            };
        }
        Ok(Some(times))
    }

    /// The rates of the conversions; all are read, whatever is wrong with one.
    async fn rates(&mut self) -> Result<Option<[AngularRate; 3]>, Refusal> {
        let mut rates = [None; 3];
        for (axis, rate) in rates.iter_mut().enumerate() {
            *rate = match self.gyros[axis].read(self.outlet.shared).await? {
                Ok(rate) => rate,
                Err(symptom) => self.mend(axis, symptom).await?,
            };
        }
        let [forward, right, down] = rates;
        Ok(forward.zip(right).zip(down).map(|((forward, right), down)| [forward, right, down]))
    }

    /// Takes note of what is wrong with an axis and mends it. One that had to be started again has lost
    /// its step.
    async fn mend<T>(&mut self, axis: usize, symptom: Symptom) -> Result<Option<T>, Refusal> {
        let gyro = &mut self.gyros[axis].gyro;
        let restarts = gyro.restarts();
        gyro.mend(symptom, self.outlet.shared).await?;
        if self.gyros[axis].gyro.restarts() != restarts {
            self.begin().await;
        }
        Ok(None)
    }

    /// Whether all converted in step. If not, all are read again half a period later, when no conversion is
    /// near; where that does not help, the one that strays is started again.
    async fn are_in_step(&mut self, times: [Instant; 3], time: Instant) -> Result<bool, Refusal> {
        let Some(axis) = self.stray(times, time) else {
            self.strays = 0;
            return Ok(true);
        };
        self.strays += 1;
        if self.strays > STRAYS {
            self.mend::<()>(axis, Symptom::OutOfStep).await?;
        } else {
            self.outlet.shared.lose(NAMES[axis], Symptom::OutOfStep);
            Timer::after(self.period / 2).await;
            self.rates().await?;
        }
        Ok(false)
    }

    /// The gyro whose conversion ended furthest from the middle one, where that is more than a quarter of a
    /// period: of three, the two that agree are right.
    fn stray(&self, times: [Instant; 3], middle: Instant) -> Option<usize> {
        let beside = |axis: &usize| times[*axis].max(middle) - times[*axis].min(middle);
        (0..times.len()).max_by_key(beside).filter(|axis| beside(axis) > self.period / 4)
    }

    /// How long the conversions that ended then have lasted, µs: since the ones before, where those are
    /// known.
    fn lasted(&mut self, time: Instant) -> u32 {
        let since = self.latest.replace(time).map_or(Duration::MAX, |latest| time - latest);
        let beside = since.max(self.period) - since.min(self.period);
        let lasted = if beside <= self.period / 4 { since } else { self.period };
        lasted.as_micros() as u32
    }

    fn turned(&mut self, rates: [AngularRate; 3], microseconds: u32) -> [AngleIncrement; 3] {
        let [forward, right, down] = &mut self.carried;
        let [about_forward, about_right, about_down] = rates;
        [
            AngleIncrement::of_rate(about_forward, microseconds, forward),
            AngleIncrement::of_rate(about_right, microseconds, right),
            AngleIncrement::of_rate(about_down, microseconds, down),
        ]
    }
}

/// Notes when a conversion came.
async fn arrive<G: InStep>(rates: &mut Rates<'_, G>, arrival: &Arrival) {
    let outcome = rates.gyro.device.ready().await;
    arrival.set(Some(outcome.map(|()| Instant::now())));
}

/// The middle one of three times.
fn middle([first, second, third]: [Instant; 3]) -> Instant {
    let [low, high] = [first.min(second), first.max(second)];
    third.clamp(low, high)
}

/// The mean of so many forces in a row.
#[derive(Clone, Copy, Debug)]
struct Mean {
    of: u32,
    count: u32,
    /// µm/s².
    sums: [i64; 3],
    /// Whether one of them stood at the limit of the range.
    is_clipped: bool,
}

impl Mean {
    fn of(forces: u32) -> Self {
        Self { of: forces.max(1), count: 0, sums: [0; 3], is_clipped: false }
    }

    /// Adds a force; the mean, towards zero, once there are enough and none was clipped.
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
