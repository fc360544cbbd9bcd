//! A gyro's conversions: waited for, read, and judged.

use drivers::fault::Fault;
use embassy_time::{Duration, Instant, with_timeout};
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::units::AngularRate;

use super::{Limit, RepeatCounter, SILENCE, STUCK};
use crate::event::Event;
use crate::guarded::Guarded;
use crate::ports::{Gyro, Observer, Quantity, RateReading};
use crate::retry_budget::Symptom;
use crate::shared::Shared;

/// Part of a period within which a conversion that was awaited was there before.
const AT_ONCE: u32 = 16;

/// A gyro at work.
pub(super) struct Rates<'a, G, V = AngularRate> {
    pub(super) gyro: Guarded<'a, G>,
    pub(super) name: Device,
    row: RepeatCounter<V>,
    limit: Limit,
    period: Duration,
    /// When the latest conversion ended.
    latest: Option<Instant>,
    /// Whether it was told that the gyro came to the limit of its range: once is enough for a log.
    has_clipped: bool,
}

/// Time without a conversion after which a gyro of that period, µs, is silent.
pub(super) fn silence(period: u32) -> Duration {
    Duration::from_micros(u64::from(period) * u64::from(SILENCE))
}

impl<'a, V: Quantity, G: Gyro<V>> Rates<'a, G, V> {
    /// Takes a gyro of so many samples a second by its name in the log.
    pub(super) fn new(gyro: &'a mut G, name: Device, sample_rate: f64) -> Self {
        let limit = Limit::new(sample_rate);
        let period = Duration::from_micros((1e6 / sample_rate + 0.5) as u64);
        Self {
            gyro: Guarded::new(gyro, name),
            name,
            row: RepeatCounter::new(),
            limit,
            period,
            latest: None,
            has_clipped: false,
        }
    }

    /// Has all retry budget with it again.
    pub(super) fn renew(&mut self) {
        self.gyro.renew();
        self.limit.samples = 0;
        self.has_clipped = false;
    }

    /// Waits for a conversion for so long; when it ended, or what is to be mended.
    pub(super) async fn conversion(&mut self, silence: Duration) -> Result<Instant, Symptom> {
        let asked = Instant::now();
        match with_timeout(silence, self.gyro.device.ready()).await {
            Ok(Ok(())) => {
                let ended = self.ended(asked, Instant::now());
                self.latest = Some(ended);
                Ok(ended)
            }
            Ok(Err(fault)) => Err(Symptom::Chip(fault)),
            Err(_) => Err(Symptom::Silent),
        }
    }

    /// When a conversion ended that was awaited from `asked` on and is there `now`. One that was there without a
    /// wait ended before, while another bus was read: it ended when it was due after the one before.
    fn ended(&self, asked: Instant, now: Instant) -> Instant {
        match self.latest {
            Some(latest) if now - asked < self.period / AT_ONCE => {
                let periods = (now - latest).as_micros() / self.period.as_micros();
                now.min(latest + self.period * (periods.max(1) as u32))
            }
            _ => now,
        }
    }

    /// A new rate, none where it is not new, or what is to be mended.
    pub(super) async fn read<O: Observer>(
        &mut self,
        shared: &Shared<'_, O>,
    ) -> Result<Result<Option<V>, Symptom>, Refusal> {
        let begun = Instant::now();
        let outcome = self.gyro.device.read().await;
        self.judge(begun, outcome, shared)
    }

    fn judge<O: Observer>(
        &mut self,
        begun: Instant,
        outcome: Result<RateReading<V>, Fault>,
        shared: &Shared<'_, O>,
    ) -> Result<Result<Option<V>, Symptom>, Refusal> {
        let RateReading { rate, is_new } = match self.gyro.checked(begun, outcome) {
            Ok(reading) => reading,
            Err(symptom) => return Ok(Err(symptom)),
        };
        if !is_new {
            return Ok(Ok(None));
        }
        if rate.is_saturated() && !core::mem::replace(&mut self.has_clipped, true) {
            shared.tell(Event::Clipped(self.name));
        }
        if self.limit.is_exceeded(rate.is_saturated(), 1) {
            return Err(shared.give_up(self.name, Trouble::Saturated));
        }
        if self.row.push(rate) >= STUCK && !rate.is_saturated() {
            self.row = RepeatCounter::new();
            return Ok(Err(Symptom::Stuck));
        }
        Ok(Ok(Some(rate)))
    }
}
