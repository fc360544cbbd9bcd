//! Numbers of a recording: finite, and inside the range that their quantity has.

use super::problem::Problem;
use super::range::Range;
use crate::angle::{self, Quantity};

/// Reads a number inside the range; what is none is looked at once more for what is wrong.
pub(super) fn number(text: &str, range: &'static Range) -> Result<f64, Problem> {
    match fast_float2::parse::<f64, _>(text) {
        Ok(value) if range.contains(value) => Ok(value),
        _ => explained(text, range),
    }
}

/// As [`number`], by the standard library. `nan`, `inf` and what overflows a double are refused by name.
fn explained(text: &str, range: &'static Range) -> Result<f64, Problem> {
    match text.parse::<f64>() {
        Ok(value) if range.contains(value) => Ok(value),
        Ok(value) if value.is_nan() => Err(Problem::Nan(text.to_owned())),
        Ok(value) if value.is_infinite() => Err(Problem::Infinite(text.to_owned())),
        Ok(_) => Err(Problem::OutOfRange(text.to_owned(), range)),
        Err(_) if text.is_empty() => Err(Problem::EmptyField),
        Err(_) => Err(Problem::NotANumber(text.to_owned())),
    }
}

/// Reads an angle inside the range, in degrees, or in degrees, minutes and seconds, as the command line takes it.
pub(super) fn angle(text: &str, of: Quantity, range: &'static Range) -> Result<f64, Problem> {
    match number(text, range) {
        Err(Problem::NotANumber(text)) => match angle::degrees(&text, of) {
            Ok(degrees) if range.contains(degrees) => Ok(degrees),
            Ok(_) => Err(Problem::OutOfRange(text, range)),
            Err(why) => Err(Problem::NotAnAngle(text, why)),
        },
        read => read,
    }
}

/// Reads two numbers inside the range with a comma between; `none` says that they are not.
pub(super) fn pair(
    text: &str,
    range: &'static Range,
    none: fn(String) -> Problem,
) -> Result<[f64; 2], Problem> {
    let (first, second) = text.split_once(',').ok_or_else(|| none(text.to_owned()))?;
    Ok([number(first.trim_ascii(), range)?, number(second.trim_ascii(), range)?])
}
