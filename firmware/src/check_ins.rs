//! Which parts of the instrument go on: each checks in whenever it has been polled, and the watchdog is fed only while
//! all have. An executor that is kept from its tasks, and a part that never returns, are thus found, and the part has a
//! name. A part that waits is polled with the others of its task: that what it waits for comes is each part's own to
//! watch, by a time limit.
//!
//! A part belongs to those that are expected from its first poll on, until it ends. The parts of a task must be polled
//! at least once in the time of the watchdog: where nothing else wakes them, a timer does.

use core::pin::Pin;
use core::sync::atomic::{AtomicU32, Ordering};
use core::task::{Context, Poll};

use orientation::words;

/// A part of the instrument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Acquisition of samples.
    Acquisition,
    /// The aligner with its method.
    Aligner,
    /// The motors of the mechanism.
    Mechanism,
    /// The serial link.
    Link,
    /// The navigator, which keeps the attitude.
    Keeper,
    /// The store of the heading.
    Store,
    /// The writer of the log's lines that are kept.
    Log,
}

words! { Part:
    part => "{}", part.name();
}

impl Part {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Acquisition => "acquisition",
            Self::Aligner => "aligner",
            Self::Mechanism => "mechanism",
            Self::Link => "link",
            Self::Keeper => "keeper",
            Self::Store => "store",
            Self::Log => "log",
        }
    }

    /// All parts, in the order of their numbers.
    const ALL: [Self; 7] = [
        Self::Acquisition,
        Self::Aligner,
        Self::Mechanism,
        Self::Link,
        Self::Keeper,
        Self::Store,
        Self::Log,
    ];

    /// The set of this part alone.
    const fn bit(self) -> u32 {
        1 << self as u32
    }

    /// The part with a number from zero; [`None`] beyond the last.
    fn of(number: u32) -> Option<Self> {
        Self::ALL.get(number as usize).copied()
    }
}

/// A set of parts, a bit for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Parts(u32);

words! { Parts:
    Self(0) => "none";
    Self(bits) if bits.is_power_of_two() => "{}", first(bits);
    Self(bits) => "{}, {}", first(bits), Self(bits & (bits - 1));
}

/// The part of the lowest bit of a set that is not empty.
fn first(bits: u32) -> Part {
    Part::of(bits.trailing_zeros()).unwrap_or(Part::Acquisition)
}

impl Parts {
    /// The parts of these bits; others are left out.
    fn of(bits: u32) -> Self {
        Self(bits & ((1 << Part::ALL.len()) - 1))
    }

    /// Name of the first one.
    #[must_use]
    pub fn first(self) -> Option<&'static str> {
        (!self.is_empty()).then(|| first(self.0).name())
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }
}

/// No part is polled.
const NO_PART: u32 = u32::MAX;

/// Who is expected, who has checked in, and who is being polled. Any bits that memory may hold are valid, so that it can
/// outlast a reset.
#[derive(Debug)]
pub struct CheckIns {
    /// Bits of the parts that are expected.
    expected: AtomicU32,
    /// Bits of those that have checked in.
    present: AtomicU32,
    /// Number of the part that is being polled.
    running: AtomicU32,
    /// How often in a row a part was looked for in vain.
    vain: AtomicU32,
}

impl Default for CheckIns {
    fn default() -> Self {
        Self::new()
    }
}

impl CheckIns {
    /// No part is expected.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            expected: AtomicU32::new(0),
            present: AtomicU32::new(0),
            running: AtomicU32::new(NO_PART),
            vain: AtomicU32::new(0),
        }
    }

    /// Forgets everything.
    pub fn clear(&self) {
        self.expected.store(0, Ordering::Relaxed);
        self.present.store(0, Ordering::Relaxed);
        self.running.store(NO_PART, Ordering::Relaxed);
        self.vain.store(0, Ordering::Relaxed);
    }

    /// The part that is being polled. Of two priorities it is the one that has interrupted the other.
    #[must_use]
    pub fn running(&self) -> Parts {
        Part::of(self.running.load(Ordering::Relaxed)).map_or(Parts(0), |part| Parts(part.bit()))
    }

    /// The parts that are expected and have not checked in.
    #[must_use]
    pub fn missing(&self) -> Parts {
        let [expected, present] =
            [&self.expected, &self.present].map(|bits| bits.load(Ordering::Relaxed));
        Parts::of(expected & !present)
    }

    /// Whether all parts have checked in; if so, they are to do it again.
    #[must_use]
    pub fn renew(&self) -> bool {
        let are_all = self.missing().is_empty();
        let vain = self.vain.load(Ordering::Relaxed);
        self.vain.store(if are_all { 0 } else { vain.saturating_add(1) }, Ordering::Relaxed);
        if are_all {
            self.present.store(0, Ordering::Relaxed);
        }
        are_all
    }

    /// The parts that were looked for in vain, twice in a row or more often; none where who looks for them was stuck itself.
    #[must_use]
    pub fn lost(&self) -> Parts {
        if self.vain.load(Ordering::Relaxed) > 1 { self.missing() } else { Parts(0) }
    }

    /// A part begins to be polled; returns the number of the one that it interrupts.
    fn enter(&self, part: Part) -> u32 {
        add(&self.expected, part);
        let before = self.running.load(Ordering::Relaxed);
        self.running.store(part as u32, Ordering::Relaxed);
        before
    }

    /// A part has been polled.
    fn leave(&self, part: Part, before: u32) {
        add(&self.present, part);
        self.running.store(before, Ordering::Relaxed);
    }

    /// A part has ended.
    fn sign_off(&self, part: Part) {
        self.expected.fetch_and(!part.bit(), Ordering::Relaxed);
    }
}

/// Adds a part to a set. It is nearly always there, and a load costs less than an exchange.
fn add(set: &AtomicU32, part: Part) {
    if set.load(Ordering::Relaxed) & part.bit() == 0 {
        set.fetch_or(part.bit(), Ordering::Relaxed);
    }
}

/// The future of a part, which checks in with every poll, where there is a watchdog, and is no longer expected once
/// it is dropped.
#[derive(Debug)]
pub struct Checked<'a, F> {
    check_ins: Option<&'a CheckIns>,
    part: Part,
    future: F,
}

impl<'a, F: Future + Unpin> Checked<'a, F> {
    /// A part that checks in here.
    pub const fn new(check_ins: Option<&'a CheckIns>, part: Part, future: F) -> Self {
        Self { check_ins, part, future }
    }
}

impl<F: Future + Unpin> Future for Checked<'_, F> {
    type Output = F::Output;

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<F::Output> {
        let Some(check_ins) = self.check_ins else {
            return Pin::new(&mut self.future).poll(context);
        };
        let before = check_ins.enter(self.part);
        let polled = Pin::new(&mut self.future).poll(context);
        check_ins.leave(self.part, before);
        polled
    }
}

impl<F> Drop for Checked<'_, F> {
    fn drop(&mut self) {
        if let Some(check_ins) = self.check_ins {
            check_ins.sign_off(self.part);
        }
    }
}
