//! Simulated MT6835: 21-bit magnetic angle encoder of the stage (`MagnTek` data sheet, rev. 1.3).
//!
//! Modelled: commands, register map in RAM with the EEPROM behind it, power-up and programming time,
//! the angle latched when a burst begins, zero position, direction, hysteresis, warnings, checksum.
//! Not modelled, and without effect: bandwidth (noise is the environment's), table of corrections,
//! self-calibration, the incremental and PWM outputs.

mod registers;

use embassy_time::{Duration, Instant};
use embedded_hal::spi::MODE_3;

use crate::checksum::remainder;
use crate::chip::{BusLimits, Exchange, SpiChip};
use crate::environment::ShaftAngle;
use crate::registers::{read_refusal, reset_bytes, write_refusal};
use crate::violation::{Misuse, Violations};
use registers::{ANGLE, CALIBRATION, CRC, DIRECTION, MAP, SIZE, ZERO_HIGH, ZERO_LOW, hysteresis};

/// From power to angles (data sheet, Power-up Time, as quoted by a public evaluation of the chip).
pub const POWER_UP: Duration = Duration::from_millis(64);

/// Programming the EEPROM; its supply must not fail meanwhile.
pub const PROGRAMMING: Duration = Duration::from_secs(6);

/// Fastest bus clock, Hz.
const FASTEST: u32 = 16_000_000;

/// The rest of the bus (SPI Interface, timing: TL, TH, `TCSnH`). TH, half a clock, counts from the last falling
/// edge, and ends with the last edge.
const BUS: BusLimits = BusLimits {
    mode: Some(MODE_3),
    select_to_clock_ns: 100,
    clock_to_deselect_ns: 0,
    deselected_ns: 150,
};

/// Steps in a turn.
const STEPS: f64 = 2_097_152.0;

/// Turns per second above which the chip warns: 120 000 1/min.
const FASTEST_SHAFT: f64 = 2000.0;

/// Delay of the chip's signal path, s (Electrical Characteristics, typical): noise between two looks
/// at one moment is no speed.
const DELAY: f64 = 10e-6;

/// The answer of a chip that takes a command for its EEPROM.
const ACKNOWLEDGE: u8 = 0x55;

/// Commands (data sheet, SPI Interface), the upper four bits of a first byte: a register is read.
const READ: u8 = 0x3;
/// A register in RAM is written.
const WRITE: u8 = 0x6;
/// Angle, status and checksum are read in a row.
const BURST: u8 = 0xA;
/// The angle of this moment becomes zero.
const SET_ZERO: u8 = 0x5;
/// The EEPROM is programmed.
const PROGRAM: u8 = 0xC;

/// What has passed since the select line fell.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    /// Bytes that have passed; it stops at its limit.
    bytes: u8,
    /// The first three of them: command and address, then what is written.
    sent: [u8; 3],
    /// What goes out from the third byte on.
    reply: [u8; 4],
    /// Where the shaft stood when the command came, turns; of a command that asks for it.
    turns: f64,
    /// Whether the chip does not follow: the clock is too fast, or it is still starting.
    is_refused: bool,
}

impl Course {
    /// The command, four bits.
    const fn command(&self) -> u8 {
        self.sent[0] >> 4
    }

    /// The register's address, twelve bits.
    const fn address(&self) -> u16 {
        u16::from_be_bytes([self.sent[0] & 0x0F, self.sent[1]])
    }

    /// Whether it is as long as its command wants it.
    const fn is_complete(&self) -> bool {
        self.bytes == if self.command() == BURST { 6 } else { 3 }
    }
}

/// The simulated chip.
#[derive(Clone, Debug)]
pub struct Mt6835 {
    /// The registers that the chip works with.
    pub ram: [u8; SIZE],
    /// What the registers are loaded with at power-up.
    eeprom: [u8; SIZE],
    /// How often the EEPROM was programmed.
    pub programmings: u32,
    /// From when on the chip listens.
    ready_at: Instant,
    /// State of the self-calibration, two bits: none, running, failed, done.
    pub calibration: u8,
    /// Where the hysteresis holds the angle, turns.
    held: Option<f64>,
    /// When the shaft was last looked at, and where it was.
    seen: Option<(Instant, f64)>,
    /// Whether the supply is too low, but not so low that the chip restarts.
    pub has_undervoltage: bool,
    /// Bits of the next checksum that go out wrong.
    pub spoiled: u8,
    /// The transaction under way.
    course: Course,
    /// What was done to the chip that its data sheet forbids.
    violations: Violations,
}

impl Mt6835 {
    /// A chip from the factory that gets its supply at `now`.
    #[must_use]
    pub fn new(now: Instant) -> Self {
        Self {
            ram: reset_bytes(MAP),
            eeprom: reset_bytes(MAP),
            programmings: 0,
            ready_at: now + POWER_UP,
            calibration: 0,
            held: None,
            seen: None,
            has_undervoltage: false,
            spoiled: 0,
            course: Course::default(),
            violations: Violations::default(),
        }
    }

    /// What a register in RAM holds.
    fn register(&self, address: u16) -> u8 {
        self.ram.get(usize::from(address)).copied().unwrap_or(0)
    }

    /// Angle, status and checksum of the moment of the command.
    fn frame(&mut self, environment: &impl ShaftAngle, now: Instant) -> [u8; 4] {
        let turns = self.course.turns;
        let is_fast = self.seen.replace((now, turns)).is_some_and(|(then, before)| {
            let seconds = (now.as_micros() - then.as_micros()) as f64 * 1e-6;
            libm::fabs(turns - before) > FASTEST_SHAFT * (seconds + DELAY)
        });
        let is_weak = !environment.magnet_is_present();
        let warnings =
            u32::from(is_fast) | u32::from(is_weak) << 1 | u32::from(self.has_undervoltage) << 2;
        let word = self.steps(turns) << 3 | warnings;
        let [_, high, middle, low] = word.to_be_bytes();
        [high, middle, low, remainder(word) ^ core::mem::take(&mut self.spoiled)]
    }

    /// The angle in steps, after hysteresis, zero position and direction.
    fn steps(&mut self, turns: f64) -> u32 {
        let direction = self.register(DIRECTION);
        let play = hysteresis(direction);
        let held = self.held.map_or(turns, |held| held.max(turns - play).min(turns + play));
        self.held = Some(held);
        let fraction = held - libm::floor(held);
        let steps = libm::round(fraction * STEPS) as u32;
        let zero = u32::from(self.register(ZERO_HIGH)) << 13
            | u32::from(self.register(ZERO_LOW) >> 4) << 9;
        let steps = steps.wrapping_sub(zero);
        let steps = if direction & 0x08 == 0 { steps } else { steps.wrapping_neg() };
        steps & 0x1F_FFFF
    }

    /// What a read of a register gives.
    fn read(&mut self, environment: &impl ShaftAngle, address: u16, now: Instant) -> u8 {
        match address {
            ANGLE..=CRC => self.frame(environment, now)[usize::from(address - ANGLE)],
            CALIBRATION => self.calibration << 6,
            _ => {
                let Some(misuse) = read_refusal(MAP, address) else {
                    return self.register(address);
                };
                self.violations.record(misuse, address as u8, now);
                0
            }
        }
    }

    /// Writes a register in RAM, or records why it must not be written.
    fn write(&mut self, address: u16, value: u8, now: Instant) {
        let changed = value ^ self.register(address);
        match write_refusal(MAP, address, changed.into()) {
            Some(misuse) => self.violations.record(misuse, address as u8, now),
            None => self.ram[usize::from(address)] = value,
        }
    }

    /// Takes the angle of the moment of the command as zero, in RAM.
    fn set_zero(&mut self, turns: f64) {
        self.ram[usize::from(ZERO_HIGH)] = 0;
        self.ram[usize::from(ZERO_LOW)] &= 0x0F;
        let zero = (self.steps(turns) >> 9) as u16;
        self.ram[usize::from(ZERO_HIGH)] = (zero >> 4) as u8;
        self.ram[usize::from(ZERO_LOW)] |= (zero << 4) as u8;
    }

    /// Copies the RAM to the EEPROM, which takes [`PROGRAMMING`].
    fn program(&mut self, now: Instant) {
        self.eeprom = self.ram;
        self.programmings += 1;
        self.ready_at = now + PROGRAMMING;
    }

    /// Looks at the first byte of a transaction: too fast a clock, too early.
    fn judge(&mut self, exchange: &Exchange) {
        let misuse = if exchange.hertz > FASTEST {
            Misuse::ClockTooFast
        } else if exchange.since < self.ready_at {
            Misuse::TooEarly
        } else {
            return;
        };
        self.course.is_refused = true;
        self.violations.record(misuse, exchange.sent, exchange.since);
    }

    /// Whether the bytes so far ask for an angle of their moment.
    fn asks(&self) -> bool {
        match (self.course.bytes, self.course.command()) {
            (1, BURST | SET_ZERO) => true,
            (2, READ) => (ANGLE..=CRC).contains(&self.course.address()),
            _ => false,
        }
    }

    /// What goes out from the third byte on.
    fn reply(&mut self, environment: &impl ShaftAngle, now: Instant) -> [u8; 4] {
        let address = self.course.address();
        match (self.course.command(), address) {
            (READ, _) => [self.read(environment, address, now), 0, 0, 0],
            (BURST, ANGLE) => self.frame(environment, now),
            (SET_ZERO | PROGRAM, 0) => [ACKNOWLEDGE, 0, 0, 0],
            _ => [0; 4],
        }
    }

    /// Executes the command of a transaction that was long enough.
    fn execute(&mut self, course: &Course, now: Instant) {
        let [first, _, third] = course.sent;
        match (course.command(), course.address()) {
            (READ, _) | (BURST, ANGLE) => {}
            (WRITE, address) => self.write(address, third, now),
            (SET_ZERO, 0) => self.set_zero(course.turns),
            (PROGRAM, 0) => self.program(now),
            (SET_ZERO | BURST | PROGRAM, _) => {
                self.violations.record(Misuse::ForbiddenValue, first, now);
            }
            _ => self.violations.record(Misuse::UnknownCommand, first, now),
        }
    }
}

impl<E: ShaftAngle> SpiChip<E> for Mt6835 {
    fn next_event(&self) -> Option<Instant> {
        None
    }

    fn event(&mut self, _: &mut E) {}

    fn select(&mut self, _: &mut E, _: Instant) {
        self.course = Course::default();
    }

    fn exchange(&mut self, environment: &mut E, exchange: &Exchange) -> u8 {
        let index = usize::from(self.course.bytes);
        if index == 0 {
            self.judge(exchange);
        }
        if let Some(byte) = self.course.sent.get_mut(index) {
            *byte = exchange.sent;
        }
        self.course.bytes = self.course.bytes.saturating_add(1);
        if self.course.is_refused {
            return 0;
        }
        if self.asks() {
            self.course.turns = environment.shaft_turns(exchange.since);
        }
        if index == 2 {
            self.course.reply = self.reply(environment, exchange.since);
        }
        index.checked_sub(2).and_then(|byte| self.course.reply.get(byte)).copied().unwrap_or(0)
    }

    /// What a command changes it changes now, where the transaction was as long as it must be.
    fn deselect(&mut self, _: &mut E, since: Instant, is_whole: bool) {
        let course = core::mem::take(&mut self.course);
        if course.is_refused {
            return;
        }
        if is_whole && course.is_complete() {
            self.execute(&course, since);
        } else {
            self.violations.record(Misuse::Length, course.sent[0], since);
        }
    }

    fn limits(&self) -> BusLimits {
        BUS
    }

    fn power_cycle(&mut self, now: Instant) {
        *self = Self {
            ram: self.eeprom,
            eeprom: self.eeprom,
            programmings: self.programmings,
            has_undervoltage: self.has_undervoltage,
            violations: core::mem::take(&mut self.violations),
            ..Self::new(now)
        };
    }

    fn violations(&self) -> &Violations {
        &self.violations
    }
}
