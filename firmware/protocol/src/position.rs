//! The latitude that a satellite receiver on the same bus states, in sentences GGA and RMC of any talker.

use orientation::earth::Latitude;

use crate::command::{content, number};

/// Qualities of a position in GGA that were measured: 1 to 5. Those that were estimated, given by hand or simulated are none.
const MEASURED: [&str; 5] = ["1", "2", "3", "4", "5"];
/// Modes of a position in RMC that was not measured: not valid, simulated, by hand, estimated.
const NOT_MEASURED: [&str; 4] = ["N", "S", "M", "E"];
/// Place of the mode among the fields of RMC, which sentences before version 2.3 do not have.
const MODE: usize = 12;
/// Minutes of a degree.
const MINUTES: f64 = 60.0;

/// The latitude of a line, where that is a sentence with a valid checksum and a position that was measured.
#[must_use]
pub fn latitude(line: &str) -> Option<Latitude> {
    let content = content(line.strip_prefix('$')?)?;
    let field = |place: usize| content.split(',').nth(place);
    let address = field(0).filter(|address| address.len() == 5)?;
    let (is_valid, place) = match address.get(2..)? {
        "GGA" => (MEASURED.contains(&field(6)?), 2),
        "RMC" => {
            let is_measured = field(MODE).is_none_or(|mode| !NOT_MEASURED.contains(&mode));
            (field(2)? == "A" && is_measured, 3)
        }
        _ => return None,
    };
    let sign = match field(place + 1)? {
        "N" => 1.0,
        "S" => -1.0,
        _ => return None,
    };
    let degrees = degrees(field(place)?).filter(|_| is_valid)?;
    Latitude::from_degrees(sign * degrees)
}

/// Degrees of a field `ddmm.mmmm`: two digits of degrees, two of minutes, and their decimal places.
fn degrees(field: &str) -> Option<f64> {
    let (degrees, minutes) = field.split_at_checked(2)?;
    let has_two_digits = minutes.find('.').unwrap_or(minutes.len()) == 2;
    let (degrees, minutes) = (number(degrees).ok()?, number(minutes).ok()?);
    let is_one =
        has_two_digits && (0.0..=90.0).contains(&degrees) && (0.0..MINUTES).contains(&minutes);
    is_one.then(|| degrees + minutes / MINUTES)
}
