//! The catalogue of what can go wrong with a simulated board: every fault has one name, the platforms on
//! which it may happen, and what the board must notice of it.
//!
//! ```text
//!  Fault ──Injection::at──▶ Injection ─┬─ PortWrapper ─▶ buses and data-ready lines
//!                                      ├─ blackouts, frames, sensors, disturbances ─▶ simulated board
//!                                      └─ hang ─▶ recorder
//! ```

mod chip;
mod injection;
mod port;

use core::fmt;

use orientation::device::Device;

pub use self::chip::{Chip, ChipFault, InjectionPoint};
pub use self::injection::Injection;
pub use self::port::{FaultyRecorder, PortWrapper};
pub use firmware::platform::Platform;

use Platform::{Spin, Stage, Turntable, TwoFrame, Vehicle};

/// The motors of a platform, each with its encoder.
const fn axes(platform: Platform) -> &'static [Device] {
    match platform {
        Stage | Turntable => &[Device::Stage],
        TwoFrame => &[Device::OuterFrame, Device::InnerFrame],
        Vehicle | Spin => &[],
    }
}

/// What goes wrong with a motor, its encoder's magnet, or its cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisFault {
    /// Something blocks the axis for a while.
    BlockedOnce,
    /// Something blocks the axis for good.
    Blocked,
    /// A cable is caught within the travel.
    TravelLimit,
    /// The encoder's magnet slips by half a degree.
    Slip,
    /// The magnet has slipped before the start.
    SlipAtStart,
    /// The magnet slips while something blocks the axis.
    SlipBlocked,
    /// The magnet creeps whenever the axis turns.
    Creep,
}

/// Faults of axes: the name on a stage, the name on a frame after "outer-" or "inner-", and what must be
/// noticed. A block that passes may come while the axis stands.
const AXIS_FAULTS: [(AxisFault, [&str; 2], Notice); 7] = [
    (AxisFault::BlockedOnce, ["stage-blocked-once", "frame-blocked-once"], Notice::Nothing),
    (AxisFault::Blocked, ["stage-blocked", "frame-blocked"], Notice::Anything),
    (AxisFault::TravelLimit, ["travel-limit"; 2], Notice::Anything),
    (AxisFault::Slip, ["encoder-slip"; 2], Notice::Anything),
    (AxisFault::SlipAtStart, ["encoder-slip-at-start"; 2], Notice::Anything),
    (AxisFault::SlipBlocked, ["blocked-slip"; 2], Notice::Anything),
    (AxisFault::Creep, ["encoder-creep"; 2], Notice::Anything),
];

impl AxisFault {
    /// Names of the fault on a stage and on a frame, and what must be noticed.
    fn entry(self) -> ([&'static str; 2], Notice) {
        let found = AXIS_FAULTS.iter().find(|(entry, ..)| *entry == self);
        found.map_or(([""; 2], Notice::Nothing), |(_, names, notice)| (*names, *notice))
    }
}

/// Something that goes wrong, where nothing else is said in the middle of the measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A chip or its bus fails.
    Chip(Device, ChipFault),
    /// A motor, its encoder's magnet or its cable fails; the device is the motor.
    Axis(Device, AxisFault),
    /// Every transfer of the gyro's converter hangs until its bus gives it up.
    GyroHang,
    /// The conversions of the right gyro come late from then on.
    OutOfStep,
    /// The gyro's output, in a vehicle that of the right gyro, clips for two seconds.
    SaturationOnce,
    /// The gyro's output, in a vehicle that of the right gyro, clips to the end.
    Saturation,
    /// The accelerometer's output clips for two seconds.
    OverloadOnce,
    /// The accelerometer's output clips for good.
    Overload,
    /// What takes the samples does not for half a second.
    Overflow,
    /// A door falls shut.
    DoorSlam,
    /// A person leans on the base for some seconds.
    Nudge,
    /// The vehicle never drives.
    NeverDrives,
    /// The vehicle never stops again.
    NeverStops,
    /// Every later stop is too short.
    ShortStops,
    /// The vehicle sways at every stop.
    Sway,
    /// Doors fall shut at every stop.
    Bumps,
    /// The lift is gone for 0.3 s.
    LiftFades,
    /// The lift is gone for good.
    LiftGone,
    /// The spin stops.
    SpinStops,
    /// The gyro about the long axis of a spinning body clips for 0.3 s.
    SpinSaturation,
    /// The accelerometers of a spinning body clip for 0.3 s.
    SpinOverload,
}

/// What a board must notice of a fault, so that a survived fault was seen and not missed by luck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notice {
    /// Nothing need be noticed: the fault may pass without a trace, or cannot be seen.
    Nothing,
    /// Something must be reported that a healthy run does not report.
    Anything,
    /// This device must be named.
    Named(Device),
}

/// The platforms whose gyro turns on a motor, and all but the spinning body.
const TURNED: &[Platform] = &[Stage, TwoFrame, Turntable];
const NORTH: &[Platform] = &[Stage, TwoFrame, Turntable, Vehicle];

/// Faults of neither a chip nor an axis: name, platforms, and what must be noticed. An overload of the
/// accelerometer of two seconds need not meet a levelling; at stops that sway or are bumped a vehicle may be
/// found to stand or not.
const OTHERS: [(Fault, &str, &[Platform], Notice); 19] = [
    (Fault::GyroHang, "gyro-hang-always", TURNED, Notice::Named(Device::Gyro)),
    (Fault::OutOfStep, "out-of-step", &[Vehicle], Notice::Named(Device::RightGyro)),
    (Fault::SaturationOnce, "saturation-once", NORTH, Notice::Anything),
    (Fault::Saturation, "saturation-always", NORTH, Notice::Anything),
    (Fault::OverloadOnce, "overload-once", NORTH, Notice::Nothing),
    (Fault::Overload, "overload-always", NORTH, Notice::Named(Device::Accelerometer)),
    (Fault::Overflow, "overflow-once", NORTH, Notice::Anything),
    (Fault::DoorSlam, "door-slam", TURNED, Notice::Anything),
    (Fault::Nudge, "base-nudge", TURNED, Notice::Anything),
    (Fault::NeverDrives, "never-drives", &[Vehicle], Notice::Anything),
    (Fault::NeverStops, "never-stops", &[Vehicle], Notice::Anything),
    (Fault::ShortStops, "short-stops", &[Vehicle], Notice::Anything),
    (Fault::Sway, "sway-at-stops", &[Vehicle], Notice::Nothing),
    (Fault::Bumps, "bumps-at-stops", &[Vehicle], Notice::Nothing),
    (Fault::LiftFades, "lift-fades", &[Spin], Notice::Anything),
    (Fault::LiftGone, "lift-gone", &[Spin], Notice::Anything),
    (Fault::SpinStops, "spin-stops", &[Spin], Notice::Anything),
    (Fault::SpinSaturation, "spin-saturation-once", &[Spin], Notice::Anything),
    (Fault::SpinOverload, "spin-overload-once", &[Spin], Notice::Anything),
];

impl Fault {
    /// The faults of a platform: every chip with every fault of a chip, the axes, then the rest.
    pub fn all(platform: Platform) -> impl Iterator<Item = Self> {
        let chips = Chip::all(platform)
            .flat_map(|chip| chip.faults().map(move |fault| Self::Chip(chip.device, fault)));
        let axes = axes(platform)
            .iter()
            .flat_map(|axis| AXIS_FAULTS.iter().map(|(fault, ..)| Self::Axis(*axis, *fault)));
        let others =
            OTHERS.iter().filter(move |(_, _, platforms, _)| platforms.contains(&platform));
        chips.chain(axes).chain(others.map(|(fault, ..)| *fault))
    }

    /// The platforms on which the fault may happen.
    pub fn platforms(self) -> impl Iterator<Item = Platform> {
        Platform::ALL.into_iter().filter(move |platform| Self::all(*platform).any(|of| of == self))
    }

    /// What the board must notice.
    #[must_use]
    pub fn notice(self) -> Notice {
        match self {
            Self::Chip(device, fault) => fault.notice(device),
            Self::Axis(_, fault) => fault.entry().1,
            other => other.entry().1,
        }
    }

    /// Name of the fault and what must be noticed, of one of neither a chip nor an axis.
    fn entry(self) -> (&'static str, Notice) {
        let found = OTHERS.iter().find(|(entry, ..)| *entry == self);
        found.map_or(("", Notice::Nothing), |(_, name, _, notice)| (*name, *notice))
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Chip(device, fault) => write!(f, "{}-{fault}", Chip::name(*device)),
            Self::Axis(Device::OuterFrame, fault) => write!(f, "outer-{}", fault.entry().0[1]),
            Self::Axis(Device::InnerFrame, fault) => write!(f, "inner-{}", fault.entry().0[1]),
            Self::Axis(_, fault) => f.write_str(fault.entry().0[0]),
            other => f.write_str(other.entry().0),
        }
    }
}
