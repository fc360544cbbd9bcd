//! Why an instrument does not begin, as its log and its link say it.

use orientation::alignment::setup::SetupError;
use orientation::alignment::stepwise::mount::MountError;
use orientation::words;

use crate::settings::SettingsError;

/// Why an instrument does not begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotBegun {
    /// Its settings must not be used.
    Settings(SettingsError),
    /// Its latitude was not stated.
    NoLatitude,
    /// Its procedure is none.
    Session(SetupError),
    /// Its two frames do not reach an orientation.
    Mount(MountError),
    /// A sensor of a spinning body has no scale factor.
    NoScale,
}

words! { NotBegun:
    Self::Settings(error) => "no settings: {}", error;
    Self::NoLatitude => "no latitude is set";
    Self::Session(error) => "no session: {}", error;
    Self::Mount(error) => "no mount: {}", error;
    Self::NoScale => "a sensor's scale factor is none";
}

impl From<SettingsError> for NotBegun {
    fn from(error: SettingsError) -> Self {
        Self::Settings(error)
    }
}

impl From<SetupError> for NotBegun {
    fn from(error: SetupError) -> Self {
        Self::Session(error)
    }
}

impl From<MountError> for NotBegun {
    fn from(error: MountError) -> Self {
        Self::Mount(error)
    }
}
