//! Outlet of samples: queued for the session, counted, and reported where they are missing or late.

use drivers::data_ready::Edge;
use embassy_time::Duration;
use orientation::units::Instant;

use crate::event::Event;
use crate::shared::{Channels, Shared};
use crate::timeline::{Arrival, Timeline};

/// Outlet of samples of kind `S`.
pub struct Outlet<'a, S> {
    /// Channels to the session and to the other tasks.
    channels: &'a Channels<'a, S>,
    /// Expected times of the samples.
    timeline: Timeline,
    /// Number of successive samples lost because the queue was full.
    overflowed: u32,
}

impl<'a, S> Outlet<'a, S> {
    /// Outlet of samples with this period, µs, and motions with that one.
    pub(super) fn new(period: u32, motions: u32, channels: &'a Channels<'a, S>) -> Self {
        let Shared { period: samples, motion_period, .. } = &channels.shared;
        samples.set(Duration::from_micros(period.into()));
        motion_period.set(Duration::from_micros(motions.into()));
        Self { channels, timeline: Timeline::new(period), overflowed: 0 }
    }

    /// True time at which a conversion ended.
    pub(super) fn time(&self, end: Edge) -> Instant {
        self.channels.shared.clocks.instant(end.at)
    }

    /// Signals and counters that all parts share.
    pub(super) fn shared(&self) -> &'a Shared<'a> {
        &self.channels.shared
    }

    /// Whether the queue has no room for another sample.
    pub(super) fn is_full(&self) -> bool {
        self.channels.samples.is_full()
    }

    /// Queues a sample for the session, and reports an overflow of the queue. While the aligner computes, it
    /// needs none: they are passed by.
    pub(super) fn hand_over(&mut self, sample: S) {
        let shared = self.shared();
        shared.count(|health| health.samples = health.samples.saturating_add(1));
        if shared.is_computing.get() {
            return shared.pass_by();
        }
        shared.is_behind.set(true);
        if self.channels.samples.try_send(sample).is_err() {
            self.overflowed += 1;
            shared.count(|health| health.overflowed += 1);
        } else if self.overflowed > 0 {
            shared.report(Event::Overflowed(self.overflowed));
            self.overflowed = 0;
        }
    }

    /// Counts and reports samples that are missing before one of a conversion with this end, or that
    /// are late.
    pub(super) fn judge(&mut self, end: Edge) {
        let shared = self.shared();
        match self.timeline.judge(end) {
            Arrival::InTime => {}
            Arrival::Late(microseconds) => {
                shared.count(|health| health.late += 1);
                shared.report(Event::Late(microseconds));
            }
            Arrival::Missing(count) => {
                shared.count(|health| health.missing = health.missing.saturating_add(count));
                shared.report(Event::Missing(count));
            }
        }
    }
}
