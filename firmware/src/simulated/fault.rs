//! The catalogue of what can go wrong with a simulated board, each by its name.

use core::fmt;

use embassy_time::{Duration, Instant, Timer};
use embedded_hal_async::digital::Wait;
use embedded_hal_async::spi::SpiDevice;
use hal_mock::chip::Select;
use hal_mock::disturbance::Disturbance;
use hal_mock::fault::{Blackout, BusFault, FaultPlan, FaultyReady, FaultySpi, When};
use hal_mock::plant::StageFault;
use heapless::Vec;
use orientation::units::TURN;

use super::Around;
use crate::ports::Recorder;

/// When things go wrong that go wrong in the middle: in a dwell of the default schedule.
const MIDDLE: Instant = Instant::from_secs(65);
/// How long a passing fault of the stage lasts: it spans the rotation that follows.
const PASSING: Duration = Duration::from_secs(15);
/// Chooses the bits that are flipped.
const FLIP: u64 = 6;
/// For how long a recorder that hangs takes no sample.
const HANG: Duration = Duration::from_millis(500);
/// Angle at which a cable is caught, rad: 200°.
const CAUGHT: f64 = 200.0 / 360.0 * TURN;
/// By how much the encoder's magnet slips, rad: 0.5°.
const SLIP: f64 = 0.5 / 360.0 * TURN;
/// How fast it creeps, rad/s: 0.02°/s, by which three steps of 15° add up to what a stage tolerates.
const CREEP: f64 = 0.02 / 360.0 * TURN;

/// What is wrong with a chip or its bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sickness {
    /// Another chip answers, or none, from the start.
    Identity,
    /// One bit of one reply is wrong.
    ChecksumOnce,
    /// One bit of every reply is wrong.
    ChecksumAlways,
    /// The same reply comes again and again.
    Stuck,
    /// No data-ready any more; where there is no such line, no answer any more.
    Silent,
    /// One data-ready edge is lost; where there is no such line, one answer.
    SilentOnce,
    /// The supply is lost for a moment.
    Reset,
    /// The bus reports an error once.
    BusOnce,
    /// The bus reports errors from some time on.
    BusAlways,
    /// One transfer takes 300 ms.
    Hang,
}

/// Where a sickness shows.
pub(super) enum Showing {
    /// In a loss of supply, when it comes.
    Supply,
    /// On the data-ready line.
    Ready(When),
    /// On the bus.
    Bus(FaultPlan),
}

impl Sickness {
    /// Where it shows at a chip that has a data-ready line, or has none.
    pub(super) fn showing(self, has_line: bool, middle: Instant) -> Showing {
        let once = When::once(middle);
        let always = When::always(middle);
        let (fault, when) = match self {
            Self::Reset => return Showing::Supply,
            Self::Silent if has_line => return Showing::Ready(always),
            Self::SilentOnce if has_line => return Showing::Ready(once),
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
        Showing::Bus(FaultPlan { fault, when })
    }
}

/// Something that goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// With a chip.
    Chip(Select, Sickness),
    /// Something blocks the stage for a while.
    BlockedOnce,
    /// Something blocks the stage for good.
    Blocked,
    /// A cable is caught at 200°, within the travel.
    TravelLimit,
    /// The encoder's magnet slips by half a degree.
    EncoderSlip,
    /// The magnet has slipped before the start.
    EncoderSlipAtStart,
    /// The magnet slips while something blocks the stage.
    EncoderSlipBlocked,
    /// The magnet creeps whenever the stage turns.
    EncoderCreep,
    /// Every transfer of the gyro's converter takes 300 ms.
    GyroHang,
    /// The gyro's output clips for two seconds.
    SaturationOnce,
    /// The gyro's output clips for good.
    Saturation,
    /// The accelerometer's output clips for two seconds.
    OverloadOnce,
    /// The accelerometer's output clips for good.
    Overload,
    /// Whoever takes the samples does not for half a second.
    Overflow,
    /// A door falls shut.
    DoorSlam,
    /// Somebody leans on the base for some seconds.
    Nudge,
}

const CHIPS: [(Select, &str); 4] = [
    (Select::Gyro, "gyro"),
    (Select::Accelerometer, "accelerometer"),
    (Select::Encoder, "encoder"),
    (Select::Actuator, "stage"),
];

pub(super) const SICKNESSES: [(Sickness, &str); 10] = [
    (Sickness::Identity, "identity"),
    (Sickness::ChecksumOnce, "checksum-once"),
    (Sickness::ChecksumAlways, "checksum-always"),
    (Sickness::Stuck, "stuck"),
    (Sickness::SilentOnce, "silent-once"),
    (Sickness::Silent, "silent"),
    (Sickness::Reset, "reset"),
    (Sickness::BusOnce, "bus-once"),
    (Sickness::BusAlways, "bus-always"),
    (Sickness::Hang, "hang"),
];

const OTHERS: [(Fault, &str); 15] = [
    (Fault::BlockedOnce, "stage-blocked-once"),
    (Fault::Blocked, "stage-blocked"),
    (Fault::TravelLimit, "travel-limit"),
    (Fault::EncoderSlip, "encoder-slip"),
    (Fault::EncoderSlipAtStart, "encoder-slip-at-start"),
    (Fault::EncoderSlipBlocked, "blocked-slip"),
    (Fault::EncoderCreep, "encoder-creep"),
    (Fault::GyroHang, "gyro-hang-always"),
    (Fault::SaturationOnce, "saturation-once"),
    (Fault::Saturation, "saturation-always"),
    (Fault::OverloadOnce, "overload-once"),
    (Fault::Overload, "overload-always"),
    (Fault::Overflow, "overflow-once"),
    (Fault::DoorSlam, "door-slam"),
    (Fault::Nudge, "base-nudge"),
];

/// How many faults there are.
pub const COUNT: usize = CHIPS.len() * SICKNESSES.len() + OTHERS.len();

impl Fault {
    /// All faults: every chip with every sickness, then the rest.
    pub fn all() -> impl Iterator<Item = Self> {
        let chips = CHIPS.iter().flat_map(|(select, _)| {
            SICKNESSES.iter().map(|(sickness, _)| Self::Chip(*select, *sickness))
        });
        chips.chain(OTHERS.iter().map(|(fault, _)| *fault))
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Self::Chip(select, sickness) = self {
            return write!(f, "{}-{}", name(&CHIPS, select), name(&SICKNESSES, sickness));
        }
        f.write_str(name(&OTHERS, self))
    }
}

/// The name that a table gives to a value; every value is in its table.
pub(super) fn name<T: PartialEq>(table: &[(T, &'static str)], value: &T) -> &'static str {
    table.iter().find(|(entry, _)| entry == value).map_or("", |(_, name)| name)
}

/// What a fault does to the parts of the board.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Faults of the four buses: gyro, accelerometer, encoder, actuator.
    pub buses: [Option<FaultPlan>; 4],
    /// Lost data-ready edges.
    pub ready: Option<When>,
    /// Losses of supply.
    pub blackouts: Vec<Blackout, 1>,
    /// Faults of the stage.
    pub stage: Vec<StageFault, 2>,
    /// What happens to the base.
    pub disturbances: Vec<Disturbance, 1>,
    /// Angle at which the travel ends too soon, rad.
    pub caught: Option<f64>,
    /// When the recorder hangs.
    pub hang: Option<Instant>,
}

impl Plan {
    /// Nothing goes wrong.
    pub const NONE: Self = Self {
        buses: [None; 4],
        ready: None,
        blackouts: Vec::new(),
        stage: Vec::new(),
        disturbances: Vec::new(),
        caught: None,
        hang: None,
    };

    /// The plan of a fault, or of none.
    #[must_use]
    pub fn of(fault: Option<Fault>) -> Self {
        Self::at(fault, MIDDLE)
    }

    /// The same of one that comes in the middle at another time.
    #[must_use]
    pub fn at(fault: Option<Fault>, middle: Instant) -> Self {
        let mut plan = Self::NONE;
        match fault {
            None => {}
            Some(Fault::Chip(select, sickness)) => plan.sicken(select, sickness, middle),
            Some(other) => plan.disturb(other, middle),
        }
        plan
    }

    fn sicken(&mut self, select: Select, sickness: Sickness, middle: Instant) {
        match sickness.showing(select == Select::Gyro, middle) {
            Showing::Supply => {
                self.blackouts = [Blackout { select, at: middle }].into_iter().collect();
            }
            Showing::Ready(when) => self.ready = Some(when),
            Showing::Bus(plan) => self.buses[place(select)] = Some(plan),
        }
    }

    fn disturb(&mut self, fault: Fault, middle: Instant) {
        let seconds = middle.as_micros() as f64 * 1e-6;
        let held = |until| StageFault::Block { from: middle, until };
        let slip = |at| StageFault::Slip { at, by_rad: SLIP };
        let stage = match fault {
            Fault::BlockedOnce => Some(held(middle + PASSING)),
            Fault::Blocked => Some(held(Instant::MAX)),
            Fault::EncoderSlip => Some(slip(middle)),
            Fault::EncoderSlipAtStart => Some(slip(Instant::MIN)),
            Fault::EncoderSlipBlocked => Some(slip(middle + PASSING / 2)),
            Fault::EncoderCreep => Some(StageFault::Creep { from: middle, rad_per_s: CREEP }),
            _ => None,
        };
        let block = matches!(fault, Fault::EncoderSlipBlocked).then(|| held(middle + PASSING));
        let disturbance = match fault {
            Fault::SaturationOnce => Some(Disturbance::overload(seconds, 2.0)),
            Fault::Saturation => Some(Disturbance::overload(seconds, 1e6)),
            Fault::OverloadOnce => Some(Disturbance::force_overload(seconds, 2.0)),
            Fault::Overload => Some(Disturbance::force_overload(seconds, 1e6)),
            Fault::DoorSlam => Some(Disturbance::door_slam(seconds)),
            Fault::Nudge => {
                Some(Disturbance::Nudge { start_s: seconds, seconds: 4.0, rate_deg_h: 2.0 })
            }
            _ => None,
        };
        self.stage = stage.into_iter().chain(block).collect();
        if fault == Fault::GyroHang {
            let plan = FaultPlan { fault: BusFault::Hang, when: When::always(middle) };
            self.buses[place(Select::Gyro)] = Some(plan);
        }
        self.disturbances = disturbance.into_iter().collect();
        self.caught = (fault == Fault::TravelLimit).then_some(CAUGHT);
        self.hang = (fault == Fault::Overflow).then_some(middle);
    }
}

impl Around for Plan {
    type Spi<S: SpiDevice> = FaultySpi<S>;
    type Line<W: Wait> = FaultyReady<W>;

    fn spi<S: SpiDevice>(&self, select: Select, bus: S) -> FaultySpi<S> {
        FaultySpi::new(bus, self.buses[place(select)])
    }

    fn line<W: Wait>(&self, _: Select, line: W) -> FaultyReady<W> {
        FaultyReady::new(line, self.ready)
    }
}

/// The place of a chip in [`Plan::buses`].
fn place(select: Select) -> usize {
    match select {
        Select::Gyro
        | Select::GyroUp
        | Select::GyroRight
        | Select::GyroDown
        | Select::ForceUp
        | Select::ForceRight => 0,
        Select::Accelerometer => 1,
        Select::Encoder | Select::InnerEncoder => 2,
        Select::Actuator | Select::InnerActuator => 3,
    }
}

/// A recorder that may hang once.
#[derive(Debug)]
pub struct FaultyRecorder<R> {
    recorder: R,
    hang: Option<Instant>,
}

impl<R> FaultyRecorder<R> {
    /// The recorder with the time when it hangs, or a healthy one.
    pub const fn new(recorder: R, hang: Option<Instant>) -> Self {
        Self { recorder, hang }
    }
}

impl<S, R: Recorder<S>> Recorder<S> for FaultyRecorder<R> {
    async fn record(&mut self, sample: &S) {
        if self.hang.take_if(|at| Instant::now() >= *at).is_some() {
            Timer::after(HANG).await;
        }
        self.recorder.record(sample).await;
    }
}
