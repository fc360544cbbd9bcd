//! Simulated ADXL355: three-axis accelerometer on the platform (Analog Devices data sheet, rev. C).
//!
//! Modelled: register map with access rules, power-up and reset times, the NVM's busy bit, output
//! rates, ranges, offsets, self-test, temperature, status, FIFO, data-ready pin, shadow registers
//! and the race that may spoil them. The filter is the environment's mean over the output period.
//! Not modelled, and without effect: high-pass filter, activity detection, external synchronisation.
//!
//! Where the data sheet promises nothing, the chip does the worst: a byte of data that is clocked
//! out after a new sample has landed in the same transaction comes inverted (the sample itself is there after
//! the transaction, or when the next one lands), the busy bit is still
//! set at the first look after loading, and self-test mode lets outside forces through (the data
//! sheet says both that it does and that it does not).

mod fifo;
mod registers;

use embassy_time::{Duration, Instant};
use embedded_hal::spi::MODE_0;

use crate::chip::{BusLimits, Exchange, ReadyLine, SpiChip};
use crate::clock::Cadence;
use crate::environment::ForceInput;
use crate::registers::{read_refusal, reset_bytes};
use crate::violation::{Misuse, Violations};
use fifo::Fifo;
use registers::{
    DRDY_OFF, FIFO_DATA, FIFO_ENTRIES, FIFO_SAMPLES, FILTER, MAP, OFFSET_X_H, POWER_CTL, RANGE,
    RESET, SELF_TEST, SHADOW, SHADOW_LAST, SIZE, STANDBY, STATUS, TEMP1, TEMP2, XDATA3, ZDATA1,
};

/// From power to standby (Specifications, Turn-On Time: below 10 ms).
pub const POWER_UP: Duration = Duration::from_millis(10);

/// From software reset to standby: the data sheet has no figure; the Linux driver waits this long.
pub const RESET_TIME: Duration = Duration::from_millis(5);

/// Bus clocks, Hz (SPI Characteristics).
const CLOCKS: core::ops::RangeInclusive<u32> = 100_000..=10_000_000;

/// The rest of the bus (SPI Characteristics: tCSS, tCSH, tCSD; Serial Communications: CPHA = CPOL = 0).
const BUS: BusLimits = BusLimits {
    mode: Some(MODE_0),
    select_to_clock_ns: 20,
    clock_to_deselect_ns: 20,
    deselected_ns: 40,
};

/// Answer to the self-test force, g (Specifications, typical values).
const SELF_TEST_RESPONSE: [f64; 3] = [0.3, 0.3, 1.5];

/// Factory settings of this chip: any pattern, each chip has its own.
const FACTORY: [u8; 5] = [0x3C, 0x81, 0x5A, 0x07, 0xE2];

/// What wrongly loaded factory settings add to each axis, g.
const SPOILED_BIAS: f64 = 0.1;

/// A sample has come that was not read (STATUS, `DATA_RDY`).
const DATA_RDY: u8 = 0x01;
/// The FIFO holds as many values as its mark says (STATUS, `FIFO_FULL`).
const FIFO_FULL: u8 = 0x02;
/// The FIFO has lost values (STATUS, `FIFO_OVR`).
const FIFO_OVR: u8 = 0x04;
/// The factory settings are being loaded (STATUS, `NVM_BUSY`).
const NVM_BUSY: u8 = 0x10;

/// What is felt at one time.
#[derive(Clone, Copy, Debug)]
struct Felt {
    /// When it is felt.
    landed: Instant,
    /// Specific force on the chip's axes, g.
    force_g: [f64; 3],
    /// Temperature, °C.
    temperature_c: f64,
}

/// What has passed since the select line fell.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    /// Whether samples that land have to wait.
    is_selected: bool,
    /// Bytes that have passed.
    bytes: usize,
    /// Bytes that the chip follows, the command included.
    follows: usize,
    /// Address and direction.
    command: u8,
    /// The register that is next.
    address: u8,
    /// When the first sample landed.
    landed: Option<Instant>,
}

/// The simulated chip.
#[derive(Clone, Debug)]
pub struct Adxl355 {
    /// The register map as it stands.
    pub registers: [u8; SIZE],
    /// The factory settings as loaded, which the shadow registers show.
    shadow: [u8; 5],
    /// From when on the chip listens.
    ready_at: Instant,
    /// Whether that wait follows a loss of supply, not a reset.
    is_powering_up: bool,
    /// The samples of a chip that is not in standby.
    measuring: Option<Cadence>,
    /// When the data-ready pin falls by itself; it is high until then.
    pin_falls: Option<Instant>,
    /// The latest sample of x, y, z, counts of 20 bits.
    counts: [i32; 3],
    /// The samples that were not read through the FIFO yet.
    fifo: Fifo,
    /// The transaction under way.
    course: Course,
    /// A sample that has landed in its course.
    waiting: Option<Felt>,
    /// What a self-test adds to each axis, g.
    pub self_test_response: [f64; 3],
    /// Software resets to come that load wrong factory settings (Reset Register, note: a race in silicon up
    /// to revision 1); power cycles never do.
    pub spoiled_resets: u32,
    /// What was done to the chip that its data sheet forbids.
    violations: Violations,
}

impl Adxl355 {
    /// A chip that gets its supply at `now`.
    #[must_use]
    pub fn new(now: Instant) -> Self {
        Self {
            registers: reset_bytes(MAP),
            shadow: FACTORY,
            ready_at: now + POWER_UP,
            is_powering_up: true,
            measuring: None,
            pin_falls: None,
            counts: [0; 3],
            fifo: Fifo::default(),
            course: Course::default(),
            waiting: None,
            self_test_response: SELF_TEST_RESPONSE,
            spoiled_resets: 0,
            violations: Violations::default(),
        }
    }

    /// A software reset at `now`.
    fn restart(&mut self, now: Instant) {
        let spoiled = self.spoiled_resets > 0;
        *self = Self {
            ready_at: now + RESET_TIME,
            is_powering_up: false,
            shadow: if spoiled { FACTORY.map(|byte| byte ^ 0x11) } else { FACTORY },
            spoiled_resets: self.spoiled_resets.saturating_sub(1),
            course: self.course,
            ..self.sane(now)
        };
        self.registers[usize::from(STATUS)] = NVM_BUSY;
    }

    /// A chip as after a loss of supply at `now`, with the faults and the record of this one.
    fn sane(&mut self, now: Instant) -> Self {
        Self {
            self_test_response: self.self_test_response,
            spoiled_resets: self.spoiled_resets,
            violations: core::mem::take(&mut self.violations),
            ..Self::new(now)
        }
    }

    /// What a register holds.
    fn at(&self, address: u8) -> u8 {
        self.registers[usize::from(address)]
    }

    /// Takes the sample that is due; in the course of a transaction it waits.
    fn convert(&mut self, environment: &mut (impl ForceInput + ?Sized), mut measuring: Cadence) {
        let now = measuring.next();
        let force_g = environment.force_g(now);
        let felt = Felt { landed: now, force_g, temperature_c: environment.temperature_c(now) };
        measuring.pass();
        self.pin_falls = Some(now + Duration::from_micros((0.5e6 / measuring.hertz()) as u64));
        self.measuring = Some(measuring);
        self.release();
        if self.course.is_selected {
            self.course.landed.get_or_insert(now);
            self.waiting = Some(felt);
        } else {
            self.store(&felt);
        }
    }

    /// Stores a sample that has waited.
    fn release(&mut self) {
        if let Some(felt) = self.waiting.take() {
            self.store(&felt);
        }
    }

    /// Stores a sample where the bus reads it.
    fn store(&mut self, felt: &Felt) {
        for (axis, force) in felt.force_g.into_iter().enumerate() {
            self.counts[axis] = self.count(axis, force);
        }
        let temperature = 1885.0 - 9.05 * (felt.temperature_c - 25.0);
        let [high, low] = (libm::round(temperature) as u16).min(0xFFF).to_be_bytes();
        self.registers[usize::from(TEMP2)] = high;
        self.registers[usize::from(TEMP1)] = low;
        let is_lost = self.fifo.push(self.counts);
        let status = &mut self.registers[usize::from(STATUS)];
        *status |= DATA_RDY | if is_lost { FIFO_OVR } else { 0 };
    }

    /// A force of one axis, g, in counts.
    fn count(&self, axis: usize, force: f64) -> i32 {
        let test = if self.at(SELF_TEST) == 3 { self.self_test_response[axis] } else { 0.0 };
        let bias = if self.shadow == FACTORY { 0.0 } else { SPOILED_BIAS };
        let per_g = f64::from(256_000 >> ((self.at(RANGE) & 0x03) - 1));
        let offset = usize::from(OFFSET_X_H) + 2 * axis;
        let offset = i16::from_be_bytes([self.registers[offset], self.registers[offset + 1]]);
        let count = libm::round((force + test + bias) * per_g) as i32;
        count.saturating_add(i32::from(offset) << 4).clamp(-0x8_0000, 0x7_FFFF)
    }

    /// Reads one register with all that a read does to it.
    fn read(&mut self, address: u8, now: Instant) -> u8 {
        match address {
            STATUS => self.read_status(now),
            FIFO_ENTRIES => self.fifo.entries(),
            XDATA3..=ZDATA1 => {
                self.lower_pin();
                let byte = usize::from(address - XDATA3);
                (self.counts[byte / 3] << 4 >> (16 - 8 * (byte % 3))) as u8
            }
            SHADOW..=SHADOW_LAST => self.shadow[usize::from(address - SHADOW)],
            _ => self.at(address),
        }
    }

    /// Reads the status, which clears it; the busy bit stays where settings are still being loaded.
    fn read_status(&mut self, now: Instant) -> u8 {
        let is_full = self.fifo.entries() >= self.at(FIFO_SAMPLES);
        let status = self.at(STATUS) | if is_full { FIFO_FULL } else { 0 };
        let is_busy = now < self.ready_at;
        self.registers[usize::from(STATUS)] = if is_busy { NVM_BUSY } else { 0 };
        status
    }

    /// Lowers the data-ready pin, as a read of data does; what is read does not belong to a sample that waits.
    fn lower_pin(&mut self) {
        if self.waiting.is_none() {
            self.pin_falls = None;
        }
    }

    /// Takes the first byte of a transaction.
    fn begin(&mut self, exchange: &Exchange) {
        let Exchange { sent: command, since, begin, .. } = *exchange;
        if self.waiting.is_some_and(|felt| felt.landed <= begin) {
            self.release();
        }
        let landed = self.waiting.map(|felt| felt.landed);
        let address = command >> 1;
        self.judge_clock(exchange, address);
        let looks = command == STATUS << 1 | 1 && !self.is_powering_up;
        let follows = if since >= self.ready_at { usize::MAX } else { 1 + usize::from(looks) };
        self.course = Course { is_selected: true, bytes: 1, follows, command, address, landed };
    }

    /// Reads or writes the next register, or records that the chip does not listen; while it loads its settings
    /// only the status can be read, once in a transaction.
    fn follow(&mut self, exchange: &Exchange) -> u8 {
        let Course { bytes, follows, command, .. } = self.course;
        self.course.bytes += 1;
        if bytes >= follows {
            if bytes == follows {
                self.violations.record(Misuse::TooEarly, command >> 1, exchange.since);
            }
            0
        } else if command & 1 == 1 {
            self.read_next(exchange)
        } else {
            let address = self.course.address;
            self.course.address = address.wrapping_add(1);
            self.write(address, exchange.sent, exchange.since);
            0
        }
    }

    /// Reads the next register of a row. At the FIFO the address stays, and the FIFO gives its values only
    /// where the transaction began there.
    fn read_next(&mut self, exchange: &Exchange) -> u8 {
        let address = self.course.address;
        if address == FIFO_DATA {
            self.lower_pin();
            return if self.course.command >> 1 == FIFO_DATA { self.fifo.read() } else { 0 };
        }
        self.course.address = address.wrapping_add(1);
        if let Some(misuse) = read_refusal(MAP, address.into()) {
            self.violations.record(misuse, address, exchange.since);
            return 0;
        }
        let byte = self.read(address, exchange.since);
        if self.has_landed_before(exchange.end) { byte ^ data_bits(address) } else { byte }
    }

    /// Whether a new sample lands in the course of the transaction before `end`.
    fn has_landed_before(&self, end: Instant) -> bool {
        let next = self.measuring.map(|measuring| measuring.next());
        self.course.landed.or(next).is_some_and(|at| at < end)
    }

    /// Writes a register, or records why it must not be written.
    fn write(&mut self, address: u8, value: u8, now: Instant) {
        let held = self.registers.get(usize::from(address)).copied().unwrap_or(0);
        let is_measuring = self.measuring.is_some();
        if let Some(misuse) = registers::write_refusal(address, value, held, is_measuring) {
            self.violations.record(misuse, address, now);
        } else if address == RESET {
            self.restart(now);
        } else {
            self.registers[usize::from(address)] = value;
            if address == POWER_CTL {
                self.switch(now);
            }
        }
    }

    /// Begins or ends measuring; in standby the data path is reset.
    fn switch(&mut self, now: Instant) {
        if self.at(POWER_CTL) & STANDBY == 0 {
            let hertz = 4000.0 / f64::from(1_u32 << (self.at(FILTER) & 0x0F));
            self.measuring.get_or_insert(Cadence::new(now, 1, hertz));
        } else {
            self.measuring = None;
            self.waiting = None;
            self.pin_falls = None;
            self.counts = [0; 3];
            self.fifo = Fifo::default();
            self.registers[usize::from(STATUS)] = 0;
        }
    }

    /// Records a bus clock beyond what the chip allows.
    fn judge_clock(&mut self, exchange: &Exchange, address: u8) {
        if exchange.hertz > *CLOCKS.end() {
            self.violations.record(Misuse::ClockTooFast, address, exchange.since);
        } else if exchange.hertz < *CLOCKS.start() {
            self.violations.record(Misuse::ForbiddenValue, address, exchange.since);
        }
    }
}

/// The bits of a register that a new sample changes.
const fn data_bits(address: u8) -> u8 {
    match address {
        TEMP2 => 0x0F,
        0x0A | 0x0D | ZDATA1 => 0xF0,
        TEMP1 | XDATA3..ZDATA1 => 0xFF,
        _ => 0,
    }
}

impl<E: ForceInput + ?Sized> SpiChip<E> for Adxl355 {
    fn next_event(&self) -> Option<Instant> {
        let next = self.measuring.map(|measuring| measuring.next());
        next.map(|at| self.pin_falls.map_or(at, |falls| falls.min(at)))
    }

    fn event(&mut self, environment: &mut E) {
        let Some(measuring) = self.measuring else { return };
        if self.pin_falls.take().is_none_or(|falls| falls >= measuring.next()) {
            self.convert(environment, measuring);
        }
    }

    fn select(&mut self, _: &mut E, _: Instant) {
        self.course = Course { is_selected: true, ..Course::default() };
    }

    fn exchange(&mut self, _: &mut E, exchange: &Exchange) -> u8 {
        if self.course.bytes == 0 {
            self.begin(exchange);
            return 0;
        }
        self.follow(exchange)
    }

    fn deselect(&mut self, _: &mut E, since: Instant, is_whole: bool) {
        self.release();
        let Course { bytes, command, .. } = core::mem::take(&mut self.course);
        if bytes == 1 || !is_whole {
            self.violations.record(Misuse::Length, command >> 1, since);
        }
    }

    fn limits(&self) -> BusLimits {
        BUS
    }

    /// High where the data sheet has it high: for half a period after a new sample, unless that is read
    /// before.
    fn ready_line(&self) -> ReadyLine {
        if self.at(POWER_CTL) & DRDY_OFF != 0 {
            return ReadyLine::default();
        }
        let next = self.measuring.map(|measuring| measuring.next());
        ReadyLine { active: self.pin_falls.is_some(), next, ..ReadyLine::default() }
    }

    fn power_cycle(&mut self, now: Instant) {
        *self = self.sane(now);
    }

    fn violations(&self) -> &Violations {
        &self.violations
    }
}
