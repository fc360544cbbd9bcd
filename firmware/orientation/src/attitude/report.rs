//! Pitch, roll and azimuth as they are reported, with their uncertainties and what limits them.

use super::vertical::Trust;
use crate::alignment::Azimuth;
use crate::units::{Instant, Radians, RadiansPerSecond, Seconds};
use crate::words::Rounded;

/// Reliability of the level, and how long it has been so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Reliability of the level, and the cause that limits it.
    pub trust: Trust,
    /// Duration of that reliability.
    pub seconds: Seconds,
}

crate::words! { State:
    Self { trust: Trust::Starting, .. } => "starting";
    Self { trust: Trust::Level, .. } => "level";
    Self { trust: Trust::Coasting, seconds } => "coasting for {} s: the gyros alone carry the level", Rounded::<1>(seconds.0);
    Self { trust: Trust::FreeFall, seconds } => "falling freely for {} s", Rounded::<1>(seconds.0);
    Self { trust: Trust::NoForce, seconds } => "without forces for {} s", Rounded::<1>(seconds.0);
    Self { trust: Trust::RotationLost, seconds } => "finding the level again for {} s: rotation was lost", Rounded::<1>(seconds.0);
}

/// Present attitude with its uncertainties, as reported to the user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// End of the latest sample.
    pub time: Instant,
    /// Pitch, nose up positive.
    pub pitch: Radians,
    /// Roll, right side down positive.
    pub roll: Radians,
    /// Standard deviation of pitch and of roll, 1σ.
    pub level_sigma: Radians,
    /// Azimuth; none before one was handed over, or after it was withdrawn.
    pub azimuth: Option<Azimuth>,
    /// Attitude from body axes to north, east, down (w, x, y, z); up to a constant heading without
    /// an azimuth.
    pub attitude: [f64; 4],
    /// Reliability of the level.
    pub state: State,
    /// Whether the body is at rest.
    pub is_at_rest: bool,
    /// Estimated biases of the gyros forward, right, down.
    pub biases: [RadiansPerSecond; 3],
    /// Standard deviations of the biases, 1σ.
    pub bias_sigmas: [RadiansPerSecond; 3],
    /// Whether a bias exceeded five times its configured 1σ; the configured 1σ of all biases is
    /// then inflated.
    pub is_bias_beyond_stated: bool,
    /// Time since the azimuth was handed over; zero without an azimuth.
    pub seconds: Seconds,
}
