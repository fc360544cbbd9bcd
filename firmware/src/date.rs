//! Calendar days, as the log and the tables write dates.
//!
//! The calendar is the Gregorian one, in coordinated universal time without leap seconds, as Unix
//! time counts.

use orientation::words;

/// Seconds in a day.
const DAY: u64 = 86_400;
/// The first year, in which the counting of seconds begins.
const FIRST: u16 = 1970;
/// The last year with four digits; later times are reported as its last day.
const LAST: u16 = 9999;

/// A day of the Gregorian calendar in universal time: year, month 1–12 and day 1–31; or an unknown
/// day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Day(Option<(u16, u8, u8)>);

impl Day {
    /// The day of a time in seconds since 1970-01-01; zero means that the time is unknown.
    #[must_use]
    pub fn of(seconds: u64) -> Self {
        if seconds == 0 {
            return Self(None);
        }
        let mut days = seconds / DAY;
        for (year, month) in months() {
            let length = length(year, month);
            if days < length {
                return Self(Some((year, month, days as u8 + 1)));
            }
            days -= length;
        }
        Self(Some((LAST, 12, 31)))
    }

    /// The begin of a day, s since 1970-01-01; [`None`] if the date does not exist, or if its year
    /// is outside 1970–9999.
    #[must_use]
    pub fn begin(year: u16, month: u8, day: u8) -> Option<u64> {
        let is_year = (FIRST..=LAST).contains(&year) && (1..=12).contains(&month);
        if !is_year || day == 0 || u64::from(day) > length(year, month) {
            return None;
        }
        let before = months().take_while(|&then| then < (year, month));
        let days: u64 = before.map(|(year, month)| length(year, month)).sum();
        Some((days + u64::from(day) - 1) * DAY)
    }
}

words! { Day:
    Self(None) => "an unknown day";
    Self(Some((year, month, day))) => "{}-{:02}-{:02}", year, month, day;
}

/// All months from the first year to the last, in order.
fn months() -> impl Iterator<Item = (u16, u8)> {
    (FIRST..=LAST).flat_map(|year| (1..=12).map(move |month| (year, month)))
}

/// Number of days in a month, 28–31.
fn length(year: u16, month: u8) -> u64 {
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    match month {
        2 => 28 + u64::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}
