//! Converters in step that are awaited and read one after the other.

use core::task::Poll;

use drivers::data_ready::Edge;
use drivers::fault::Fault;
use embassy_futures::poll_once;

use crate::ports::{Gyro, Quantity, RateReading, Together};

/// Reads converters in step one after the other.
#[derive(Debug)]
pub struct OneByOne<V, const N: usize> {
    /// Ends of the latest conversions.
    ends: [Edge; N],
    /// What was read of them.
    readings: [Result<RateReading<V>, Fault>; N],
    /// The converter whose conversion is awaited.
    awaited: usize,
}

impl<V: Quantity, const N: usize> Default for OneByOne<V, N> {
    fn default() -> Self {
        let nothing = RateReading { rate: V::default(), is_new: false };
        Self { ends: [Edge::default(); N], readings: [Ok(nothing); N], awaited: 0 }
    }
}

impl<V: Quantity, C: Gyro<V>, const N: usize> Together<C, V, N> for OneByOne<V, N> {
    /// They end one right after the other, as they were begun, and an end that has come is returned at once: so the last
    /// one is awaited first, and wakes the task once for all.
    async fn next(&mut self, mut converters: [&mut C; N], apart: u64) -> Result<(), Fault> {
        for (index, converter) in converters.iter_mut().enumerate().rev() {
            self.awaited = index;
            self.ends[index] = converter.ready().await?;
        }
        self.catch_up(&mut converters, apart);
        for (reading, converter) in self.readings.iter_mut().zip(&mut converters) {
            *reading = converter.read().await;
        }
        Ok(())
    }

    fn end(&self, index: usize) -> Edge {
        self.ends[index]
    }

    fn reading(&self, index: usize) -> Result<RateReading<V>, Fault> {
        self.readings[index]
    }

    fn awaited(&self) -> usize {
        self.awaited
    }
}

impl<V, const N: usize> OneByOne<V, N> {
    /// Looks again at converters whose end was seen just before the others ended another conversion.
    fn catch_up<C: Gyro<V>>(&mut self, converters: &mut [&mut C; N], apart: u64) {
        let latest = self.ends.iter().map(|end| end.at.0).max().unwrap_or(0);
        let near = latest.saturating_sub(apart);
        for (converter, end) in converters.iter_mut().zip(&mut self.ends) {
            if end.at.0 < near
                && let Poll::Ready(Ok(later)) = poll_once(converter.ready())
            {
                *end = later;
            }
        }
    }
}
