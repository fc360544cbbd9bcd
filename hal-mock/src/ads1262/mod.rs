//! Simulated ADS1262: 32-bit converter of the analogue fibre-optic gyro (Texas Instruments SBAS661C).
//!
//! Full register map of the 21 registers, commands, direct and commanded reading, all filters and
//! data rates, calibration registers, test voltage, both checksum forms. Not modelled: chopping and
//! the calibration commands (recorded as violations, so that no driver relies on them), pins other than
//! AIN0 and AIN1 (0 V), supply and clock pins, noise of its own.
//!
//! Conversions end at the environment's time; the environment is asked only where the gyro's inputs
//! are selected. A transaction acts at its bytes' time, and conversions that end in its course
//! become visible after it, as the data sheet has them wait (figure 9-43); where the next one ends before,
//! with that.

mod analogue;
mod frame;
mod registers;
mod timing;
mod transaction;

use embassy_time::Instant;

use crate::chip::{BusLimits, Exchange, ReadyLine, SpiChip};
use crate::clock::Cadence;
use crate::environment::AnalogueInput;
use crate::violation::{Misuse, Violations};
use analogue::Selected;
pub use analogue::Voltages;
use registers::Registers;
use transaction::Course;

/// Bit of the status byte: the conversion was not read before.
const STATUS_NEW: u8 = 0x40;

/// The command that stands for the START pin where it is misused.
const START1: u8 = 0x08;

/// The newest conversion.
#[derive(Clone, Copy, Debug, Default)]
struct Holding {
    /// The code, two's complement of 32 bits.
    code: i32,
    /// The alarm bits of the status byte (table 9-18).
    alarms: u8,
    /// Whether the bus has not read it yet.
    is_new: bool,
}

/// What is broken in this chip.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChipFault {
    /// The code of 32 bits, two's complement, that every conversion gives whatever the input, signalled as
    /// new nevertheless.
    pub stuck_at: Option<i32>,
    /// Whether no conversion ends that is begun.
    pub is_dead: bool,
    /// Whether the next frame that is read by command gets a wrong bit, in its third byte; frames that are
    /// read directly stay whole.
    pub corrupts_next: bool,
    /// A register, 0 to 20, that keeps its value whatever is written; the write is not recorded.
    pub broken_register: Option<u8>,
}

/// The chip with what is connected to it. Without a fault it converts exactly, to the nearest code.
#[derive(Clone, Debug)]
pub struct Ads1262 {
    /// The register map as it stands.
    registers: Registers,
    /// What the ID register holds.
    identity: u8,
    /// What supply and reference are connected to.
    pub voltages: Voltages,
    /// Commands before this are too early.
    operational: Instant,
    /// When the internal reference was switched on.
    reference_since: Instant,
    /// Conversions under way, counted from the end of the first.
    running: Option<Cadence>,
    /// The newest conversion, which a command reads.
    holding: Holding,
    /// The data-ready line, and with it the shift register that is read directly.
    is_ready: bool,
    /// The transaction under way.
    course: Course,
    /// When a conversion has ended in its course, and its voltage, V.
    waiting: Option<(Instant, f64)>,
    /// End of the latest conversion, and the number of conversions.
    ended: (Option<Instant>, u32),
    /// Conversions that a newer one replaced before they were read.
    pub overwritten: u64,
    /// Whether a clock is found at the pins, which the status byte shows.
    pub has_external_clock: bool,
    /// What is broken in this chip.
    pub chip_fault: ChipFault,
    /// What was done to the chip that its data sheet forbids.
    violations: Violations,
}

impl Default for Ads1262 {
    /// A healthy chip whose supply comes up at time zero.
    fn default() -> Self {
        Self {
            registers: Registers::reset(0),
            identity: 0,
            voltages: Voltages { supply: 5.0, reference: 2.5 },
            operational: Instant::from_micros(0) + timing::POWER_UP,
            reference_since: Instant::from_micros(0),
            running: None,
            holding: Holding::default(),
            is_ready: false,
            course: Course::default(),
            waiting: None,
            ended: (None, 0),
            overwritten: 0,
            has_external_clock: false,
            chip_fault: ChipFault::default(),
            violations: Violations::default(),
        }
    }
}

impl Ads1262 {
    /// From now on every conversion repeats the last code, and is signalled as new nevertheless.
    pub fn stick(&mut self) {
        self.chip_fault.stuck_at = Some(self.holding.code);
    }

    /// The level of the START pin changes at `at`: conversions begin with its rise, in one moment in all
    /// chips that share the line, and end with its fall (Conversion Control). Commands want it low.
    pub fn set_start(&mut self, is_high: bool, at: Instant) {
        if at < self.operational {
            self.violations.record(Misuse::TooEarly, START1, at);
        } else if is_high {
            self.start(START1, at);
        } else {
            self.stop();
        }
    }

    /// Sets what the ID register says (zero is an ADS1262 of revision 0) and resets all others.
    pub fn set_identity(&mut self, identity: u8) {
        self.identity = identity;
        self.registers = Registers::reset(identity);
    }

    /// The status byte of the newest conversion (table 9-18); there is no second converter.
    fn status(&self) -> u8 {
        let new = if self.holding.is_new { STATUS_NEW } else { 0 };
        let clock = u8::from(self.has_external_clock) << 5;
        new | clock | self.holding.alarms | u8::from(self.registers.is_set(registers::RESET_FLAG))
    }

    /// Begins conversions at `at`; what was converted before is lost.
    fn begin(&mut self, at: Instant) {
        let fields = [registers::FILTER, registers::RATE, registers::DELAY];
        let [filter, rate, delay] = fields.map(|field| self.registers.value(field));
        let (latency, hertz) = (timing::latency(filter, rate, delay), timing::hertz(rate));
        self.clear();
        if !self.chip_fault.is_dead {
            self.running = Some(Cadence::new(at + latency, 0, hertz));
        }
    }

    /// Ends conversions; one that has just ended is lost as well.
    fn stop(&mut self) {
        self.running = None;
        self.waiting = None;
    }

    /// Ends conversions and discards their results.
    fn clear(&mut self) {
        self.stop();
        self.holding = Holding::default();
        self.is_ready = false;
    }

    /// Converts a voltage that the bus sees from now on.
    fn hold(&mut self, volts: f64) {
        self.overwritten += u64::from(self.holding.is_new);
        let (converted, alarms) = analogue::convert(&self.registers, self.voltages, volts);
        let code = self.chip_fault.stuck_at.unwrap_or(converted);
        self.holding = Holding { code, alarms, is_new: true };
        self.is_ready = true;
    }

    /// All registers as after a reset, which stops conversions.
    fn reset(&mut self, at: Instant) {
        if !self.registers.is_set(registers::REFERENCE_ON) {
            self.reference_since = at;
        }
        self.registers = Registers::reset(self.identity);
        self.clear();
    }
}

impl<E: AnalogueInput> SpiChip<E> for Ads1262 {
    fn next_event(&self) -> Option<Instant> {
        self.running.map(|running| running.next())
    }

    fn event(&mut self, environment: &mut E) {
        let Some(mut running) = self.running else { return };
        let now = running.next();
        let volts = match analogue::selected(&self.registers, self.voltages) {
            Selected::Gyro(sign) => sign * environment.volts(now),
            Selected::Own(volts) => volts,
        };
        running.pass();
        let (_, count) = self.ended;
        self.ended = (Some(now), count.wrapping_add(1));
        self.running = (!self.registers.is_set(registers::ONE_SHOT)).then_some(running);
        if self.waiting.is_some() {
            self.release();
        }
        if self.course.is_selected {
            self.waiting = Some((now, volts));
        } else {
            self.hold(volts);
        }
    }

    fn select(&mut self, _: &mut E, _: Instant) {
        self.course = Course::begun();
    }

    fn exchange(&mut self, _: &mut E, exchange: &Exchange) -> u8 {
        self.pass(exchange)
    }

    fn deselect(&mut self, _: &mut E, since: Instant, is_whole: bool) {
        self.end(since, is_whole);
    }

    fn limits(&self) -> BusLimits {
        timing::BUS
    }

    fn ready_line(&self) -> ReadyLine {
        let active = self.is_ready || self.waiting.is_some();
        let (latest, count) = self.ended;
        ReadyLine { active, next: self.running.map(|running| running.next()), latest, count }
    }

    fn power_cycle(&mut self, now: Instant) {
        self.reset(now);
        self.course = Course::default();
        self.operational = now + timing::POWER_UP;
        self.reference_since = now;
    }

    fn violations(&self) -> &Violations {
        &self.violations
    }
}
