//! Virtual time: nothing happens between two events, so the clock jumps from one to the next.
//!
//! A binary wraps one clock as its embassy-time driver and calls [`VirtualClock::advance`] when
//! every future waits. Time then costs nothing, and one seed gives one run.

use core::task::Waker;

use embassy_time::Instant;
use embassy_time_queue_utils::Queue;

/// A clock of microseconds that stands still until it is advanced.
#[derive(Debug)]
pub struct VirtualClock {
    /// Ticks since the start, µs.
    pub now: u64,
    /// What is to be woken, and when.
    queue: Queue,
}

impl VirtualClock {
    /// A clock at zero with nothing to wait for.
    #[must_use]
    pub const fn new() -> Self {
        Self { now: 0, queue: Queue::new() }
    }

    /// Wakes the waker when the clock reaches `at`, in ticks (µs) since the start; at once where it has.
    /// There is room for sixteen wakers (`generic-queue-16`).
    pub fn schedule_wake(&mut self, at: u64, waker: &Waker) {
        if at <= self.now {
            waker.wake_by_ref();
        } else {
            self.queue.schedule_wake(at, waker);
        }
    }

    /// Jumps to the next moment for which a future waits and wakes all that wait for it. Without any it
    /// stands still and returns `false`.
    pub fn advance(&mut self) -> bool {
        let next = self.queue.next_expiration(self.now);
        if next == u64::MAX {
            return false;
        }
        self.now = next;
        self.queue.next_expiration(next);
        true
    }
}

impl Default for VirtualClock {
    fn default() -> Self {
        Self::new()
    }
}

/// Outputs of a chip at a frequency, one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cadence {
    /// From when periods are counted.
    since: Instant,
    /// How many periods after that the next output comes.
    count: u64,
    /// Outputs per second, Hz, > 0.
    hertz: f64,
    /// When that is: it is asked for more often than outputs come.
    next: Instant,
}

impl Cadence {
    /// Outputs whose next one comes so many periods after a moment.
    pub(crate) fn new(since: Instant, count: u64, hertz: f64) -> Self {
        Self { since, count, hertz, next: period(since, count, hertz) }
    }

    /// When the next output comes.
    pub(crate) fn next(&self) -> Instant {
        self.next
    }

    /// Outputs per second, Hz.
    pub(crate) fn hertz(&self) -> f64 {
        self.hertz
    }

    /// The next output has come.
    pub(crate) fn pass(&mut self) {
        *self = Self::new(self.since, self.count + 1, self.hertz);
    }
}

/// The `count`-th period of a frequency in hertz after `start`, to the nearest microsecond; the
/// rounding does not add up.
pub(crate) fn period(start: Instant, count: u64, hertz: f64) -> Instant {
    // Halves go up, as they do in libm's `round`, which takes twice as long; here they are asked for at every event.
    Instant::from_micros(start.as_micros() + (count as f64 * 1e6 / hertz + 0.5) as u64)
}
