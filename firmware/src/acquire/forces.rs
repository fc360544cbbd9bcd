//! The accelerometer's readings: taken with every so-manieth sample, and judged.

use drivers::fault::Fault;
use embassy_time::Instant;
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;
use orientation::units::SpecificForce;

use super::{Limit, Row, STUCK};
use crate::guarded::Guarded;
use crate::patience::Symptom;
use crate::pointing::Every;
use crate::ports::{Accelerometer, ForceReading, Observer};
use crate::shared::Shared;

/// The accelerometer at work.
pub(super) struct Forces<'a, A> {
    accelerometer: Guarded<'a, A>,
    due: Every,
    row: Row<[SpecificForce; 3]>,
    limit: Limit,
}

impl<'a, A: Accelerometer> Forces<'a, A> {
    /// Takes the accelerometer, to be read with every so-manieth of so many samples a second.
    pub(super) fn new(accelerometer: &'a mut A, divider: u32, sample_rate: f64) -> Self {
        Self {
            accelerometer: Guarded::new(accelerometer, Device::Accelerometer),
            due: Every::new(divider),
            row: Row::new(),
            limit: Limit::new(sample_rate),
        }
    }

    /// Starts it, several times where it must be.
    pub(super) fn start<O: Observer>(
        &mut self,
        shared: &Shared<'_, O>,
    ) -> impl Future<Output = Result<(), Refusal>> {
        self.accelerometer.start(shared)
    }

    /// A new reading where one is due, perhaps a clipped one; none where it was lost. Called with every
    /// sample.
    pub(super) async fn read<O: Observer>(
        &mut self,
        shared: &Shared<'_, O>,
    ) -> Result<Option<ForceReading>, Refusal> {
        if !self.due.is_due() {
            return Ok(None);
        }
        let begun = Instant::now();
        let outcome = self.accelerometer.device.read().await;
        match self.judge(begun, outcome, shared)? {
            Ok(reading) => Ok(reading.is_new.then_some(reading)),
            Err(symptom) => self.accelerometer.mend(symptom, shared).await.map(|()| None),
        }
    }

    /// A reading, or what is to be mended. Old outputs and equal ones show an accelerometer that has
    /// stopped; one that stays at its limit is of no use.
    fn judge<O: Observer>(
        &mut self,
        begun: Instant,
        outcome: Result<ForceReading, Fault>,
        shared: &Shared<'_, O>,
    ) -> Result<Result<ForceReading, Symptom>, Refusal> {
        let reading = match self.accelerometer.checked(begun, outcome) {
            Ok(reading) => reading,
            Err(symptom) => return Ok(Err(symptom)),
        };
        if self.limit.is_exceeded(reading.is_clipped, self.due.divider) {
            return Err(shared.give_up(Device::Accelerometer, Trouble::Saturated));
        }
        if self.row.push(reading.force) >= STUCK && !reading.is_clipped {
            self.row = Row::new();
            return Ok(Err(Symptom::Stuck));
        }
        Ok(Ok(reading))
    }
}
