//! An SPI bus at the level of its wires.

use core::fmt;

use embedded_hal::spi::{Mode, Phase};
use heapless::Vec;

use super::{half_bits, instant, instant_after};
use crate::chip::{BusLimits, Exchange, Rig, Select};
use crate::violation::Record;

/// Select lines of one bus.
const LINES: usize = 11;

/// What the pull-up of MISO gives where no chip drives it.
const PULLED_UP: u8 = 0xFF;

/// How the controller clocks a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock {
    /// Polarity and phase.
    pub mode: Mode,
    /// Frequency, Hz, > 0.
    pub hertz: u32,
}

impl Clock {
    /// When the first and the last edge of a byte come, ns after its beginning.
    const fn edges(self) -> [u64; 2] {
        match self.mode.phase {
            Phase::CaptureOnFirstTransition => {
                [half_bits(1, self.hertz), half_bits(16, self.hertz)]
            }
            Phase::CaptureOnSecondTransition => [0, half_bits(15, self.hertz)],
        }
    }
}

/// A least time that a data sheet has between two edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// From the fall of select to the first edge of the clock.
    SelectToClock,
    /// From the last edge of the clock to the rise of select.
    ClockToDeselect,
    /// From the rise of select to its next fall.
    Deselected,
}

/// A rule of the bus that was broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpiRule {
    /// The chip was selected while another one was.
    TwoSelected {
        /// The chip that was selected already.
        other: Select,
    },
    /// The select line moved while a byte was on the bus.
    MovedInByte,
    /// A byte was clocked in a mode that the chip does not have.
    WrongMode(Mode),
    /// A wait was shorter than the chip allows.
    TooShort {
        /// Which wait.
        wait: Wait,
        /// How long the wait was, ns.
        nanoseconds: u32,
    },
}

/// A rule of the bus that was broken: what, whose, when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpiFault {
    /// The rule that was broken.
    pub rule: SpiRule,
    /// The chip whose select line or byte it was.
    pub select: Select,
    /// When the rule was broken, ns since the clock began.
    pub nanoseconds: u64,
}

impl fmt::Display for SpiFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rule, select, nanoseconds } = self;
        write!(f, "{rule:?} of {select:?} after {nanoseconds} ns")
    }
}

/// The select line of one chip.
#[derive(Clone, Copy, Debug)]
struct Line {
    /// Whose line it is.
    select: Select,
    /// Whether the line is low.
    is_low: bool,
    /// When it last moved, ns; none where it never did.
    moved: Option<u64>,
    /// What the chip asks of its bus.
    limits: BusLimits,
    /// Whether the chip hears the byte on the bus from its first bit on.
    hears: bool,
    /// Whether the chip has heard a part of a byte.
    is_ragged: bool,
    /// When the last edge of the clock came while the line was low, ns.
    edge: Option<u64>,
    /// The moment that accesses belong to ([`Exchange::since`]), ns.
    since: u64,
    /// When the latest byte ended, or the line fell, ns.
    end: u64,
    /// The latest bytes that were sent and answered, of which a wrong mode keeps a bit.
    latest: [u8; 2],
}

impl Line {
    /// A line that is high and was never low.
    const fn new(select: Select) -> Self {
        let limits = BusLimits {
            mode: None,
            select_to_clock_ns: 0,
            clock_to_deselect_ns: 0,
            deselected_ns: 0,
        };
        Self {
            select,
            is_low: false,
            moved: None,
            limits,
            hears: false,
            is_ragged: false,
            edge: None,
            since: 0,
            end: 0,
            latest: [0; 2],
        }
    }

    /// A fault of this line.
    const fn fault(&self, rule: SpiRule, nanoseconds: u64) -> SpiFault {
        SpiFault { rule, select: self.select, nanoseconds }
    }

    /// A wait since a time that is shorter than `least`, ns.
    fn short(&self, wait: Wait, least: u32, since: Option<u64>, at: u64) -> Option<SpiFault> {
        let nanoseconds = u32::try_from(at.saturating_sub(since?)).ok()?;
        let rule = SpiRule::TooShort { wait, nanoseconds };
        (nanoseconds < least).then(|| self.fault(rule, at))
    }

    /// Has the chip take a byte, and gives its own. In a mode that the chip does not have, both sides read each
    /// bit one bit late.
    fn exchange(&mut self, rig: &mut (impl Rig + ?Sized), byte: &Byte) -> u8 {
        let is_late = self.has_not(byte.clock.mode);
        let Byte { sent, clock, begin, .. } = *byte;
        let heard = if is_late { late(self.latest[0], sent) } else { sent };
        let exchange = Exchange {
            sent: heard,
            since: instant(self.since),
            begin: instant(begin),
            end: instant_after(begin + half_bits(16, clock.hertz)),
            hertz: clock.hertz,
        };
        let reply = rig.exchange(self.select, &exchange);
        let shown = if is_late { late(self.latest[1], reply) } else { reply };
        self.latest = [sent, reply];
        shown
    }

    /// Whether the chip has another mode than this.
    fn has_not(&self, mode: Mode) -> bool {
        self.limits.mode.is_some_and(|own| own != mode)
    }
}

/// A byte one bit late, after the byte before it.
const fn late(before: u8, byte: u8) -> u8 {
    before << 7 | byte >> 1
}

/// A byte on the bus.
#[derive(Clone, Copy, Debug)]
struct Byte {
    /// The byte from the controller.
    sent: u8,
    /// How it is clocked.
    clock: Clock,
    /// When the first bit begins, ns.
    begin: u64,
    /// What the controller reads, once the chips have heard the byte.
    reply: Option<u8>,
}

impl Byte {
    /// Whether the byte has begun at a time, and the last edge of the clock has not come.
    fn is_under_way(&self, at: u64) -> bool {
        let [_, last] = self.clock.edges();
        (self.begin..self.begin + last).contains(&at)
    }
}

/// The wires of one SPI bus.
///
/// - A chip hears a byte that it was selected for from its first to its last edge. Where its line moves in
///   between, the fall or the rise is recorded, the byte is lost, and the transaction has a wrong length.
/// - Where no chip is selected, MISO is pulled up. Where several are, each hears every byte, and MISO is low
///   where one of them pulls it low; that is recorded when the second one is selected.
/// - In a mode that a chip does not have, both sides read each bit one bit late; each such byte is recorded.
/// - Waits that are shorter than a chip allows ([`BusLimits`]) are recorded, and have no other effect.
///
/// Too fast a clock is a violation of the chip's own.
#[derive(Clone, Debug, Default)]
pub struct SpiWires {
    /// Select lines that have moved.
    lines: Vec<Line, LINES>,
    /// The byte on the bus.
    byte: Option<Byte>,
    /// Rules that were broken.
    faults: Record<SpiFault>,
}

impl SpiWires {
    /// Wires at rest: all select lines are high.
    #[must_use]
    pub const fn new() -> Self {
        let faults = Record { first: Vec::new(), count: 0 };
        Self { lines: Vec::new(), byte: None, faults }
    }

    /// The rules that were broken.
    #[must_use]
    pub const fn faults(&self) -> &Record<SpiFault> {
        &self.faults
    }

    /// The select line of a chip becomes low or high at `at` ns; nothing happens where it is so already.
    pub fn set_select(
        &mut self,
        rig: &mut (impl Rig + ?Sized),
        select: Select,
        is_low: bool,
        at: u64,
    ) {
        let Some(index) = self.line(select).filter(|index| self.lines[*index].is_low != is_low)
        else {
            return;
        };
        let is_within = self.byte.is_some_and(|byte| byte.reply.is_none() && byte.is_under_way(at));
        if is_within {
            self.faults.keep(self.lines[index].fault(SpiRule::MovedInByte, at));
        } else {
            self.hear(rig);
        }
        if is_low {
            self.fall(rig, index, is_within, at);
        } else {
            self.rise(rig, index, is_within, at);
        }
    }

    /// The controller begins to clock a byte at `at` ns, which the chips hear with its last bit.
    pub fn begin(&mut self, rig: &mut (impl Rig + ?Sized), sent: u8, clock: Clock, at: u64) {
        self.hear(rig);
        self.byte = Some(Byte { sent, clock, begin: at, reply: None });
        let [first, last] = clock.edges().map(|edge| at + edge);
        for line in self.lines.iter_mut().filter(|line| line.is_low) {
            if line.edge.is_none() {
                let least = line.limits.select_to_clock_ns;
                let short = line.short(Wait::SelectToClock, least, line.moved, first);
                if let Some(fault) = short {
                    self.faults.keep(fault);
                }
            }
            if line.has_not(clock.mode) {
                self.faults.keep(line.fault(SpiRule::WrongMode(clock.mode), at));
            }
            line.hears = true;
            line.edge = Some(last);
            line.since += at.saturating_sub(line.end);
            line.end = at + half_bits(16, clock.hertz);
        }
    }

    /// The byte on the bus has ended: what the controller reads.
    pub fn finish(&mut self, rig: &mut (impl Rig + ?Sized)) -> u8 {
        self.hear(rig);
        self.byte.take().and_then(|byte| byte.reply).unwrap_or(PULLED_UP)
    }

    /// A byte is clocked from `at` ns on while no select line moves: what the controller reads.
    pub fn exchange(
        &mut self,
        rig: &mut (impl Rig + ?Sized),
        sent: u8,
        clock: Clock,
        at: u64,
    ) -> u8 {
        self.begin(rig, sent, clock, at);
        self.finish(rig)
    }

    /// Where the line of a chip stands in the list, which it enters with its first move.
    fn line(&mut self, select: Select) -> Option<usize> {
        let known = self.lines.iter().position(|line| line.select == select);
        known.or_else(|| self.lines.push(Line::new(select)).ok().map(|()| self.lines.len() - 1))
    }

    /// A line falls, perhaps within a byte.
    fn fall(&mut self, rig: &mut (impl Rig + ?Sized), index: usize, is_within: bool, at: u64) {
        let mut line = self.lines[index];
        line.limits = rig.limits(line.select);
        let short = line.short(Wait::Deselected, line.limits.deselected_ns, line.moved, at);
        let others = self.lines.iter().filter(|other| other.is_low);
        let others = others.map(|o| line.fault(SpiRule::TwoSelected { other: o.select }, at));
        short.into_iter().chain(others).for_each(|fault| self.faults.keep(fault));
        rig.select(line.select, instant(at));
        self.lines[index] = Line {
            is_low: true,
            moved: Some(at),
            is_ragged: is_within,
            since: at,
            end: at,
            limits: line.limits,
            ..Line::new(line.select)
        };
    }

    /// A line rises, perhaps within a byte.
    fn rise(&mut self, rig: &mut (impl Rig + ?Sized), index: usize, is_within: bool, at: u64) {
        let line = &mut self.lines[index];
        if !is_within {
            let least = line.limits.clock_to_deselect_ns;
            let short = line.short(Wait::ClockToDeselect, least, line.edge, at);
            if let Some(fault) = short {
                self.faults.keep(fault);
            }
        }
        let is_whole = !(is_within || line.is_ragged);
        line.is_low = false;
        line.hears = false;
        line.moved = Some(at);
        rig.deselect(line.select, instant(at), instant(line.since), is_whole);
    }

    /// Has the chips hear the byte on the bus, unless they have.
    fn hear(&mut self, rig: &mut (impl Rig + ?Sized)) {
        let Some(byte) = self.byte.as_mut().filter(|byte| byte.reply.is_none()) else { return };
        let mut miso = PULLED_UP;
        for line in self.lines.iter_mut().filter(|line| line.hears) {
            line.hears = false;
            miso &= line.exchange(rig, byte);
        }
        byte.reply = Some(miso);
    }
}
