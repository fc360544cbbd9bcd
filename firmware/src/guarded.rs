//! A device with the patience that is left for it: lost readings are counted, a lost device is
//! started again, a sick one given up.

use embassy_time::{Duration, Timer};
use orientation::device::Device;
use orientation::error::Refusal;

use crate::event::Event;
use crate::patience::{Patience, Remedy, Symptom};
use crate::ports::{Observer, Startable};
use crate::shared::Shared;

/// Rest before a device is started again, so that a disturbed supply can recover.
const REST: Duration = Duration::from_millis(20);

/// A device under guard.
#[derive(Debug)]
pub struct Guarded<'a, D> {
    /// The device.
    pub device: &'a mut D,
    name: Device,
    patience: Patience,
}

impl<'a, D: Startable> Guarded<'a, D> {
    /// Guards a device.
    pub fn new(device: &'a mut D, name: Device) -> Self {
        Self { device, name, patience: Patience::default() }
    }

    /// How often the device had to be started again.
    #[must_use]
    pub fn restarts(&self) -> u8 {
        self.patience.restarts()
    }

    /// Starts the device, several times where it must be.
    ///
    /// # Errors
    /// It is given up.
    pub async fn start<O: Observer>(&mut self, shared: &Shared<'_, O>) -> Result<(), Refusal> {
        while let Err(fault) = self.device.start().await {
            let symptom = Symptom::Chip(fault);
            match self.patience.failed(symptom) {
                Remedy::GiveUp(trouble) => return Err(shared.give_up(self.name, trouble)),
                Remedy::Drop | Remedy::Restart => self.rest(shared, symptom).await,
            }
        }
        shared.tell(Event::Started(self.name));
        Ok(())
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
        match self.patience.failed(symptom) {
            Remedy::Drop => {
                shared.lose(self.name, symptom);
                Ok(())
            }
            Remedy::Restart => {
                self.rest(shared, symptom).await;
                self.start(shared).await
            }
            Remedy::GiveUp(trouble) => Err(shared.give_up(self.name, trouble)),
        }
    }

    /// The outcome of an exchange; a failed one is mended and gives nothing.
    ///
    /// # Errors
    /// The device is given up.
    pub async fn checked<T, O: Observer>(
        &mut self,
        outcome: Result<T, drivers::fault::Fault>,
        shared: &Shared<'_, O>,
    ) -> Result<Option<T>, Refusal> {
        match outcome {
            Ok(value) => {
                self.patience.succeeded();
                Ok(Some(value))
            }
            Err(fault) => self.mend(Symptom::Chip(fault), shared).await.map(|()| None),
        }
    }

    async fn rest<O: Observer>(&self, shared: &Shared<'_, O>, symptom: Symptom) {
        shared.count(|health| health.restart(self.name));
        shared.tell(Event::Restarting(self.name, symptom));
        Timer::after(REST).await;
    }
}
