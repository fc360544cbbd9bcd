//! A board put together from several chips around one world: who acts when, and who answers.
//!
//! Before a chip is touched, every chip does what is due until that moment, in order of time, so
//! that a conversion sees the world as it was when the conversion ended. A supply that is lost at the
//! moment of a chip's event is lost before it.
//!
//! Chips say which of them there are and which environment each of them sees ([`Chips::with`]); order,
//! losses of supply and the bus ([`Rig`]) follow from that.

use embassy_time::Instant;

use crate::chip::{ReadyLine, Rig, Select, SpiChip, Transaction};
use crate::fault::Blackout;
use crate::violation::{Violation, Violations};

/// Something that is done with a chip of any type.
pub trait Task {
    /// Does it with a chip in the environment that the board gives it.
    fn perform<E: ?Sized, C: SpiChip<E>>(&mut self, chip: &mut C, environment: &mut E);
}

/// The chips of a board in a world `P`: what names its parts. Times that they are asked for never fall.
pub trait Chips<P> {
    /// The chips, in the order in which they act at equal times.
    const SELECTS: &'static [Select];

    /// Performs a task with a chip, or nothing where the board has no such chip.
    fn with(&mut self, plant: &mut P, select: Select, task: &mut impl Task);

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
        let mut found = Found(None);
        self.with(select, &mut found);
        found.0
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
                    self.with(select, &mut Event);
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
            let mut next = Next(None);
            self.with(select, &mut next);
            Some((next.0?, select))
        };
        C::SELECTS.iter().filter_map(|select| due(*select)).min_by_key(|(at, _)| *at)
    }

    /// Takes a chip's supply away at `now` and gives it back at once.
    fn restart(&mut self, select: Select, now: Instant) {
        C::lose(&mut self.plant, select, now);
        self.with(select, &mut Restart(now));
    }

    /// Performs a task with a chip, or nothing where the board has no such chip.
    fn with(&mut self, select: Select, task: &mut impl Task) {
        self.chips.with(&mut self.plant, select, task);
    }
}

/// Learns when a chip acts of itself.
struct Next(Option<Instant>);

impl Task for Next {
    fn perform<E: ?Sized, C: SpiChip<E>>(&mut self, chip: &mut C, _: &mut E) {
        self.0 = chip.next_event();
    }
}

/// Has a chip do what is due.
struct Event;

impl Task for Event {
    fn perform<E: ?Sized, C: SpiChip<E>>(&mut self, chip: &mut C, environment: &mut E) {
        chip.event(environment);
    }
}

/// Has a chip answer.
struct Answer<'t, 'b>(&'t Transaction<'b>, &'t mut [u8]);

impl Task for Answer<'_, '_> {
    fn perform<E: ?Sized, C: SpiChip<E>>(&mut self, chip: &mut C, environment: &mut E) {
        chip.transact(environment, self.0, self.1);
    }
}

/// Looks at a chip's data-ready line.
struct Line(ReadyLine);

impl Task for Line {
    fn perform<E: ?Sized, C: SpiChip<E>>(&mut self, chip: &mut C, _: &mut E) {
        self.0 = chip.ready_line();
    }
}

/// Takes a chip's supply away for a moment.
struct Restart(Instant);

impl Task for Restart {
    fn perform<E: ?Sized, C: SpiChip<E>>(&mut self, chip: &mut C, _: &mut E) {
        chip.power_cycle(self.0);
    }
}

/// What was done to a chip that its data sheet forbids.
struct Found(Option<Violations>);

impl Task for Found {
    fn perform<E: ?Sized, C: SpiChip<E>>(&mut self, chip: &mut C, _: &mut E) {
        self.0 = Some(chip.violations().clone());
    }
}

impl<P, C: Chips<P>> Rig for Board<'_, P, C> {
    fn transact(&mut self, select: Select, transaction: &Transaction, reply: &mut [u8]) {
        self.advance(transaction.now);
        self.with(select, &mut Answer(transaction, reply));
    }

    fn ready_line(&mut self, select: Select, now: Instant) -> ReadyLine {
        self.advance(now);
        let mut line = Line(ReadyLine::default());
        self.with(select, &mut line);
        line.0
    }

    fn power_cycle(&mut self, select: Select, now: Instant) {
        self.advance(now);
        self.restart(select, now);
    }
}
