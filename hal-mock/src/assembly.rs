//! A board put together from several chips around one world: who acts when, and who answers.
//!
//! Before a chip is touched, every chip does what is due until that moment, in order of time, so
//! that a conversion sees the world as it was when the conversion ended. A supply that is lost at the
//! moment of a chip's event is lost before it.
//!
//! Chips say which of them there are and which environment each of them sees ([`Chips::with`]); order,
//! losses of supply and the bus ([`Rig`]) follow from that.

use embassy_time::Instant;

use crate::chip::{BusLimits, Exchange, ReadyLine, Rig, Select, SpiChip, Transaction};
use crate::fault::Blackout;
use crate::violation::{Violation, Violations};

/// Something that is done with a chip of any type; what is learnt stays as it was where the board has no
/// such chip.
#[derive(Debug)]
pub enum Task<'t, 'b> {
    /// Learns when the chip acts of itself.
    Next(&'t mut Option<Instant>),
    /// Has the chip do what is due.
    Event,
    /// Has the chip answer.
    Answer(&'t Transaction<'b>, &'t mut [u8]),
    /// Has the select line fall at a moment.
    Select(Instant),
    /// Has the chip take a byte and give its own.
    Exchange(&'t Exchange, &'t mut u8),
    /// Has the select line rise, for an access of a moment, after a whole byte or not.
    Deselect(Instant, bool),
    /// Learns what the chip asks of its bus.
    Limits(&'t mut BusLimits),
    /// Looks at the data-ready line.
    Line(&'t mut ReadyLine),
    /// Takes the supply away for a moment.
    Restart(Instant),
    /// Learns what was done to the chip that its data sheet forbids.
    Violations(&'t mut Option<Violations>),
}

impl Task<'_, '_> {
    /// Does it with a chip in the environment that the board gives it.
    pub fn perform<E: ?Sized, C: SpiChip<E>>(self, chip: &mut C, environment: &mut E) {
        match self {
            Self::Next(next) => *next = chip.next_event(),
            Self::Event => chip.event(environment),
            Self::Answer(transaction, reply) => chip.transact(environment, transaction, reply),
            Self::Select(now) => chip.select(environment, now),
            Self::Exchange(exchange, reply) => *reply = chip.exchange(environment, exchange),
            Self::Deselect(since, is_whole) => chip.deselect(environment, since, is_whole),
            Self::Limits(limits) => *limits = chip.limits(),
            Self::Line(line) => *line = chip.ready_line(),
            Self::Restart(now) => chip.power_cycle(now),
            Self::Violations(found) => *found = Some(chip.violations().clone()),
        }
    }
}

/// The chips of a board in a world `P`: what names its parts. Times that they are asked for never fall.
pub trait Chips<P> {
    /// The chips, in the order in which they act at equal times.
    const SELECTS: &'static [Select];

    /// Performs a task with a chip, or nothing where the board has no such chip.
    fn with(&mut self, plant: &mut P, select: Select, task: Task);

    /// Moves the world on to `now`, which is never before the time of an earlier call, where readings alone
    /// do not.
    fn move_on(_plant: &mut P, _now: Instant) {}

    /// Takes from the world what it loses with the supply of a chip at `now`, as a motor's drive.
    fn lose(_plant: &mut P, _select: Select, _now: Instant) {}
}

/// Chips around a world, on one bus.
#[must_use]
#[derive(Clone, Debug)]
pub struct Board<'a, P, C> {
    /// What the chips measure and move.
    pub plant: P,
    /// The chips.
    pub chips: C,
    /// Losses of supply to come, in order of time.
    pub blackouts: &'a [Blackout],
}

impl<P, C: Chips<P>> Board<'_, P, C> {
    /// What was done to a chip that its data sheet forbids; none where the board has no such chip.
    pub fn violations(&mut self, select: Select) -> Option<Violations> {
        let mut found = None;
        self.with(select, Task::Violations(&mut found));
        found
    }

    /// The forbidden accesses that are kept ([`Violations::first`]) with their chips, chip by chip in the
    /// order of [`Chips::SELECTS`].
    pub fn recorded(&mut self) -> impl Iterator<Item = (Select, Violation)> {
        C::SELECTS.iter().flat_map(|select| {
            let found = self.violations(*select).unwrap_or_default().first;
            found.into_iter().map(|violation| (*select, violation))
        })
    }

    /// Lets everything happen that is due until `now`, that moment included.
    pub fn advance(&mut self, now: Instant) {
        loop {
            let event = self.next_event().filter(|(at, _)| *at <= now);
            let blackout = self.blackouts.first().filter(|blackout| blackout.at <= now).copied();
            match (event, blackout) {
                (Some((at, select)), blackout) if blackout.is_none_or(|b| at < b.at) => {
                    C::move_on(&mut self.plant, at);
                    self.with(select, Task::Event);
                }
                (_, Some(Blackout { select, at })) => {
                    self.blackouts = &self.blackouts[1..];
                    self.restart(select, at);
                }
                _ => break,
            }
        }
        C::move_on(&mut self.plant, now);
    }

    /// The chip that acts next, and when; of several at one time the first of [`Chips::SELECTS`].
    fn next_event(&mut self) -> Option<(Instant, Select)> {
        let mut due = |select| {
            let mut next = None;
            self.with(select, Task::Next(&mut next));
            Some((next?, select))
        };
        C::SELECTS.iter().filter_map(|select| due(*select)).min_by_key(|(at, _)| *at)
    }

    /// Takes a chip's supply away at `now` and gives it back at once.
    fn restart(&mut self, select: Select, now: Instant) {
        C::lose(&mut self.plant, select, now);
        self.with(select, Task::Restart(now));
    }

    /// Performs a task with a chip, or nothing where the board has no such chip.
    fn with(&mut self, select: Select, task: Task) {
        self.chips.with(&mut self.plant, select, task);
    }
}

impl<P, C: Chips<P>> Rig for Board<'_, P, C> {
    fn transact(&mut self, select: Select, transaction: &Transaction, reply: &mut [u8]) {
        self.advance(transaction.now);
        self.with(select, Task::Answer(transaction, reply));
    }

    fn select(&mut self, select: Select, now: Instant) {
        self.advance(now);
        self.with(select, Task::Select(now));
    }

    fn exchange(&mut self, select: Select, exchange: &Exchange) -> u8 {
        self.advance(exchange.begin);
        let mut reply = 0xFF;
        self.with(select, Task::Exchange(exchange, &mut reply));
        reply
    }

    fn deselect(&mut self, select: Select, now: Instant, since: Instant, is_whole: bool) {
        self.advance(now);
        self.with(select, Task::Deselect(since, is_whole));
    }

    fn limits(&mut self, select: Select) -> BusLimits {
        let mut limits = BusLimits::default();
        self.with(select, Task::Limits(&mut limits));
        limits
    }

    fn ready_line(&mut self, select: Select, now: Instant) -> ReadyLine {
        self.advance(now);
        self.latest_line(select)
    }

    fn latest_line(&mut self, select: Select) -> ReadyLine {
        let mut line = ReadyLine::default();
        self.with(select, Task::Line(&mut line));
        line
    }

    fn power_cycle(&mut self, select: Select, now: Instant) {
        self.advance(now);
        self.restart(select, now);
    }
}
