//! The settings of an instrument from the other side: read, kept in a file, and loaded from one.
//!
//! ```text
//!  instrument ─get─▶ read ─▶ snapshot ─▶ file
//!       ▲                       │          │
//!       └─set, save, get─ load ◀┴──────────┘
//! ```

pub mod file;
pub mod load;
pub mod read;
pub mod value;

use std::collections::BTreeMap;

use firmware::settings::CALIBRATIONS;

/// The names that say what an instrument is and cannot be set: its carrier, the serial number of its controller, the version
/// of its firmware.
pub const IDENTITY: [&str; 3] = ["carrier", "serial", "firmware"];

/// What an instrument is, and all its settings, as it says them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Snapshot {
    /// Those of [`IDENTITY`] that are known.
    pub identity: BTreeMap<String, String>,
    /// Names and values of the settings.
    pub settings: BTreeMap<String, String>,
}

impl Snapshot {
    /// What these names and values say.
    #[must_use]
    pub fn of(values: Vec<(String, String)>) -> Self {
        let is_identity = |(name, _): &(String, String)| IDENTITY.contains(&name.as_str());
        let (identity, settings) = values.into_iter().partition(is_identity);
        Self { identity, settings }
    }

    /// What it says of its identity under a name; nothing where it says nothing.
    #[must_use]
    pub fn identity(&self, name: &str) -> Option<&str> {
        self.identity.get(name).map(String::as_str)
    }
}

/// Whether a setting is a calibration, which belongs to one board.
#[must_use]
pub fn is_calibration(name: &str) -> bool {
    CALIBRATIONS.iter().any(|begin| name.starts_with(begin))
}
