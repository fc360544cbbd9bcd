//! Converters in step: read together, restarted where one loses synchronism.
//!
//! They share one clock and are started in succession, again whenever one of them had to be
//! restarted. A converter that converts at other times than the others is detected by its
//! data-ready line.

use core::pin::pin;

use drivers::data_ready::Edge;
use drivers::fault::Fault;
use embassy_time::{Duration, Timer};
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::math;
use orientation::units::{AngularRate, Instant};

use super::Pace;
use super::rates::{Rates, silence};
use crate::ports::{InStep, Quantity, Together};
use crate::retry_budget::Symptom;
use crate::shared::Shared;

/// Number of successive conversions that may be out of step: a single lost edge of a data-ready
/// line is no reason for a restart.
const MOST_OUT_OF_STEP: u8 = 3;
/// Time by which conversions may end apart in any case, µs: they are begun one after the other, some
/// 8 µs each, and an interrupt may come between.
const APART: u64 = 50;

/// Group of `N` converters with sensors that measure values `V`.
pub(super) struct Group<'a, C, R, const N: usize, V = AngularRate> {
    /// Converters with their checks.
    converters: [Rates<'a, C, V>; N],
    /// How they are read.
    reader: R,
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

impl<'a, C: InStep<V>, R: Together<C, V, N>, V: Quantity, const N: usize> Group<'a, C, R, N, V> {
    /// Takes converters with a period in µs, each with its name in the log; nothing is started yet.
    pub(super) fn new(
        (converters, reader): (&'a mut [C; N], R),
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
        Self { converters: taken, reader, shared, period, silence, out_of_step: 0, pace }
    }

    /// Starts all converters, and their conversions in step; none converts meanwhile.
    pub(super) async fn start(&mut self) -> Result<(), Refusal> {
        for converter in &mut self.converters {
            converter.gyro.start(self.shared).await?;
            let armed = converter.gyro.device.arm().await;
            tell(armed, converter, self.shared);
        }
        self.begin().await;
        Ok(())
    }

    /// Restores the full retry budget of all converters.
    pub(super) fn renew(&mut self) {
        self.converters.iter_mut().for_each(Rates::renew);
    }

    /// Stops all converters, and starts their conversions in step.
    async fn begin_anew(&mut self) {
        for converter in &mut self.converters {
            let armed = converter.gyro.device.arm().await;
            tell(armed, converter, self.shared);
        }
        self.begin().await;
    }

    /// Begins the conversions of all converters, one right after the other.
    async fn begin(&mut self) {
        for converter in &mut self.converters {
            let begun = converter.gyro.device.begin().await;
            tell(begun, converter, self.shared);
        }
        self.out_of_step = 0;
    }

    /// How many conversions of every converter are kept although none is taken.
    pub(super) fn room(&self) -> usize {
        self.reader.room()
    }

    /// Takes none for so long: others have had their turn then, so that no other rest is due soon.
    pub(super) async fn rest_for(&mut self, time: Duration) {
        self.pace.rest_for(time).await;
    }

    /// End of a converter's conversion among those taken last.
    pub(super) fn end(&self, index: usize) -> Edge {
        self.reader.end(index)
    }

    /// Takes the next conversion of every converter: the median of their ends, with the count of the first, and their
    /// values, where all were read; none after a fault.
    pub(super) async fn next(&mut self) -> Result<Option<(Edge, Option<[V; N]>)>, Refusal> {
        self.pace.rest().await;
        if let Err(symptom) = self.conversions().await {
            return self.mend(self.reader.awaited(), symptom).await;
        }
        let values = self.values().await?;
        let ends = Ends::of(core::array::from_fn(|index| self.reader.end(index)));
        let is_in_step = self.are_in_step(&ends).await?;
        Ok(is_in_step.then_some((ends.middle, values)))
    }

    /// Waits for the conversions, and reads them.
    async fn conversions(&mut self) -> Result<(), Symptom> {
        let apart = self.apart();
        let converters = self.converters.each_mut().map(|converter| &mut *converter.gyro.device);
        let read = pin!(self.reader.next(converters, apart));
        let outcome = self.pace.within(self.silence, read).await;
        outcome.map_err(|_| Symptom::Silent)?.map_err(Symptom::Chip)
    }

    /// Values of the conversions; all are taken, even if one fails.
    async fn values(&mut self) -> Result<Option<[V; N]>, Refusal> {
        let mut values = [V::default(); N];
        let mut is_whole = true;
        for (index, value) in values.iter_mut().enumerate() {
            let converter = &mut self.converters[index];
            let checked = match self.reader.reading(index) {
                Err(Fault::Hung) => converter.read_again(self.shared).await,
                reading => converter.check(reading, self.shared),
            };
            match checked {
                Ok(Some(new)) => *value = new,
                Ok(None) => is_whole = false,
                Err(symptom) => {
                    is_whole = false;
                    self.mend::<()>(index, symptom).await?;
                }
            }
        }
        Ok(is_whole.then_some(values))
    }

    /// Logs a converter's symptom and repairs it. A restarted converter has lost its step, so all
    /// are started again.
    async fn mend<T>(&mut self, index: usize, symptom: Symptom) -> Result<Option<T>, Refusal> {
        if self.converters[index].gyro.mend(symptom, self.shared).await? {
            self.begin_anew().await;
        }
        Ok(None)
    }

    /// Whether all converted in step. Otherwise all are read again half a period later, when no
    /// conversion is near; if that does not help, the deviating one is restarted.
    async fn are_in_step(&mut self, ends: &Ends<N>) -> Result<bool, Refusal> {
        if ends.beside <= self.apart() {
            self.out_of_step = 0;
            return Ok(true);
        }
        self.out_of_step += 1;
        if self.out_of_step > MOST_OUT_OF_STEP {
            self.mend::<()>(ends.outlier(), Symptom::OutOfStep).await?;
        } else {
            self.shared.lose(self.converters[ends.outlier()].gyro.name, Symptom::OutOfStep);
            Timer::after_micros(u64::from(self.period / 2)).await;
            self.read_again().await?;
        }
        Ok(false)
    }

    /// Reads all converters once more, whatever they have.
    async fn read_again(&mut self) -> Result<(), Refusal> {
        for index in 0..N {
            if let Err(symptom) = self.converters[index].read(self.shared).await {
                self.mend::<()>(index, symptom).await?;
            }
        }
        Ok(())
    }

    /// Time by which conversions that are in step may end apart, µs: a quarter of a period.
    fn apart(&self) -> u64 {
        APART.max(u64::from(self.period / 4))
    }
}

/// Counts and reports a failure of a converter to begin, which shows as silence later.
fn tell<C, V>(outcome: Result<(), Fault>, converter: &Rates<'_, C, V>, shared: &Shared<'_>) {
    if let Err(fault) = outcome {
        shared.lose(converter.gyro.name, Symptom::Chip(fault));
    }
}

/// Ends of the conversions of an odd number of converters.
struct Ends<const N: usize> {
    /// Time of the end of each after that of the first, µs; it wraps.
    after: [i32; N],
    /// Their median, with the count of the first converter.
    middle: Edge,
    /// Median of the times after the first, µs.
    median: i32,
    /// Greatest distance of one from the median, µs.
    beside: u64,
}

impl<const N: usize> Ends<N> {
    /// Compares ends.
    fn of(ends: [Edge; N]) -> Self {
        let Edge { at: first, count } = ends[0];
        let after = ends.map(|end| (end.at.0 as u32).wrapping_sub(first.0 as u32).cast_signed());
        let mut sorted = after;
        // As they are begun, one after the other.
        if !sorted.is_sorted() {
            math::sort(&mut sorted, |a, b| a < b);
        }
        let median = sorted[N / 2];
        let beside = (sorted[N - 1] - median).max(median - sorted[0]);
        let at = Instant(first.0.wrapping_add_signed(median.into()));
        Self { after, middle: Edge { at, count }, median, beside: beside as u64 }
    }

    /// Converter whose conversion ended furthest from the median: the majority is right.
    fn outlier(&self) -> usize {
        let beside = |index: &usize| self.after[*index].abs_diff(self.median);
        (0..N).max_by_key(beside).unwrap_or_default()
    }
}
