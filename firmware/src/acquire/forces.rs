//! Readings of the accelerometer: taken with every n-th sample, and checked.

use drivers::fault::Fault;
use embassy_time::{Duration, Instant};
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::units::SpecificForce;

use super::Plausibility;
use crate::guarded::Guarded;
use crate::pointing::Decimator;
use crate::ports::{Accelerometer, ForceReading};
use crate::retry_budget::{RETRY, Symptom};
use crate::shared::Shared;

/// Time for which a failing accelerometer is not read while the vehicle moves.
const PAUSE: Duration = Duration::from_secs(1);

/// Whether an azimuth is held and the body moves. Rotation during the restart of a device would be
/// lost, so the gyros alone carry the attitude, and the accelerometer is repaired at the next rest.
fn is_on_the_way(shared: &Shared<'_>) -> bool {
    shared.is_holding() && !shared.is_at_rest.get()
}

/// State of the accelerometer's readings.
pub(super) struct Forces<'a, A> {
    /// Accelerometer with its retry budget.
    pub(super) accelerometer: Guarded<'a, A>,
    /// Decimation of the sample rate.
    due: Decimator,
    /// Checks of its readings.
    plausibility: Plausibility<[SpecificForce; 3]>,
    /// Time until which it is not read, after a failure while an azimuth is held.
    absent: Option<Instant>,
}

impl<'a, A: Accelerometer> Forces<'a, A> {
    /// Takes the accelerometer, to be read with every `divider`-th of `sample_rate` samples per
    /// second.
    pub(super) fn new(accelerometer: &'a mut A, divider: u32, sample_rate: f64) -> Self {
        Self {
            accelerometer: Guarded::new(accelerometer, Device::Accelerometer),
            due: Decimator::new(divider),
            plausibility: Plausibility::new(sample_rate),
            absent: None,
        }
    }

    /// Restores the full retry budget.
    pub(super) fn renew(&mut self) {
        self.accelerometer.renew();
        self.plausibility.saturated = 0;
        self.absent = None;
    }

    /// Returns a new reading where one is due, possibly saturated; none where it was lost on the way. It must
    /// be called with every sample.
    ///
    /// # Errors
    /// The symptom to repair.
    pub(super) async fn read(
        &mut self,
        shared: &Shared<'_>,
    ) -> Result<Option<ForceReading>, Symptom> {
        if !self.due.is_due() || self.absent.is_some_and(|until| Instant::now() < until) {
            return Ok(None);
        }
        let outcome = self.accelerometer.device.read().await;
        match self.judge(outcome) {
            Ok(reading) => {
                self.absent = None;
                Ok(reading.is_new.then_some(reading))
            }
            Err(symptom) if symptom != Symptom::Saturated && is_on_the_way(shared) => {
                shared.lose(Device::Accelerometer, symptom);
                self.absent = Some(Instant::now() + PAUSE);
                Ok(None)
            }
            Err(symptom) => Err(symptom),
        }
    }

    /// Handles a symptom, with which a reading was lost. While an azimuth is held, continues without an
    /// accelerometer that is given up until it may be tried again.
    ///
    /// # Errors
    /// The accelerometer is given up.
    pub(super) async fn mend(
        &mut self,
        symptom: Symptom,
        shared: &Shared<'_>,
    ) -> Result<Option<ForceReading>, Refusal> {
        match self.accelerometer.mend(symptom, shared).await {
            Err(_) if shared.is_holding() => {
                self.renew();
                self.absent = Some(Instant::now() + RETRY);
                Ok(None)
            }
            outcome => outcome.map(|_| None),
        }
    }

    /// Checks a reading: a valid one, or the symptom to repair. Repeated outputs show an
    /// accelerometer that has stopped.
    fn judge(&mut self, outcome: Result<ForceReading, Fault>) -> Result<ForceReading, Symptom> {
        let reading = self.accelerometer.checked(outcome)?;
        self.plausibility.judge(reading.force, reading.is_clipped, self.due.divider)?;
        Ok(reading)
    }
}
