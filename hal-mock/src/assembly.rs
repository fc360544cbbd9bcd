//! A board put together from several chips around one world: who acts when, and who answers.
//!
//! Before a chip is touched, every chip does what is due until that moment, in order of time, so
//! that a conversion sees the world as it was when the conversion ended. A supply that is lost at the
//! moment of a chip's event is lost before it.
//!
//! A board says which chips it has and which environment each of them sees ([`Assembly::with`]); order,
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

/// Chips around a world.
///
/// A board implements what names its parts; [`Assembly::advance`] and what it is made of are the same for
/// every board. Times that boards are asked for never fall.
pub trait Assembly {
    /// The chips, in the order in which they act at equal times.
    const CHIPS: &'static [Select];

    /// Performs a task with a chip, or nothing where the board has no such chip.
    fn with(&mut self, select: Select, task: &mut impl Task);

    /// What was done to a chip that its data sheet forbids; none where the board has no such chip.
    fn violations(&self, select: Select) -> Option<&Violations>;

    /// Moves the world on to `now`, which is never before the time of an earlier call.
    fn move_on(&mut self, now: Instant);

    /// Takes from the world what it loses with the supply of a chip at `now`, as a motor's drive.
    fn lose(&mut self, _: Select, _: Instant) {}

    /// The losses of supply to come, in order of time.
    fn blackouts(&self) -> &[Blackout] {
        &[]
    }

    /// Strikes the first of [`Self::blackouts`], which has happened.
    fn drop_blackout(&mut self) {}

    /// The forbidden accesses that are kept ([`Violations::first`]) with their chips, chip by chip in the
    /// order of [`Self::CHIPS`].
    fn recorded(&self) -> impl Iterator<Item = (Select, Violation)> + '_ {
        Self::CHIPS.iter().flat_map(|select| {
            let found = self.violations(*select).into_iter().flat_map(Violations::first);
            found.map(|violation| (*select, *violation))
        })
    }

    /// Lets everything happen that is due until `now`, that moment included.
    fn advance(&mut self, now: Instant) {
        loop {
            let event = self.next_event().filter(|(at, _)| *at <= now);
            let blackout = self.blackouts().first().filter(|blackout| blackout.at <= now).copied();
            match (event, blackout) {
                (Some((at, select)), blackout) if blackout.is_none_or(|b| at < b.at) => {
                    self.move_on(at);
                    self.with(select, &mut Event);
                }
                (_, Some(Blackout { select, at })) => {
                    self.drop_blackout();
                    self.restart(select, at);
                }
                _ => break,
            }
        }
        self.move_on(now);
    }

    /// The chip that acts next, and when; of several at one time the first of [`Self::CHIPS`].
    fn next_event(&mut self) -> Option<(Instant, Select)> {
        let mut due = |select| {
            let mut next = Next(None);
            self.with(select, &mut next);
            Some((next.0?, select))
        };
        Self::CHIPS.iter().filter_map(|select| due(*select)).min_by_key(|(at, _)| *at)
    }

    /// Takes a chip's supply away at `now` and gives it back at once.
    fn restart(&mut self, select: Select, now: Instant) {
        self.lose(select, now);
        self.with(select, &mut Restart(now));
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

impl<A: Assembly> Rig for A {
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
