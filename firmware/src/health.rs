//! What went wrong so far, counted: nothing is lost silently.

use embassy_time::{Duration, Timer};
use orientation::device::Device;
use orientation::error::Refusal;

use crate::ports::Observer;
use crate::shared::Shared;

/// Time without any sample after which nothing more is expected: longer than all restarts of a
/// sensor together.
const SILENCE: Duration = Duration::from_secs(30);

/// Counters since the start; all stop at their limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Health {
    /// Samples that were taken.
    pub samples: u32,
    /// Samples that never came.
    pub missing: u32,
    /// Samples that came beside their time.
    pub late: u32,
    /// Samples that nobody took in time.
    pub overflowed: u32,
    /// The same of those for the keeper.
    pub unkept: u32,
    /// Readings lost, by device: gyro, accelerometer, encoder, stage, base; both frames together, and
    /// three gyros.
    pub lost: [u16; 5],
    /// Restarts, by device.
    pub restarts: [u16; 5],
    /// Status lines that the link did not take.
    pub unsent: u32,
}

impl Health {
    /// Nothing has gone wrong.
    pub const EMPTY: Self = Self {
        samples: 0,
        missing: 0,
        late: 0,
        overflowed: 0,
        unkept: 0,
        lost: [0; 5],
        restarts: [0; 5],
        unsent: 0,
    };

    /// A reading of a device was lost.
    pub fn lose(&mut self, device: Device) {
        count(&mut self.lost, device);
    }

    /// A device was started again.
    pub fn restart(&mut self, device: Device) {
        count(&mut self.restarts, device);
    }

    /// All faults together.
    #[must_use]
    pub fn faults(&self) -> u32 {
        let devices: u32 = self.lost.iter().chain(&self.restarts).map(|n| u32::from(*n)).sum();
        devices
            .saturating_add(self.missing)
            .saturating_add(self.late)
            .saturating_add(self.overflowed)
            .saturating_add(self.unkept)
            .saturating_add(self.unsent)
    }
}

fn count(counters: &mut [u16; 5], device: Device) {
    let counter = &mut counters[match device {
        Device::Gyro
        | Device::ForwardGyro
        | Device::RightGyro
        | Device::DownGyro
        | Device::UpGyro => 0,
        Device::Accelerometer | Device::UpAccelerometer | Device::RightAccelerometer => 1,
        Device::Encoder | Device::OuterEncoder | Device::InnerEncoder => 2,
        Device::Stage | Device::OuterFrame | Device::InnerFrame => 3,
        Device::Base => 4,
    }];
    *counter = counter.saturating_add(1);
}

/// Ends the session where no sample comes any more, whatever the reason.
pub async fn watch<O: Observer>(shared: &Shared<'_, O>) {
    loop {
        let before = shared.health.get().samples;
        Timer::after(SILENCE).await;
        if shared.health.get().samples == before {
            shared.fail(Refusal::TimeExhausted);
        }
    }
}
