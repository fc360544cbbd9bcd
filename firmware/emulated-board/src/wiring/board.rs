//! The simulated chips of a carrier on the pins of the board B-L475E-IOT01A, as its image's first page lists them.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::rc::Rc;
use std::slice;

use embassy_time::Instant;
use hal_mock::ads1262::Ads1262;
use hal_mock::assembly::{Board as Assembly, Chips};
use hal_mock::board::StageChips;
use hal_mock::chip::{Rig, Select, Single};
use hal_mock::converters::Converters;
use hal_mock::gimbal::board::GimbalChips;
use hal_mock::i2c::I2cChip;
use hal_mock::lsm6dsl::Lsm6dsl;
use hal_mock::plant::base::Base;
use hal_mock::tmc5160::{ChipFault, Tmc5160};
use hal_mock::wires::{Clock, I2cWires, SpiWires};

use super::{I2cBus, Pin, Wiring};
use crate::time::Time;

/// Select lines of a carrier: pin, serial bus and chip.
pub type Selects = &'static [(Pin, usize, Select)];
/// Data-ready lines of a carrier: pin and chip.
pub type Lines = &'static [(Pin, Select)];

/// Select lines of a stage or a turntable.
pub const STAGE: Selects = &[
    (Pin::named(b"PA2"), 0, Select::Gyro),
    (Pin::named(b"PA15"), 0, Select::Accelerometer),
    (Pin::named(b"PD0"), 1, Select::Encoder),
    (Pin::named(b"PD5"), 1, Select::Actuator),
];
/// Select lines of two frames.
pub const FRAMES: Selects = &[
    STAGE[0],
    STAGE[1],
    STAGE[2],
    STAGE[3],
    (Pin::named(b"PB2"), 1, Select::InnerEncoder),
    (Pin::named(b"PA4"), 1, Select::InnerActuator),
];
/// Select lines in a vehicle.
pub const VEHICLE: Selects = &[
    STAGE[0],
    STAGE[1],
    (Pin::named(b"PB2"), 0, Select::GyroRight),
    (Pin::named(b"PA4"), 0, Select::GyroDown),
];
/// Select lines on a spinning body.
pub const SPIN: Selects = &[
    STAGE[0],
    (Pin::named(b"PB2"), 0, Select::GyroRight),
    (Pin::named(b"PA4"), 0, Select::GyroUp),
    (Pin::named(b"PA3"), 0, Select::ForceUp),
    (Pin::named(b"PB4"), 0, Select::ForceRight),
];
/// The pin that enables the motor drivers, active low.
const MOTORS: Pin = Pin::named(b"PD2");
/// Clock and data of the bus of the base.
const TWO_WIRES: [Pin; 2] = [Pin::named(b"PB10"), Pin::named(b"PB11")];
/// The pin to which the virtual COM port sends, which drives its wire at all times.
const LINK: Pin = Pin::named(b"PB7");
/// Rate of the virtual COM port at the other side of the link, baud, as `firmware/README.md` states it.
const BAUD: u32 = 115_200;
/// By how much of its rate that of a frame of ten bits may differ, %: a bit is read in its middle, and the last one by the
/// clock that its start has set (RM0351, 40.5.5).
const TOLERANCE: u32 = 3;
/// The data-ready line of a single converter.
pub const ONE_LINE: Lines = &[(Pin::named(b"PD14"), Select::Gyro)];
/// Data-ready lines in a vehicle.
pub const VEHICLE_LINES: Lines =
    &[ONE_LINE[0], (Pin::named(b"PB0"), Select::GyroRight), (Pin::named(b"PB1"), Select::GyroDown)];
/// Data-ready lines on a spinning body.
pub const SPIN_LINES: Lines = &[
    ONE_LINE[0],
    (Pin::named(b"PB0"), Select::GyroRight),
    (Pin::named(b"PB1"), Select::GyroUp),
    (Pin::named(b"PC4"), Select::ForceUp),
    (Pin::named(b"PC3"), Select::ForceRight),
];

/// The chips and the world of a carrier.
pub trait Carrier: Rig {
    /// What was done to chips that their data sheets forbid, as sentences.
    fn violations(&mut self) -> Vec<String>;

    /// Conversions that a newer one replaced before they were read.
    fn lost(&self) -> u64;

    /// The motor drivers are enabled or not, where there are any.
    fn enable_motors(&mut self, is_enabled: bool);
}

impl<P, C: Chips<P> + Parts> Carrier for Assembly<'_, P, C> {
    fn violations(&mut self) -> Vec<String> {
        self.recorded().map(|(chip, violation)| format!("{chip:?}: {violation}")).collect()
    }

    fn lost(&self) -> u64 {
        self.chips.converters().iter().map(|converter| converter.overwritten).sum()
    }

    fn enable_motors(&mut self, is_enabled: bool) {
        let fault = if is_enabled { ChipFault::None } else { ChipFault::Disabled };
        self.chips.motors().iter_mut().for_each(|motor| motor.inject(fault));
    }
}

/// Chips of a carrier by what they are.
pub trait Parts {
    /// The converters.
    fn converters(&self) -> &[Ads1262];

    /// The motor drivers.
    fn motors(&mut self) -> &mut [Tmc5160];
}

impl<A, E> Parts for StageChips<Ads1262, A, E, Tmc5160> {
    fn converters(&self) -> &[Ads1262] {
        slice::from_ref(&self.gyro)
    }

    fn motors(&mut self) -> &mut [Tmc5160] {
        slice::from_mut(&mut self.actuator)
    }
}

impl Parts for GimbalChips {
    fn converters(&self) -> &[Ads1262] {
        slice::from_ref(&self.gyro)
    }

    fn motors(&mut self) -> &mut [Tmc5160] {
        &mut self.actuators
    }
}

impl<const N: usize> Parts for Converters<N> {
    fn converters(&self) -> &[Ads1262] {
        &self.converters
    }

    fn motors(&mut self) -> &mut [Tmc5160] {
        &mut []
    }
}

/// The IMU of the board on the base under a platform.
pub type BaseImu = Single<Lsm6dsl, Base<'static>>;

/// A data-ready line and when it next falls.
struct Line {
    pin: Pin,
    select: Select,
    next: Option<Instant>,
    /// Since when a conversion waits to be read.
    waits: Option<Time>,
    /// How conversions were served.
    served: Served,
}

/// How the conversions of a converter were served.
#[derive(Clone, Copy, Debug, Default)]
pub struct Served {
    /// Conversions that were read.
    pub read: u64,
    /// The longest time for which a converter waited to be read, from the end of the first conversion that waited, and
    /// when it was read; or now, where it waits.
    pub longest: (Time, Time),
}

/// A board with a carrier's chips on its pins.
pub struct Board {
    /// The chips and the world.
    carrier: Rc<RefCell<dyn Carrier>>,
    /// The wires of the serial buses.
    buses: [SpiWires; 2],
    selects: Selects,
    lines: Vec<Line>,
    /// The IMU on the base, and the bus to it.
    base: (Option<BaseImu>, I2cWires),
    /// Whether the pins of its clock and data, as outputs, hold these wires low.
    pulled: [bool; 2],
    /// Whether the motor drivers are enabled.
    motors: bool,
    /// When the latest byte on a serial bus began.
    begun: Time,
    /// The first rate of a frame on the link that its other side does not understand, baud.
    other_rate: Option<u32>,
    /// Pins whose wires something else drives, and which the controller has driven.
    opposed: BTreeSet<Pin>,
}

impl Board {
    /// A board with these chips on these pins.
    pub fn new(
        carrier: Rc<RefCell<dyn Carrier>>,
        (selects, lines): (Selects, Lines),
        base: Option<BaseImu>,
    ) -> Self {
        let line = |(pin, select): &(Pin, Select)| Line {
            pin: *pin,
            select: *select,
            next: None,
            waits: None,
            served: Served::default(),
        };
        let buses = [SpiWires::new(), SpiWires::new()];
        let lines = lines.iter().map(line).collect();
        let base = (base, I2cWires::new());
        Self {
            carrier,
            buses,
            selects,
            lines,
            base,
            pulled: [false; 2],
            motors: true,
            begun: Time::ZERO,
            other_rate: None,
            opposed: BTreeSet::new(),
        }
    }

    /// Looks when the data-ready lines next fall.
    fn look(&mut self, now: Time) {
        for line in &mut self.lines {
            line.next = self.carrier.borrow_mut().ready_line(line.select, now.instant()).next;
        }
    }

    /// A pin holds a wire of the base's bus low, 0 its clock and 1 its data, or no longer: what the device sees of it. A
    /// start by the pins is not modelled.
    fn pull(&mut self, wire: usize, is_low: bool, now: Time) {
        let was_low = std::mem::replace(&mut self.pulled[wire], is_low);
        match (wire, was_low, is_low) {
            (0, false, true) => self.base.1.clock_falls(),
            (1, true, false) if !self.pulled[0] => self.stop(now),
            _ => {}
        }
    }

    /// What drives the wire of a pin at all times, whatever the controller does; none where nothing does.
    fn driver(&self, pin: Pin) -> Option<String> {
        let line = self.lines.iter().find(|line| line.pin == pin);
        line.map(|line| format!("{:?}", line.select))
            .or_else(|| (pin == LINK).then(|| "the virtual COM port".to_owned()))
    }

    /// Counts the conversions that are read from now on: the first byte to a converter lifts its line.
    fn serve(&mut self, now: Time) {
        for line in self.lines.iter_mut().filter(|line| line.waits.is_some()) {
            let seen = self.carrier.borrow_mut().ready_line(line.select, now.instant());
            if let Some(since) = line.waits.take_if(|_| !seen.active) {
                line.served.read += 1;
                line.served.longest = line.served.longest.max((now - since, now));
            }
        }
    }
}

impl I2cBus for Board {
    fn start(&mut self, address: u8, reads: bool, hertz: u32, now: Time) -> bool {
        let (base, wires) = &mut self.base;
        base.as_mut()
            .is_some_and(|base| wires.start(base, address, reads, hertz, now.as_nanoseconds()))
    }

    fn write(&mut self, byte: u8, now: Time) -> bool {
        let (base, wires) = &mut self.base;
        base.as_mut().is_some_and(|base| wires.write(base, byte, now.as_nanoseconds()))
    }

    fn read(&mut self, is_acknowledged: bool, now: Time) -> u8 {
        let (base, wires) = &mut self.base;
        base.as_mut().map_or(0xFF, |base| wires.read(base, is_acknowledged, now.as_nanoseconds()))
    }

    fn stop(&mut self, now: Time) {
        if let (Some(base), wires) = &mut self.base {
            wires.stop(base, now.as_nanoseconds());
        }
    }

    fn stop_clock(&mut self, bit: u32, began: Time) {
        if let (Some(base), wires) = &mut self.base {
            wires.stop_clock(base, bit, began.as_nanoseconds());
        }
    }
}

impl Wiring for Board {
    fn served(&mut self, now: Time) -> Served {
        let mut sum = Served::default();
        for line in &mut self.lines {
            let Served { read, longest } = std::mem::take(&mut line.served);
            let waits = line.waits.map_or(longest, |since| (now - since, now));
            sum.read += read;
            sum.longest = sum.longest.max(longest).max(waits);
        }
        sum
    }

    fn drive(&mut self, pin: Pin, level: Option<bool>, now: Time) {
        if level.is_some() && self.driver(pin).is_some() {
            self.opposed.insert(pin);
        }
        if pin == MOTORS {
            // A resistor pulls the pin up where nothing drives it.
            let is_enabled = level == Some(false);
            if std::mem::replace(&mut self.motors, is_enabled) != is_enabled {
                self.carrier.borrow_mut().enable_motors(is_enabled);
            }
        }
        // Resistors pull select lines, and the two wires, up where nothing drives them.
        let is_low = level == Some(false);
        if let Some(wire) = TWO_WIRES.iter().position(|own| *own == pin) {
            self.pull(wire, is_low, now);
        }
        for (_, bus, select) in self.selects.iter().filter(|(own, ..)| *own == pin) {
            self.buses[*bus].set_select(
                &mut *self.carrier.borrow_mut(),
                *select,
                is_low,
                now.as_nanoseconds(),
            );
            if !is_low {
                self.look(now);
            }
        }
    }

    fn level(&mut self, pin: Pin, now: Time) -> bool {
        if pin == TWO_WIRES[1] {
            return !self.base.1.is_data_low();
        }
        let line = self.lines.iter().find(|line| line.pin == pin);
        // What nothing drives is pulled up.
        line.is_none_or(|line| {
            !self.carrier.borrow_mut().ready_line(line.select, now.instant()).active
        })
    }

    fn begin(&mut self, bus: usize, byte: u8, clock: Clock, now: Time) {
        self.buses[bus].begin(&mut *self.carrier.borrow_mut(), byte, clock, now.as_nanoseconds());
        self.begun = now;
    }

    fn finish(&mut self, bus: usize) -> u8 {
        let answer = self.buses[bus].finish(&mut *self.carrier.borrow_mut());
        self.serve(self.begun);
        answer
    }

    fn baud(&self) -> u32 {
        BAUD
    }

    fn frame(&mut self, baud: u32) {
        if baud.abs_diff(BAUD) > BAUD / 100 * TOLERANCE {
            self.other_rate.get_or_insert(baud);
        }
    }

    fn faults(&self) -> Vec<String> {
        let spi =
            self.buses.iter().flat_map(|bus| bus.faults().first.iter().map(ToString::to_string));
        let (base, wires) = &self.base;
        let of_base = base.iter().flat_map(|base| &I2cChip::<Base>::violations(&base.chip).first);
        let of_base = of_base.map(|violation| format!("base: {violation}"));
        let buses = spi.chain(wires.faults().first.iter().map(ToString::to_string));
        let link =
            self.other_rate.map(|baud| format!("the link: {baud} baud, where {BAUD} are meant"));
        let opposed = self.opposed.iter().filter_map(|pin| {
            Some(format!("{pin}: the controller drives it against {}", self.driver(*pin)?))
        });
        buses.chain(of_base).chain(link).chain(opposed).collect()
    }

    fn due(&self) -> Time {
        self.lines.iter().filter_map(|line| line.next).min().map_or(Time::NEVER, Time::of)
    }

    fn edges(&mut self, now: Time) -> Vec<(Pin, bool)> {
        let mut fallen = Vec::new();
        for line in
            self.lines.iter_mut().filter(|line| line.next.is_some_and(|at| at <= now.instant()))
        {
            line.waits.get_or_insert(now);
            fallen.push((line.pin, false));
        }
        self.look(now);
        fallen
    }
}
