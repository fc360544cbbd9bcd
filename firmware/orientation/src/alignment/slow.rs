//! Slow motion of the base, which an alignment cannot distinguish from rest where its data do not
//! show it: how well the data show it, and its effect on the azimuth.

use crate::units::{RadiansPerSecond, Seconds};

/// Observability of a slow motion of the base in the data of an alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlowMotion {
    /// Standard deviation of its rate from the data, 1σ; infinite where they do not show it.
    pub sigma: RadiansPerSecond,
    /// Sensitivity of the azimuth at the end to a neglected rate, s (rad per rad/s). For rotation
    /// about the vertical it is half of the time for which the base turned, plus the effect of the
    /// rate itself through the tilt; for tilting, at most one over the horizontal Earth rate.
    pub lever: Seconds,
}
