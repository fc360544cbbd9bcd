//! Converters in step: awaited together, read in succession, restarted where one loses synchronism.
//!
//! They share one clock and are started in succession, again whenever one of them had to be
//! restarted. A converter that converts at other times than the others is detected by its
//! data-ready line.

use core::cell::Cell;

use drivers::fault::Fault;
use embassy_futures::join::join_array;
use embassy_time::{Duration, Instant, Timer, with_timeout};
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::math;
use orientation::units::AngularRate;

use super::rates::{Rates, silence};
use crate::ports::{InStep, Quantity};
use crate::retry_budget::Symptom;
use crate::shared::Shared;

/// Number of successive conversions that may be out of step: a single lost edge of a data-ready
/// line is no reason for a restart.
const MOST_OUT_OF_STEP: u8 = 3;

/// Arrival of a conversion: its end, or the fault of the chip; none while it is awaited.
type Arrival = Cell<Option<Result<Instant, Fault>>>;

/// Group of `N` converters with sensors that measure values `V`.
pub(super) struct Group<'a, C, const N: usize, V = AngularRate> {
    /// Converters with their checks.
    converters: [Rates<'a, C, V>; N],
    /// Channels to the other tasks.
    shared: &'a Shared<'a>,
    /// Sample period.
    period: Duration,
    /// Time without a conversion after which a converter counts as silent.
    silence: Duration,
    /// Number of successive conversions that were out of step.
    out_of_step: u8,
}

impl<'a, C: InStep<V>, V: Quantity, const N: usize> Group<'a, C, N, V> {
    /// Takes converters with a period in µs, each with its name in the log; nothing is started yet.
    pub(super) fn new(
        converters: &'a mut [C; N],
        names: [Device; N],
        sample_rate: f64,
        period: u32,
        shared: &'a Shared<'a>,
    ) -> Self {
        let mut names = names.into_iter();
        let taken = converters.each_mut().map(|converter| {
            let name = names.next().unwrap_or(Device::Gyro);
            Rates::new(converter, name, sample_rate)
        });
        Self {
            converters: taken,
            shared,
            period: Duration::from_micros(period.into()),
            silence: silence(period),
            out_of_step: 0,
        }
    }

    /// Starts all converters, and their conversions in step.
    pub(super) async fn start(&mut self) -> Result<(), Refusal> {
        for converter in &mut self.converters {
            converter.gyro.start(self.shared).await?;
        }
        self.begin().await;
        Ok(())
    }

    /// Restores the full retry budget of all converters.
    pub(super) fn renew(&mut self) {
        self.converters.iter_mut().for_each(Rates::renew);
    }

    /// Starts the conversions of all converters in step. A failure shows as silence later.
    async fn begin(&mut self) {
        for converter in &mut self.converters {
            if let Err(fault) = converter.gyro.device.arm().await {
                self.shared.lose(converter.gyro.name, Symptom::Chip(fault));
            }
        }
        for converter in &mut self.converters {
            if let Err(fault) = converter.gyro.device.begin().await {
                self.shared.lose(converter.gyro.name, Symptom::Chip(fault));
            }
        }
        self.out_of_step = 0;
    }

    /// Waits for a conversion of every converter; returns the end of each, or none after a fault.
    pub(super) async fn conversions(&mut self) -> Result<Option<[Instant; N]>, Refusal> {
        let arrivals = [const { Arrival::new(None) }; N];
        {
            let mut each = arrivals.iter();
            // There are as many arrivals as converters, so the default is never used.
            let none = Arrival::new(None);
            let waits = self
                .converters
                .each_mut()
                .map(|converter| arrive(converter, each.next().unwrap_or(&none)));
            // A missing conversion is detected below.
            let _ = with_timeout(self.silence, join_array(waits)).await;
        }
        let mut times = [Instant::MIN; N];
        for (index, (time, arrival)) in times.iter_mut().zip(&arrivals).enumerate() {
            *time = match arrival.get() {
                Some(Ok(at)) => at,
                Some(Err(fault)) => return self.mend(index, Symptom::Chip(fault)).await,
                None => return self.mend(index, Symptom::Silent).await,
            };
        }
        Ok(Some(times))
    }

    /// Values of the conversions; all are read, even if one fails.
    pub(super) async fn values(&mut self) -> Result<Option<[V; N]>, Refusal> {
        let mut values = [None; N];
        for (index, value) in values.iter_mut().enumerate() {
            *value = match self.converters[index].read(self.shared).await {
                Ok(value) => value,
                Err(symptom) => self.mend(index, symptom).await?,
            };
        }
        let is_whole = values.iter().all(Option::is_some);
        Ok(is_whole.then(|| values.map(Option::unwrap_or_default)))
    }

    /// Logs a converter's symptom and repairs it. A restarted converter has lost its step, so all
    /// are started again.
    async fn mend<T>(&mut self, index: usize, symptom: Symptom) -> Result<Option<T>, Refusal> {
        let device = &mut self.converters[index].gyro;
        let restarts = device.restarts();
        device.mend(symptom, self.shared).await?;
        if self.converters[index].gyro.restarts() != restarts {
            self.begin().await;
        }
        Ok(None)
    }

    /// Whether all converted in step. Otherwise all are read again half a period later, when no
    /// conversion is near; if that does not help, the deviating one is restarted.
    pub(super) async fn are_in_step(
        &mut self,
        times: [Instant; N],
        time: Instant,
    ) -> Result<bool, Refusal> {
        let Some(index) = self.outlier(times, time) else {
            self.out_of_step = 0;
            return Ok(true);
        };
        self.out_of_step += 1;
        if self.out_of_step > MOST_OUT_OF_STEP {
            self.mend::<()>(index, Symptom::OutOfStep).await?;
        } else {
            self.shared.lose(self.converters[index].gyro.name, Symptom::OutOfStep);
            Timer::after(self.period / 2).await;
            self.values().await?;
        }
        Ok(false)
    }

    /// Converter whose conversion ended furthest from the median, where that is more than a quarter
    /// of a period: the majority is right.
    fn outlier(&self, times: [Instant; N], middle: Instant) -> Option<usize> {
        let beside = |index: &usize| times[*index].max(middle) - times[*index].min(middle);
        (0..N).max_by_key(beside).filter(|index| beside(index) > self.period / 4)
    }
}

/// Stores the time at which a conversion ended.
async fn arrive<C: InStep<V>, V: Quantity>(converter: &mut Rates<'_, C, V>, arrival: &Arrival) {
    let outcome = converter.gyro.device.ready().await;
    arrival.set(Some(outcome.map(|()| Instant::now())));
}

/// Median of an odd number of times.
pub(super) fn middle<const N: usize>(mut times: [Instant; N]) -> Instant {
    math::sort(&mut times, |a, b| a < b);
    times[N / 2]
}
