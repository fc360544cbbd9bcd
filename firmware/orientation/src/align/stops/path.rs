//! All that is kept of a vehicle's way from its first stop to now.

use super::Setting;
use super::block::{AT_REST, Blocks, DRIVEN};
use super::place::Place;
use super::stop::Stop;
use crate::math::rotation::{Vector, difference, dot, transposed};
use crate::signal::strapdown::Carried;

/// Least power of the accelerometers' noise that is believed, (m/s²)²·s: 1 µg/√Hz.
const LEAST_DENSITY: f64 = 1e-10;
/// Power of white forces that blurs a slope over some seconds as much as the velocities at both ends do, over their
/// variance and times those seconds: 12 of the slope's, 2 · 36 of the velocities'.
const OF_ENDS: f64 = 6.0;

/// A vehicle's way.
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    /// The place of the first stop.
    pub place: Place,
    /// Gravity there, m/s².
    pub gravity: f64,
    /// When the start frame was frozen, s.
    pub start: f64,
    /// The stops.
    pub stops: &'a [Stop],
    /// Means over the time at rest.
    pub blocks: &'a Blocks<AT_REST>,
    /// Means over the drives.
    pub drives: &'a Blocks<DRIVEN>,
    /// When the last sample ended, s.
    pub now: f64,
    /// What was carried then.
    pub carried: Carried,
    /// Power of the accelerometers' noise as it is stated, (m/s²)²·s.
    pub stated_density: f64,
}

impl Path<'_> {
    /// Where a stop is, north and east of the first, m; zero where nobody told.
    #[must_use]
    pub fn displaced(&self, stop: usize) -> [f64; 2] {
        self.stops.get(stop).and_then(|stop| stop.displacement).unwrap_or_default()
    }

    /// 1σ of where the last stop is, m; with one stop there is nothing to know.
    #[must_use]
    pub fn displacement_sigma(&self, setting: &Setting) -> f64 {
        let [Some(first), Some(last)] = [self.stops.first(), self.stops.last()] else { return 0.0 };
        if self.stops.len() < 2 {
            return 0.0;
        }
        let unknown = setting.speed_sigma * (last.from - first.to).max(0.0);
        if last.displacement.is_some() { setting.displacement_sigma } else { unknown }
    }

    /// Where the vehicle is between two stops, taken to drive straight and evenly, m.
    #[must_use]
    pub fn underway(&self, stop: usize, at: f64) -> [f64; 2] {
        let [Some(before), Some(after)] = [self.stops.get(stop), self.stops.get(stop + 1)] else {
            return self.displaced(stop);
        };
        let part = (at - before.to) / (after.from - before.to).max(1.0);
        let [from, to] = [self.displaced(stop), self.displaced(stop + 1)];
        [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])]
    }

    /// How far up at the last stop depends on scale errors of the gyros, by a rotation about this axis.
    #[must_use]
    pub fn turned_about(&self, about: &Vector) -> Vector {
        let [Some(first), Some(last)] = [self.stops.first(), self.stops.last()] else {
            return [0.0; 3];
        };
        let gained: [[f64; 3]; 3] = core::array::from_fn(|row| {
            difference(&last.begin.scale[row].map(f64::from), &first.end.scale[row].map(f64::from))
        });
        transposed(&gained).map(|column| dot(about, &column))
    }

    /// Power of what moves the forces, (m/s²)²·s: the accelerometers' noise, and sway.
    #[must_use]
    pub fn density(&self) -> f64 {
        let stood: f64 = self.stops.iter().map(Stop::seconds).sum();
        let of_ends = OF_ENDS * self.blocks.swing() / stood.max(1.0);
        self.blocks.scatter().max(of_ends).max(self.least_density())
    }

    /// Power of the accelerometers' noise alone, (m/s²)²·s.
    #[must_use]
    pub fn least_density(&self) -> f64 {
        self.stated_density.max(LEAST_DENSITY)
    }
}
