//! What a fault does to the parts of a board, whatever carries it.

use drivers::data_ready::DataReady;
use embassy_time::{Duration, Instant};
use embedded_hal_async::digital::Wait;
use embedded_hal_async::i2c::{ErrorKind, I2c};
use embedded_hal_async::spi::SpiDevice;
use hal_mock::chip::Select;
use hal_mock::disturbance::Disturbance;
use hal_mock::fault::{Blackout, BusFault, FaultPlan, FaultyI2c, FaultyReady, FaultySpi, When};
use hal_mock::plant::StageFault;
use hal_mock::sensor_fault::{SensorFailure, SensorFault};
use heapless::Vec;
use orientation::device::Device;
use orientation::units::TURN;

use super::{AxisFault, Chip, ChipFault, Fault, InjectionPoint, PortWrapper};
use firmware::ports::Frames;

/// When things go wrong that go wrong in the middle of positions: in a dwell of the default schedule.
const MIDDLE: Instant = Instant::from_secs(65);
/// How long a passing fault of an axis lasts: it spans the rotation that follows.
const PASSING: Duration = Duration::from_secs(15);
/// Duration of a passing saturation of a sensor, s; the second one on a spinning body.
const CLIPPED: f64 = 2.0;
const CLIPPED_SPINNING: f64 = 0.3;
/// Duration of a lasting saturation of a sensor, s: longer than any run.
const EVER: f64 = 1e6;
/// Angles at which a cable is caught, rad: 200° on a stage, 60° on a frame, whose travel ends at 100°.
const CAUGHT: f64 = 200.0 / 360.0 * TURN;
const CAUGHT_FRAME: f64 = 60.0 / 360.0 * TURN;
/// By how much the encoder's magnet slips, rad: 0.5°.
const SLIP: f64 = 0.5 / 360.0 * TURN;
/// How fast the magnet creeps, rad/s: 0.02°/s, by which three steps of 15° add up to what a stage tolerates.
const CREEP: f64 = 0.02 / 360.0 * TURN;

/// What a fault does to the parts of a board. A part that a board does not have is not looked at.
#[must_use]
#[derive(Clone, Debug, Default)]
pub struct Injection {
    /// Faults of serial buses, by the chip that is selected.
    pub buses: Vec<(Select, FaultPlan), 2>,
    /// Lost data-ready edges, by the converter.
    pub ready: Vec<(Select, When), 1>,
    /// The converter whose conversions come late, and since when.
    pub late: Option<(Select, Instant)>,
    /// When the coarse IMU on the base does not answer.
    pub coarse_imu: Option<When>,
    /// Losses of supply.
    pub blackouts: Vec<Blackout, 1>,
    /// Faults of the sensors of a vehicle or a spinning body.
    pub sensors: Vec<SensorFault, 3>,
    /// Faults of the frames; the one axis of a stage is the outer one.
    pub axes: Frames<Vec<StageFault, 2>>,
    /// Angles at which the frames' travel ends too soon, rad.
    pub caught: Frames<Option<f64>>,
    /// What happens to the base of a stage or of two frames.
    pub disturbances: Vec<Disturbance, 1>,
    /// When the recorder hangs.
    pub hang: Option<Instant>,
}

impl Injection {
    /// Nothing goes wrong.
    pub const NONE: Self = Self {
        buses: Vec::new(),
        ready: Vec::new(),
        late: None,
        coarse_imu: None,
        blackouts: Vec::new(),
        sensors: Vec::new(),
        axes: Frames { outer: Vec::new(), inner: Vec::new() },
        caught: Frames { outer: None, inner: None },
        disturbances: Vec::new(),
        hang: None,
    };

    /// What a fault does that comes in the third dwell or so, or nothing.
    pub fn of(fault: Option<Fault>) -> Self {
        Self::at(fault, MIDDLE)
    }

    /// What a fault does that comes at a time, or nothing. What a vehicle does wrong is in its day, how a
    /// spinning body flies wrong in its course.
    pub fn at(fault: Option<Fault>, middle: Instant) -> Self {
        let mut injection = Self::NONE;
        match fault {
            None => {}
            Some(Fault::Chip(device, fault)) => injection.chip(device, fault, middle),
            Some(Fault::Axis(device, fault)) => injection.axis(device, fault, middle),
            Some(Fault::GyroHang) => {
                let plan = FaultPlan { fault: BusFault::Hang, when: When::always(middle) };
                injection.buses = one((Select::Gyro, plan));
            }
            Some(Fault::OutOfStep) => injection.late = Some((Select::GyroRight, middle)),
            Some(Fault::Overflow) => injection.hang = Some(middle),
            Some(other) => injection.clip(other, middle),
        }
        injection
    }

    fn chip(&mut self, device: Device, fault: ChipFault, middle: Instant) {
        let Some(chip) = Chip::of(device) else { return };
        match (chip.select, fault.point(chip.has_line(), middle)) {
            (Some(select), InjectionPoint::Supply(at)) => {
                self.blackouts = one(Blackout { select, at });
            }
            (Some(select), InjectionPoint::Ready(when)) => self.ready = one((select, when)),
            (Some(select), InjectionPoint::Bus(plan)) => self.buses = one((select, plan)),
            (None, InjectionPoint::Bus(plan)) => self.coarse_imu = Some(plan.when),
            (None, _) => {}
        }
    }

    fn axis(&mut self, device: Device, fault: AxisFault, middle: Instant) {
        let held = |until| StageFault::Block { from: middle, until };
        let slip = |at| StageFault::Slip { at, by_rad: SLIP };
        let passed = middle + PASSING;
        let faults: &[StageFault] = match fault {
            AxisFault::BlockedOnce => &[held(passed)],
            AxisFault::Blocked => &[held(Instant::MAX)],
            AxisFault::TravelLimit => &[],
            AxisFault::Slip => &[slip(middle)],
            AxisFault::SlipAtStart => &[slip(Instant::MIN)],
            AxisFault::SlipBlocked => &[slip(middle + PASSING / 2), held(passed)],
            AxisFault::Creep => &[StageFault::Creep { from: middle, rad_per_s: CREEP }],
        };
        let limit = if device == Device::Stage { CAUGHT } else { CAUGHT_FRAME };
        let (axis, caught) = match device {
            Device::InnerFrame => (&mut self.axes.inner, &mut self.caught.inner),
            _ => (&mut self.axes.outer, &mut self.caught.outer),
        };
        *axis = faults.iter().copied().collect();
        *caught = (fault == AxisFault::TravelLimit).then_some(limit);
    }

    /// What clips sensors or shakes the base: of stages and frames by what happens to the base, of vehicles
    /// and spinning bodies by what the sensors show.
    fn clip(&mut self, fault: Fault, middle: Instant) {
        let start_s = middle.as_micros() as f64 * 1e-6;
        let lasts = matches!(fault, Fault::Saturation | Fault::Overload);
        let seconds = if lasts { EVER } else { CLIPPED };
        let clipped = |channels: core::ops::Range<usize>, seconds: f64| {
            let until_s = start_s + seconds;
            let saturated = |channel| SensorFault {
                failure: SensorFailure::Saturated(channel),
                from_s: start_s,
                until_s,
            };
            channels.map(saturated).collect()
        };
        let (sensors, disturbance) = match fault {
            Fault::SaturationOnce | Fault::Saturation => {
                (clipped(1..2, seconds), Disturbance::overload(start_s, seconds))
            }
            Fault::OverloadOnce | Fault::Overload => {
                (clipped(3..6, seconds), Disturbance::force_overload(start_s, seconds))
            }
            Fault::DoorSlam => (Vec::new(), Disturbance::door_slam(start_s)),
            Fault::Nudge => {
                let (seconds, rate_deg_h, none) = (4.0, 2.0, Disturbance::default());
                (Vec::new(), Disturbance { start_s, seconds, rate_deg_h, ..none })
            }
            Fault::SpinSaturation => return self.sensors = clipped(0..1, CLIPPED_SPINNING),
            Fault::SpinOverload => return self.sensors = clipped(3..5, CLIPPED_SPINNING),
            _ => return,
        };
        self.sensors = sensors;
        self.disturbances = one(disturbance);
    }
}

/// A list of one.
fn one<T, const N: usize>(item: T) -> Vec<T, N> {
    core::iter::once(item).collect()
}

/// What a list holds for a chip.
fn for_chip<T: Copy>(list: &[(Select, T)], select: Select) -> Option<T> {
    list.iter().find(|(chip, _)| *chip == select).map(|(_, item)| *item)
}

impl PortWrapper for Injection {
    type Spi<S: SpiDevice> = FaultySpi<S>;
    type Line<W: Wait> = FaultyReady<W>;
    type Ready<D: DataReady> = D;
    type I2c<B: I2c<Error = ErrorKind>> = FaultyI2c<B>;

    fn spi<S: SpiDevice>(&self, select: Select, bus: S) -> FaultySpi<S> {
        FaultySpi::new(bus, for_chip(&self.buses, select))
    }

    fn line<W: Wait>(&self, select: Select, line: W) -> FaultyReady<W> {
        let since = self.late.filter(|(chip, _)| *chip == select).map(|(_, since)| since);
        FaultyReady::new(line, for_chip(&self.ready, select), since)
    }

    fn ready<D: DataReady>(&self, line: D) -> D {
        line
    }

    fn i2c<B: I2c<Error = ErrorKind>>(&self, bus: B) -> FaultyI2c<B> {
        FaultyI2c::new(bus, self.coarse_imu)
    }
}
