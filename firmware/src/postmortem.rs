//! What is left of a run that ended by a panic, a fault or the watchdog: a record in RAM that outlasts the reset, told
//! by log and link of the next start.
//!
//! RAM holds anything after a power-on, so a record counts only with its checksum. That of a run is written when it
//! begins, and again when it ends; so where there is one although the supply was too low, RAM has kept its content: it
//! was a brown-out.

use core::fmt;
use core::sync::atomic::{AtomicU32, Ordering};

use orientation::checksum::crc32;
use orientation::words;

use crate::check_ins::{CheckIns, Parts};
use crate::kept_lines::KeptLines;

/// Number of return addresses that are kept.
pub const CALLERS: usize = 6;
/// Words of the place and the message of a panic.
const TEXT: usize = 40;
/// Words of a record: the first one, how it ended, its number, resets, crystal, registers, return addresses, text, checksum.
pub const WORDS: usize = 5 + 8 + CALLERS + TEXT + 1;
/// The first word of a record, with the version of its form and of what else outlasts a reset with it: what another
/// program has left is not taken for that.
const FIRST: u32 = 0x4D52_4403;

/// How a run ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum End {
    /// It did not end by itself.
    #[default]
    None,
    /// By a panic.
    Panic,
    /// By a fault of the core.
    Fault,
    /// By an exception or interrupt that nothing handles.
    Unhandled,
}

impl End {
    /// All ends, in the order of their numbers.
    const ALL: [Self; 4] = [Self::None, Self::Panic, Self::Fault, Self::Unhandled];
}

/// Registers of the core at a fault (ARMv7-M Architecture Reference Manual, B1.5.6, B3.2.15).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Registers {
    /// Address of the instruction.
    pub pc: u32,
    /// Where its function returns to.
    pub lr: u32,
    /// Status of the program; in its lowest nine bits the exception that was handled.
    pub psr: u32,
    /// Stack pointer.
    pub sp: u32,
    /// `CFSR`, the causes.
    pub cfsr: u32,
    /// `HFSR`, the causes of a hard fault.
    pub hfsr: u32,
    /// `MMFAR`, the address that is protected, where `CFSR` says that it is valid.
    pub mmfar: u32,
    /// `BFAR`, the address at which nothing answers, where `CFSR` says that it is valid.
    pub bfar: u32,
}

impl Registers {
    /// Whether registers could not be stacked (`CFSR`, MSTKERR and STKERR): the stack had left its memory.
    #[must_use]
    pub const fn is_stack_overflow(&self) -> bool {
        self.cfsr & (1 << 4 | 1 << 12) != 0
    }
}

/// Place and message of a panic, as far as they fit: 160 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Text([u8; 4 * TEXT]);

impl Default for Text {
    fn default() -> Self {
        Self([0; 4 * TEXT])
    }
}

impl Text {
    /// As it was written; a character that did not fit is left out.
    #[must_use]
    pub fn as_str(&self) -> &str {
        let written = self.0.split(|byte| *byte == 0).next().unwrap_or_default();
        written.utf8_chunks().next().map_or("", |chunk| chunk.valid())
    }
}

impl fmt::Write for Text {
    /// Writes what fits, in one line; it never fails.
    fn write_str(&mut self, words: &str) -> fmt::Result {
        let free = self.0.iter_mut().skip_while(|byte| **byte != 0);
        for (place, byte) in free.zip(words.bytes()) {
            *place = byte.max(b' ');
        }
        Ok(())
    }
}

/// The record of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Record {
    /// How it ended.
    pub end: End,
    /// Resets since the supply came up, before it.
    pub resets: u32,
    /// Whether the crystal did not start.
    pub is_crystal_dead: bool,
    /// Number of an interrupt that nothing handles.
    pub number: u32,
    /// Registers at a fault.
    pub registers: Registers,
    /// What may be return addresses on the stack, from its top; zero where there is none. The first that are none of
    /// core's own panics are where it happened.
    pub callers: [u32; CALLERS],
    /// Place and message of a panic.
    pub text: Text,
}

impl Record {
    /// Stored form; the last word is the CRC-32 of the others.
    #[must_use]
    pub fn to_words(&self) -> [u32; WORDS] {
        let Registers { pc, lr, psr, sp, cfsr, hfsr, mmfar, bfar } = self.registers;
        let (end, crystal) = (self.end as u32, self.is_crystal_dead.into());
        let Self { number, resets, .. } = *self;
        let head = [FIRST, end, number, resets, crystal, pc, lr, psr, sp, cfsr, hfsr, mmfar, bfar];
        let (text, _) = self.text.0.as_chunks();
        let text = text.iter().map(|bytes| u32::from_le_bytes(*bytes));
        let mut words = [0; WORDS];
        let all = head.into_iter().chain(self.callers).chain(text);
        words.iter_mut().zip(all).for_each(|(place, word)| *place = word);
        words[WORDS - 1] = checksum(&words);
        words
    }

    /// Of [`Self::to_words`]; [`None`] of anything else.
    #[must_use]
    pub fn from_words(words: &[u32; WORDS]) -> Option<Self> {
        let [first, end, number, resets, crystal, rest @ ..] = *words;
        let [pc, lr, psr, sp, cfsr, hfsr, mmfar, bfar, rest @ .., last] = rest;
        (first == FIRST && last == checksum(words)).then_some(())?;
        let (callers, kept) = rest.split_first_chunk()?;
        let mut text = Text::default();
        let bytes = kept.iter().flat_map(|word| word.to_le_bytes());
        text.0.iter_mut().zip(bytes).for_each(|(place, byte)| *place = byte);
        Some(Self {
            end: *End::ALL.get(end as usize)?,
            resets,
            is_crystal_dead: crystal != 0,
            number,
            registers: Registers { pc, lr, psr, sp, cfsr, hfsr, mmfar, bfar },
            callers: *callers,
            text,
        })
    }
}

/// The CRC-32 of all words but the last one.
fn checksum(words: &[u32; WORDS]) -> u32 {
    crc32(words[..WORDS - 1].iter().copied())
}

/// Memory that outlasts a reset. Any bits that it may hold are valid.
#[derive(Debug)]
pub struct Outlasting {
    /// The record of this run.
    record: [AtomicU32; WORDS],
    /// Seconds since this run began.
    seconds: AtomicU32,
    /// Which parts go on.
    pub check_ins: CheckIns,
    /// Lines of the log that are to be kept.
    pub lines: KeptLines,
}

impl Default for Outlasting {
    fn default() -> Self {
        Self::new()
    }
}

impl Outlasting {
    /// Memory without a record.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            record: [const { AtomicU32::new(0) }; WORDS],
            seconds: AtomicU32::new(0),
            check_ins: CheckIns::new(),
            lines: KeptLines::new(),
        }
    }

    /// Begins the record of a run; returns what is left of the one before it.
    pub fn begin(&self) -> Option<Last> {
        let last = self.record().map(|record| Last {
            record,
            seconds: self.seconds.load(Ordering::Relaxed),
            running: self.check_ins.running(),
            missing: self.check_ins.missing(),
            lost: self.check_ins.lost(),
        });
        if last.is_none() {
            self.lines.clear();
        }
        self.check_ins.clear();
        self.seconds.store(0, Ordering::Relaxed);
        self.note(&last.map_or_else(Record::default, |last| Record {
            resets: last.record.resets.saturating_add(1),
            is_crystal_dead: last.record.is_crystal_dead,
            ..Record::default()
        }));
        last
    }

    /// The record of this run, where it is whole.
    #[must_use]
    pub fn record(&self) -> Option<Record> {
        Record::from_words(&self.record.each_ref().map(|word| word.load(Ordering::Relaxed)))
    }

    /// Writes the record of this run.
    pub fn note(&self, record: &Record) {
        for (place, word) in self.record.iter().zip(record.to_words()) {
            place.store(word, Ordering::Relaxed);
        }
    }

    /// Counts a second of this run.
    pub fn pass_second(&self) {
        self.seconds.store(self.seconds.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
        self.lines.pass_second();
    }
}

/// What is left of the run before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Last {
    /// Its record.
    pub record: Record,
    /// How long it ran, s.
    pub seconds: u32,
    /// The part that was being polled.
    pub running: Parts,
    /// Parts that had not checked in.
    pub missing: Parts,
    /// Those of them that were looked for again and again, and in vain.
    pub lost: Parts,
}

/// The lines that tell how the last run ended.
#[derive(Clone, Copy, Debug)]
pub enum Line<'a> {
    /// How, and in which part.
    End(How, &'a Last),
    /// Place and message of a panic.
    Text(&'a str),
    /// Where a fault was.
    Place(&'a Registers),
    /// What caused a fault.
    Cause(&'a Registers),
    /// Return addresses.
    Callers(&'a [u32; CALLERS]),
}

/// How a run ended, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// By a panic.
    Panic,
    /// By a fault of the core.
    Fault,
    /// By a stack that left its memory.
    StackOverflow,
    /// By an interrupt with this number that nothing handles.
    Unhandled(u32),
    /// By the watchdog.
    Stuck,
    /// By a supply that was too low for a moment.
    BrownOut,
}

impl Last {
    /// How it ended, for a start by the watchdog, by a supply that was too low, or by neither; [`None`] where it ended on
    /// purpose.
    #[must_use]
    pub fn how(&self, by_watchdog: bool, by_supply: bool) -> Option<How> {
        Some(match self.record.end {
            End::Panic => How::Panic,
            End::Fault if self.record.registers.is_stack_overflow() => How::StackOverflow,
            End::Fault => How::Fault,
            End::Unhandled => How::Unhandled(self.record.number),
            End::None if by_watchdog => How::Stuck,
            End::None if by_supply => How::BrownOut,
            End::None => return None,
        })
    }

    /// The part in which it ended: the one that was being polled, or else one that was looked for in vain. Where none was,
    /// who looks for them did not go on: a task of the thread that never returns, and is no part.
    #[must_use]
    pub fn part(&self, how: How) -> &'static str {
        let outside = if how == How::Stuck { "the thread, outside of any part" } else { "no part" };
        self.running.first().or(self.lost.first()).unwrap_or(outside)
    }

    /// The lines of the log that tell how it ended.
    #[must_use]
    pub fn lines(&self, how: How) -> [Option<Line<'_>>; 5] {
        let Record { registers, callers, text, .. } = &self.record;
        let text = text.as_str();
        [
            Some(Line::End(how, self)),
            (!text.is_empty()).then_some(Line::Text(text)),
            (registers.pc != 0).then_some(Line::Place(registers)),
            (registers.hfsr != 0).then_some(Line::Cause(registers)),
            (callers[0] != 0).then_some(Line::Callers(callers)),
        ]
    }
}

impl How {
    /// It in brief, as the link tells it.
    #[must_use]
    pub const fn brief(self) -> &'static str {
        match self {
            Self::Panic => "panic",
            Self::Fault => "fault of the core",
            Self::StackOverflow => "stack overflow",
            Self::Unhandled(_) => "unhandled interrupt",
            Self::Stuck => "stuck task",
            Self::BrownOut => "brown-out",
        }
    }
}

words! { How:
    Self::Unhandled(number) => "unhandled interrupt {}", number;
    how => "{}", how.brief();
}

words! { Line<'_>:
    Self::End(how, last) =>
        "last reset: {} in {} after {} s, {} resets before; running: {}; missing: {}",
        how, last.part(how), last.seconds, last.record.resets, last.running, last.missing;
    Self::Text(text) => "panicked at {}", text;
    Self::Place(registers) =>
        "PC {:#010x}, LR {:#010x}, PSR {:#010x}, SP {:#010x}",
        registers.pc, registers.lr, registers.psr, registers.sp;
    Self::Cause(registers) =>
        "CFSR {:#010x}, HFSR {:#010x}, MMFAR {:#010x}, BFAR {:#010x}",
        registers.cfsr, registers.hfsr, registers.mmfar, registers.bfar;
    Self::Callers([a, b, c, d, e, f]) =>
        "called from {:#010x} {:#010x} {:#010x} {:#010x} {:#010x} {:#010x}", a, b, c, d, e, f;
}
