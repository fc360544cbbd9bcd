//! Days of the calendar, as dates are told and given.

use orientation::words;

/// Seconds of a day.
const DAY: u64 = 86_400;
/// The first year that is counted from.
const FIRST: u16 = 1970;
/// The last year that has four digits; what lies beyond is told as its last day.
const LAST: u16 = 9999;

/// A day of the Gregorian calendar, of universal time; none where nobody knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Day(Option<(u16, u8, u8)>);

impl Day {
    /// The day of a time in seconds since 1970; of zero, none.
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

    /// When a day begins, s since 1970; [`None`] where there is no such day, or its year has not four
    /// digits or lies before 1970.
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

/// All months from the first year to the last.
fn months() -> impl Iterator<Item = (u16, u8)> {
    (FIRST..=LAST).flat_map(|year| (1..=12).map(move |month| (year, month)))
}

/// Days of a month.
fn length(year: u16, month: u8) -> u64 {
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    match month {
        2 => 28 + u64::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}
