//! Integers of the sample path, each with the size of its step. Every conversion from `f64` rounds
//! to nearest (ties away from zero) and saturates; NaN becomes zero, so readers of external data
//! must refuse NaN before they convert.

use core::ops::Sub;

use super::TURN;

/// Steps of the 32-bit fraction in one turn, 2³².
const STEPS_PER_TURN: f64 = 4_294_967_296.0;

/// Rounds to the nearest integer and saturates at the limits of `i32`; NaN becomes zero.
fn to_i32(value: f64) -> i32 {
    libm::round(value) as i32
}

/// Angular rate, 1 LSB = 1 nrad/s, range ±2.147 rad/s (±123 °/s).
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AngularRate(pub i32);

impl AngularRate {
    /// Rate from rad/s, rounded to nearest and saturated.
    pub fn from_rad_per_s(rate: f64) -> Self {
        Self(to_i32(rate * 1e9))
    }

    /// Rate in rad/s, exact.
    #[must_use]
    pub fn rad_per_s(self) -> f64 {
        f64::from(self.0) * 1e-9
    }

    /// Whether the value stands at a limit of its range, where a sensor or a conversion clips.
    #[must_use]
    pub fn is_saturated(self) -> bool {
        self.0 == i32::MAX || self.0 == i32::MIN
    }
}

/// Angle turned within one sample, 1 LSB = 4 nrad, range ±8.59 rad.
///
/// The remainder of rounding is carried to the next sample, so that no rotation is lost: the sum of
/// any number of increments is off by at most one LSB.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AngleIncrement(pub i32);

impl AngleIncrement {
    /// One step, rad.
    pub const STEP: f64 = 4e-9;

    /// One step in nrad/s · ns, which is 10⁻¹⁸ rad.
    const STEP_ATTORADIANS: u64 = 4_000_000_000;

    /// 2⁶³ over that, rounded down.
    const RECIPROCAL: u64 = (1 << 63) / Self::STEP_ATTORADIANS;

    /// Increment from rad; the remainder `carried`, rad, begins at zero and belongs to the axis.
    /// NaN is an unknown rotation and becomes the upper limit.
    pub fn from_rad(angle: f64, carried: &mut f64) -> Self {
        let whole = if angle.is_nan() { f64::INFINITY } else { angle + *carried };
        let increment = Self(to_i32(whole / Self::STEP));
        *carried = if increment.is_saturated() { 0.0 } else { whole - increment.rad() };
        increment
    }

    /// Increment of a rate over a time in ns, at most four seconds; the remainder `carried`, 10⁻¹⁸ rad,
    /// begins at zero and belongs to the axis. A saturated rate gives a saturated increment.
    pub fn of_rate_over(rate: AngularRate, nanoseconds: u64, carried: &mut i64) -> Self {
        let whole = i64::from(rate.0) * nanoseconds.cast_signed() + *carried;
        let [steps, rest] = Self::steps(whole.unsigned_abs()).map(u64::cast_signed);
        let (steps, rest) = if whole < 0 { (-steps, -rest) } else { (steps, rest) };
        *carried = rest;
        if rate.is_saturated() {
            return Self(if rate.0 > 0 { i32::MAX } else { i32::MIN });
        }
        Self(steps.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32)
    }

    /// Whole steps of an angle of at most 2⁶³ · 10⁻¹⁸ rad, and what is left of it, exact: a division of 64 bits takes the
    /// core 240 instructions, this 20.
    const fn steps(attoradians: u64) -> [u64; 2] {
        // Less than 1.76 below the quotient, of which the bits that are cut off make 0.54.
        let steps = ((attoradians >> 31) * Self::RECIPROCAL) >> 32;
        let rest = attoradians - steps * Self::STEP_ATTORADIANS;
        let is_short = rest >= Self::STEP_ATTORADIANS;
        if is_short { [steps + 1, rest - Self::STEP_ATTORADIANS] } else { [steps, rest] }
    }

    /// Increment in rad, exact.
    #[must_use]
    pub fn rad(self) -> f64 {
        f64::from(self.0) * Self::STEP
    }

    /// Whether the value stands at a limit of its range, where a sensor or a conversion clips.
    #[must_use]
    pub fn is_saturated(self) -> bool {
        self.0 == i32::MAX || self.0 == i32::MIN
    }
}

/// Specific force, 1 LSB = 1 µm/s², range ±2147 m/s².
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpecificForce(pub i32);

impl SpecificForce {
    /// Force from m/s², rounded to nearest and saturated.
    pub fn from_m_per_s2(force: f64) -> Self {
        Self(to_i32(force * 1e6))
    }

    /// Force in m/s².
    #[must_use]
    pub fn m_per_s2(self) -> f64 {
        f64::from(self.0) * 1e-6
    }
}

/// Specific force on a spinning body, 1 LSB = 10 µm/s², range ±21 474 m/s²: at 100 turns a second
/// the centripetal force two centimetres off the axis is 8000 m/s².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct SpinForce(pub i32);

impl SpinForce {
    /// Force from m/s², rounded to nearest and saturated; NaN becomes the upper limit.
    #[must_use]
    pub fn from_m_per_s2(force: f64) -> Self {
        if force.is_nan() { Self(i32::MAX) } else { Self(to_i32(force * 1e5)) }
    }

    /// Force in m/s².
    #[must_use]
    pub fn m_per_s2(self) -> f64 {
        f64::from(self.0) * 1e-5
    }

    /// Whether the value stands at a limit of its range, where a sensor or a conversion clips.
    #[must_use]
    pub fn is_saturated(self) -> bool {
        self.0 == i32::MAX || self.0 == i32::MIN
    }
}

/// Temperature, 1 LSB = 1 m°C.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Temperature(pub i32);

impl Temperature {
    /// Temperature from °C, rounded to nearest and saturated.
    pub fn from_celsius(temperature: f64) -> Self {
        Self(to_i32(temperature * 1e3))
    }

    /// Temperature in °C.
    pub(crate) fn celsius(self) -> f64 {
        f64::from(self.0) * 1e-3
    }
}

/// An angle as a 32-bit fraction of a turn (1 LSB = 1.46 nrad); arithmetic wraps at whole turns.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Angle(pub u32);

impl Angle {
    /// One step, rad.
    pub const STEP: f64 = TURN / STEPS_PER_TURN;

    /// Angle from radians, any number of turns (exact to one LSB up to 10⁶ turns).
    pub fn from_rad(angle: f64) -> Self {
        let turns = angle / TURN;
        let fraction = turns - libm::floor(turns);
        Self(libm::round(fraction * STEPS_PER_TURN) as u64 as u32)
    }

    /// Angle in radians, [0, 2π).
    #[must_use]
    pub fn rad(self) -> f64 {
        f64::from(self.0) * Self::STEP
    }

    /// Angle in radians, [−π, π).
    #[must_use]
    pub fn signed_rad(self) -> f64 {
        f64::from(self.0.cast_signed()) * Self::STEP
    }
}

impl Sub for Angle {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

/// A point in time, 1 LSB = 1 µs since the start of the session's clock.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Instant(pub u64);

impl Instant {
    /// Time from seconds, rounded to nearest; negative times become zero.
    pub fn from_seconds(seconds: f64) -> Self {
        Self(libm::round(seconds * 1e6) as u64)
    }

    /// Time in seconds.
    #[must_use]
    pub fn seconds(self) -> f64 {
        self.0 as f64 * 1e-6
    }
}
