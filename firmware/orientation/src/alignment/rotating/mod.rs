//! Azimuth from a continuously rotating platform: carouselling (MET 2018).
//!
//! ```text
//!  sample ─▶ turn accumulator ─turns─▶ average ─────────────Q₊, Q₋─▶ solution ─▶ azimuth ± σ
//!                └─modulated─▶ misalignment ▲   accelerometer ─F────────▲
//! ```
//!
//! At the encoder angle θ, turning with the rate w in the sense d = ±1, the gyro measures
//!
//! ```text
//! u = Re{ [cos α E + (Ω_v + κ) F + G/(j d w)] e^{jθ} } + sin α (Ω_v − θ̇) + bias + noise
//!
//! E = Ω_h e^{jA}   horizontal Earth rate, whose argument is the azimuth A
//! F                tilt of the platform, read by the accelerometer that turns with the gyro
//! κ = k_s + j k_o  g-sensitivity of the gyro
//! G                g-sensitivity that integrates acceleration, of a molecular-electronic sensor
//! α                axis misalignment: angle between the sensitive axis and the platform's plane
//! ```
//!
//! Whole turns are demodulated, u on cos θ and sin θ: `Q₊` clockwise, `Q₋` the other way. The bias
//! falls out of them. The response to the platform's own unevenness is removed by the axis
//! misalignment, which rate-modulated turns show. G changes its sign with the sense of rotation, so
//! the mean of both senses does not contain it:
//!
//! ```text
//! A = arg[ (Q₊ + Q₋)/2 − (Ω_v + κ) F ]
//! ```
//!
//! A sensor of unknown gain and lag needs both senses for its lag, and two speeds for G, which falls
//! with the speed ([`molecular`]).

pub mod average;
mod change;
pub mod conclusion;
mod heading;
pub mod level;
pub mod misalignment;
pub mod molecular;
pub(crate) mod part;
pub(crate) mod progress;
pub(crate) mod refusal;
pub mod session;
pub mod solution;
mod tilting;
pub mod turn;
pub mod turn_accumulator;

pub use progress::Progress;
pub use refusal::Refusal;
pub use session::Session;

use self::misalignment::AxisMisalignment;
use self::turn::SPEEDS;
use super::refusal::{Passed, refuse_if};
use super::setup::{GREATEST, LONGEST, SetupError, check_ranges};
use super::site::Site;
use crate::units::{Degrees, Radians, RadiansPerSecond, Seconds, TURN};

/// Kind of sensor on the platform.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sensor {
    /// Whether the response is flat: gain one and no lag at the platform's speed. Otherwise gain
    /// and lag are unknown, and rotation in both senses determines them.
    pub is_flat: bool,
    /// Standard deviation, 1σ, of either part of a g-sensitivity that integrates acceleration
    /// (molecular-electronic sensors): its effect of tilt times the platform's speed, over the
    /// horizontal Earth rate. Zero for a gyro without it; infinite where it is unknown,
    /// which requires two speeds.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::units::or_infinite"))]
    pub molecular_sigma: RadiansPerSecond,
    /// Settling time of the output after a change of speed.
    pub settle_seconds: Seconds,
}

impl Sensor {
    /// Ordinary gyro: flat, with a g-sensitivity proportional to force only, settled within 1 s.
    pub const GYRO: Self = Self {
        is_flat: true,
        molecular_sigma: RadiansPerSecond(0.0),
        settle_seconds: Seconds(1.0),
    };
    /// Molecular-electronic sensor without prior knowledge, settled within 5 s.
    pub const MOLECULAR: Self = Self {
        is_flat: false,
        molecular_sigma: RadiansPerSecond(f64::INFINITY),
        settle_seconds: Seconds(5.0),
    };
}

/// Configuration of an alignment on a rotating platform.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Setting {
    /// Site, gyro, accelerometer and requirements.
    pub site: Site,
    /// Kind of sensor.
    pub sensor: Sensor,
    /// Stored axis misalignments, one for each speed; rate-modulated turns replace them.
    pub misalignments: [Option<AxisMisalignment>; SPEEDS],
    /// Greatest misalignment of the sensitive axis from the platform's plane.
    pub misalignment_limit: Radians,
    /// Standard deviation of the encoder's zero, 1σ. It enters the azimuth fully, and no
    /// rotation shows it.
    pub encoder_zero_sigma: Radians,
    /// Whether the encoder's error twice per turn is within [`Site::encoder_sigma`]; otherwise
    /// modulation of the platform's rate at that frequency may be such an error.
    pub harmonics_known: bool,
    /// Quantisation step of the gyro's rates, as far as their noise does not hide it:
    /// rounding that is synchronous with the turn does not average out.
    pub rate_step: RadiansPerSecond,
}

/// Default of [`Setting::misalignment_limit`]: 2°.
const MISALIGNMENT_LIMIT: Radians = Radians::from_degrees(2.0);

impl Setting {
    /// Configuration without stored misalignments, for an exact encoder.
    #[must_use]
    pub const fn new(site: Site, sensor: Sensor) -> Self {
        Self {
            site,
            sensor,
            misalignments: [None; SPEEDS],
            misalignment_limit: MISALIGNMENT_LIMIT,
            encoder_zero_sigma: Radians(0.0),
            harmonics_known: true,
            rate_step: RadiansPerSecond(0.0),
        }
    }

    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`].
    pub(crate) fn check(&self) -> Result<(), SetupError> {
        self.site.check()?;
        check_ranges(&[
            ("molecular_sigma", self.sensor.molecular_sigma.0, [0.0, f64::INFINITY]),
            ("settle_seconds", self.sensor.settle_seconds.0, [0.0, LONGEST]),
            ("misalignment_limit", self.misalignment_limit.0, [0.0, TURN]),
            ("encoder_zero_sigma", self.encoder_zero_sigma.0, [0.0, TURN]),
            ("rate_step", self.rate_step.0, [0.0, GREATEST]),
        ])
    }

    /// Checks that the axis misalignment is within its limit.
    ///
    /// # Errors
    /// [`Refusal::Misaligned`]: the sensor must be aligned mechanically.
    pub(crate) fn accept(&self, misalignment: &AxisMisalignment) -> Passed {
        let (angle, allowed) = (misalignment.angle(), self.misalignment_limit);
        let is_allowed = angle.0.abs() <= allowed.0;
        let [angle, allowed] = [angle, allowed].map(Degrees::from);
        refuse_if(!is_allowed, Refusal::Misaligned { angle, allowed })
    }
}
