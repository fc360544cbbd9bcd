//! Data-ready lines whose edges are stamped and counted in their interrupt, whatever the tasks do meanwhile.
//!
//! A line stays unmasked. [`take`] or [`take_pending`], which the board's handlers call, notes time and count of each edge in a static of
//! the line and wakes the task that waits for it; a task that comes late finds the end of the conversion as it was,
//! and by the count how many ended before.
//!
//! The board gives these interrupts the highest priority of all, which its critical sections do not hold back: so nothing
//! comes between an edge and its stamp, and the handlers touch nothing but words that are atomic. To wake a task takes
//! more: that is left to the interrupt of the [`NOTIFIER`], which [`notify`] serves.

use core::future::poll_fn;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use core::task::{Poll, Waker};

use cortex_m::peripheral::NVIC;
use drivers::data_ready::{DataReady, Edge};
use drivers::fault::Fault;
use embassy_stm32::Peri;
use embassy_stm32::exti::{ExtiInput, TriggerEdge};
use embassy_stm32::gpio::{ExtiPin, Pin, Pull};
use embassy_stm32::interrupt::Interrupt;
use embassy_stm32::mode::Blocking;
use embassy_stm32::pac::EXTI;
use embassy_stm32::pac::exti::regs::Lines;
use embassy_sync::waitqueue::AtomicWaker;
use embassy_time::Instant;
use firmware::platform::Platform;
use orientation::units;

use crate::{PLATFORM, chain};

/// Number of lines that are pins.
const LINES: usize = 16;

/// The interrupt that wakes the tasks which wait for edges. Its peripheral, a timer, is not used.
pub const NOTIFIER: Interrupt = Interrupt::LPTIM2;
/// The chain among what waits for the notifier, beside the lines.
pub(crate) const CHAIN: u32 = 1 << LINES;
/// What waits for the notifier: lines, as bits, and the chain.
static DUE: AtomicU32 = AtomicU32::new(0);

/// What the interrupts note.
static NOTED: [Noted; LINES] = [const { Noted::new() }; LINES];

/// The edges of a line until now.
struct Noted {
    /// Time of the latest, µs: the lower and the upper half.
    at: [AtomicU32; 2],
    /// Number of edges; it wraps.
    count: AtomicU32,
    /// Whether a task waits for the next, and which.
    is_awaited: AtomicBool,
    waiting: AtomicWaker,
}

impl Noted {
    /// A line without an edge.
    const fn new() -> Self {
        Self {
            at: [const { AtomicU32::new(0) }; 2],
            count: AtomicU32::new(0),
            is_awaited: AtomicBool::new(false),
            waiting: AtomicWaker::new(),
        }
    }

    /// Notes an edge. Only an interrupt of the line does so.
    fn note(&self, now: u64) {
        let [low, high] = &self.at;
        low.store(now as u32, Ordering::Relaxed);
        high.store((now >> 32) as u32, Ordering::Relaxed);
        self.count.store(self.count.load(Ordering::Relaxed).wrapping_add(1), Ordering::Release);
    }

    /// Whether a task waits for an edge, which is then to be woken.
    #[inline]
    fn takes_waiting(&self) -> bool {
        let is_awaited = self.is_awaited.load(Ordering::Relaxed);
        if is_awaited {
            self.is_awaited.store(false, Ordering::Relaxed);
        }
        is_awaited
    }

    /// The latest edge, for an interrupt of the same priority.
    #[inline]
    fn words(&self) -> [u32; 3] {
        let [low, high] = &self.at;
        [low, high, &self.count].map(|word| word.load(Ordering::Relaxed))
    }

    /// Has the next edge wake a task. One that has come meanwhile has woken none.
    fn await_next(&self, task: &Waker) {
        self.waiting.register(task);
        self.is_awaited.store(true, Ordering::Release);
    }

    /// The latest edge. Where another one comes in between, it is read again.
    #[inline(never)]
    fn latest(&self) -> Edge {
        loop {
            let count = self.count.load(Ordering::Acquire);
            let [low, high] = self.at.each_ref().map(|half| half.load(Ordering::Acquire));
            if self.count.load(Ordering::Acquire) == count {
                let at = units::Instant(u64::from(high) << 32 | u64::from(low));
                return Edge { at, count };
            }
        }
    }
}

/// The latest edge of a line, for an interrupt of the same priority: the lower and the upper half of its time, µs, and its
/// count.
#[inline]
pub(crate) fn words(line: usize) -> [u32; 3] {
    NOTED[line % LINES].words()
}

/// Has the notifier wake what waits for lines, as bits, or for the chain.
pub(crate) fn wake(waiting: u32) {
    DUE.fetch_or(waiting, Ordering::Release);
    NVIC::pend(NOTIFIER);
}

/// Wakes the tasks that are due; called from the interrupt of the notifier.
pub fn notify() {
    let mut due = DUE.swap(0, Ordering::Acquire);
    if PLATFORM == Platform::Spin && due & CHAIN != 0 {
        chain::wake();
    }
    due &= !CHAIN;
    while due != 0 {
        NOTED[due.trailing_zeros() as usize % LINES].waiting.wake();
        due &= due - 1;
    }
}

/// Takes the edge of a line whose interrupt is its own.
#[inline]
pub fn take(line: usize) {
    EXTI.pr(0).write_value(Lines(1 << line));
    NOTED[line].note(Instant::now().as_micros());
    if NOTED[line].takes_waiting() {
        wake(1 << line);
    }
    if PLATFORM == Platform::Spin {
        chain::noted(1 << line);
    }
}

/// Takes the edges that are pending on lines that share an interrupt, as bits from line 0 on.
pub fn take_pending(lines: u32) {
    let Lines(pending) = EXTI.pr(0).read();
    let mut pending = pending & lines;
    while pending != 0 {
        take(pending.trailing_zeros() as usize % LINES);
        pending &= pending - 1;
    }
}

/// A data-ready line, low while there is a conversion that was not read.
pub struct Line {
    pin: ExtiInput<'static, Blocking>,
    /// Its number.
    number: u8,
    noted: &'static Noted,
    /// Count of the latest edge that was returned.
    returned: u32,
}

impl Line {
    /// A line on a pin, with the interrupt of the pin, whose handler calls [`take`] or [`take_pending`]. A pull-up keeps a line that is
    /// broken from having edges.
    pub fn new<P: ExtiPin + Pin>(
        pin: Peri<'static, P>,
        interrupt: Peri<'static, P::ExtiChannel>,
    ) -> Self {
        let number = pin.pin();
        let noted = &NOTED[usize::from(number) % LINES];
        let pin = ExtiInput::new_blocking(pin, interrupt, Pull::Up, TriggerEdge::Falling);
        Self { pin, number, noted, returned: 0 }
    }

    /// Its number, which is that of its pin in its port.
    pub(crate) const fn number(&self) -> u8 {
        self.number
    }

    /// The latest edge, where it has not been returned before and its conversion was not read meanwhile, which lifts
    /// the line.
    #[inline]
    fn unread(&mut self) -> Option<Edge> {
        if self.noted.count.load(Ordering::Acquire) == self.returned {
            return None;
        }
        let edge = self.noted.latest();
        self.returned = edge.count;
        Some(edge).filter(|_| self.pin.is_low())
    }
}

impl DataReady for Line {
    async fn edge(&mut self) -> Result<Edge, Fault> {
        let edge = poll_fn(|context| {
            if let Some(edge) = self.unread() {
                return Poll::Ready(edge);
            }
            self.noted.await_next(context.waker());
            self.unread().map_or(Poll::Pending, Poll::Ready)
        });
        Ok(edge.await)
    }
}
