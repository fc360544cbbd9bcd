//! What can go wrong with a simulated vehicle, each by its name: its chips, its clock, who drives.

use core::fmt;

use embassy_time::{Duration, Instant, Timer};
use embedded_hal::digital::ErrorType;
use embedded_hal_async::digital::Wait;
use embedded_hal_async::spi::SpiDevice;
use hal_mock::chip::Select;
use hal_mock::fault::{Blackout, FaultPlan, FaultyReady, FaultySpi, When};
use hal_mock::vehicle::SensorFault;
use hal_mock::vehicle::board::CHIPS;
use heapless::Vec;

use crate::simulated::Around;
use crate::simulated::fault::{SICKNESSES, Showing, Sickness, name};

/// For how long a sensor that clips once does, s.
const PASSING: f64 = 2.0;
/// By how much a converter that is out of step comes late.
const LATE: Duration = Duration::from_millis(4);

/// Something that goes wrong, where nothing else is said in the middle of the first drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VehicleFault {
    /// With a chip.
    Chip(Select, Sickness),
    /// The right gyro's conversions come late from then on.
    OutOfStep,
    /// The right gyro clips for two seconds.
    SaturationOnce,
    /// It clips for good.
    Saturation,
    /// The accelerometer clips for two seconds.
    OverloadOnce,
    /// It clips for good.
    Overload,
    /// Whoever takes the samples does not for half a second.
    Overflow,
    /// The vehicle never drives.
    NeverDrives,
    /// It never stops again.
    NeverStops,
    /// Every later stop is too short.
    ShortStops,
    /// It sways at every stop.
    Sway,
    /// Doors fall shut at every stop.
    Bumps,
}

/// The chips' names.
const NAMES: [(Select, &str); 4] = [
    (Select::Gyro, "forward-gyro"),
    (Select::GyroRight, "right-gyro"),
    (Select::GyroDown, "down-gyro"),
    (Select::Accelerometer, "accelerometer"),
];

const OTHERS: [(VehicleFault, &str); 11] = [
    (VehicleFault::OutOfStep, "out-of-step"),
    (VehicleFault::SaturationOnce, "saturation-once"),
    (VehicleFault::Saturation, "saturation-always"),
    (VehicleFault::OverloadOnce, "overload-once"),
    (VehicleFault::Overload, "overload-always"),
    (VehicleFault::Overflow, "overflow-once"),
    (VehicleFault::NeverDrives, "never-drives"),
    (VehicleFault::NeverStops, "never-stops"),
    (VehicleFault::ShortStops, "short-stops"),
    (VehicleFault::Sway, "sway-at-stops"),
    (VehicleFault::Bumps, "bumps-at-stops"),
];

impl VehicleFault {
    /// All faults: every chip with every sickness, then the rest.
    pub fn all() -> impl Iterator<Item = Self> {
        let chips = CHIPS.into_iter().flat_map(|select| {
            SICKNESSES.iter().map(move |(sickness, _)| Self::Chip(select, *sickness))
        });
        chips.chain(OTHERS.iter().map(|(fault, _)| *fault))
    }
}

impl fmt::Display for VehicleFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Self::Chip(select, sickness) = self {
            return write!(f, "{}-{}", name(&NAMES, select), name(&SICKNESSES, sickness));
        }
        f.write_str(name(&OTHERS, self))
    }
}

/// What a fault does to the chips.
#[derive(Clone, Debug)]
pub struct VehiclePlan {
    /// Faults of the buses, in the order of [`CHIPS`].
    pub buses: [Option<FaultPlan>; CHIPS.len()],
    /// Lost data-ready edges, forward, right, down.
    pub ready: [Option<When>; 3],
    /// Since when the right gyro's conversions come late.
    pub late: Option<Instant>,
    /// Losses of supply.
    pub blackouts: Vec<Blackout, 1>,
    /// Faults of the sensors.
    pub sensors: Vec<SensorFault, 3>,
    /// When the recorder hangs.
    pub hang: Option<Instant>,
}

impl VehiclePlan {
    /// Nothing goes wrong.
    pub const NONE: Self = Self {
        buses: [None; CHIPS.len()],
        ready: [None; 3],
        late: None,
        blackouts: Vec::new(),
        sensors: Vec::new(),
        hang: None,
    };

    /// The plan of a fault that comes at a time in s, or of none.
    #[must_use]
    pub fn at(fault: Option<VehicleFault>, seconds: f64) -> Self {
        let mut plan = Self::NONE;
        let middle = Instant::from_micros((seconds * 1e6) as u64);
        let clipped = |channels: core::ops::Range<usize>, for_s: f64| {
            let (from_s, until_s) = (seconds, seconds + for_s);
            channels
                .map(|channel| SensorFault::Saturated { channel, from_s, until_s })
                .collect::<Vec<_, 3>>()
        };
        match fault {
            Some(VehicleFault::Chip(select, sickness)) => plan.sicken(select, sickness, middle),
            Some(VehicleFault::OutOfStep) => plan.late = Some(middle),
            Some(VehicleFault::SaturationOnce) => plan.sensors = clipped(1..2, PASSING),
            Some(VehicleFault::Saturation) => plan.sensors = clipped(1..2, f64::INFINITY),
            Some(VehicleFault::OverloadOnce) => plan.sensors = clipped(3..6, PASSING),
            Some(VehicleFault::Overload) => plan.sensors = clipped(3..6, f64::INFINITY),
            Some(VehicleFault::Overflow) => plan.hang = Some(middle),
            // What the vehicle does is in its day.
            _ => {}
        }
        plan
    }

    fn sicken(&mut self, select: Select, sickness: Sickness, middle: Instant) {
        let place = place(select);
        match sickness.showing(place < self.ready.len(), middle) {
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

impl Around for VehiclePlan {
    type Spi<S: SpiDevice> = FaultySpi<S>;
    type Line<W: Wait> = LateReady<FaultyReady<W>>;

    fn spi<S: SpiDevice>(&self, select: Select, bus: S) -> FaultySpi<S> {
        FaultySpi::new(bus, self.buses[place(select)])
    }

    fn line<W: Wait>(&self, select: Select, line: W) -> LateReady<FaultyReady<W>> {
        let line = FaultyReady::new(line, self.ready.get(place(select)).copied().flatten());
        LateReady { line, since: self.late.filter(|_| select == Select::GyroRight) }
    }
}

/// A data-ready line that falls late from some time on.
#[derive(Debug)]
pub struct LateReady<W> {
    line: W,
    since: Option<Instant>,
}

impl<W> LateReady<W> {
    async fn lag(&self) {
        if self.since.is_some_and(|since| Instant::now() >= since) {
            Timer::after(LATE).await;
        }
    }
}

impl<W: ErrorType> ErrorType for LateReady<W> {
    type Error = W::Error;
}

impl<W: Wait> Wait for LateReady<W> {
    fn wait_for_high(&mut self) -> impl Future<Output = Result<(), W::Error>> {
        self.line.wait_for_high()
    }

    async fn wait_for_low(&mut self) -> Result<(), W::Error> {
        self.line.wait_for_low().await?;
        self.lag().await;
        Ok(())
    }

    fn wait_for_rising_edge(&mut self) -> impl Future<Output = Result<(), W::Error>> {
        self.line.wait_for_rising_edge()
    }

    async fn wait_for_falling_edge(&mut self) -> Result<(), W::Error> {
        self.line.wait_for_falling_edge().await?;
        self.lag().await;
        Ok(())
    }

    fn wait_for_any_edge(&mut self) -> impl Future<Output = Result<(), W::Error>> {
        self.line.wait_for_any_edge()
    }
}
