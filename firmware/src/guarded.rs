//! A device with the retry budget that is left for it: lost readings are counted, a lost device is
//! started again, a sick one given up.

use drivers::fault::Fault;
use embassy_time::{Duration, Instant, Timer};
use orientation::device::Device;
use orientation::error::Refusal;

use crate::event::Event;
use crate::ports::{Observer, Startable};
use crate::retry_budget::{Remedy, RetryBudget, Symptom};
use crate::shared::Shared;

/// Rest before a device is started again, so that a disturbed supply can recover.
const REST: Duration = Duration::from_millis(20);

/// An exchange of less than a millisecond that takes as long as this hangs.
const SLOW: Duration = Duration::from_millis(50);

/// A device under guard.
#[derive(Debug)]
pub struct Guarded<'a, D> {
    /// The device.
    pub device: &'a mut D,
    guard: Guard,
}

/// What guards a device: the same for every device, so that it is there once.
#[derive(Debug)]
struct Guard {
    name: Device,
    retry_budget: RetryBudget,
}

impl Guard {
    /// Whether the device is to be started again after this, or only the reading is lost.
    fn is_to_restart<O: Observer>(
        &mut self,
        symptom: Symptom,
        shared: &Shared<'_, O>,
    ) -> Result<bool, Refusal> {
        match self.retry_budget.failed(symptom) {
            Remedy::Drop => Ok(false),
            Remedy::Restart => Ok(true),
            Remedy::GiveUp(trouble) => Err(shared.give_up(self.name, trouble)),
        }
    }
}

impl<'a, D: Startable> Guarded<'a, D> {
    /// Guards a device.
    pub fn new(device: &'a mut D, name: Device) -> Self {
        Self { device, guard: Guard { name, retry_budget: RetryBudget::default() } }
    }

    /// How often the device had to be started again.
    #[must_use]
    pub fn restarts(&self) -> u8 {
        self.guard.retry_budget.restarts()
    }

    /// Has all retry budget with it again.
    pub fn renew(&mut self) {
        self.guard.retry_budget = RetryBudget::default();
    }

    /// Starts the device, several times where it must be.
    ///
    /// # Errors
    /// It is given up.
    pub fn start<O: Observer>(
        &mut self,
        shared: &Shared<'_, O>,
    ) -> impl Future<Output = Result<(), Refusal>> {
        self.start_after(None, shared)
    }

    /// Takes note of a symptom and mends it: the reading is lost, perhaps the device started again.
    ///
    /// # Errors
    /// The device is given up.
    pub async fn mend<O: Observer>(
        &mut self,
        symptom: Symptom,
        shared: &Shared<'_, O>,
    ) -> Result<(), Refusal> {
        if self.guard.is_to_restart(symptom, shared)? {
            return self.start_after(Some(symptom), shared).await;
        }
        shared.lose(self.guard.name, symptom);
        Ok(())
    }

    /// The outcome of an exchange that was begun then, or what is to be mended.
    pub fn checked<T>(&mut self, begun: Instant, outcome: Result<T, Fault>) -> Result<T, Symptom> {
        self.checked_at(Instant::now(), begun, outcome)
    }

    /// The same of one that ended just now.
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
            self.guard.retry_budget.succeeded();
        }
        outcome.map_err(Symptom::Chip)
    }

    /// Starts the device until it has started, each time after a rest where something was wrong.
    async fn start_after<O: Observer>(
        &mut self,
        mut trouble: Option<Symptom>,
        shared: &Shared<'_, O>,
    ) -> Result<(), Refusal> {
        loop {
            if let Some(symptom) = trouble {
                shared.restart(self.guard.name, symptom);
                Timer::after(REST).await;
            }
            let Err(fault) = self.device.start().await else { break };
            let symptom = Symptom::Chip(fault);
            self.guard.is_to_restart(symptom, shared)?;
            trouble = Some(symptom);
        }
        shared.tell(Event::Started(self.guard.name));
        Ok(())
    }
}
