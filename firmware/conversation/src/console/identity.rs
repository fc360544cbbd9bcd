//! What an instrument says of itself beside its settings, by names that cannot be set.

use firmware::settings::Editable;
use protocol::answer;
use protocol::nmea::Sentence;

use super::Console;

/// The names: the carrier of the image, the serial number of the controller, the version of the firmware.
const NAMES: [&str; 3] = ["carrier", "serial", "firmware"];

impl Console {
    /// The answer to `get` with one of these names; [`None`] where it is none.
    pub(super) fn identity(&self, name: &str, settings: &dyn Editable) -> Option<Sentence> {
        match name {
            "carrier" => answer::value("get", name, settings.carrier()),
            "serial" => answer::value("get", name, self.serial),
            "firmware" => answer::value("get", name, env!("CARGO_PKG_VERSION")),
            _ => None,
        }
    }

    /// The same of the name of this number; [`None`] behind the last one.
    pub(super) fn nth_identity(&self, number: usize, settings: &dyn Editable) -> Option<Sentence> {
        NAMES.get(number).and_then(|name| self.identity(name, settings))
    }
}
