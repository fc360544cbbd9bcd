//! Reasons for which an alignment cannot begin, with the sentences that are printed for them.

use crate::filter::DesignError;
use crate::units::{Radians, TURN};
use crate::words::{Rounded, Shortened};

/// Reason for which an alignment cannot begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SetupError {
    /// A quantity of the configuration is out of its range, or not a number.
    OutOfRange(Quantity),
    /// A quantity is none of those that it can be.
    NotAmong {
        /// Name of its field.
        name: &'static str,
        /// What it is.
        value: u32,
        /// What it can be, in words.
        choices: &'static str,
    },
    /// The filter cannot be designed for this sample rate.
    Filter(DesignError),
    /// Dwells of this many samples are too short for the filter's lag.
    DwellTooShort {
        /// Number of samples of the shortest dwell.
        samples: u32,
        /// Number of samples that the filter needs.
        needed: u32,
    },
    /// A position lies outside the stage's travel.
    BeyondTravel(Radians),
    /// The schedule has no position.
    NoPosition,
    /// The schedule has two positions, which leave two azimuths, and no half of the circle is stated.
    TwoPositions,
    /// A rotating platform lacks speeds above zero, two turns in each sense, or a modulation of its
    /// rate-modulated turns.
    NoSpeed,
    /// The stops of a vehicle lack a length, or there are fewer than two or too
    /// many of them.
    NoStops,
    /// The reference table (etalon) in flash fails its CRC: the firmware must be programmed again.
    TableCorrupt,
}

/// A quantity of a configuration, in SI units, with the range in which it makes sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Name of its field.
    pub name: &'static str,
    /// Value.
    pub value: f64,
    /// Least and greatest value.
    pub range: [f64; 2],
}

/// Longest time of a configuration, s: eleven days, which samples count in microseconds and periods.
pub(crate) const LONGEST: f64 = 1e6;
/// Shortest and longest sample period, s.
pub(crate) const PERIODS: [f64; 2] = [1e-6, 1e3];
/// Greatest quantity for which no better limit is known: its square is finite with room to spare.
pub const GREATEST: f64 = 1e9;

/// Refuses the first quantity, given by name, value and range, that is out of its range or not a number.
///
/// # Errors
/// [`SetupError::OutOfRange`].
#[inline(never)]
pub fn check_ranges(quantities: &[(&'static str, f64, [f64; 2])]) -> Result<(), SetupError> {
    for &(name, value, range @ [least, greatest]) in quantities {
        if !(least..=greatest).contains(&value) {
            return Err(SetupError::OutOfRange(Quantity { name, value, range }));
        }
    }
    Ok(())
}

impl core::error::Error for SetupError {}

crate::words! { SetupError:
    Self::OutOfRange(Quantity { name, value, range: [least, greatest] }) =>
        "{} is {}, not from {} to {}",
        name, Shortened(value), Shortened(least), Shortened(greatest);
    Self::NotAmong { name, value, choices } => "{} is {}, not {}", name, value, choices;
    Self::Filter(error) => "no filter for this sample rate: {}", error;
    Self::DwellTooShort { samples, needed } =>
        "the shortest dwell has {} samples; the filter needs {}", samples, needed;
    Self::BeyondTravel(angle) =>
        "position {}° is beyond the stage's travel", Rounded::<2>(angle.0 / TURN * 360.0);
    Self::NoPosition => "there is no position";
    Self::TwoPositions => "two positions leave two azimuths: state the half first";
    Self::NoStops =>
        "stops need a length above zero, and two to eight of them";
    Self::NoSpeed =>
        "a turning platform needs one or two speeds above zero, two turns in either sense, a modulation";
    Self::TableCorrupt => "the etalon table fails its checksum";
}
