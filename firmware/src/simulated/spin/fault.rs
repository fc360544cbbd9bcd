//! What can go wrong with a simulated spinning body, each by its name: its chips, its sensors, its flight.

use core::fmt;

use embassy_time::Instant;
use embedded_hal_async::digital::Wait;
use embedded_hal_async::spi::SpiDevice;
use hal_mock::chip::Select;
use hal_mock::fault::{Blackout, FaultPlan, FaultyReady, FaultySpi, When};
use hal_mock::spin::board::CHIPS;
use hal_mock::vehicle::SensorFault;
use heapless::Vec;

use super::Course;
use crate::simulated::Around;
use crate::simulated::fault::{SICKNESSES, Showing, Sickness, name};

/// How long a lift that fades is gone, and for how long a sensor clips once, s.
const PASSING: f64 = 0.3;
/// How long a lift takes to fade, and a spin to stop, s.
const FADING: f64 = 0.02;

/// Something that goes wrong in the middle of the flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpinFault {
    /// With a chip.
    Chip(Select, Sickness),
    /// The lift is gone for 0.3 s.
    LiftFades,
    /// The lift is gone for good.
    LiftGone,
    /// The spin stops.
    SpinStops,
    /// The gyro about the long axis clips for 0.3 s.
    SaturationOnce,
    /// The accelerometers clip for 0.3 s.
    OverloadOnce,
}

/// The chips' names.
const NAMES: [(Select, &str); CHIPS.len()] = [
    (Select::Gyro, "forward-gyro"),
    (Select::GyroUp, "up-gyro"),
    (Select::GyroRight, "right-gyro"),
    (Select::ForceUp, "up-accelerometer"),
    (Select::ForceRight, "right-accelerometer"),
];

const OTHERS: [(SpinFault, &str); 5] = [
    (SpinFault::LiftFades, "lift-fades"),
    (SpinFault::LiftGone, "lift-gone"),
    (SpinFault::SpinStops, "spin-stops"),
    (SpinFault::SaturationOnce, "spin-saturation-once"),
    (SpinFault::OverloadOnce, "spin-overload-once"),
];

impl SpinFault {
    /// All faults: every chip with every sickness, then the rest.
    pub fn all() -> impl Iterator<Item = Self> {
        let chips = CHIPS.into_iter().flat_map(|select| {
            SICKNESSES.iter().map(move |(sickness, _)| Self::Chip(select, *sickness))
        });
        chips.chain(OTHERS.iter().map(|(fault, _)| *fault))
    }
}

impl fmt::Display for SpinFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Self::Chip(select, sickness) = self {
            return write!(f, "{}-{}", name(&NAMES, select), name(&SICKNESSES, sickness));
        }
        f.write_str(name(&OTHERS, self))
    }
}

/// How a body flies that spins so fast, rad/s, on such a lift, m/s², when something goes wrong at a time, s.
pub(super) fn course(fault: Option<SpinFault>, spin: f64, lift: f64, at: f64) -> Course {
    let gone = at + FADING;
    let back = gone + PASSING;
    let steady = |value: f64| [(0.0, value); 4];
    match fault {
        Some(SpinFault::LiftFades) => Course {
            spin: steady(spin),
            lift: [(at, lift), (gone, 0.0), (back, 0.0), (back + FADING, lift)],
        },
        Some(SpinFault::LiftGone) => {
            Course { spin: steady(spin), lift: [(at, lift), (gone, 0.0), (gone, 0.0), (gone, 0.0)] }
        }
        Some(SpinFault::SpinStops) => {
            Course { spin: [(at, spin), (gone, 0.0), (gone, 0.0), (gone, 0.0)], lift: steady(lift) }
        }
        _ => Course { spin: steady(spin), lift: steady(lift) },
    }
}

/// What a fault does to the chips and sensors.
#[derive(Clone, Debug)]
pub struct SpinPlan {
    /// Faults of the buses, in the order of [`CHIPS`].
    pub buses: [Option<FaultPlan>; CHIPS.len()],
    /// Lost data-ready edges.
    pub ready: [Option<When>; CHIPS.len()],
    /// Losses of supply.
    pub blackouts: Vec<Blackout, 1>,
    /// Faults of the sensors.
    pub sensors: Vec<SensorFault, 2>,
}

impl SpinPlan {
    /// Nothing goes wrong.
    pub const NONE: Self = Self {
        buses: [None; CHIPS.len()],
        ready: [None; CHIPS.len()],
        blackouts: Vec::new(),
        sensors: Vec::new(),
    };

    /// The plan of a fault that comes at a time in s, or of none.
    #[must_use]
    pub fn at(fault: Option<SpinFault>, seconds: f64) -> Self {
        let mut plan = Self::NONE;
        let middle = Instant::from_micros((seconds * 1e6) as u64);
        let clipped = |channels: core::ops::Range<usize>| {
            let (from_s, until_s) = (seconds, seconds + PASSING);
            channels
                .map(|channel| SensorFault::Saturated { channel, from_s, until_s })
                .collect::<Vec<_, 2>>()
        };
        match fault {
            Some(SpinFault::Chip(select, sickness)) => plan.sicken(select, sickness, middle),
            Some(SpinFault::SaturationOnce) => plan.sensors = clipped(0..1),
            Some(SpinFault::OverloadOnce) => plan.sensors = clipped(3..5),
            // What the body does is in its course.
            _ => {}
        }
        plan
    }

    fn sicken(&mut self, select: Select, sickness: Sickness, middle: Instant) {
        let place = place(select);
        match sickness.showing(true, middle) {
            Showing::Supply => {
                self.blackouts = [Blackout { select, at: middle }].into_iter().collect();
            }
            Showing::Ready(when) => self.ready[place] = Some(when),
            Showing::Bus(plan) => self.buses[place] = Some(plan),
        }
    }
}

/// The place of a chip among [`CHIPS`].
fn place(select: Select) -> usize {
    CHIPS.iter().position(|chip| *chip == select).unwrap_or(0)
}

impl Around for SpinPlan {
    type Spi<S: SpiDevice> = FaultySpi<S>;
    type Line<W: Wait> = FaultyReady<W>;

    fn spi<S: SpiDevice>(&self, select: Select, bus: S) -> FaultySpi<S> {
        FaultySpi::new(bus, self.buses[place(select)])
    }

    fn line<W: Wait>(&self, select: Select, line: W) -> FaultyReady<W> {
        FaultyReady::new(line, self.ready[place(select)])
    }
}
