//! Where samples go out: queued for the session, counted, and told where they are missing or late.

use embassy_time::Instant;

use crate::event::Event;
use crate::ports::Observer;
use crate::shared::{Channels, Queue, Shared};
use crate::timeline::{Arrival, Timeline};

/// The outlet of samples of the kind `S`.
pub(super) struct Outlet<'a, O, S> {
    queue: &'a Queue<S>,
    pub(super) shared: &'a Shared<'a, O>,
    timeline: Timeline,
    /// Samples lost in a row because nobody took them.
    overflowed: u32,
}

impl<'a, O: Observer, S> Outlet<'a, O, S> {
    /// Of samples with a period in µs.
    pub(super) fn new(period: u32, channels: &'a Channels<'a, O, S>) -> Self {
        Self {
            queue: &channels.samples,
            shared: &channels.shared,
            timeline: Timeline::new(period),
            overflowed: 0,
        }
    }

    /// Queues a sample for the session, and tells of it where it cannot.
    pub(super) fn hand_over(&mut self, sample: S) {
        self.shared.count(|health| health.samples = health.samples.saturating_add(1));
        self.shared.keep.is_behind.set(true);
        if self.queue.try_send(sample).is_err() {
            self.overflowed += 1;
            self.shared.count(|health| health.overflowed += 1);
        } else if self.overflowed > 0 {
            self.shared.tell(Event::Overflowed(self.overflowed));
            self.overflowed = 0;
        }
    }

    /// Counts and tells samples that are missing before one of this time, or beside theirs.
    pub(super) fn judge(&mut self, time: Instant) {
        match self.timeline.judge(time) {
            Arrival::InTime => {}
            Arrival::Late(microseconds) => {
                self.shared.count(|health| health.late += 1);
                self.shared.tell(Event::Late(microseconds));
            }
            Arrival::Missing(count) => {
                self.shared.count(|health| health.missing = health.missing.saturating_add(count));
                self.shared.tell(Event::Missing(count));
            }
        }
    }
}
