//! Decimal fractions in integers: what is rounded first has no sign at zero, and an angle no 360.

use core::fmt;

use orientation::units::Radians;

/// A decimal fraction of `PLACES` places, as an integer of its last place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fixed<const PLACES: usize>(i64);

/// Units of the last of so many decimal places in one.
const fn unit(places: usize) -> i64 {
    10_i64.pow(places as u32)
}

impl<const PLACES: usize> Fixed<PLACES> {
    /// A number that is rounded to nearest. One that is not finite, or too great, is at the limit of the integer.
    pub fn nearest(number: f64) -> Self {
        Self(libm::round(number * unit(PLACES) as f64) as i64)
    }

    /// An angle in degrees, from zero to less than a full turn once it is rounded.
    pub fn turn(angle: Radians) -> Self {
        let Self(rounded) = Self::nearest(angle.degrees());
        Self(rounded.rem_euclid(360 * unit(PLACES)))
    }

    /// A standard deviation of an angle in degrees, rounded up: never less than it is, and 180 at most.
    pub fn sigma(sigma: Radians) -> Self {
        let most = 180.0 * unit(PLACES) as f64;
        let rounded = libm::ceil(sigma.degrees() * unit(PLACES) as f64);
        Self(if rounded < most { rounded as i64 } else { most as i64 })
    }

    /// Its magnitude.
    pub fn magnitude(self) -> Self {
        Self(self.0.saturating_abs())
    }

    /// Whether it is below zero.
    pub fn is_negative(self) -> bool {
        self.0 < 0
    }
}

impl<const PLACES: usize> fmt::Display for Fixed<PLACES> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (sign, magnitude) = (if self.0 < 0 { "-" } else { "" }, self.0.unsigned_abs());
        let unit = unit(PLACES).unsigned_abs();
        write!(f, "{sign}{}.{:0PLACES$}", magnitude / unit, magnitude % unit)
    }
}

/// A field that is empty where there is nothing to say.
pub(super) struct Field<T>(pub Option<T>);

impl<T: fmt::Display> fmt::Display for Field<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.as_ref().map_or(Ok(()), |value| value.fmt(f))
    }
}
