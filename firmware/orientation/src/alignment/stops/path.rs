//! Path of a vehicle from its first stop until now: all data that are kept of it.

use super::Setting;
use super::block::{AT_REST, Blocks, DRIVEN};
use super::place::Place;
use super::stop::Stop;
use crate::math::rotation::{Matrix, Vector, difference, dot, transposed};
use crate::signal::strapdown::{Carried, Rough};

/// Least noise power of the accelerometers that is assumed, (m/s²)²·s: 1 µg/√Hz.
const LEAST_DENSITY: f64 = 1e-10;
/// Time after a stop that may still belong to it, s: the delay of the stop criteria.
const REMAINDER: f64 = 4.0;
/// Ratio of the white force noise that blurs a slope over some seconds as much as the velocities at
/// both ends do, to the velocities' variance times those seconds: 12 for a slope, 2 · 36 for the
/// velocities.
const OF_ENDS: f64 = 6.0;

/// Averages of a vehicle's path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path<'a> {
    /// Place of the first stop.
    pub place: Place,
    /// Gravity at the first stop, m/s².
    pub gravity: f64,
    /// Time at which the start frame was frozen, s.
    pub start: f64,
    /// Stops in the order of time.
    pub stops: &'a [Stop],
    /// Averages over the time at rest.
    pub blocks: &'a Blocks<AT_REST>,
    /// Averages over the drives.
    pub drives: &'a Blocks<DRIVEN>,
    /// End of the last sample, s.
    pub now: f64,
    /// Attitude and sensitivities at that time.
    pub carried: Carried,
    /// Configured noise power of the accelerometers, (m/s²)²·s.
    pub stated_density: f64,
}

impl Path<'_> {
    /// Position of a stop, north and east of the first, m; zero where it was not reported.
    pub(crate) fn displaced(&self, stop: usize) -> [f64; 2] {
        let displacement = self.stops.get(stop).and_then(|stop| stop.displacement);
        let [north, east] = displacement.unwrap_or_default();
        [north.0, east.0]
    }

    /// Standard deviation of the last stop's position, 1σ, m; zero with a single stop.
    pub(crate) fn displacement_sigma(&self, setting: &Setting) -> f64 {
        let [Some(first), Some(last)] = [self.stops.first(), self.stops.last()] else { return 0.0 };
        if self.stops.len() < 2 {
            return 0.0;
        }
        let unknown = setting.speed_sigma.0 * (last.from.0 - first.to.0).max(0.0);
        if last.displacement.is_some() { setting.displacement_sigma.0 } else { unknown }
    }

    /// Standard deviation of the distance that was driven since the last stop, 1σ, m; it is not known.
    pub(crate) fn left_sigma(&self, setting: &Setting) -> f64 {
        let driven = self.stops.last().map_or(0.0, |stop| self.now - stop.to.0 - REMAINDER);
        setting.speed_sigma.0 * driven.max(0.0)
    }

    /// Position between two stops, m, for a straight drive at constant speed.
    pub(crate) fn underway(&self, stop: usize, at: f64) -> [f64; 2] {
        let [Some(before), Some(after)] = [self.stops.get(stop), self.stops.get(stop + 1)] else {
            return self.displaced(stop);
        };
        let part = (at - before.to.0) / (after.from.0 - before.to.0).max(1.0);
        let [from, to] = [self.displaced(stop), self.displaced(stop + 1)];
        [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])]
    }

    /// Sensitivity of the up vector at the last stop to scale errors of the gyros, for rotation
    /// about this axis.
    pub(crate) fn turned_about(&self, about: &Vector) -> Vector {
        let [Some(first), Some(last)] = [self.stops.first(), self.stops.last()] else {
            return [0.0; 3];
        };
        let gained = gained(&last.begin.scale, &first.end.scale);
        transposed(&gained).map(|column| dot(about, &column))
    }

    /// Power of the force noise, (m/s²)²·s: the accelerometers' noise, and sway.
    pub(crate) fn density(&self) -> f64 {
        let stood: f64 = self.stops.iter().map(|stop| stop.seconds().0).sum();
        let of_ends = OF_ENDS * self.blocks.swing / stood.max(1.0);
        self.blocks.scatter().max(of_ends).max(self.least_density())
    }

    /// Power of the accelerometers' noise alone, (m/s²)²·s.
    pub(crate) fn least_density(&self) -> f64 {
        self.stated_density.max(LEAST_DENSITY)
    }
}

/// Change of a sensitivity, in double precision.
pub(super) fn gained(now: &Rough, before: &Rough) -> Matrix {
    core::array::from_fn(|row| difference(&now[row].map(f64::from), &before[row].map(f64::from)))
}
