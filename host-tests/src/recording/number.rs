//! Numbers of a recording: finite, and inside the range that their quantity has.

use super::problem::{Problem, ValueProblem};
use super::range::Range;

/// Reads a number inside the range. `nan`, `inf` and what overflows a double are refused by name.
pub(super) fn number(text: &str, range: &'static Range) -> Result<f64, ValueProblem> {
    match text.parse::<f64>() {
        Ok(value) if range.contains(value) => Ok(value),
        Ok(value) => Err(refusal(value, text, range)),
        Err(_) if text.is_empty() => Err(ValueProblem::EmptyField),
        Err(_) => Err(ValueProblem::NotANumber(text.to_owned())),
    }
}

/// Reads two numbers inside the range with a comma between; `none` says that they are not.
pub(super) fn pair<P: Into<Problem>>(
    text: &str,
    range: &'static Range,
    none: fn(String) -> P,
) -> Result<[f64; 2], Problem> {
    let (first, second) = text.split_once(',').ok_or_else(|| none(text.to_owned()).into())?;
    Ok([number(first.trim_ascii(), range)?, number(second.trim_ascii(), range)?])
}

/// Why a value that is a number to Rust does not do.
fn refusal(value: f64, text: &str, range: &'static Range) -> ValueProblem {
    let text = text.to_owned();
    if value.is_nan() {
        ValueProblem::Nan(text)
    } else if value.is_infinite() {
        ValueProblem::Infinite(text)
    } else {
        ValueProblem::OutOfRange(text, range)
    }
}
