//! Converters in step: awaited and read in succession, restarted where one loses synchronism.
//!
//! They share one clock and are started in succession, again whenever one of them had to be
//! restarted. A converter that converts at other times than the others is detected by its
//! data-ready line.

use core::task::Poll;

use drivers::data_ready::Edge;
use embassy_futures::poll_once;
use embassy_time::{Duration, Timer, with_timeout};
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::math;
use orientation::units::AngularRate;

use super::Pace;
use super::rates::{Rates, silence};
use crate::ports::{InStep, Quantity};
use crate::retry_budget::Symptom;
use crate::shared::Shared;

/// Number of successive conversions that may be out of step: a single lost edge of a data-ready
/// line is no reason for a restart.
const MOST_OUT_OF_STEP: u8 = 3;
/// Time by which conversions may end apart in any case, µs: they are begun one after the other, some
/// 8 µs each, and a critical section may delay the stamps of some.
const APART: u64 = 50;

/// Group of `N` converters with sensors that measure values `V`.
pub(super) struct Group<'a, C, const N: usize, V = AngularRate> {
    /// Converters with their checks.
    converters: [Rates<'a, C, V>; N],
    /// Channels to the other tasks.
    shared: &'a Shared<'a>,
    /// Sample period, µs.
    period: u32,
    /// Time without a conversion after which a converter counts as silent.
    silence: Duration,
    /// Number of successive conversions that were out of step.
    out_of_step: u8,
    /// Pace at which conversions are read.
    pace: Pace,
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
        let (silence, pace) = (silence(period), Pace::default());
        Self { converters: taken, shared, period, silence, out_of_step: 0, pace }
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

    /// Waits for a conversion of every converter; returns the ends, or none after a fault. They end
    /// together, and an end that has come is returned at once, so one is awaited after the other.
    pub(super) async fn conversions(&mut self) -> Result<Option<[Edge; N]>, Refusal> {
        self.pace.rest().await;
        let (mut ends, mut come) = ([Edge::default(); N], 0);
        let all = async {
            for (end, converter) in ends.iter_mut().zip(&mut self.converters) {
                *end = converter.gyro.device.ready().await.map_err(Symptom::Chip)?;
                come += 1;
            }
            Ok(())
        };
        if let Err(symptom) =
            with_timeout(self.silence, self.pace.note(all)).await.unwrap_or(Err(Symptom::Silent))
        {
            return self.mend(come, symptom).await;
        }
        self.catch_up(&mut ends);
        Ok(Some(ends))
    }

    /// Looks again at converters whose end was seen just before the others ended another conversion.
    fn catch_up(&mut self, ends: &mut [Edge; N]) {
        let latest = ends.iter().map(|end| end.at.0).max().unwrap_or(0);
        let near = latest.saturating_sub(self.apart());
        for (converter, end) in self.converters.iter_mut().zip(ends) {
            if end.at.0 < near
                && let Poll::Ready(Ok(later)) = poll_once(converter.gyro.device.ready())
            {
                *end = later;
            }
        }
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
        if self.converters[index].gyro.mend(symptom, self.shared).await? {
            self.begin().await;
        }
        Ok(None)
    }

    /// Whether all converted in step. Otherwise all are read again half a period later, when no
    /// conversion is near; if that does not help, the deviating one is restarted.
    pub(super) async fn are_in_step(&mut self, ends: &[Edge; N]) -> Result<bool, Refusal> {
        let Some(index) = self.outlier(ends) else {
            self.out_of_step = 0;
            return Ok(true);
        };
        self.out_of_step += 1;
        if self.out_of_step > MOST_OUT_OF_STEP {
            self.mend::<()>(index, Symptom::OutOfStep).await?;
        } else {
            self.shared.lose(self.converters[index].gyro.name, Symptom::OutOfStep);
            Timer::after_micros(u64::from(self.period / 2)).await;
            self.values().await?;
        }
        Ok(false)
    }

    /// Time by which conversions that are in step may end apart, µs: a quarter of a period.
    fn apart(&self) -> u64 {
        APART.max(u64::from(self.period / 4))
    }

    /// Converter whose conversion ended furthest from the median, where that is too far: the
    /// majority is right.
    fn outlier(&self, ends: &[Edge; N]) -> Option<usize> {
        let Edge { at: middle, .. } = middle(ends);
        let beside = |index: &usize| ends[*index].at.0.abs_diff(middle.0);
        (0..N).max_by_key(beside).filter(|index| beside(index) > self.apart())
    }
}

/// Median of the ends of an odd number of conversions, with the count of the first converter.
pub(super) fn middle<const N: usize>(ends: &[Edge; N]) -> Edge {
    let mut times = ends.map(|end| end.at);
    math::sort(&mut times, |a, b| a < b);
    Edge { at: times[N / 2], count: ends[0].count }
}
