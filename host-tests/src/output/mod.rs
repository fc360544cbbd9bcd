//! What the user sees of plans, noise analyses and campaigns, and the progress bar.

pub mod allan;
pub mod emulation;
pub mod executed;
pub mod manner;
pub mod plan;
pub mod progress;

use std::io::{self, Write};

use embassy_time::Instant;
use orientation::alignment::stepwise::fit::{Fit, Hypothesis};
use orientation::math::regression::Column;
use orientation::noise::model::GyroNoise;
use orientation::units::{ARCSECOND, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, RadiansPerSecond};

/// Writes a line to standard error. A line that has no reader is lost, which is no error.
pub fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// A text in one line for a terminal: what would break the line, hide a part of it or steer the terminal, as names of files
/// may, stands there escaped.
#[must_use]
pub fn printable(text: &str) -> String {
    let is_hidden = |c: char| c.is_control() || matches!(c, '\u{2028}'..='\u{202e}');
    let escaped =
        |c: char| if is_hidden(c) { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(escaped).collect()
}

/// A time of the instrument's clock, s from power-on.
#[must_use]
pub fn seconds(at: Instant) -> f64 {
    at.as_micros() as f64 * 1e-6
}

/// Radians to degrees.
#[must_use]
pub fn degrees(angle: f64) -> f64 {
    angle.to_degrees()
}

/// A number with so many decimal places; one that rounds to zero has no sign.
#[must_use]
pub fn fixed(value: f64, places: usize) -> String {
    unsigned_zero(format!("{value:.places$}"), "")
}

/// A number with its sign and so many decimal places; one that rounds to zero has a plus.
#[must_use]
pub fn signed(value: f64, places: usize) -> String {
    unsigned_zero(format!("{value:+.places$}"), "+")
}

/// An azimuth in degrees with so many decimal places, as it stands within a circle: what rounds to a whole one is north.
#[must_use]
pub fn azimuth(degrees: f64, places: usize) -> String {
    let text = fixed(degrees.rem_euclid(360.0), places);
    if text.starts_with("360") { fixed(0.0, places) } else { text }
}

/// A number above zero with so many digits that count, and without an exponent.
#[must_use]
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    fixed(value, places(value.abs().max(1e-12), digits).max(0.0) as usize)
}

/// A value and its 1σ with as many decimal places as show two digits of that.
#[must_use]
pub fn to_sigma(value: f64, sigma: f64) -> [String; 2] {
    let places = places_of(sigma);
    [value, sigma].map(|number| fixed(number, places))
}

/// Decimal places that show two digits of a number.
#[must_use]
pub fn places_of(number: f64) -> usize {
    places(number.abs(), 2).clamp(0.0, 12.0) as usize
}

/// Decimal places that show so many digits of a number, negative where the last one stands before the point.
fn places(number: f64, digits: i32) -> f64 {
    f64::from(digits) - 1.0 - number.log10().floor()
}

/// So many of what has this name, in words; the plural is regular.
#[must_use]
pub fn counted(count: usize, name: &str) -> String {
    let ending = match count {
        1 => "",
        _ if name.ends_with('s') => "es",
        _ => "s",
    };
    format!("{count} {name}{ending}")
}

/// A text in which each word that leaves open whether it is one or several, as in `1 turn(s)`, says which by the number
/// before it.
#[must_use]
pub fn in_number(text: &str) -> String {
    let mut parts = text.split("(s)");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |before, rest| {
        let count = before.split(' ').rev().find_map(|word| word.parse::<f64>().ok());
        let ending = if count == Some(1.0) { "" } else { "s" };
        format!("{before}{ending}{rest}")
    })
}

/// The text of a number, with another sign where it is that of a negative zero.
fn unsigned_zero(text: String, sign: &str) -> String {
    match text.strip_prefix('-') {
        Some(size) if size.chars().all(|digit| matches!(digit, '0' | '.')) => {
            format!("{sign}{size}")
        }
        _ => text,
    }
}

/// What rounds to zero, being smaller than `half`, prints without a sign.
pub(crate) fn positive_zero(value: f64, half: f64) -> f64 {
    if value.abs() < half { 0.0 } else { value }
}

/// rad/s to °/h.
#[must_use]
pub fn degrees_per_hour(rate: f64) -> f64 {
    rate.to_degrees() * 3600.0
}

/// Rates about three axes in °/h.
#[must_use]
pub fn in_degrees_per_hour(rates: [RadiansPerSecond; 3]) -> [f64; 3] {
    rates.map(|rate| degrees_per_hour(rate.0))
}

/// The difference of two azimuths in degrees, (−180, 180].
#[must_use]
pub fn azimuth_error(azimuth: f64, truth: f64) -> f64 {
    let turns = (azimuth - truth) / 360.0;
    (turns - turns.round()) * 360.0
}

/// The names of the columns that a fit used.
#[must_use]
pub fn columns(fit: &Fit) -> Vec<&'static str> {
    let mut names = vec!["cos", "sin", "1"];
    if fit.model.time != Column::Absent {
        names.push("t");
    }
    if fit.model.temperature != Column::Absent {
        names.push("temperature");
    }
    names.extend(of_hypothesis(fit.model.hypothesis));
    names
}

/// The names of the columns of what moves beside the stage, or bends.
fn of_hypothesis(hypothesis: Hypothesis) -> &'static [&'static str] {
    match hypothesis {
        Hypothesis::Steady => &[],
        Hypothesis::Yawing => &["t·cos, t·sin of a base that yaws"],
        Hypothesis::Elliptic => &["second harmonic of the encoder"],
        Hypothesis::Curved => &["t²"],
        Hypothesis::Winding => &["t²", "t³"],
        Hypothesis::Stepped { .. } => &["step of the heading"],
    }
}

/// The coefficients of a gyro's noise in the field's units, those that are there; N where it is known.
#[must_use]
pub fn noise_in_words(noise: &GyroNoise, is_white_known: bool) -> String {
    let walk = noise.angle_random_walk.0 / DEGREE_PER_SQRT_HOUR;
    let white = if is_white_known {
        format!("N {} °/√h", rounded(walk))
    } else {
        "N from the data".to_owned()
    };
    let others = [
        ("B", noise.bias_instability.degrees_per_hour(), " °/h"),
        ("K", noise.rate_random_walk.0 / DEGREE_PER_HOUR * 60.0, " °/h/√h"),
        ("R", noise.rate_ramp.0 / DEGREE_PER_HOUR * 3600.0, " °/h²"),
        ("Q", noise.quantisation.0 / ARCSECOND, "″"),
    ];
    let others = others.into_iter().filter(|(_, value, _)| *value > 0.0);
    let others = others.map(|(name, value, unit)| format!("{name} {}{unit}", rounded(value)));
    [white].into_iter().chain(others).collect::<Vec<_>>().join(", ")
}

/// Six digits are enough of what was typed in.
fn rounded(value: f64) -> f64 {
    let scale = 10.0_f64.powi(6 - value.abs().max(1e-12).log10().ceil() as i32);
    (value * scale).round() / scale
}
