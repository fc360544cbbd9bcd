//! Complex numbers in single precision, for the sums of a spinning body.

use core::iter::Sum;
use core::ops::{Add, AddAssign, Sub};

/// A complex number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Complex {
    /// Real part.
    pub(super) real: f32,
    /// Imaginary part.
    pub(super) imaginary: f32,
}

impl Complex {
    /// Complex conjugate.
    pub(super) fn conjugate(self) -> Self {
        Self { real: self.real, imaginary: -self.imaginary }
    }

    /// Product of the conjugate of this number with another.
    #[inline]
    pub(super) fn against(self, other: Self) -> Self {
        Self {
            real: self.real * other.real + self.imaginary * other.imaginary,
            imaginary: self.real * other.imaginary - self.imaginary * other.real,
        }
    }

    /// Product with another number.
    #[inline]
    pub(super) fn times(self, other: Self) -> Self {
        Self {
            real: self.real * other.real - self.imaginary * other.imaginary,
            imaginary: self.real * other.imaginary + self.imaginary * other.real,
        }
    }

    /// Product with a real factor.
    #[inline]
    pub(super) fn scaled(self, factor: f32) -> Self {
        Self { real: factor * self.real, imaginary: factor * self.imaginary }
    }

    /// Squared magnitude.
    pub(super) fn power(self) -> f32 {
        self.real * self.real + self.imaginary * self.imaginary
    }
}

impl Add for Complex {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self { real: self.real + other.real, imaginary: self.imaginary + other.imaginary }
    }
}

impl AddAssign for Complex {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Complex {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other.scaled(-1.0)
    }
}

impl Sum for Complex {
    fn sum<I: Iterator<Item = Self>>(numbers: I) -> Self {
        numbers.fold(Self::default(), Add::add)
    }
}
