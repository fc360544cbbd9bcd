//! Conversions of a gyro: awaited, read, and checked.

use embassy_time::{Duration, Instant, with_timeout};
use orientation::device::Device;
use orientation::units::AngularRate;

use super::{Plausibility, SILENCE};
use crate::event::Event;
use crate::guarded::Guarded;
use crate::ports::{Gyro, Quantity, RateReading};
use crate::retry_budget::Symptom;
use crate::shared::Shared;

/// Divisor of a period: a conversion that is returned within this part of it had ended before.
const AT_ONCE: u32 = 16;

/// State of a gyro's conversions.
pub(super) struct Rates<'a, G, V = AngularRate> {
    /// Gyro with its retry budget.
    pub(super) gyro: Guarded<'a, G>,
    /// Checks of its readings.
    plausibility: Plausibility<V>,
    /// Sample period.
    pub(super) period: Duration,
    /// End of the latest conversion.
    latest: Option<Instant>,
    /// Whether it was reported that the gyro came to the limit of its range: once is enough for a log.
    has_clipped: bool,
}

/// Time without a conversion after which a gyro with this period, µs, counts as silent.
pub(super) fn silence(period: u32) -> Duration {
    Duration::from_micros(u64::from(period) * u64::from(SILENCE))
}

impl<'a, V: Quantity, G: Gyro<V>> Rates<'a, G, V> {
    /// Takes a gyro with this sample rate, Hz, by its name in the log.
    pub(super) fn new(gyro: &'a mut G, name: Device, sample_rate: f64) -> Self {
        let period = Duration::from_micros((1e6 / sample_rate + 0.5) as u64);
        Self {
            gyro: Guarded::new(gyro, name),
            plausibility: Plausibility::new(sample_rate),
            period,
            latest: None,
            has_clipped: false,
        }
    }

    /// Restores the full retry budget.
    pub(super) fn renew(&mut self) {
        self.gyro.renew();
        self.plausibility.saturated = 0;
        self.has_clipped = false;
    }

    /// Waits for a conversion, at most for `silence`; returns its end, or the symptom to repair.
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

    /// End of a conversion that was awaited from `asked` on and is present at `now`. One that was
    /// present without a wait ended before, while another bus was read: it ended when it was due
    /// after the previous one.
    fn ended(&self, asked: Instant, now: Instant) -> Instant {
        match self.latest {
            Some(latest) if now - asked < self.period / AT_ONCE => {
                let periods = (now - latest).as_micros() / self.period.as_micros();
                now.min(latest + self.period * (periods.max(1) as u32))
            }
            _ => now,
        }
    }

    /// Returns a new rate, checked for saturation and repetition; none where it is not new, or the
    /// symptom to repair.
    pub(super) async fn read(&mut self, shared: &Shared<'_>) -> Result<Option<V>, Symptom> {
        let begun = Instant::now();
        let outcome = self.gyro.device.read().await;
        let RateReading { rate, is_new } = self.gyro.checked(begun, outcome)?;
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
