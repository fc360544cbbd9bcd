//! The base drives off, with everything on it: the motion of a vehicle under a stage or a mount.
//!
//! Until it departs the base stands, or sways, as it always did. From then on gyros and accelerometers on it
//! feel what a vehicle feels: turns, slopes, accelerations, the Earth's rotation and its own.

use crate::earth::InertialInput;
use crate::instruments::InstrumentsConfiguration;
use crate::sensor_fault::SensorFault;
use crate::vehicle::averaged::Averaged;
use crate::vehicle::motion::Motion;
use crate::vehicle::{Event, Leg};

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
    /// What goes wrong with coarse sensors on the base, in order; gaps are not looked at.
    pub faults: &'a [SensorFault],
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
    /// A base that is at the place of these instruments, and faces as they do, as it departs.
    pub(crate) fn new(
        configuration: &JourneyConfiguration<'a>,
        instruments: &InstrumentsConfiguration,
    ) -> Self {
        let InstrumentsConfiguration { latitude_deg, azimuth_deg, .. } = *instruments;
        let [latitude_rad, azimuth_rad] = [latitude_deg, azimuth_deg].map(f64::to_radians);
        let JourneyConfiguration { departs_s, legs, events, .. } = *configuration;
        let motion = Motion::new(legs, events, latitude_rad, azimuth_rad, [0.0; 3]);
        Self { departs_s, motion: Averaged::new(motion) }
    }

    /// Means over the sample of a chip, the first or the second, that ends at a time in s; none before it
    /// departs.
    pub(crate) fn felt(
        &mut self,
        chip: usize,
        time_s: f64,
        period_s: f64,
    ) -> Option<InertialInput> {
        (time_s >= self.departs_s).then(|| self.motion.felt(chip, time_s, period_s))
    }
}
