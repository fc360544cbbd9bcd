//! Counters of all that went wrong, so that no loss goes unreported.

use orientation::device::Device;

/// Counters since the start; each saturates at the limit of its type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Health {
    /// Samples that were acquired.
    pub samples: u32,
    /// Samples that were passed by because the aligner computed, and needed none.
    pub passed_by: u32,
    /// Samples that never came, by the gaps in the time of those that did.
    pub missing: u32,
    /// Samples that came at the wrong time.
    pub late: u32,
    /// Samples that were discarded because the queue to the session was full.
    pub overflowed: u32,
    /// Samples that were discarded because the queue to the attitude keeper was full.
    pub unkept: u32,
    /// Lost readings by kind of device: gyros, accelerometers, encoders, drives, base sensors.
    /// Devices of the same kind, as the two frames of a mount, share one counter.
    pub lost: [u16; 5],
    /// Restarts by kind of device, in the same order as `lost`.
    pub restarts: [u16; 5],
    /// Status lines that the link did not accept in time.
    pub unsent: u32,
}

impl Health {
    /// Counts a lost reading of a device.
    pub fn lose(&mut self, device: Device) {
        count(&mut self.lost, device);
    }

    /// Counts a restart of a device.
    pub fn restart(&mut self, device: Device) {
        count(&mut self.restarts, device);
    }

    /// Sum of all faults; samples that were acquired or passed by do not count.
    #[must_use]
    pub fn faults(&self) -> u32 {
        let devices = self.lost.iter().chain(&self.restarts).map(|count| u32::from(*count));
        [self.missing, self.late, self.overflowed, self.unkept, self.unsent]
            .into_iter()
            .fold(devices.sum(), u32::saturating_add)
    }
}

/// Increments the counter of a device's kind.
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
