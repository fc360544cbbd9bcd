//! A device with its retry budget: lost readings are counted, a device that stays silent is started
//! again, and one that fails too often is given up.

use drivers::fault::Fault;
use embassy_time::{Duration, Instant, Timer};
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;

use crate::event::Event;
use crate::ports::Startable;
use crate::retry_budget::{Remedy, RetryBudget, Symptom};
use crate::shared::Shared;

/// Rest before a device is started again, so that a disturbed supply can recover.
const REST: Duration = Duration::from_millis(20);

/// Duration of an exchange beyond which the bus counts as hanging; a regular exchange takes less
/// than a millisecond.
const SLOW: Duration = Duration::from_millis(50);

/// A device with its retry budget.
#[derive(Debug)]
pub struct Guarded<'a, D> {
    /// The device.
    pub device: &'a mut D,
    /// Name of the device in the log.
    pub name: Device,
    /// Failures that the device may still have.
    retry_budget: RetryBudget,
}

/// Charges a symptom of a device to its budget: true if it must be started again, false if only the
/// reading is lost. Not a method, so that its code exists once for all devices.
fn is_to_restart(
    (name, retry_budget): (Device, &mut RetryBudget),
    symptom: Symptom,
    shared: &Shared<'_>,
) -> Result<bool, Refusal> {
    match retry_budget.failed(symptom) {
        Remedy::Drop => Ok(false),
        Remedy::Restart => Ok(true),
        Remedy::GiveUp(trouble) => Err(shared.give_up(name, trouble)),
    }
}

impl<'a, D: Startable> Guarded<'a, D> {
    /// Gives a device its full retry budget. The name identifies it in the log and in the counters.
    pub fn new(device: &'a mut D, name: Device) -> Self {
        Self { device, name, retry_budget: RetryBudget::default() }
    }

    /// Number of times that the device was started again since the budget was last restored.
    #[must_use]
    pub fn restarts(&self) -> u8 {
        self.retry_budget.restarts()
    }

    /// Restores the full retry budget.
    pub fn renew(&mut self) {
        self.retry_budget = RetryBudget::default();
    }

    /// Starts the device, several times if necessary.
    ///
    /// # Errors
    /// The device is given up: it did not start within its retry budget.
    pub fn start(&mut self, shared: &Shared<'_>) -> impl Future<Output = Result<(), Refusal>> {
        self.start_after(None, shared)
    }

    /// Handles a symptom: counts a lost reading or starts the device again.
    ///
    /// # Errors
    /// The device is given up.
    pub async fn mend(&mut self, symptom: Symptom, shared: &Shared<'_>) -> Result<(), Refusal> {
        if is_to_restart((self.name, &mut self.retry_budget), symptom, shared)? {
            return self.start_after(Some(symptom), shared).await;
        }
        shared.lose(self.name, symptom);
        Ok(())
    }

    /// Judges the outcome of an exchange that began at `begun` and ends now.
    ///
    /// # Errors
    /// The driver's fault, or [`Symptom::Slow`] if the exchange took longer than 50 ms.
    pub fn checked<T>(&mut self, begun: Instant, outcome: Result<T, Fault>) -> Result<T, Symptom> {
        self.checked_at(Instant::now(), begun, outcome)
    }

    /// Judges the outcome of an exchange that began at `begun` and ended at `now`; the caller
    /// supplies the end so that the clock is read once.
    ///
    /// # Errors
    /// The driver's fault, or [`Symptom::Slow`] if the exchange took longer than 50 ms, even if it
    /// succeeded.
    pub fn checked_at<T>(
        &mut self,
        now: Instant,
        begun: Instant,
        outcome: Result<T, Fault>,
    ) -> Result<T, Symptom> {
        if now - begun > SLOW {
            return Err(Symptom::Slow);
        }
        if outcome.is_ok() {
            self.retry_budget.succeeded();
        }
        outcome.map_err(Symptom::Chip)
    }

    /// Starts the device until it succeeds, with a rest before every attempt that follows a
    /// failure.
    async fn start_after(
        &mut self,
        mut trouble: Option<Symptom>,
        shared: &Shared<'_>,
    ) -> Result<(), Refusal> {
        loop {
            if let Some(symptom) = trouble {
                shared.restart(self.name, symptom);
                Timer::after(REST).await;
            }
            let Err(fault) = self.device.start().await else { break };
            let symptom = Symptom::Chip(fault);
            is_to_restart((self.name, &mut self.retry_budget), symptom, shared)?;
            trouble = Some(symptom);
        }
        shared.report(Event::Started(self.name));
        Ok(())
    }
}
