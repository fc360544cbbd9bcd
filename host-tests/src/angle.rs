//! Angles as people write them: decimal degrees, or degrees, minutes and seconds; with a sign or with a letter behind them.

use thiserror::Error;

/// What an angle is of: it decides which letters may stand behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// North or south of the equator: N or S.
    Latitude,
    /// East or west of north: E or W.
    Azimuth,
    /// Any other: no letter.
    Other,
}

/// Why a text is no angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum AngleError {
    /// It is written in no way that is known.
    #[error("not a number of degrees, as 47.58 or 47°35′20″, 47d35m20s, 47:35:20")]
    Unknown,
    /// A part of a degree that is a whole one, or of a minute.
    #[error("minutes and seconds of an angle are below 60")]
    Sixty,
    /// A sign and a letter.
    #[error("a sign before it and a letter behind it say the same; leave one out")]
    SignAndLetter,
    /// A letter that it cannot have.
    #[error("{} here", letter_words(*.0))]
    Letter(Quantity),
}

/// Which letters an angle may have, in words.
fn letter_words(of: Quantity) -> &'static str {
    match of {
        Quantity::Latitude => "a latitude has N or S behind it, no other letter",
        Quantity::Azimuth => "an azimuth has E or W behind it, no other letter",
        Quantity::Other => "neither N, S, E nor W has a meaning",
    }
}

/// The letters, with the sign that each stands for.
const LETTERS: [(char, Quantity, f64); 4] = [
    ('N', Quantity::Latitude, 1.0),
    ('S', Quantity::Latitude, -1.0),
    ('E', Quantity::Azimuth, 1.0),
    ('W', Quantity::Azimuth, -1.0),
];

/// The marks of degrees, minutes and seconds; two marks of minutes are one of seconds.
const MARKS: [&[char]; 3] = [&['°', 'd'], &['′', '\'', '’', 'm'], &['″', '"', '”', 's']];

/// An angle in degrees, of whatever size.
///
/// # Errors
/// Why the text is none.
pub fn degrees(text: &str, of: Quantity) -> Result<f64, AngleError> {
    let text = text.trim();
    let letter = LETTERS.iter().find(|(letter, ..)| text.ends_with(*letter));
    if letter.is_some_and(|(_, quantity, _)| *quantity != of) {
        return Err(AngleError::Letter(of));
    }
    let text = letter.map_or(text, |_| text[..text.len() - 1].trim_end());
    let (sign, size) = match text.strip_prefix(['-', '−']) {
        Some(size) => (Some(-1.0), size),
        None => (text.strip_prefix('+').map(|_| 1.0), text.strip_prefix('+').unwrap_or(text)),
    };
    if sign.is_some() && letter.is_some() {
        return Err(AngleError::SignAndLetter);
    }
    let sign = sign.or(letter.map(|(.., sign)| *sign)).unwrap_or(1.0);
    Ok(sign * unsigned(size)?)
}

/// An angle without sign and letter, °.
fn unsigned(text: &str) -> Result<f64, AngleError> {
    if text.starts_with(['-', '+']) {
        return Err(AngleError::Unknown);
    }
    match text.parse() {
        Ok(degrees) => Ok(degrees),
        Err(_) => in_parts(text),
    }
}

/// An angle in degrees, minutes and seconds, °; any of them may be missing, and the last one may have decimal places.
fn in_parts(text: &str) -> Result<f64, AngleError> {
    let parts = if text.contains(':') { between_colons(text) } else { before_marks(text) };
    let parts = parts.ok_or(AngleError::Unknown)?;
    let [last, before @ ..] = &parts[..] else { return Err(AngleError::Unknown) };
    if before.iter().any(|(_, number)| number.contains('.')) {
        return Err(AngleError::Unknown);
    }
    let mut sum = 0.0;
    for (place, number) in [last].into_iter().chain(before) {
        let value = number.parse::<f64>().map_err(|_| AngleError::Unknown)?;
        if *place > 0 && value >= 60.0 {
            return Err(AngleError::Sixty);
        }
        sum += value / [1.0, 60.0, 3600.0][*place];
    }
    Ok(sum)
}

/// The places and texts of an angle's parts, the last one first.
type Parts<'t> = Vec<(usize, &'t str)>;

/// Parts between colons: two or three, from the degrees on.
fn between_colons(text: &str) -> Option<Parts<'_>> {
    let parts: Vec<&str> = text.split(':').collect();
    let is_whole = parts.len() <= MARKS.len() && parts.iter().all(|part| is_number(part));
    is_whole.then(|| parts.into_iter().enumerate().rev().collect())
}

/// Parts before their marks, in their order; a last one without a mark is in the place after the one before it.
fn before_marks(text: &str) -> Option<Parts<'_>> {
    let (mut rest, mut parts, mut next) = (text, Parts::new(), 0);
    while !rest.is_empty() {
        let length = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let (number, behind) = rest.split_at(length);
        let (place, behind) = marked(behind.trim_start(), next)?;
        if place < next || place >= MARKS.len() || !is_number(number) {
            return None;
        }
        parts.insert(0, (place, number));
        (rest, next) = (behind.trim_start(), place + 1);
    }
    Some(parts)
}

/// The place of the mark with which a text begins, and what follows it; where it is empty, the next place.
fn marked(text: &str, next: usize) -> Option<(usize, &str)> {
    if text.is_empty() {
        return Some((next, text));
    }
    let twice = ["''", "′′", "’’"].iter().find_map(|marks| text.strip_prefix(marks));
    let once = || MARKS.iter().enumerate().find_map(|(i, of)| Some((i, text.strip_prefix(*of)?)));
    twice.map(|rest| (2, rest)).or_else(once)
}

/// Whether a text is digits, with a decimal point or without.
fn is_number(text: &str) -> bool {
    let has_digit = text.contains(|c: char| c.is_ascii_digit());
    has_digit && text.chars().all(|c| c.is_ascii_digit() || c == '.')
}
