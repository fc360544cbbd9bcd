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

impl<const PLACES: usize> fmt::Display for Rounded<PLACES> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.PLACES$}", self.0)
    }
}

#[cfg(feature = "defmt")]
impl<const PLACES: usize> defmt::Format for Rounded<PLACES> {
    fn format(&self, f: defmt::Formatter) {
        let unit = (0..PLACES).fold(1.0, |unit, _| unit * 10.0);
        defmt::write!(f, "{}", libm::round(self.0 * unit) / unit);
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
