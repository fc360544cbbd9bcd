//! An I²C bus at the level of its conditions and bytes.

use core::fmt;

use super::{half_bits, instant, instant_after};
use crate::chip::Single;
use crate::i2c::{I2cChip, Start};
use crate::violation::Record;

/// What the pull-up of the data line gives where no chip drives it.
const PULLED_UP: u8 = 0xFF;

/// A rule of the bus that was broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum I2cRule {
    /// A byte or a stop came without a start.
    NotStarted,
    /// A byte was written after an address for reading, or read after one for writing.
    WrongDirection,
    /// A byte was written or read after one that was not acknowledged.
    AfterNoAcknowledge,
    /// A start or a stop came where the chip still drives the data line: the last byte that was read was
    /// acknowledged.
    StillDriven,
}

/// A rule of the bus that was broken, and when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct I2cFault {
    /// The rule that was broken.
    pub rule: I2cRule,
    /// When the rule was broken, ns since the clock began.
    pub nanoseconds: u64,
}

impl fmt::Display for I2cFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} after {} ns", self.rule, self.nanoseconds)
    }
}

/// Where the bus is in a transfer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// There was no start since the last stop.
    #[default]
    Free,
    /// Bytes are written.
    Writing,
    /// The first byte is to be read.
    Turned,
    /// A byte was read and acknowledged.
    Reading,
    /// Something was not acknowledged.
    Over,
    /// The clock stopped amid a byte that the chip sends: its bits from the one on the wire on, ones behind them.
    Stopped(u8),
}

/// The wires of an I²C bus with one chip. What breaks a rule of the bus is recorded and does not reach the
/// chip.
#[derive(Clone, Debug, Default)]
pub struct I2cWires {
    /// Where the bus is.
    state: State,
    /// Bus clock of the transfer, Hz.
    hertz: u32,
    /// When the transfer began, later by all pauses in it, ns.
    since: u64,
    /// When the latest condition or byte ended, ns.
    end: u64,
    /// Rules that were broken.
    faults: Record<I2cFault>,
}

impl I2cWires {
    /// A bus at rest.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The rules that were broken.
    #[must_use]
    pub const fn faults(&self) -> &Record<I2cFault> {
        &self.faults
    }

    /// A start condition, repeated or not, and an address of 7 bits with its direction, from `at` ns on at
    /// `hertz` (> 0); returns whether a chip acknowledged.
    pub fn start<C: I2cChip<E>, E>(
        &mut self,
        rig: &mut Single<C, E>,
        address: u8,
        is_read: bool,
        hertz: u32,
        at: u64,
    ) -> bool {
        match self.state {
            State::Free | State::Stopped(_) if !self.is_data_low() => {
                (self.since, self.end) = (at, at);
            }
            State::Reading | State::Stopped(_) => return self.breaks(I2cRule::StillDriven, at),
            _ => {}
        }
        self.hertz = hertz;
        self.take(rig, 10, at);
        let start = Start { now: instant(self.since), hertz, address, is_read };
        let is_acknowledged = rig.chip.start(&mut rig.environment, &start);
        self.state = match (is_acknowledged, is_read) {
            (false, _) => State::Over,
            (true, false) => State::Writing,
            (true, true) => State::Turned,
        };
        is_acknowledged
    }

    /// A byte is written from `at` ns on; returns whether the chip acknowledged.
    pub fn write<C: I2cChip<E>, E>(&mut self, rig: &mut Single<C, E>, byte: u8, at: u64) -> bool {
        match self.state {
            State::Writing => {}
            State::Free | State::Stopped(_) => return self.breaks(I2cRule::NotStarted, at),
            State::Over => return self.breaks(I2cRule::AfterNoAcknowledge, at),
            State::Turned | State::Reading => return self.breaks(I2cRule::WrongDirection, at),
        }
        self.take(rig, 9, at);
        let is_acknowledged = rig.chip.write(&mut rig.environment, byte, instant(self.since));
        if !is_acknowledged {
            self.state = State::Over;
        }
        is_acknowledged
    }

    /// A byte is read from `at` ns on, which the controller then acknowledges or not: the last one must not be.
    pub fn read<C: I2cChip<E>, E>(
        &mut self,
        rig: &mut Single<C, E>,
        is_acknowledged: bool,
        at: u64,
    ) -> u8 {
        let broken = match self.state {
            State::Turned | State::Reading => None,
            State::Free | State::Stopped(_) => Some(I2cRule::NotStarted),
            State::Over => Some(I2cRule::AfterNoAcknowledge),
            State::Writing => Some(I2cRule::WrongDirection),
        };
        if let Some(rule) = broken {
            self.breaks(rule, at);
            return PULLED_UP;
        }
        self.take(rig, 9, at);
        self.state = if is_acknowledged { State::Reading } else { State::Over };
        rig.chip.read(&mut rig.environment, instant_after(at))
    }

    /// The clock stops, while it is high, amid a byte that is read from `at` ns on; the bit of this number is on the wire,
    /// from 0, 8 being the acknowledge. The chip drives the line until the clock goes on, or until a start or a stop, which
    /// it can see while its bit is a one (UM10204, 3.1.16).
    pub fn stop_clock<C: I2cChip<E>, E>(&mut self, rig: &mut Single<C, E>, bit: u32, at: u64) {
        rig.pass(instant(at));
        self.state = State::Stopped(rig.chip.read(&mut rig.environment, instant_after(at)));
        (0..bit).for_each(|_| self.clock_falls());
    }

    /// Whether a chip holds the data line low, in the midst of a byte.
    #[must_use]
    pub const fn is_data_low(&self) -> bool {
        matches!(self.state, State::Stopped(bits) if bits < 0x80)
    }

    /// The clock, which had stopped, falls: the chip puts its next bit on the wire, none behind the last. The acknowledge
    /// is not modelled: what stopped the clock wants no further byte.
    pub const fn clock_falls(&mut self) {
        if let State::Stopped(bits) = &mut self.state {
            *bits = *bits << 1 | 1;
        }
    }

    /// A stop condition at `at` ns.
    pub fn stop<C: I2cChip<E>, E>(&mut self, rig: &mut Single<C, E>, at: u64) {
        match self.state {
            State::Free => {
                self.breaks(I2cRule::NotStarted, at);
                return;
            }
            State::Reading => {
                self.breaks(I2cRule::StillDriven, at);
            }
            // The data line does not rise: the chip sees no stop.
            State::Stopped(_) if self.is_data_low() => return,
            _ => {}
        }
        self.pause(rig, at);
        self.state = State::Free;
        rig.chip.stop(&mut rig.environment, instant(self.since));
    }

    /// Something of so many bits begins, perhaps after a pause.
    fn take<C: I2cChip<E>, E>(&mut self, rig: &mut Single<C, E>, bits: u64, at: u64) {
        self.pause(rig, at);
        self.end += half_bits(2 * bits, self.hertz);
    }

    /// The chip does what is due, and a pause until now is noted.
    fn pause<C: I2cChip<E>, E>(&mut self, rig: &mut Single<C, E>, at: u64) {
        rig.pass(instant(at));
        self.since += at.saturating_sub(self.end);
        self.end = at;
    }

    /// Records a broken rule, of which nothing comes: no acknowledge.
    fn breaks(&mut self, rule: I2cRule, nanoseconds: u64) -> bool {
        self.faults.keep(I2cFault { rule, nanoseconds });
        false
    }
}
