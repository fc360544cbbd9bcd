//! Conversions of a gyro: awaited, read, and checked.

use core::pin::pin;

use drivers::data_ready::Edge;
use drivers::fault::Fault;
use embassy_futures::select::{Either, select};
use embassy_time::Duration;
use orientation::device::Device;
use orientation::units::AngularRate;

use super::{Pace, Plausibility, SILENCE};
use crate::event::Event;
use crate::guarded::Guarded;
use crate::ports::{Gyro, Quantity, RateReading};
use crate::retry_budget::Symptom;
use crate::shared::Shared;

/// State of a gyro's conversions.
pub(super) struct Rates<'a, G, V = AngularRate> {
    /// Gyro with its retry budget.
    pub(super) gyro: Guarded<'a, G>,
    /// Checks of its readings.
    plausibility: Plausibility<V>,
    /// A conversion that ended while something else was awaited.
    next: Option<Result<Edge, Fault>>,
    /// Pace at which conversions are read.
    pace: Pace,
    /// Whether it was reported that the gyro came to the limit of its range: once is enough for a log.
    has_clipped: bool,
}

/// Least such time: a board may bring the conversions of fast converters some at a time.
const LEAST_SILENCE: Duration = Duration::from_millis(2);

/// Time without a conversion after which a gyro with this period, µs, counts as silent.
pub(super) fn silence(period: u32) -> Duration {
    Duration::from_micros(u64::from(period) * u64::from(SILENCE)).max(LEAST_SILENCE)
}

impl<'a, V: Quantity, G: Gyro<V>> Rates<'a, G, V> {
    /// Takes a gyro with this sample rate, Hz, by its name in the log.
    pub(super) fn new(gyro: &'a mut G, name: Device, sample_rate: f64) -> Self {
        Self {
            gyro: Guarded::new(gyro, name),
            plausibility: Plausibility::new(sample_rate),
            next: None,
            pace: Pace::default(),
            has_clipped: false,
        }
    }

    /// Waits for something else, until the next conversion at the longest.
    pub(super) async fn until_next(&mut self, awaited: impl Future<Output = ()>) {
        if self.next.is_none()
            && let Either::Second(end) = select(awaited, self.gyro.device.ready()).await
        {
            self.next = Some(end);
        }
    }

    /// Restores the full retry budget.
    pub(super) fn renew(&mut self) {
        self.gyro.renew();
        self.plausibility.saturated = 0;
        self.has_clipped = false;
    }

    /// Waits for a conversion, at most for `silence`; returns its end, or the symptom to repair.
    pub(super) async fn conversion(&mut self, silence: Duration) -> Result<Edge, Symptom> {
        if let Some(end) = self.next.take() {
            return end.map_err(Symptom::Chip);
        }
        self.pace.rest().await;
        match self.pace.within(silence, pin!(self.gyro.device.ready())).await {
            Ok(end) => end.map_err(Symptom::Chip),
            Err(_) => Err(Symptom::Silent),
        }
    }

    /// Returns a new rate, checked for saturation and repetition; none where it is not new, or the
    /// symptom to repair.
    pub(super) async fn read(&mut self, shared: &Shared<'_>) -> Result<Option<V>, Symptom> {
        let outcome = self.gyro.device.read().await;
        if outcome == Err(Fault::Hung) {
            return self.read_again(shared).await;
        }
        self.check(outcome, shared)
    }

    /// Reads once more after a transfer that its bus has given up: the conversion is still there, although the
    /// converter may take it for read.
    pub(super) async fn read_again(&mut self, shared: &Shared<'_>) -> Result<Option<V>, Symptom> {
        shared.lose(self.gyro.name, Symptom::Chip(Fault::Hung));
        let outcome = self.gyro.device.read().await;
        self.check(outcome.map(|reading| RateReading { is_new: true, ..reading }), shared)
    }

    /// Checks what was read.
    pub(super) fn check(
        &mut self,
        outcome: Result<RateReading<V>, Fault>,
        shared: &Shared<'_>,
    ) -> Result<Option<V>, Symptom> {
        let RateReading { rate, is_new } = self.gyro.checked(outcome)?;
        if !is_new {
            return Ok(None);
        }
        if rate.is_saturated() && !core::mem::replace(&mut self.has_clipped, true) {
            shared.report(Event::Clipped(self.gyro.name));
        }
        self.plausibility.judge(rate, rate.is_saturated(), 1)?;
        Ok(Some(rate))
    }
}
