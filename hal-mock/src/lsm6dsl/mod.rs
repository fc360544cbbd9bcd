//! Simulated LSM6DSL: coarse gyros and accelerometers on the base (ST data sheet `DocID028475`), I²C.
//!
//! Modelled: register map with access rules, power-up, reset and boot times, output rates, ranges,
//! units, status, block data update, address increment, turn-on time, self-test, clipping, acknowledge.
//! Not modelled, and without effect: FIFO, sensor hub, interrupts, low-power modes, high-pass filters,
//! embedded functions. Big-endian outputs are refused.
//!
//! Where the data sheet promises nothing, the chip does the worst: outputs stand at their limit until
//! a sensor that was switched has settled, and a sample that lands in a burst is seen from the next
//! byte on, or with block data update from the next axis on.

mod registers;

use embassy_time::{Duration, Instant};

use crate::clock::Cadence;
use crate::environment::MotionInput;
use crate::i2c::{I2cChip, Start};
use crate::registers::{read_refusal, reset_bytes};
use crate::violation::{Misuse, Violations};
use registers::{
    BDU, BOOT, CTRL1_XL, CTRL2_G, CTRL3_C, CTRL5_C, IF_INC, MAP, OUT_TEMP_L, OUTX_L_G, OUTX_L_XL,
    OUTZ_H_XL, SIZE, STATUS, SW_RESET, force_unit_mg, hertz, rate_unit_mdps,
};

/// From power, and from the boot bit, to an answer (ST's examples: boot time).
pub const BOOT_TIME: Duration = Duration::from_millis(15);

/// Software reset (data sheet, `CTRL3_C`: 50 µs).
pub const RESET_TIME: Duration = Duration::from_micros(50);

/// From a switched gyro to good data (data sheet, turn-on time: 35 ms), taken for both sensors.
pub const TURN_ON: Duration = Duration::from_millis(35);

/// Bus clocks, Hz (I²C slave timing values).
const FASTEST: u32 = 400_000;

/// Answers to the self-test forces, within their limits: g, °/s.
const SELF_TEST: (f64, f64) = (0.5, 400.0);

/// The new-data bits of accelerometer and gyro.
const NEW: [u8; 2] = [0x01, 0x02];

/// One sensor at work.
#[derive(Clone, Copy, Debug)]
struct Measuring {
    /// The outputs, counted from when the sensor was switched.
    outputs: Cadence,
    /// From when on the outputs are good.
    settled: Instant,
}

/// The accelerometers, by [`CTRL1_XL`].
const FORCE: usize = 0;
/// The gyros, by [`CTRL2_G`].
const RATE: usize = 1;

/// What has passed since the start condition of a transfer to this chip.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    /// When the start condition came; none where the chip was not addressed.
    began: Option<Instant>,
    /// Bus clock, Hz.
    hertz: u32,
    /// The register that was named.
    register: Option<u8>,
    /// The register that is next.
    address: u8,
    /// From one written register to the next.
    step: u8,
    /// Whether the chip does not listen yet, but for its control register.
    is_early: bool,
    /// Whether a register was written.
    is_written: bool,
    /// Whether bytes are read.
    is_read: bool,
}

/// The simulated chip.
#[derive(Clone, Debug)]
pub struct Lsm6dsl {
    /// The 7-bit address that the chip answers to.
    address: u8,
    /// The register map as it stands.
    pub registers: [u8; SIZE],
    /// Until when it does not listen, but for the bit that it clears itself.
    ready_at: Instant,
    /// Whether that wait follows a loss of supply, not a reset or a boot.
    is_powering_up: bool,
    /// Accelerometers and gyros, where they are on.
    measuring: [Option<Measuring>; 2],
    /// Ratio of its oscillator to the nominal one.
    clock: f64,
    /// The transfer under way.
    course: Course,
    /// What a self-test adds to each axis: g, and °/s.
    pub self_test: (f64, f64),
    /// What was done to the chip that its data sheet forbids.
    violations: Violations,
}

impl Lsm6dsl {
    /// A chip at a 7-bit address that gets its supply at `now`. Its oscillator runs at `clock` times the
    /// nominal frequency, > 0, and with it its output rates.
    #[must_use]
    pub fn new(now: Instant, address: u8, clock: f64) -> Self {
        Self {
            address,
            registers: reset_bytes(MAP),
            ready_at: now + BOOT_TIME,
            is_powering_up: true,
            measuring: [None; 2],
            clock,
            course: Course::default(),
            self_test: SELF_TEST,
            violations: Violations::default(),
        }
    }

    /// What a register holds.
    fn at(&self, address: u8) -> u8 {
        self.registers[usize::from(address)]
    }

    /// The sensor that is due next.
    fn next(&self) -> Option<(Instant, usize)> {
        let due = |sensor: usize| self.measuring[sensor].map(|m| (m.outputs.next(), sensor));
        [FORCE, RATE].into_iter().filter_map(due).min()
    }

    /// Takes the sample that is due.
    fn convert(&mut self, environment: &mut impl MotionInput) {
        let Some((now, sensor)) = self.next() else { return };
        let counts = if sensor == FORCE {
            let unit = force_unit_mg(self.at(CTRL1_XL));
            let pushed = f64::from(self_test_sign(self.at(CTRL5_C), 2)) * self.self_test.0;
            environment.force_g(now).map(|force| (force + pushed) * 1e3 / unit)
        } else {
            let unit = rate_unit_mdps(self.at(CTRL2_G));
            let pushed = f64::from(self_test_sign(self.at(CTRL5_C) >> 2, 3)) * self.self_test.1;
            environment.rate_rad_s(now).map(|rate| (rate.to_degrees() + pushed) * 1e3 / unit)
        };
        let Some(measuring) = &mut self.measuring[sensor] else { return };
        measuring.outputs.pass();
        let is_settled = now >= measuring.settled;
        let first = [OUTX_L_XL, OUTX_L_G][sensor];
        for (axis, count) in (0..).zip(counts) {
            let word = if is_settled { libm::round(count) as i16 } else { i16::MAX };
            self.put(first + 2 * axis, word);
        }
        let temperature = 256.0 * (environment.temperature_c(now) - 25.0);
        self.put(OUT_TEMP_L, libm::round(temperature) as i16);
        self.registers[usize::from(STATUS)] |= NEW[sensor];
    }

    /// Stores a word, lower byte first.
    fn put(&mut self, address: u8, word: i16) {
        let place = usize::from(address);
        self.registers[place..place + 2].copy_from_slice(&word.to_le_bytes());
    }

    /// Reads a register; the upper byte of an axis takes its sensor's new-data bit away.
    fn read(&mut self, address: u8) -> u8 {
        let sensor = match address {
            OUTX_L_G..OUTX_L_XL => Some(RATE),
            OUTX_L_XL..=OUTZ_H_XL => Some(FORCE),
            _ => None,
        };
        if let Some(sensor) = sensor.filter(|_| address & 1 == 1) {
            self.registers[usize::from(STATUS)] &= !NEW[sensor];
        }
        self.at(address)
    }

    /// Whether samples that fall due must wait: while registers are named and written, and with block data
    /// update between the two bytes of an axis.
    fn holds(&self) -> bool {
        let Course { began, address, is_read, .. } = self.course;
        began.is_some() && (!is_read || address & 1 == 1 && self.at(CTRL3_C) & BDU != 0)
    }

    /// Reads the next register of a row; samples that have fallen due meanwhile land before it.
    fn read_next(&mut self, environment: &mut impl MotionInput, began: Instant, at: Instant) -> u8 {
        while !self.holds() && self.next().is_some_and(|(due, _)| due <= at) {
            self.convert(environment);
        }
        let address = self.course.address;
        let byte = match read_refusal(MAP, address.into()) {
            Some(misuse) => {
                self.violations.record(misuse, address, began);
                0
            }
            None => self.read(address),
        };
        self.course.address = address.wrapping_add(u8::from(self.at(CTRL3_C) & IF_INC != 0));
        byte
    }

    /// Writes a register, or records why it must not be written.
    fn write(&mut self, address: u8, value: u8, now: Instant) {
        if let Some(misuse) = registers::write_refusal(address, value) {
            return self.violations.record(misuse, address, now);
        }
        if address == CTRL3_C && value & SW_RESET != 0 {
            self.registers = reset_bytes(MAP);
            self.registers[usize::from(CTRL3_C)] |= SW_RESET;
            self.measuring = [None; 2];
            self.ready_at = now + RESET_TIME;
            return;
        }
        if address == CTRL3_C && value & BOOT != 0 {
            self.ready_at = now + BOOT_TIME;
        }
        self.registers[usize::from(address)] = value;
        match address {
            CTRL1_XL => self.switch(FORCE, now),
            CTRL2_G => self.switch(RATE, now),
            CTRL5_C => {
                for measuring in self.measuring.iter_mut().flatten() {
                    measuring.settled = now + TURN_ON;
                }
            }
            _ => {}
        }
    }

    /// Switches a sensor to what its control register says.
    fn switch(&mut self, sensor: usize, now: Instant) {
        let control = self.at([CTRL1_XL, CTRL2_G][sensor]);
        self.measuring[sensor] = hertz(control).map(|hertz| Measuring {
            outputs: Cadence::new(now, 1, hertz * self.clock),
            settled: now + TURN_ON,
        });
    }

    /// Takes the register that a transfer names; returns whether the chip acknowledged. While it resets or
    /// boots only its control register is looked at.
    fn name(&mut self, register: u8, since: Instant) -> bool {
        if self.course.hertz > FASTEST {
            self.violations.record(Misuse::ClockTooFast, register, since);
        }
        if since >= self.ready_at {
            self.is_powering_up = false;
            self.registers[usize::from(CTRL3_C)] &= !(SW_RESET | BOOT);
        } else if register != CTRL3_C || self.is_powering_up {
            self.violations.record(Misuse::TooEarly, register, since);
            self.course = Course::default();
            return false;
        }
        self.course.is_early = since < self.ready_at;
        self.course.step = u8::from(self.at(CTRL3_C) & IF_INC != 0);
        self.course.register = Some(register);
        self.course.address = register;
        true
    }

    /// Begins to read; a transfer that has written, or that names no register, is too long or too short.
    fn turn_round(&mut self, began: Instant) {
        self.course.is_read = true;
        self.course.address = self.course.register.unwrap_or(0);
        if self.course.register.is_none() || self.course.is_written {
            self.violations.record(Misuse::Length, self.course.address, began);
        }
    }
}

/// The direction of a self-test force: 1 is positive, `negative` negative.
const fn self_test_sign(bits: u8, negative: u8) -> i8 {
    match bits & 3 {
        1 => 1,
        code if code == negative => -1,
        _ => 0,
    }
}

impl<E: MotionInput> I2cChip<E> for Lsm6dsl {
    fn next_event(&self) -> Option<Instant> {
        self.next().map(|(at, _)| at).filter(|_| !self.holds())
    }

    fn event(&mut self, environment: &mut E) {
        self.convert(environment);
    }

    fn start(&mut self, _: &mut E, start: &Start) -> bool {
        if start.address != self.address {
            self.course = Course::default();
            return false;
        }
        let began = self.course.began.unwrap_or(start.now);
        if !start.is_read || self.course.began.is_none() {
            self.course = Course { began: Some(began), hertz: start.hertz, ..Course::default() };
        }
        if start.is_read {
            self.turn_round(began);
        }
        true
    }

    fn write(&mut self, _: &mut E, byte: u8, since: Instant) -> bool {
        let Course { began: Some(_), register, address, step, is_early, is_read: false, .. } =
            self.course
        else {
            return false;
        };
        let Some(register) = register else { return self.name(byte, since) };
        if is_early {
            self.violations.record(Misuse::TooEarly, register, since);
            self.course = Course::default();
            return false;
        }
        self.course.is_written = true;
        self.course.address = address.wrapping_add(step);
        self.write(address, byte, since);
        true
    }

    fn read(&mut self, environment: &mut E, at: Instant) -> u8 {
        match self.course {
            Course { began: Some(began), register: Some(_), is_read: true, .. } => {
                self.read_next(environment, began, at)
            }
            _ => 0,
        }
    }

    fn stop(&mut self, _: &mut E, since: Instant) {
        let Course { began, register, is_early, is_written, is_read, .. } =
            core::mem::take(&mut self.course);
        let is_void = began.is_some() && !is_read && !is_written;
        match register {
            None if is_void => self.violations.record(Misuse::Length, 0, since),
            Some(register) if is_void && is_early => {
                self.violations.record(Misuse::TooEarly, register, since);
            }
            _ => {}
        }
    }

    fn power_cycle(&mut self, now: Instant) {
        *self = Self {
            self_test: self.self_test,
            violations: core::mem::take(&mut self.violations),
            ..Self::new(now, self.address, self.clock)
        };
    }

    fn violations(&self) -> &Violations {
        &self.violations
    }
}
