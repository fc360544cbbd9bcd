//! What can go wrong with a chip or its bus, and the chips of every platform.

use core::fmt;

use embassy_time::Instant;
use hal_mock::chip::Select;
use hal_mock::fault::{BusFault, FaultPlan, When};
use orientation::device::Device;

use super::{NORTH, Notice, Platform};

/// Chooses the bits that are flipped.
const FLIP: u64 = 6;

/// What is wrong with a chip or its bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChipFault {
    /// Another chip answers, or none, from the start.
    Identity,
    /// One bit of one reply is wrong.
    ChecksumOnce,
    /// One bit of every reply is wrong.
    ChecksumAlways,
    /// The chip repeats one reply again and again.
    Stuck,
    /// One data-ready edge is lost; where there is no such line, one answer.
    SilentOnce,
    /// No data-ready any more; where there is no such line, no answer any more.
    Silent,
    /// The supply is lost for a moment.
    Reset,
    /// The bus reports an error once.
    BusOnce,
    /// The bus reports errors from some time on.
    BusAlways,
    /// One transfer hangs until its bus gives it up.
    Hang,
}

const CHIP_FAULTS: [(ChipFault, &str); 10] = [
    (ChipFault::Identity, "identity"),
    (ChipFault::ChecksumOnce, "checksum-once"),
    (ChipFault::ChecksumAlways, "checksum-always"),
    (ChipFault::Stuck, "stuck"),
    (ChipFault::SilentOnce, "silent-once"),
    (ChipFault::Silent, "silent"),
    (ChipFault::Reset, "reset"),
    (ChipFault::BusOnce, "bus-once"),
    (ChipFault::BusAlways, "bus-always"),
    (ChipFault::Hang, "hang"),
];

impl fmt::Display for ChipFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let found = CHIP_FAULTS.iter().find(|(entry, _)| entry == self);
        f.write_str(found.map_or("", |(_, name)| name))
    }
}

/// Where a fault of a chip is injected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InjectionPoint {
    /// The chip's supply, which is lost at this time.
    Supply(Instant),
    /// The chip's data-ready line, which loses edges then.
    Ready(When),
    /// The chip's bus.
    Bus(FaultPlan),
}

impl ChipFault {
    /// Where the fault shows at a chip that has a data-ready line, or has none, and when.
    #[must_use]
    pub fn point(self, has_line: bool, middle: Instant) -> InjectionPoint {
        let once = When::once(middle);
        let always = When::always(middle);
        let (fault, when) = match self {
            Self::Reset => return InjectionPoint::Supply(middle),
            Self::Silent if has_line => return InjectionPoint::Ready(always),
            Self::SilentOnce if has_line => return InjectionPoint::Ready(once),
            Self::Identity => (BusFault::Missing { level: 0xff }, When::always(Instant::MIN)),
            Self::ChecksumOnce => (BusFault::FlippedBit { seed: FLIP }, once),
            Self::ChecksumAlways => (BusFault::FlippedBit { seed: FLIP }, always),
            Self::Stuck => (BusFault::Stuck, always),
            Self::Silent => (BusFault::Missing { level: 0x00 }, always),
            Self::SilentOnce => (BusFault::Missing { level: 0x00 }, once),
            Self::BusOnce => (BusFault::Error, once),
            Self::BusAlways => (BusFault::Error, always),
            Self::Hang => (BusFault::Hang, once),
        };
        InjectionPoint::Bus(FaultPlan { fault, when })
    }

    /// What must be noticed of a fault of a device: of a single wrong answer nothing where the device has no
    /// data-ready line, since it is asked again; of a lost edge the missing sample.
    pub(super) fn notice(self, device: Device) -> Notice {
        match (self, Chip::of(device)) {
            (Self::SilentOnce, Some(chip)) if chip.has_line() => Notice::Anything,
            (Self::SilentOnce | Self::ChecksumOnce, Some(chip)) if !chip.has_line() => {
                Notice::Nothing
            }
            _ => Notice::Named(device),
        }
    }
}

/// A chip of the boards.
#[derive(Clone, Copy, Debug)]
pub struct Chip {
    /// The device that the board names in its log.
    pub device: Device,
    /// The chip's select line on the serial bus; none of a chip on the I²C bus.
    pub select: Option<Select>,
    name: &'static str,
    platforms: &'static [Platform],
}

const fn chip(
    device: Device,
    select: Select,
    name: &'static str,
    platforms: &'static [Platform],
) -> Chip {
    Chip { device, select: Some(select), name, platforms }
}

use Platform::{Spin, Stage, Turntable, TwoFrame, Vehicle};

/// The chips of all platforms; those of one platform in the order in which its faults are listed.
const CHIPS: [Chip; 15] = [
    chip(Device::Gyro, Select::Gyro, "gyro", super::TURNED),
    chip(Device::ForwardGyro, Select::Gyro, "forward-gyro", &[Vehicle, Spin]),
    chip(Device::UpGyro, Select::GyroUp, "up-gyro", &[Spin]),
    chip(Device::RightGyro, Select::GyroRight, "right-gyro", &[Vehicle, Spin]),
    chip(Device::DownGyro, Select::GyroDown, "down-gyro", &[Vehicle]),
    chip(Device::Accelerometer, Select::Accelerometer, "accelerometer", NORTH),
    chip(Device::UpAccelerometer, Select::ForceUp, "up-accelerometer", &[Spin]),
    chip(Device::RightAccelerometer, Select::ForceRight, "right-accelerometer", &[Spin]),
    chip(Device::Encoder, Select::Encoder, "encoder", &[Stage, Turntable]),
    chip(Device::OuterEncoder, Select::Encoder, "outer-encoder", &[TwoFrame]),
    chip(Device::InnerEncoder, Select::InnerEncoder, "inner-encoder", &[TwoFrame]),
    chip(Device::Stage, Select::Actuator, "stage", &[Stage, Turntable]),
    chip(Device::OuterFrame, Select::Actuator, "outer-frame", &[TwoFrame]),
    chip(Device::InnerFrame, Select::InnerActuator, "inner-frame", &[TwoFrame]),
    Chip { device: Device::Base, select: None, name: "coarse-imu", platforms: super::TURNED },
];

impl Chip {
    /// The chips of a platform.
    pub fn all(platform: Platform) -> impl Iterator<Item = Self> {
        CHIPS.into_iter().filter(move |chip| chip.platforms.contains(&platform))
    }

    /// The chip of a device; none of a device that is no chip.
    #[must_use]
    pub fn of(device: Device) -> Option<Self> {
        CHIPS.into_iter().find(|chip| chip.device == device)
    }

    /// The name that the chip has in the names of its faults.
    pub(super) fn name(device: Device) -> &'static str {
        Self::of(device).map_or("", |chip| chip.name)
    }

    /// Whether the chip has a data-ready line: a converter does.
    pub(super) fn has_line(&self) -> bool {
        use Select::{ForceRight, ForceUp, Gyro, GyroDown, GyroRight, GyroUp};
        let converters = [Gyro, GyroUp, GyroRight, GyroDown, ForceUp, ForceRight];
        self.select.is_some_and(|select| converters.contains(&select))
    }

    /// The faults of the chip: on an I²C bus the device answers, or does not.
    pub(super) fn faults(self) -> impl Iterator<Item = ChipFault> {
        let answers = [ChipFault::Identity, ChipFault::SilentOnce, ChipFault::Silent];
        let faults = CHIP_FAULTS.iter().map(|(fault, _)| *fault);
        faults.filter(move |fault| self.select.is_some() || answers.contains(fault))
    }
}
