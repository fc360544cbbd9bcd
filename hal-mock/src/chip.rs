//! A chip on a serial bus: registers behind transactions, and a clock of its own.

use embassy_time::{Duration, Instant};

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

/// Time that `bytes` bytes take on a bus clocked at `hertz` (> 0), rounded up to microseconds.
pub(crate) fn bus_time(bytes: usize, hertz: u32) -> Duration {
    Duration::from_micros((bytes as u64 * 8_000_000).div_ceil(u64::from(hertz)))
}

/// A data-ready line of a chip at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadyLine {
    /// Whether the line is active: there are data that the bus has not read.
    pub active: bool,
    /// When the line becomes active again, where the chip brings that about without an access.
    pub next: Option<Instant>,
}

/// A chip with serial interface in an environment `E`.
pub trait SpiChip<E: ?Sized> {
    /// When the chip next does something of itself, such as a conversion.
    fn next_event(&self) -> Option<Instant>;

    /// Does what is due at [`Self::next_event`].
    fn event(&mut self, environment: &mut E);

    /// Answers a transaction into `reply`, which is as long as what was sent. All events up to its
    /// time have happened. A byte of the reply depends on earlier sent bytes only.
    fn transact(&mut self, environment: &mut E, transaction: &Transaction, reply: &mut [u8]);

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

/// Chips that can be addressed through [`crate::spi::SpiPort`].
pub trait Rig {
    /// Answers a transaction with the selected chip.
    fn transact(&mut self, select: Select, transaction: &Transaction, reply: &mut [u8]);

    /// The data-ready line of the selected chip at `now`.
    fn ready_line(&mut self, select: Select, now: Instant) -> ReadyLine;

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

    fn ready_line(&mut self, _: Select, now: Instant) -> ReadyLine {
        advance(&mut self.chip, &mut self.environment, now);
        self.chip.ready_line()
    }

    fn power_cycle(&mut self, _: Select, now: Instant) {
        advance(&mut self.chip, &mut self.environment, now);
        self.chip.power_cycle(now);
    }
}
