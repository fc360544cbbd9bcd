//! Data-ready lines whose edges are stamped and counted in their interrupt, whatever the tasks do meanwhile.
//!
//! A line stays unmasked. [`take`], which the board's handlers call, notes time and count of each edge in a static of
//! the line and wakes the task that waits for it; a task that comes late finds the end of the conversion as it was,
//! and by the count how many ended before.
//!
//! The board gives these interrupts the highest priority of all, so that nothing but a critical section, of some
//! microseconds, comes between an edge and its stamp.

use core::future::poll_fn;
use core::sync::atomic::{AtomicU32, Ordering};
use core::task::Poll;

use drivers::data_ready::{DataReady, Edge};
use drivers::fault::Fault;
use embassy_stm32::Peri;
use embassy_stm32::exti::{ExtiInput, TriggerEdge};
use embassy_stm32::gpio::{ExtiPin, Pin, Pull};
use embassy_stm32::mode::Blocking;
use embassy_stm32::pac::EXTI;
use embassy_stm32::pac::exti::regs::Lines;
use embassy_sync::waitqueue::AtomicWaker;
use embassy_time::Instant;
use orientation::units;

/// Number of lines that are pins.
const LINES: usize = 16;

/// What the interrupts note.
static NOTED: [Noted; LINES] = [const { Noted::new() }; LINES];

/// The edges of a line until now.
struct Noted {
    /// Time of the latest, µs: the lower and the upper half.
    at: [AtomicU32; 2],
    /// Number of edges; it wraps.
    count: AtomicU32,
    /// The task that waits for the next.
    waiting: AtomicWaker,
}

impl Noted {
    /// A line without an edge.
    const fn new() -> Self {
        Self {
            at: [const { AtomicU32::new(0) }; 2],
            count: AtomicU32::new(0),
            waiting: AtomicWaker::new(),
        }
    }

    /// Notes an edge. Only an interrupt of the line does so.
    fn note(&self, now: u64) {
        let [low, high] = &self.at;
        low.store(now as u32, Ordering::Relaxed);
        high.store((now >> 32) as u32, Ordering::Relaxed);
        self.count.store(self.count.load(Ordering::Relaxed).wrapping_add(1), Ordering::Release);
        self.waiting.wake();
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

/// Takes the edges that are pending on the lines of a mask, from line 0 on.
pub fn take(mask: u32) {
    let Lines(pending) = EXTI.pr(0).read();
    let mut pending = pending & mask;
    EXTI.pr(0).write_value(Lines(pending));
    let now = Instant::now().as_micros();
    while let Some(noted) = NOTED.get(pending.trailing_zeros() as usize) {
        noted.note(now);
        pending &= pending - 1;
    }
}

/// A data-ready line, low while there is a conversion that was not read.
pub struct Line {
    pin: ExtiInput<'static, Blocking>,
    noted: &'static Noted,
    /// Count of the latest edge that was returned.
    returned: u32,
}

impl Line {
    /// A line on a pin, with the interrupt of the pin, whose handler calls [`take`]. A pull-up keeps a line that is
    /// broken from having edges.
    pub fn new<P: ExtiPin + Pin>(
        pin: Peri<'static, P>,
        interrupt: Peri<'static, P::ExtiChannel>,
    ) -> Self {
        let noted = &NOTED[usize::from(pin.pin()) % LINES];
        let pin = ExtiInput::new_blocking(pin, interrupt, Pull::Up, TriggerEdge::Falling);
        Self { pin, noted, returned: 0 }
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
            self.noted.waiting.register(context.waker());
            // One that has come meanwhile has woken no task.
            self.unread().map_or(Poll::Pending, Poll::Ready)
        });
        Ok(edge.await)
    }
}
