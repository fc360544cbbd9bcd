//! Converters in step: waited for together, read one after the other, begun again where one strays.
//!
//! They have one clock and are begun one right after the other, again whenever one of them had to be
//! started. What converts at other times than the rest is told by its data-ready line.

use core::cell::Cell;

use drivers::fault::Fault;
use embassy_futures::join::join_array;
use embassy_time::{Duration, Instant, Timer, with_timeout};
use orientation::device::Device;
use orientation::error::Refusal;
use orientation::math;
use orientation::units::AngularRate;

use super::rates::{Rates, silence};
use crate::ports::{InStep, Observer, Quantity};
use crate::retry_budget::Symptom;
use crate::shared::Shared;

/// Conversions in a row that may be out of step: one lost edge of a data-ready line is no reason to
/// start anything again.
const STRAYS: u8 = 3;

/// What a conversion brought: when it ended, or what is wrong with the chip; none as long as it lasts.
type Arrival = Cell<Option<Result<Instant, Fault>>>;

/// `N` converters with sensors behind them that show values `V`.
pub(super) struct Group<'a, C, O, const N: usize, V = AngularRate> {
    converters: [Rates<'a, C, V>; N],
    shared: &'a Shared<'a, O>,
    period: Duration,
    silence: Duration,
    /// Conversions in a row that were out of step.
    strays: u8,
}

impl<'a, C: InStep<V>, O: Observer, V: Quantity, const N: usize> Group<'a, C, O, N, V> {
    /// Takes converters with a period in µs, each by its name in the log; nothing is started yet.
    pub(super) fn new(
        converters: &'a mut [C; N],
        names: [Device; N],
        sample_rate: f64,
        period: u32,
        shared: &'a Shared<'a, O>,
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
            strays: 0,
        }
    }

    /// Starts all of them, and their conversions in step.
    pub(super) async fn start(&mut self) -> Result<(), Refusal> {
        for converter in &mut self.converters {
            converter.gyro.start(self.shared).await?;
        }
        self.begin().await;
        Ok(())
    }

    /// Has all retry budget with them again.
    pub(super) fn renew(&mut self) {
        self.converters.iter_mut().for_each(Rates::renew);
    }

    /// Has all begin to convert in step. One that fails to will be found silent.
    async fn begin(&mut self) {
        for converter in &mut self.converters {
            if let Err(fault) = converter.gyro.device.arm().await {
                self.shared.lose(converter.name, Symptom::Chip(fault));
            }
        }
        for converter in &mut self.converters {
            if let Err(fault) = converter.gyro.device.begin().await {
                self.shared.lose(converter.name, Symptom::Chip(fault));
            }
        }
        self.strays = 0;
    }

    /// Waits for a conversion of every converter; when each ended.
    pub(super) async fn conversions(&mut self) -> Result<Option<[Instant; N]>, Refusal> {
        let arrivals = [const { Arrival::new(None) }; N];
        {
            let mut each = arrivals.iter();
            // Nobody waits without an arrival: there are as many.
            let none = Arrival::new(None);
            let waits = self
                .converters
                .each_mut()
                .map(|converter| arrive(converter, each.next().unwrap_or(&none)));
            // Who did not come is seen below.
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

    /// The values of the conversions; all are read, whatever is wrong with one.
    pub(super) async fn values(&mut self) -> Result<Option<[V; N]>, Refusal> {
        let mut values = [None; N];
        for (index, value) in values.iter_mut().enumerate() {
            *value = match self.converters[index].read(self.shared).await? {
                Ok(value) => value,
                Err(symptom) => self.mend(index, symptom).await?,
            };
        }
        let is_whole = values.iter().all(Option::is_some);
        Ok(is_whole.then(|| values.map(Option::unwrap_or_default)))
    }

    /// Takes note of what is wrong with a converter and mends it. One that had to be started again has lost
    /// its step.
    async fn mend<T>(&mut self, index: usize, symptom: Symptom) -> Result<Option<T>, Refusal> {
        let device = &mut self.converters[index].gyro;
        let restarts = device.restarts();
        device.mend(symptom, self.shared).await?;
        if self.converters[index].gyro.restarts() != restarts {
            self.begin().await;
        }
        Ok(None)
    }

    /// Whether all converted in step. If not, all are read again half a period later, when no conversion is
    /// near; where that does not help, the one that strays is started again.
    pub(super) async fn are_in_step(
        &mut self,
        times: [Instant; N],
        time: Instant,
    ) -> Result<bool, Refusal> {
        let Some(index) = self.stray(times, time) else {
            self.strays = 0;
            return Ok(true);
        };
        self.strays += 1;
        if self.strays > STRAYS {
            self.mend::<()>(index, Symptom::OutOfStep).await?;
        } else {
            self.shared.lose(self.converters[index].name, Symptom::OutOfStep);
            Timer::after(self.period / 2).await;
            self.values().await?;
        }
        Ok(false)
    }

    /// The converter whose conversion ended furthest from the middle one, where that is more than a quarter
    /// of a period: those that agree are right.
    fn stray(&self, times: [Instant; N], middle: Instant) -> Option<usize> {
        let beside = |index: &usize| times[*index].max(middle) - times[*index].min(middle);
        (0..N).max_by_key(beside).filter(|index| beside(index) > self.period / 4)
    }
}

/// Notes when a conversion came.
async fn arrive<C: InStep<V>, V: Quantity>(converter: &mut Rates<'_, C, V>, arrival: &Arrival) {
    let outcome = converter.gyro.device.ready().await;
    arrival.set(Some(outcome.map(|()| Instant::now())));
}

/// The middle one of an odd number of times.
pub(super) fn middle<const N: usize>(mut times: [Instant; N]) -> Instant {
    math::sort(&mut times, |a, b| a < b);
    times[N / 2]
}
