//! Policy of the navigator: how long an azimuth is held, and when it is renewed.

use crate::attitude::Gyro;
use crate::units::Seconds;

/// The policy that renews a held azimuth, whose σ grows with time (heading hold).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Realignment {
    /// The azimuth is not renewed by the instrument; only one from outside renews it.
    Never,
    /// A new alignment begins at every stop that lasts for this time.
    AtStops(Seconds),
    /// A new alignment begins at the stop that ended the one before, as from stop to stop in a
    /// vehicle.
    BetweenStops,
}

/// Operation after, and beside, the alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Policy {
    /// Duration for which the azimuth is held after the first alignment; infinite for ever, zero
    /// for not at all.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::units::or_infinite"))]
    pub hold_seconds: Seconds,
    /// The policy at stops.
    pub realignment: Realignment,
    /// Whether the method itself distinguishes rest from motion, as inertial-frame alignment from
    /// stop to stop does. Any other alignment is ended if the vehicle sets off before it concludes.
    pub knows_stops: bool,
    /// Whether an alignment is skipped where the azimuth is known already, from outside or from
    /// before a restart; otherwise both are compared.
    pub skips_known: bool,
    /// Stated errors of the gyro about the down axis that is read beside the two others.
    pub beside: Gyro,
    /// Stated errors of the precise gyro, which measures about the down axis once a mount has
    /// turned it to the vertical.
    pub precise: Gyro,
}

impl Policy {
    /// Whether an azimuth is held at all.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.hold_seconds.0 > 0.0
    }
}
