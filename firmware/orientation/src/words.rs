//! One wording of every message for people, whether the text is rendered on the board or by the
//! host that decodes its log.
//!
//! [`words!`](crate::words!) gives a type its [`core::fmt::Display`] and, with feature `defmt`, its
//! `defmt::Format`, from the same sentences. Numbers go through [`Rounded`].

use core::fmt;

/// A number that is printed with `PLACES` decimal places, rounded to nearest. Rendered as text the
/// places are padded with zeros; in the `defmt` log the rounded value is sent and its trailing
/// zeros are not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded<const PLACES: usize>(pub f64);

// In integers, since the link of a board tells such numbers: core's own formatting of floats takes
// 10 KB of flash.
impl<const PLACES: usize> fmt::Display for Rounded<PLACES> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_nan() {
            return f.write_str("NaN");
        }
        if self.0.is_sign_negative() {
            f.write_str("-")?;
        }
        if self.0.is_infinite() {
            return f.write_str("inf");
        }
        match decimals(self.0.abs(), PLACES as u32) {
            (whole, _) if PLACES == 0 => write!(f, "{whole}"),
            (whole, part) => write!(f, "{whole}.{part:0PLACES$}"),
        }
    }
}

/// Digits before and after the point of a number from zero to 2¹²⁸, with up to 19 decimal places:
/// rounded to nearest, and to even from the middle.
fn decimals(number: f64, places: u32) -> (u128, u64) {
    let unit = 10_u64.pow(places);
    let whole = libm::floor(number);
    // The rest, below one and exact, is mantissa · 2^−shift.
    let bits = (number - whole).to_bits();
    let mantissa = bits & ((1 << 52) - 1) | (1 << 52);
    let shift = 1075 - (bits >> 52) as u32;
    let whole = whole as u128;
    if shift >= u128::BITS {
        return (whole, 0);
    }
    let scaled = u128::from(mantissa) * u128::from(unit);
    let (part, half) = ((scaled >> shift) as u64, 1 << (shift - 1));
    let left = scaled & (2 * half - 1);
    let is_odd = (if places == 0 { whole as u64 } else { part }) & 1 == 1;
    let part = part + u64::from(left > half || (left == half && is_odd));
    if part == unit { (whole + 1, 0) } else { (whole, part) }
}

#[cfg(feature = "defmt")]
impl<const PLACES: usize> defmt::Format for Rounded<PLACES> {
    fn format(&self, f: defmt::Formatter) {
        let unit = (0..PLACES).fold(1.0, |unit, _| unit * 10.0);
        defmt::write!(f, "{}", libm::round(self.0 * unit) / unit);
    }
}

/// A number of any size that is printed with nine significant digits at most, without zeros at their end; below a millionth
/// with a power of ten. The `defmt` log has all of its digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortened(pub f64);

/// Decimal places of a [`Shortened`] number from one to ten.
const PLACES: u32 = 8;
/// Greatest number of decimal places, of a number from a millionth on.
const MOST_PLACES: u32 = 14;

// In integers, as `Rounded`.
impl fmt::Display for Shortened {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.0.abs();
        if number.is_nan() || number > 1e18 {
            return Rounded::<0>(self.0).fmt(f);
        }
        // Powers of ten up to the 22nd are exact.
        let (mut scale, mut power) = (1.0, 0);
        while number > 0.0 && number < 1e-6 && number * scale < 1.0 && power < 22 {
            (scale, power) = (scale * 10.0, power + 1);
        }
        let number = number * scale;
        let (mut places, mut bound) = (PLACES, 10.0);
        while places > 0 && number >= bound {
            (places, bound) = (places - 1, bound * 10.0);
        }
        bound = 1.0;
        while number > 0.0 && number < bound && places < MOST_PLACES {
            (places, bound) = (places + 1, bound / 10.0);
        }
        let (whole, mut part) = decimals(number, places);
        while places > 0 && part.is_multiple_of(10) {
            (part, places) = (part / 10, places - 1);
        }
        let sign = if self.0 < 0.0 { "-" } else { "" };
        write!(f, "{sign}{}", whole as u64)?;
        if places > 0 {
            write!(f, ".{part:0width$}", width = places as usize)?;
        }
        if power > 0 { write!(f, "e-{power}") } else { Ok(()) }
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Shortened {
    fn format(&self, f: defmt::Formatter) {
        defmt::write!(f, "{}", self.0);
    }
}

/// A number that is printed with this many decimal places at most, rounded to nearest, without zeros at their end and
/// without a power of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decimal {
    /// The number.
    pub number: f64,
    /// Decimal places, up to 19.
    pub places: u8,
}

// In integers, as `Rounded`.
impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { number, places } = *self;
        if !number.is_finite() {
            return Rounded::<0>(number).fmt(f);
        }
        let (whole, mut part) = decimals(number.abs(), places.into());
        let mut width = usize::from(places);
        while width > 0 && part.is_multiple_of(10) {
            (part, width) = (part / 10, width - 1);
        }
        if number < 0.0 && (whole, part) != (0, 0) {
            f.write_str("-")?;
        }
        if width == 0 { write!(f, "{whole}") } else { write!(f, "{whole}.{part:0width$}") }
    }
}

/// Gives a type its sentences: `words! { Type: pattern => "sentence {}", argument; … }`.
///
/// The patterns match `*self`; the arguments are [`core::fmt::Display`], and `defmt::Format` where
/// the calling crate has a feature `defmt`.
#[macro_export]
macro_rules! words {
    ($type:ty: $($pattern:pat $(if $guard:expr)? => $sentence:tt $(, $argument:expr)*;)+) => {
        impl core::fmt::Display for $type {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                match *self {
                    $($pattern $(if $guard)? => write!(f, $sentence $(, $argument)*),)+
                }
            }
        }

        #[cfg(feature = "defmt")]
        impl defmt::Format for $type {
            fn format(&self, f: defmt::Formatter) {
                match *self {
                    $($pattern $(if $guard)? => defmt::write!(f, $sentence $(, $argument)*),)+
                }
            }
        }
    };
}
