//! Simulated TMC5160: stepper driver with ramp generator of the stage (Trinamic data sheet, rev. 1.14).
//!
//! ```text
//!  SPI ─▶ map (access, reserved bits) ─▶ ramp ─microsteps─▶ Mechanics
//!            └─▶ status (flags, SPI_STATUS) ◀─blocked, switches─┘
//! ```
//!
//! While the motor moves the chip looks at its surroundings every [`STEP`] (some 1 300 instructions of a
//! Cortex-M4F): switches and stalls act with that granularity, except that XLATCH holds the place of an
//! edge where the surroundings know it. Standing it has no events and looks at
//! each transaction.
//!
//! Simplified: `SG_RESULT` is 0 where the motor is blocked and [`FREE_RUNNING`] otherwise, `CoolStep`,
//! `DcStep`, `StealthChop` and the encoder input are registers without effect, `VSTART` acts in
//! positioning mode only, and reading a write-only register (on which the data sheet is silent) gives
//! zero and a violation. A write-only register is not read back, but [`Tmc5160::register`] shows it.

mod demand;
mod map;
mod ramp;
mod rules;
mod status;

use embassy_time::{Duration, Instant};
use embedded_hal::spi::MODE_3;

use self::demand::{Demand, FRACTION_BITS};
use self::map::{ADDRESSES, MAP, address};
use self::ramp::{Motion, Ramp};
use crate::chip::{BusLimits, Exchange, SpiChip};
use crate::environment::Mechanics;
use crate::registers::{self, Access, Registers};
use crate::violation::{Misuse, Violations};

/// Time between two looks at the surroundings while the motor moves.
pub const STEP: Duration = Duration::from_millis(1);

/// `SG_RESULT` of a motor that turns freely.
pub const FREE_RUNNING: u32 = 350;

/// The supply's reset ends so long after it is there (28.2, `VVCC_IO`, typical).
const RESET_DELAY: Duration = Duration::from_micros(10);

/// Bytes of a datagram (4.1).
const DATAGRAM: u8 = 5;

/// Microsteps in one electrical period: where the field stands after a reset.
const PERIOD: i64 = 1024;

/// Bits of a microstep that the field is driven with.
const FIELD_BITS: u32 = 20;

/// What the chip counts time with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Oscillator {
    /// The factory-calibrated one: 12 MHz, 11.5 … 12.5 MHz at 50 °C (28.2).
    Internal {
        /// True frequency of the oscillator, Hz.
        hertz: u32,
    },
    /// A clock on CLK, 4 … 18 MHz.
    External {
        /// Frequency of the clock on CLK, Hz.
        hertz: u32,
    },
}

impl Oscillator {
    /// Frequency of the clock, Hz; the chip's time counts it to the kilohertz below.
    pub(crate) const fn hertz(self) -> u32 {
        match self {
            Self::Internal { hertz } | Self::External { hertz } => hertz,
        }
    }

    /// Fastest bus clock, Hz (4.3).
    const fn bus_hertz(self) -> u32 {
        match self {
            Self::Internal { .. } => 4_000_000,
            Self::External { hertz } => hertz / 2,
        }
    }
}

/// Faults that only the chip itself can have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChipFault {
    /// The chip is well.
    #[default]
    None,
    /// The bridges are too hot.
    Overheated,
    /// Coil A is short to ground.
    Short,
    /// Coil A is not connected.
    OpenLoad,
    /// The charge pump's voltage is low.
    ChargePumpLow,
    /// `DRV_ENN` is high: the bridges are off.
    Disabled,
    /// `SD_MODE` is high: steps come from outside.
    StepMode,
    /// VERSION is another chip's.
    Foreign,
}

/// What has passed since the select line fell.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    /// The forty bits that go out and come in, the next one in the highest of 64 bits.
    shift: u64,
    /// Bytes that have passed; it stops at its limit.
    bytes: u8,
    /// The first of them.
    command: u8,
    /// Whether the chip was still starting.
    is_early: bool,
}

/// The chip.
#[derive(Clone, Debug)]
pub struct Tmc5160 {
    /// Oscillator that the chip counts time with.
    oscillator: Oscillator,
    /// Microsteps per second in one unit of the ramp's velocity.
    per_second: f64,
    /// What was written, and the latched flags, by address.
    registers: [u32; ADDRESSES],
    /// The ramp generator with the motor's field.
    ramp: Ramp,
    /// Latched bits of `RAMP_STAT`.
    events: u32,
    /// What the chip suffers from.
    chip_fault: ChipFault,
    /// Where the rotor was left when the bridges went off, in microsteps of the field.
    left: Option<i64>,
    /// Whole electrical periods by which the rotor stands beside the field since then, in microsteps.
    slipped: i64,
    /// Levels of REFL and REFR.
    pins: [bool; 2],
    /// How far the motor had gone beyond the left switch's last edge at the last look, microsteps.
    beyond: i32,
    /// The active switches at the last look, left and right.
    stops_seen: u8,
    /// Whether the target was reached at the last look.
    was_reached: bool,
    /// Whether TSTEP is below TCOOLTHRS.
    fast: bool,
    /// Whether the motor could not follow at the last look.
    blocked: bool,
    /// Clocks since the last motion.
    still: u64,
    /// When its supply came up.
    started: Instant,
    /// Up to when its motion is done.
    at: Instant,
    /// Thousandths of a clock that are not yet a whole one.
    remainder: u32,
    /// What the next datagram carries back (4.1.1).
    pending: u32,
    /// The status byte of the next datagram (4.1.2).
    latched: u8,
    /// The transaction under way.
    course: Course,
    /// What was done to the chip that its data sheet forbids.
    violations: Violations,
}

impl Tmc5160 {
    /// A chip whose supply comes up at `now`.
    #[must_use]
    pub fn new(oscillator: Oscillator, now: Instant) -> Self {
        let mut chip = Self {
            oscillator,
            per_second: f64::from(oscillator.hertz()) / (1_u64 << 41) as f64,
            registers: registers::reset(MAP),
            ramp: Ramp::at(0),
            events: 0,
            chip_fault: ChipFault::None,
            left: None,
            slipped: 0,
            pins: [false; 2],
            beyond: 0,
            stops_seen: 0,
            was_reached: false,
            fast: false,
            blocked: false,
            still: u64::MAX >> 1,
            started: now,
            at: now,
            remainder: 0,
            pending: 0,
            latched: 0,
            course: Course::default(),
            violations: Violations::default(),
        };
        chip.ramp.ask(Demand::of(&chip.registers));
        chip.note();
        chip.latch();
        chip
    }

    /// Injects a fault into the chip, or ends it; flags of errors that have been raised stay until they are
    /// cleared. A loss of supply does not end it.
    pub fn inject(&mut self, chip_fault: ChipFault) {
        self.chip_fault = chip_fault;
        match (chip_fault == ChipFault::Disabled, self.left) {
            (true, None) => self.left = Some(self.field()),
            (false, Some(left)) => {
                // The rotor is drawn to the nearest place of the same phase.
                let beside = left - self.ramp.motion.field;
                self.slipped = (beside + PERIOD / 2).div_euclid(PERIOD) * PERIOD;
                self.left = None;
            }
            _ => {}
        }
        self.catch_errors();
    }

    /// A register as it stands, whether or not the bus may read it.
    #[must_use]
    pub fn register(&self, address: u8) -> u32 {
        self.value(address & 0x7F)
    }

    /// Where the motor's field stands as the rotor follows it, microsteps, 0 where the chip began.
    #[must_use]
    pub fn field(&self) -> i64 {
        self.ramp.motion.field + self.slipped
    }

    /// Clocks until `now`, whole ones.
    fn elapse(&mut self, now: Instant) -> u64 {
        let micros = now.saturating_duration_since(self.at).as_micros();
        let total = u64::from(self.remainder) + micros * u64::from(self.oscillator.hertz() / 1000);
        self.at = self.at.max(now);
        // The usual millisecond needs no long division.
        if let Ok(total) = u32::try_from(total) {
            self.remainder = total % 1000;
            return u64::from(total / 1000);
        }
        self.remainder = (total % 1000) as u32;
        total / 1000
    }

    /// Comes up to `now` and looks around.
    fn settle(&mut self, environment: &mut impl Mechanics, now: Instant) {
        let clocks = self.elapse(now);
        if self.ramp.is_busy() {
            self.ramp.advance(clocks as u32);
            self.still = 0;
        } else {
            self.still = self.still.saturating_add(clocks).min(u64::MAX >> 1);
        }
        self.drive(environment);
        let pins = environment.reference_switches();
        if pins != self.pins {
            self.beyond = libm::round(environment.beyond_edge()) as i32;
        }
        self.pins = pins;
        self.blocked = environment.is_blocked();
        let moved = self.ramp.motion.velocity;
        self.latch_switches();
        self.watch_load();
        if self.ramp.motion.velocity != moved {
            self.drive(environment);
        }
        self.note();
    }

    /// Turns the rotor with the field; with the bridges off it stays where it was left.
    fn drive(&self, environment: &mut impl Mechanics) {
        if let Some(left) = self.left {
            return environment.drive(self.at, left as f64, 0.0);
        }
        let Motion { fraction, velocity, .. } = self.ramp.motion;
        let fine = self.field() << FIELD_BITS | fraction >> (FRACTION_BITS - FIELD_BITS);
        let per_second = velocity as f64 * self.per_second;
        environment.drive(self.at, fine as f64 * (1.0 / f64::from(1 << FIELD_BITS)), per_second);
    }

    /// Executes a command; what the next datagram carries back (4.1.1).
    fn execute(&mut self, command: u8, data: u32) -> u32 {
        let (address, is_write) = (command & 0x7F, command & 0x80 != 0);
        if is_write {
            self.write(address, data);
            data
        } else if let Some(misuse) = registers::read_refusal(MAP, address.into()) {
            self.violate(misuse, address);
            0
        } else {
            self.value(address)
        }
    }

    /// Writes a register; a reserved or forbidden value is recorded and taken as far as bits exist.
    fn write(&mut self, address: u8, data: u32) {
        if let Some(misuse) = registers::write_refusal(MAP, address.into(), data) {
            self.violate(misuse, address);
        }
        let writable = |found: &&Registers| found.access != Access::Read;
        let found = registers::register(MAP, address.into()).filter(writable);
        let Some(register) = found else { return };
        let data = data & register.mask;
        if rules::is_forbidden(&self.registers, address, data) {
            self.violate(Misuse::ForbiddenValue, address);
        }
        if register.access == Access::WriteToClear {
            self.clear(address, data);
        } else {
            self.registers[usize::from(address)] = data;
            self.take_effect(address, data);
        }
    }

    /// What a written register changes at once.
    fn take_effect(&mut self, address: u8, data: u32) {
        match address {
            address::XACTUAL => self.ramp.place(data.cast_signed()),
            address::SW_MODE => self.set_stops(),
            address::RAMPMODE..=address::XTARGET => self.ramp.ask(Demand::of(&self.registers)),
            _ => {}
        }
    }

    /// Records a forbidden access to a register.
    fn violate(&mut self, misuse: Misuse, address: u8) {
        self.violations.record(misuse, address, self.at);
    }

    /// Looks at the first byte of a transaction: too fast a clock, too early.
    fn judge(&mut self, exchange: &Exchange) {
        self.course.command = exchange.sent;
        if exchange.hertz > self.oscillator.bus_hertz() {
            self.violate(Misuse::ClockTooFast, exchange.sent);
        }
        self.course.is_early = exchange.since < self.started + RESET_DELAY;
        if self.course.is_early {
            self.violate(Misuse::TooEarly, exchange.sent);
        }
    }
}

impl<E: Mechanics> SpiChip<E> for Tmc5160 {
    fn next_event(&self) -> Option<Instant> {
        self.ramp.is_busy().then(|| self.at + STEP)
    }

    fn event(&mut self, environment: &mut E) {
        self.settle(environment, self.at + STEP);
    }

    fn select(&mut self, environment: &mut E, now: Instant) {
        self.settle(environment, now);
        let shift = u64::from(self.latched) << 56 | u64::from(self.pending) << 24;
        self.course = Course { shift, ..Course::default() };
    }

    /// Shifts a byte through: what came in leaves again five bytes later (4.3).
    fn exchange(&mut self, _: &mut E, exchange: &Exchange) -> u8 {
        if self.course.bytes == 0 {
            self.judge(exchange);
        }
        let Course { shift, bytes, is_early, .. } = &mut self.course;
        let reply = (*shift >> 56) as u8;
        *shift = *shift << 8 | u64::from(exchange.sent) << 24;
        *bytes = bytes.saturating_add(1);
        if *is_early { 0 } else { reply }
    }

    /// Executes a whole datagram (4.1).
    fn deselect(&mut self, environment: &mut E, since: Instant, is_whole: bool) {
        let Course { shift, bytes, command, is_early } = core::mem::take(&mut self.course);
        if since > self.at {
            self.settle(environment, since);
        }
        if !is_whole || bytes != DATAGRAM {
            self.violate(Misuse::Length, command);
        } else if !is_early {
            self.pending = self.execute(command, (shift >> 24) as u32);
            self.note();
            self.latch();
            self.drive(environment);
        }
    }

    /// From select to clock and back tCC, between datagrams tCSH of an asynchronous clock: two periods of CLK
    /// and 10 ns, rounded up (4.3).
    fn limits(&self) -> BusLimits {
        BusLimits {
            mode: Some(MODE_3),
            select_to_clock_ns: 10,
            clock_to_deselect_ns: 10,
            deselected_ns: 2_000_000_000_u32.div_ceil(self.oscillator.hertz()) + 10,
        }
    }

    fn power_cycle(&mut self, now: Instant) {
        let field = self.left.unwrap_or_else(|| self.field());
        let violations = core::mem::take(&mut self.violations);
        let Self { chip_fault, left, .. } = *self;
        *self = Self { chip_fault, left, ..Self::new(self.oscillator, now) };
        // The rotor is drawn to the nearest beginning of an electrical period.
        self.ramp = Ramp::at((field + PERIOD / 2).div_euclid(PERIOD) * PERIOD);
        self.ramp.ask(Demand::of(&self.registers));
        self.violations = violations;
        self.catch_errors();
        self.latch();
    }

    fn violations(&self) -> &Violations {
        &self.violations
    }
}
