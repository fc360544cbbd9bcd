//! Reasons for which an alignment cannot begin, with the sentences that are printed for them.

use crate::filter::DesignError;
use crate::units::{Radians, TURN};
use crate::words::Rounded;

/// Reason for which an alignment cannot begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SetupError {
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
    /// A rotating platform lacks speeds above zero, two turns in each sense, or a modulation of its
    /// rate-modulated turns.
    NoSpeed,
    /// The stops of a vehicle lack a sample period or a length, or there are fewer than two or too
    /// many of them.
    NoStops,
    /// The reference table (etalon) in flash fails its CRC: the firmware must be programmed again.
    TableCorrupt,
}

impl core::error::Error for SetupError {}

crate::words! { SetupError:
    Self::Filter(error) => "no filter for this sample rate: {}", error;
    Self::DwellTooShort { samples, needed } =>
        "the shortest dwell has {} samples; the filter needs {}", samples, needed;
    Self::BeyondTravel(angle) =>
        "position {}° is beyond the stage's travel", Rounded::<2>(angle.0 / TURN * 360.0);
    Self::NoPosition => "there is no position";
    Self::NoStops =>
        "stops need a sample period and a length above zero, and two to eight of them";
    Self::NoSpeed =>
        "a turning platform needs one or two speeds above zero, two turns in either sense, a modulation";
    Self::TableCorrupt => "the etalon table fails its checksum";
}
