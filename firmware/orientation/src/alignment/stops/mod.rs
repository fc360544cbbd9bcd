//! Azimuth from stops of a vehicle by inertial-frame alignment (Szymanowski 2003), also for a
//! single stop at which the vehicle sways.
//!
//! ```text
//!  sample ─▶ stop detector ─┬─ stops: attitude carried from inertial space, rest rates ─▶ filter ─▶ azimuth ± σ
//!                      └─ lever: forces without what the sway makes of them
//!                           └─ blocks: up in the frozen start frame ──────────────────▲
//!                         Earth rotation, displacement ─▶ where up must be ───────────┘
//! ```
//!
//! ```text
//!        ▲ pole       up at the first stop and up at the second, seen from a frame that does not
//!  up(0) │  up(t)     turn with the Earth, lie on a cone about the Earth's axis, Ω t apart
//!      ↖ │ ↗
//!       ╲│╱           north is where the axis is
//! ```
//!
//! Gravity seen from inertial space turns with the Earth: its directions at two times show where
//! north is, whatever the vehicle did between, as long as its gyros carried the frame along. Of a
//! rotation q(t) from the body to the frame frozen at the start, and a force f at rest,
//!
//! ```text
//! up(t) = q(t) f/|f|   must be   R(Ω t) up(0), moved by the known displacement
//! ```
//!
//! R turns about the Earth's axis, and the azimuth at the start says where in the frozen frame that
//! axis is. An azimuth that is wrong by δ leaves a rate of `2 Ω_h |sin(δ/2)|` between both. The
//! resolution is set by the gyros: an uncompensated bias B makes an azimuth error of up to B/`Ω_h`,
//! which stops at different headings remove, because they make the biases observable.
//! [`inclination`] has the function of the azimuth that Szymanowski 2003 minimises.

mod block;
pub mod conclusion;
mod drift;
pub(crate) mod filter;
pub mod inclination;
mod lever;
mod path;
pub mod place;
pub mod plain;
pub(crate) mod progress;
pub(crate) mod refusal;
pub mod residual;
pub mod session;
mod solution;
pub mod stop;
pub mod stop_detector;

pub use progress::Progress;
pub use refusal::Refusal;
pub use session::Session;

use super::setup::{GREATEST, SetupError, check_ranges};
use super::site::Site;
use crate::signal::rest::Sensors;
use crate::units::{ForceNoise, Metres, MetresPerSecond, RadiansPerSecond};

/// Configuration of an alignment by stops.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Setting {
    /// Site of the first stop, the gyros' noise, the accelerometers' biases, and the requirements.
    pub site: Site,
    /// Standard deviation of the gyros' biases from switch-on to switch-on, 1σ; none where
    /// it is unknown.
    pub bias_sigma: Option<RadiansPerSecond>,
    /// Noise density of the accelerometers, one-sided, m/s²/√Hz.
    pub force_noise: ForceNoise,
    /// Standard deviation of a reported displacement, 1σ.
    pub displacement_sigma: Metres,
    /// Standard deviation of the mean speed north and east of a drive without reported
    /// displacement, 1σ.
    pub speed_sigma: MetresPerSecond,
}

/// Prior 1σ of an unknown bias: a worse gyro cannot find north by this method.
const ANY_BIAS: RadiansPerSecond = RadiansPerSecond::from_degrees_per_hour(30.0);
/// Default of [`Setting::displacement_sigma`]: that of a position fix.
const DISPLACEMENT_SIGMA: Metres = Metres(5.0);
/// Default of [`Setting::speed_sigma`]: most vehicles do not get farther in a straight line.
const SPEED_SIGMA: MetresPerSecond = MetresPerSecond(10.0);

impl Setting {
    /// Configuration without knowledge of the gyros' biases, for noiseless accelerometers.
    #[must_use]
    pub const fn new(site: Site) -> Self {
        Self {
            site,
            bias_sigma: None,
            force_noise: ForceNoise(0.0),
            displacement_sigma: DISPLACEMENT_SIGMA,
            speed_sigma: SPEED_SIGMA,
        }
    }

    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`].
    pub(crate) fn check(&self) -> Result<(), SetupError> {
        let positive = [0.0, GREATEST];
        self.site.check()?;
        check_ranges(&[
            ("bias_sigma", self.bias_sigma().0, positive),
            ("force_noise", self.force_noise.0, positive),
            ("displacement_sigma", self.displacement_sigma.0, positive),
            ("speed_sigma", self.speed_sigma.0, positive),
        ])
    }

    /// Prior 1σ of the gyros' biases, bias instability included.
    pub fn bias_sigma(&self) -> RadiansPerSecond {
        let instability = self.site.noise.model().bias_instability;
        RadiansPerSecond(libm::hypot(self.bias_sigma.unwrap_or(ANY_BIAS).0, instability.0))
    }

    /// Sensor properties for the stop criteria.
    #[must_use]
    pub fn sensors(&self) -> Sensors {
        Sensors {
            angle_random_walk: self.site.noise.model().angle_random_walk,
            bias_sigma: self.bias_sigma(),
            force_noise: self.force_noise,
            force_bias_sigma: self.site.accelerometer_bias_sigma,
        }
    }
}
