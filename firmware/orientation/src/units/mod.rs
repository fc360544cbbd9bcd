//! Units of angles, rates, forces and times, and conventions of the stage path.
//!
//! Navigation frame: north, east, down. Body frame: x forward, y right, z down. The azimuth is that
//! of body x from true north, clockwise from above. The stage angle is clockwise from above; the
//! gyro's sensitive axis lies along body x at zero.
//!
//! Samples flow as integers in newtypes. What a user states and reads is an `f64` in a newtype that
//! is named after its unit, or after the noise coefficient that it is; arithmetic takes the number
//! out of it and is done in `f64`. Ratios, variances and spectral densities are plain numbers.

mod quantity;
mod sample;

pub use quantity::{
    Degrees, DegreesPerHour, DegreesPerSecond, ForceNoise, GSensitivity, Metres, MetresPerSecond,
    MetresPerSecondSquared, MilliG, Milliseconds, Radians, RadiansPerRootSecond, RadiansPerSecond,
    RateRamp, RateRandomWalk, Seconds,
};
pub use sample::{
    Angle, AngleIncrement, AngularRate, Instant, SpecificForce, SpinForce, Temperature,
};

/// Radians in one turn.
pub const TURN: f64 = 2.0 * core::f64::consts::PI;

/// One degree, in radians.
pub const DEGREE: f64 = TURN / 360.0;

/// Degrees in one radian.
pub const DEGREES_PER_RADIAN: f64 = 360.0 / TURN;

/// One second of arc, in radians.
pub const ARCSECOND: f64 = TURN / 1_296_000.0;

/// One degree per hour, in rad/s.
pub const DEGREE_PER_HOUR: f64 = TURN / 360.0 / 3600.0;

/// One degree per square root of an hour (angle random walk), in rad/√s.
pub const DEGREE_PER_SQRT_HOUR: f64 = TURN / 360.0 / 60.0;

/// Wraps an angle, rad, to [0, 2π). One that is within stays as it is.
#[must_use]
pub fn wrapped(angle: f64) -> f64 {
    if (0.0..TURN).contains(&angle) {
        return angle;
    }
    let wrapped = angle - TURN * libm::floor(angle / TURN);
    if wrapped < TURN { wrapped } else { 0.0 }
}

/// Reads a quantity that text holds as a missing number where it is infinite.
#[cfg(feature = "serde")]
pub(crate) fn or_infinite<'de, D: serde::Deserializer<'de>, Q: serde::Deserialize<'de>>(
    text: D,
) -> Result<Q, D::Error> {
    let number: Option<f64> = serde::Deserialize::deserialize(text)?;
    let number = number.unwrap_or(f64::INFINITY);
    Q::deserialize(serde::de::IntoDeserializer::into_deserializer(number))
}

/// A number that may be missing, in the memory of one number: `Option<f64>` takes twice as much.
#[derive(Clone, Copy, Debug)]
pub struct Optional(f64);

impl Optional {
    /// The missing number, stored as NaN.
    pub(crate) const NONE: Self = Self(f64::NAN);

    /// The number; `None` where it is missing.
    #[must_use]
    pub fn get(self) -> Option<f64> {
        (!self.0.is_nan()).then_some(self.0)
    }
}

impl Default for Optional {
    fn default() -> Self {
        Self::NONE
    }
}

impl From<Option<f64>> for Optional {
    /// Conversion in which NaN becomes a missing number.
    fn from(number: Option<f64>) -> Self {
        number.map_or(Self::NONE, Self)
    }
}

impl PartialEq for Optional {
    fn eq(&self, other: &Self) -> bool {
        self.get() == other.get()
    }
}
