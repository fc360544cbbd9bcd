//! A vehicle's way through its legs, and what happens to it on the way.

use super::leg::{Leg, Neighbours};
use super::{Event, Pose};

/// The legs of a day, and where in them the vehicle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Route<'a> {
    /// What the vehicle does, in order.
    legs: &'a [Leg],
    /// What happens to it, in any order.
    events: &'a [Event],
    /// Number of the current leg, from 0.
    index: usize,
    /// When the current leg began, s from the start.
    since_s: f64,
    /// Heading at the beginning of the current leg, rad.
    heading_rad: f64,
}

impl<'a> Route<'a> {
    /// A route that begins with a heading in rad.
    pub(super) fn new(legs: &'a [Leg], events: &'a [Event], heading_rad: f64) -> Self {
        Self { legs, events, index: 0, since_s: 0.0, heading_rad }
    }

    /// The motion at a time in s; ask in rising order. After the last leg the vehicle stays.
    pub(super) fn pose(&mut self, time_s: f64) -> Pose {
        while let Some(leg) = self.legs.get(self.index)
            && self.index + 1 < self.legs.len()
            && time_s >= self.since_s + leg.seconds()
        {
            self.since_s += leg.seconds();
            self.heading_rad += leg.heading_change_rad();
            self.index += 1;
        }
        let mut pose = self.on_leg(time_s);
        for event in self.events {
            event.add(&mut pose, time_s);
        }
        pose
    }

    /// The motion of the current leg, without events, at a time in s.
    fn on_leg(&self, time_s: f64) -> Pose {
        let leg_at = |index: usize| self.legs.get(index);
        let before = self.index.checked_sub(1).and_then(leg_at);
        let Some(leg) = leg_at(self.index) else { return Pose::facing(self.heading_rad) };
        let neighbours = Neighbours { before, leg, after: leg_at(self.index + 1) };
        neighbours.pose(self.heading_rad, time_s - self.since_s, time_s)
    }
}
