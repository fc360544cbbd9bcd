//! Quantities that a user states and reads: an `f64` in a newtype that is named after its unit, or
//! after the coefficient of a sensor that it is.

use super::{DEGREE, DEGREE_PER_HOUR, DEGREES_PER_RADIAN};

/// Declares quantities, which differ in their names alone. Text holds them as plain numbers.
macro_rules! quantities {
    ($($(#[$meaning:meta])+ $name:ident;)+) => {$(
        $(#[$meaning])+
        #[must_use]
        #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(transparent))]
        pub struct $name(pub f64);
    )+};
}

quantities! {
    /// Angle, rad.
    Radians;
    /// Angular rate, rad/s.
    RadiansPerSecond;
    /// Rate of change of an angular rate, rad/s²: a rate ramp R.
    RateRamp;
    /// Angle random walk N, rad/√s.
    RadiansPerRootSecond;
    /// Rate random walk K, rad/s/√s.
    RateRandomWalk;
    /// g-sensitivity κ of a gyro, rad/s per g.
    GSensitivity;
    /// Time or duration, s.
    Seconds;
    /// Length, m.
    Metres;
    /// Speed, m/s.
    MetresPerSecond;
    /// Specific force or acceleration, m/s².
    MetresPerSecondSquared;
    /// Noise density of an accelerometer, one-sided, m/s²/√Hz.
    ForceNoise;
    /// Angle in a message, °.
    Degrees;
    /// Angular rate of a mechanism in a message, °/s.
    DegreesPerSecond;
    /// Angular rate of a gyro in a message, °/h.
    DegreesPerHour;
    /// Duration in a message, ms.
    Milliseconds;
    /// Specific force in a message, thousandths of standard gravity.
    MilliG;
}

impl Radians {
    /// Angle of so many degrees.
    pub const fn from_degrees(degrees: f64) -> Self {
        Self(degrees * DEGREE)
    }

    /// The angle in degrees.
    #[must_use]
    pub const fn degrees(self) -> f64 {
        self.0 * DEGREES_PER_RADIAN
    }
}

impl GSensitivity {
    /// g-sensitivity of so many °/h per g.
    pub const fn from_degrees_per_hour(rate: f64) -> Self {
        Self(rate * DEGREE_PER_HOUR)
    }
}

impl From<Radians> for Degrees {
    fn from(angle: Radians) -> Self {
        Self(angle.degrees())
    }
}

impl From<RadiansPerSecond> for DegreesPerSecond {
    fn from(rate: RadiansPerSecond) -> Self {
        Self(rate.degrees_per_second())
    }
}

impl RadiansPerSecond {
    /// Rate of so many °/h.
    pub const fn from_degrees_per_hour(rate: f64) -> Self {
        Self(rate * DEGREE_PER_HOUR)
    }

    /// The rate in °/s.
    #[must_use]
    pub const fn degrees_per_second(self) -> f64 {
        self.0 * DEGREES_PER_RADIAN
    }

    /// The rate in °/h.
    #[must_use]
    pub const fn degrees_per_hour(self) -> f64 {
        self.0 / DEGREE_PER_HOUR
    }
}
