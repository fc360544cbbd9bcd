//! Decimal fractions in integers: what is rounded first has no sign at zero, and an angle no 360.

use orientation::units::Radians;

/// A decimal fraction of `PLACES` places, as an integer of its last place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fixed<const PLACES: usize>(i32);

/// Units of the last of so many decimal places in one.
const fn unit(places: usize) -> i32 {
    10_i32.pow(places as u32)
}

impl<const PLACES: usize> Fixed<PLACES> {
    /// A number that is rounded to nearest. One that is not finite, or too great, is at the limit of the integer.
    pub fn nearest(number: f64) -> Self {
        Self(libm::round(number * f64::from(unit(PLACES))) as i32)
    }

    /// An angle in degrees, from zero to less than a full turn once it is rounded.
    pub fn turn(angle: Radians) -> Self {
        let Self(rounded) = Self::nearest(angle.degrees());
        Self(rounded.rem_euclid(360 * unit(PLACES)))
    }

    /// A standard deviation of an angle in degrees, rounded up: never less than it is, and 180 at most.
    pub fn sigma(sigma: Radians) -> Self {
        let most = 180.0 * f64::from(unit(PLACES));
        let rounded = libm::ceil(sigma.degrees() * f64::from(unit(PLACES)));
        Self(if rounded < most { rounded as i32 } else { most as i32 })
    }

    /// Its magnitude.
    pub fn magnitude(self) -> Self {
        Self(self.0.saturating_abs())
    }

    /// Whether it is below zero.
    pub fn is_negative(self) -> bool {
        self.0 < 0
    }

    /// What of its magnitude is before the point, and what behind it.
    pub fn parts(self) -> (u32, u32) {
        let (magnitude, unit) = (self.0.unsigned_abs(), unit(PLACES).unsigned_abs());
        (magnitude / unit, magnitude % unit)
    }
}
