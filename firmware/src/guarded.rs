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

/// Time of work after which the restarts of a device are forgiven: a restart takes 0.2 s at most, so
/// that a device which needs one in a minute still gives more than 99 % of its readings, whereas a
/// defective one needs its restarts one after the other.
const FORGIVEN: Duration = Duration::from_secs(60);

/// A device with its retry budget.
#[derive(Debug)]
pub struct Guarded<'a, D> {
    /// The device.
    pub device: &'a mut D,
    /// Name of the device in the log.
    pub name: Device,
    /// Failures that the device may still have.
    failures: Failures,
}

/// The failures of a device.
#[derive(Clone, Copy, Debug)]
struct Failures {
    /// Those that it may still have.
    budget: RetryBudget,
    /// Time from which it has worked without a restart.
    since: Instant,
}

impl Failures {
    /// The full budget.
    fn full() -> Self {
        Self { budget: RetryBudget::default(), since: Instant::MIN }
    }

    /// Charges a symptom to the budget: true if the device must be started again, false if only the
    /// reading is lost. Not generic, so that its code exists once for all devices.
    fn charge(
        &mut self,
        name: Device,
        symptom: Symptom,
        shared: &Shared<'_>,
    ) -> Result<bool, Refusal> {
        let now = Instant::now();
        if now - self.since >= FORGIVEN {
            self.budget.forgive();
        }
        match self.budget.failed(symptom) {
            Remedy::Drop => Ok(false),
            Remedy::Restart => {
                self.since = now;
                Ok(true)
            }
            Remedy::GiveUp(trouble) => Err(shared.give_up(name, trouble)),
        }
    }
}

impl<'a, D: Startable> Guarded<'a, D> {
    /// Gives a device its full retry budget. The name identifies it in the log and in the counters.
    pub fn new(device: &'a mut D, name: Device) -> Self {
        Self { device, name, failures: Failures::full() }
    }

    /// Restores the full retry budget.
    pub fn renew(&mut self) {
        self.failures = Failures::full();
    }

    /// Starts the device, several times if necessary.
    ///
    /// # Errors
    /// The device is given up: it did not start within its retry budget.
    pub fn start(&mut self, shared: &Shared<'_>) -> impl Future<Output = Result<(), Refusal>> {
        self.start_after(None, shared)
    }

    /// Handles a symptom: counts a lost reading or starts the device again; returns whether it was
    /// started again.
    ///
    /// # Errors
    /// The device is given up.
    pub async fn mend(&mut self, symptom: Symptom, shared: &Shared<'_>) -> Result<bool, Refusal> {
        let is_to_restart = self.failures.charge(self.name, symptom, shared)?;
        if is_to_restart {
            self.start_after(Some(symptom), shared).await?;
        } else {
            shared.lose(self.name, symptom);
        }
        Ok(is_to_restart)
    }

    /// Judges the outcome of an exchange. How long it took is judged by its bus alone, which ends one
    /// that hangs: here, other tasks and waiting for the bus would count, too.
    ///
    /// # Errors
    /// The driver's fault.
    pub fn checked<T>(&mut self, outcome: Result<T, Fault>) -> Result<T, Symptom> {
        if outcome.is_ok() {
            self.failures.budget.succeeded();
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
            self.failures.charge(self.name, symptom, shared)?;
            trouble = Some(symptom);
        }
        shared.report(Event::Started(self.name));
        Ok(())
    }
}
