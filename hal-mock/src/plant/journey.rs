//! The base drives off, with everything on it: the motion of a vehicle under a stage or a mount.
//!
//! Until it departs the base stands, or sways, as it always did. From then on gyros and accelerometers on it
//! feel what a vehicle feels: turns, slopes, accelerations, the Earth's rotation and its own.

use crate::vehicle::averaged::Averaged;
use crate::vehicle::motion::Motion;
use crate::vehicle::{Event, Leg};

pub use crate::vehicle::Means;

/// Where the base goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JourneyConfiguration<'a> {
    /// When the sensors begin to feel the motion, s from the start of the clock; the first leg, a stop,
    /// lasts longer.
    pub departs_s: f64,
    /// The stops and drives, in order, from the start of the clock.
    pub legs: &'a [Leg],
    /// What happens to the base on the way, in any order.
    pub events: &'a [Event],
    /// What goes wrong with coarse sensors on the base, in any order.
    pub faults: &'a [BaseFault],
}

/// Something that goes wrong with coarse sensors on the base, for [from, until) in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BaseFault {
    /// The gyros show their full scale.
    Clipped {
        /// Beginning of the overload, s from the start of the clock.
        from_s: f64,
        /// End of the fault, s from the start of the clock.
        until_s: f64,
    },
    /// Every sensor repeats its last value.
    Stuck {
        /// Beginning of the repetition, s from the start of the clock.
        from_s: f64,
        /// End of the fault, s from the start of the clock.
        until_s: f64,
    },
}

/// The base on its way.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Journey<'a> {
    /// From when on the base feels its motion, s from the start of the clock.
    departs_s: f64,
    /// The motion with what the gyro's and the accelerometer's chip have seen of it.
    motion: Averaged<'a, 2>,
}

impl<'a> Journey<'a> {
    /// A base that faces an azimuth, at a latitude, both in rad.
    pub(crate) fn new(
        configuration: &JourneyConfiguration<'a>,
        latitude_rad: f64,
        azimuth_rad: f64,
        lever_m: [f64; 3],
    ) -> Self {
        let JourneyConfiguration { departs_s, legs, events, .. } = *configuration;
        let motion = Motion::new(legs, events, latitude_rad, azimuth_rad, lever_m);
        Self { departs_s, motion: Averaged::new(motion) }
    }

    /// Means over the sample of a chip, the first or the second, that ends at a time in s; none before it
    /// departs.
    pub(crate) fn felt(&mut self, chip: usize, time_s: f64, period_s: f64) -> Option<Means> {
        (time_s >= self.departs_s).then(|| self.motion.felt(chip, time_s, period_s))
    }
}
