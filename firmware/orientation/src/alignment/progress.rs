//! Progress of an alignment as it is reported, with the sentences of the log.

use super::refusal::Refusal;
use super::rotating::progress as rotating;
use super::stepwise::progress as stepwise;
use super::stops::progress as stops;
use super::verdict::Solution;
use crate::roll::progress as roll;
use crate::units::{MetresPerSecondSquared, Radians};
use crate::words::Rounded;

/// Receiver of an alignment's progress.
pub type Listener<'a> = &'a mut dyn FnMut(Progress);

/// Progress of an alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The platform is level enough: inclination along and across the gyro's sensitive axis.
    Levelled([Radians; 2]),
    /// Progress of a multi-position alignment.
    Stepwise(stepwise::Progress),
    /// Progress of an alignment by continuous rotation.
    Rotating(rotating::Progress),
    /// Progress of an inertial-frame alignment from stop to stop.
    Stops(stops::Progress),
    /// Progress of the tracking of a roll.
    Roll(roll::Progress),
    /// The alignment is over, with an azimuth.
    Concluded(Solution),
    /// The alignment is over without an azimuth.
    Refused(Refusal),
}

crate::words! { Progress:
    Self::Levelled([along, across]) =>
        "level: platform inclined by {}° along and {}° across the gyro's axis",
        Rounded::<3>(along.degrees()), Rounded::<3>(across.degrees());
    Self::Stepwise(progress) => "{}", progress;
    Self::Rotating(progress) => "{}", progress;
    Self::Stops(progress) => "{}", progress;
    Self::Roll(progress) => "{}", progress;
    Self::Concluded(Solution { azimuth, limit }) =>
        "azimuth {}° ± {}° (1σ), limit {}°",
        Rounded::<4>(azimuth.angle.degrees()), Rounded::<4>(azimuth.sigma.degrees()),
        Rounded::<4>(limit.degrees());
    Self::Refused(reason) => "no azimuth: {}", reason;
}

impl Progress {
    /// The platform's inclination by its mean specific force at rest.
    pub(crate) fn levelled([along, across, down]: [MetresPerSecondSquared; 3]) -> Self {
        Self::Levelled([along, across].map(|force| Radians(libm::atan2(force.0, -down.0))))
    }
}

impl From<roll::Progress> for Progress {
    fn from(progress: roll::Progress) -> Self {
        Self::Roll(progress)
    }
}
