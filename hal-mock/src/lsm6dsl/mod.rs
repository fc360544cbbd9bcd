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
use crate::i2c::{I2cChip, Transfer};
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
        measuring.outputs.count += 1;
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

    /// Reads registers in a row; samples that fall due meanwhile land between two bytes.
    fn read_row(
        &mut self,
        environment: &mut impl MotionInput,
        transfer: &Transfer,
        reply: &mut [u8],
    ) {
        let mut address = transfer.sent.first().copied().unwrap_or(0);
        for (index, byte) in reply.iter_mut().enumerate() {
            let is_held = address & 1 == 1 && self.at(CTRL3_C) & BDU != 0;
            while !is_held && self.next().is_some_and(|(at, _)| at <= transfer.time_of(index)) {
                self.convert(environment);
            }
            match read_refusal(MAP, address.into()) {
                Some(misuse) => self.violations.record(misuse, address, transfer.now),
                None => *byte = self.read(address),
            }
            address += u8::from(self.at(CTRL3_C) & IF_INC != 0);
        }
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
            outputs: Cadence { since: now, count: 1, hertz: hertz * self.clock },
            settled: now + TURN_ON,
        });
    }

    /// Whether the chip acknowledges; while it resets or boots only its control register is looked at.
    fn listens(&mut self, transfer: &Transfer, reads: bool) -> bool {
        let register = transfer.sent.first().copied().unwrap_or(0);
        if transfer.now >= self.ready_at {
            self.is_powering_up = false;
            self.registers[usize::from(CTRL3_C)] &= !(SW_RESET | BOOT);
            return true;
        }
        let looks = register == CTRL3_C && reads && !self.is_powering_up;
        if !looks {
            self.violations.record(Misuse::TooEarly, register, transfer.now);
        }
        looks
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
        self.next().map(|(at, _)| at)
    }

    fn event(&mut self, environment: &mut E) {
        self.convert(environment);
    }

    fn transfer(&mut self, environment: &mut E, transfer: &Transfer, reply: &mut [u8]) -> bool {
        if transfer.address != self.address {
            return false;
        }
        let [register, data @ ..] = transfer.sent else {
            self.violations.record(Misuse::Length, 0, transfer.now);
            return true;
        };
        if transfer.hertz > FASTEST {
            self.violations.record(Misuse::ClockTooFast, *register, transfer.now);
        }
        if !self.listens(transfer, !reply.is_empty()) {
            return false;
        }
        if !reply.is_empty() && !data.is_empty() {
            self.violations.record(Misuse::Length, *register, transfer.now);
        }
        let step = self.at(CTRL3_C) & IF_INC != 0;
        for (index, value) in (0..).zip(data) {
            self.write(register + if step { index } else { 0 }, *value, transfer.now);
        }
        self.read_row(environment, transfer, reply);
        true
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
