//! A chip on a serial bus: registers behind bytes, and a clock of its own.
//!
//! A chip answers byte by byte, between the fall and the rise of its select line: [`SpiChip::select`],
//! [`SpiChip::exchange`], [`SpiChip::deselect`]. A whole transaction ([`SpiChip::transact`]) is a run of bytes
//! without a pause, so that both ways go through the same registers and the same checks. What the chip does
//! of itself in the course of a transaction, such as a conversion, shows after it, as if the transaction
//! had taken no time.

use embassy_time::{Duration, Instant};
use embedded_hal::spi::Mode;

use crate::violation::Violations;

/// The select line of one chip on the board. Not every board has every line
/// ([`crate::assembly::Chips::SELECTS`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Select {
    /// The converter of the precise gyro; of several on one body, that of the one forward.
    Gyro,
    /// The converter of a body's gyro to the right.
    GyroRight,
    /// The converter of a vehicle's gyro down.
    GyroDown,
    /// The converter of a spinning body's gyro upwards.
    GyroUp,
    /// The converter of a spinning body's accelerometer upwards.
    ForceUp,
    /// The converter of a spinning body's accelerometer to the right.
    ForceRight,
    /// The accelerometer on the platform.
    Accelerometer,
    /// The encoder of the stage.
    Encoder,
    /// The motor driver of the stage.
    Actuator,
    /// The encoder of a two-frame mount's inner frame; the outer one has the stage's.
    InnerEncoder,
    /// The motor driver of the inner frame.
    InnerActuator,
}

/// One transaction as the chip sees it, from select low to select high.
#[derive(Clone, Copy, Debug)]
pub struct Transaction<'a> {
    /// When the select line fell.
    pub now: Instant,
    /// Bus clock, Hz.
    pub hertz: u32,
    /// The bytes from the controller.
    pub sent: &'a [u8],
}

/// One byte as the chip sees it, in both directions.
#[derive(Clone, Copy, Debug)]
pub struct Exchange {
    /// The byte from the controller.
    pub sent: u8,
    /// When the bytes of the transaction began, later by all pauses between select and this byte: the moment
    /// that an access belongs to, where the data sheet has no finer one. Without a pause it is when the
    /// select line fell.
    pub since: Instant,
    /// When the first bit began.
    pub begin: Instant,
    /// When the last bit ended, rounded up to microseconds.
    pub end: Instant,
    /// Bus clock, Hz.
    pub hertz: u32,
}

/// Time that `bytes` bytes take on a bus clocked at `hertz` (> 0), rounded up to microseconds.
pub(crate) fn bus_time(bytes: usize, hertz: u32) -> Duration {
    let bits = bytes as u64 * 8_000_000;
    // The usual transaction needs no long division.
    Duration::from_micros(match u32::try_from(bits) {
        Ok(bits) => u64::from(bits.div_ceil(hertz)),
        Err(_) => bits.div_ceil(u64::from(hertz)),
    })
}

/// What a chip asks of its bus beside a clock that is not too fast, as its data sheet has it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BusLimits {
    /// The mode that the chip has; none where it takes any.
    pub mode: Option<Mode>,
    /// Least time from the fall of select to the first edge of the clock, ns.
    pub select_to_clock_ns: u32,
    /// Least time from the last edge of the clock to the rise of select, ns.
    pub clock_to_deselect_ns: u32,
    /// Least time from the rise of select to its next fall, ns.
    pub deselected_ns: u32,
}

/// A data-ready line of a chip at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadyLine {
    /// Whether the line is active: there are data that the bus has not read.
    pub active: bool,
    /// When the line becomes active again, where the chip brings that about without an access.
    pub next: Option<Instant>,
    /// When a conversion last made it active, or would have where it was so already; none where none did, or where
    /// the chip is no converter.
    pub latest: Option<Instant>,
    /// Number of conversions that did; it wraps.
    pub count: u32,
}

/// A chip with serial interface in an environment `E`.
pub trait SpiChip<E: ?Sized> {
    /// When the chip next does something of itself, such as a conversion.
    fn next_event(&self) -> Option<Instant>;

    /// Does what is due at [`Self::next_event`].
    fn event(&mut self, environment: &mut E);

    /// The select line falls at `now`. All events up to then have happened.
    fn select(&mut self, environment: &mut E, now: Instant);

    /// Takes a byte and gives the one that goes out meanwhile, which depends on earlier bytes only. All events
    /// up to its beginning have happened.
    fn exchange(&mut self, environment: &mut E, exchange: &Exchange) -> u8;

    /// The select line rises, after the last bit of a byte or, where the transaction is not whole, within a
    /// byte, which is then lost. The access belongs to `since` ([`Exchange::since`]).
    fn deselect(&mut self, environment: &mut E, since: Instant, is_whole: bool);

    /// Answers a transaction into `reply`, which is as long as what was sent. All events up to its
    /// time have happened.
    fn transact(&mut self, environment: &mut E, transaction: &Transaction, reply: &mut [u8]) {
        let Transaction { now, hertz, sent } = *transaction;
        self.select(environment, now);
        let mut begin = now;
        for (index, (&sent, out)) in sent.iter().zip(reply).enumerate() {
            let end = now + bus_time(index + 1, hertz);
            *out = self.exchange(environment, &Exchange { sent, since: now, begin, end, hertz });
            begin = end;
        }
        self.deselect(environment, now, true);
    }

    /// What the chip asks of its bus; without limits of its own it takes any.
    fn limits(&self) -> BusLimits {
        BusLimits::default()
    }

    /// The data-ready line; chips without one never become ready.
    fn ready_line(&self) -> ReadyLine {
        ReadyLine::default()
    }

    /// Loses the supply for a moment and starts again at `now` with its reset values.
    fn power_cycle(&mut self, now: Instant);

    /// What was done to the chip that its data sheet forbids.
    fn violations(&self) -> &Violations;
}

/// Lets a chip do everything that is due until `now`, that moment included.
pub fn advance<E>(chip: &mut impl SpiChip<E>, environment: &mut E, now: Instant) {
    while chip.next_event().is_some_and(|at| at <= now) {
        chip.event(environment);
    }
}

/// Chips that can be addressed through [`crate::spi::SpiPort`]. Everything that is due until the time of a
/// call happens first.
pub trait Rig {
    /// Answers a transaction with the selected chip.
    fn transact(&mut self, select: Select, transaction: &Transaction, reply: &mut [u8]);

    /// Has the select line of a chip fall at `now`.
    fn select(&mut self, select: Select, now: Instant);

    /// Has a chip whose select line is low take a byte, and gives its own; 0xFF where there is no such chip.
    fn exchange(&mut self, select: Select, exchange: &Exchange) -> u8;

    /// Has the select line of a chip rise at `now` ([`SpiChip::deselect`]).
    fn deselect(&mut self, select: Select, now: Instant, since: Instant, is_whole: bool);

    /// What a chip asks of its bus.
    fn limits(&mut self, select: Select) -> BusLimits;

    /// The data-ready line of the selected chip at `now`.
    fn ready_line(&mut self, select: Select, now: Instant) -> ReadyLine;

    /// That line at the latest time that anything was asked for; one that was never active where there is none.
    fn latest_line(&mut self, _select: Select) -> ReadyLine {
        ReadyLine::default()
    }

    /// Has the selected chip lose its supply for a moment.
    fn power_cycle(&mut self, select: Select, now: Instant);
}

/// One chip alone with its environment, on a bus of its own: it answers on every select line.
#[derive(Clone, Debug)]
pub struct Single<C, E> {
    /// The chip.
    pub chip: C,
    /// What the chip measures or moves.
    pub environment: E,
}

impl<C: SpiChip<E>, E> Rig for Single<C, E> {
    fn transact(&mut self, _: Select, transaction: &Transaction, reply: &mut [u8]) {
        advance(&mut self.chip, &mut self.environment, transaction.now);
        self.chip.transact(&mut self.environment, transaction, reply);
    }

    fn select(&mut self, _: Select, now: Instant) {
        advance(&mut self.chip, &mut self.environment, now);
        self.chip.select(&mut self.environment, now);
    }

    fn exchange(&mut self, _: Select, exchange: &Exchange) -> u8 {
        advance(&mut self.chip, &mut self.environment, exchange.begin);
        self.chip.exchange(&mut self.environment, exchange)
    }

    fn deselect(&mut self, _: Select, now: Instant, since: Instant, is_whole: bool) {
        advance(&mut self.chip, &mut self.environment, now);
        self.chip.deselect(&mut self.environment, since, is_whole);
    }

    fn limits(&mut self, _: Select) -> BusLimits {
        self.chip.limits()
    }

    fn ready_line(&mut self, _: Select, now: Instant) -> ReadyLine {
        advance(&mut self.chip, &mut self.environment, now);
        self.chip.ready_line()
    }

    fn latest_line(&mut self, _: Select) -> ReadyLine {
        self.chip.ready_line()
    }

    fn power_cycle(&mut self, _: Select, now: Instant) {
        advance(&mut self.chip, &mut self.environment, now);
        self.chip.power_cycle(now);
    }
}
