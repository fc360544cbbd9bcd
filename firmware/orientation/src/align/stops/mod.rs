//! Azimuth from stops (Szymanowski 2003; equations.md §5), and of a vehicle that stands and sways.
//!
//! ```text
//!  sample ─▶ stop detector ─┬─ stops: attitude carried from inertial space, rest rates ─▶ filter ─▶ azimuth ± σ
//!                      └─ lever: forces without what the sway makes of them
//!                           └─ blocks: up in the frozen start frame ──────────────────▲
//!                         Earth rotation, displacement ─▶ where up must be ───────────┘
//! ```
//!
//! Gravity seen from inertial space turns with the Earth: where it pointed at one time and points at another
//! tells where north is, whatever the vehicle did between, as long as its gyros carried the frame along.

pub mod block;
pub mod conclusion;
pub mod filter;
pub mod inclination;
pub mod lever;
pub mod path;
pub mod place;
pub mod plain;
pub mod solution;
pub mod stop;
pub mod stop_detector;

use super::setting::Setting as Common;
use crate::signal::rest::Sensors;
use crate::units::DEGREE_PER_HOUR;

/// What is known before a vehicle is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The place of the first stop, the gyros' noise, the accelerometers' biases, the demands.
    pub common: Common,
    /// 1σ of the gyros' biases from start to start, rad/s; none where nobody knows it.
    pub bias_sigma: Option<f64>,
    /// Noise of the accelerometers, one-sided, m/s²/√Hz.
    pub force_noise: f64,
    /// 1σ of a displacement that was told, m.
    pub displacement_sigma: f64,
    /// 1σ of the mean speed north and east of a drive whose displacement nobody told, m/s.
    pub speed_sigma: f64,
}

/// 1σ of a bias of which nothing is known, rad/s: a gyro that is worse cannot find north this way.
const ANY_BIAS: f64 = 30.0 * DEGREE_PER_HOUR;
/// Default of [`Setting::displacement_sigma`]: a position fix.
const DISPLACEMENT_SIGMA: f64 = 5.0;
/// Default of [`Setting::speed_sigma`]: most vehicles get no farther in a straight line.
const SPEED_SIGMA: f64 = 10.0;

impl Setting {
    /// Nothing is known of the gyros' biases, accelerometers are quiet.
    #[must_use]
    pub const fn new(common: Common) -> Self {
        Self {
            common,
            bias_sigma: None,
            force_noise: 0.0,
            displacement_sigma: DISPLACEMENT_SIGMA,
            speed_sigma: SPEED_SIGMA,
        }
    }

    /// 1σ of the gyros' biases, rad/s, instability included.
    #[must_use]
    pub fn bias_sigma(&self) -> f64 {
        libm::hypot(self.bias_sigma.unwrap_or(ANY_BIAS), self.common.noise.bias_instability)
    }

    /// The sensors as the stop criteria see them.
    #[must_use]
    pub fn sensors(&self) -> Sensors {
        let bias = self.bias_sigma.unwrap_or(ANY_BIAS);
        let force_bias = self.common.accelerometer_bias_sigma;
        Sensors::new(&self.common.noise, bias, self.force_noise, force_bias)
    }
}
