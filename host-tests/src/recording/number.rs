//! Numbers of a recording: finite, and inside the range that their quantity has.

use super::problem::ValueProblem;
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
