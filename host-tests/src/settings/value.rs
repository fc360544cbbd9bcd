//! Values of settings: decimal numbers without exponent, or words.

use protocol::command::number;
use serde_json::Value;

/// Whether two texts are one value, as `47.58` and `47.580` are.
#[must_use]
pub fn are_same(one: &str, other: &str) -> bool {
    one == other || matches!((number(one), number(other)), (Ok(one), Ok(other)) if one == other)
}

/// A value for an object: a number, or words.
#[must_use]
pub fn object(name: &str, value: &str) -> Value {
    let is_number = !super::IDENTITY.contains(&name) && number(value).is_ok();
    let number = is_number.then(|| value.parse::<i64>().map(Value::from).ok());
    let number = number.map(|whole| whole.or_else(|| value.parse::<f64>().ok().map(Value::from)));
    number.flatten().unwrap_or_else(|| value.into())
}

/// A value for a file: a number exactly as the instrument says it, where the format has such a number, else words.
#[must_use]
pub fn in_file(name: &str, value: &str) -> String {
    if !super::IDENTITY.contains(&name) && number(value).is_ok() && is_written_so(value) {
        return value.to_owned();
    }
    // What a sentence can carry needs no other escapes.
    format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Whether TOML writes a decimal number so: with digits on both sides of a point, and no zero before others.
fn is_written_so(number: &str) -> bool {
    let digits = number.strip_prefix('-').unwrap_or(number);
    let (whole, part) = digits.split_once('.').unwrap_or((digits, "0"));
    let has_leading_zero = whole.len() > 1 && whole.starts_with('0');
    !whole.is_empty() && !part.is_empty() && !has_leading_zero
}

/// The decimal number of a text as the format of files has it, which may have a sign, an exponent or another radix.
///
/// # Errors
/// Why an instrument takes no such number.
pub fn decimal(text: &str, radix: u32) -> Result<String, String> {
    let plain = text.strip_prefix('+').unwrap_or(text);
    if radix == 10 && number(plain).is_ok() {
        return Ok(plain.to_owned());
    }
    let whole = i64::from_str_radix(text, radix).ok().map(|whole| whole.to_string());
    let real = || plain.parse::<f64>().ok().filter(|_| radix == 10).map(|real| real.to_string());
    let plain = whole.or_else(real).filter(|decimal| number(decimal).is_ok());
    plain.ok_or_else(|| format!("{text} is no number of at most fifteen digits"))
}
