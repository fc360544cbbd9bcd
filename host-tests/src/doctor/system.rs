//! Operating systems, as far as they differ in how something is installed.

use std::path::Path;

use super::environment::Environment;

/// An operating system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum System {
    /// Debian, Ubuntu, and what is made of them.
    Debian,
    /// Fedora, and what resembles it.
    Fedora,
    /// Arch Linux, and what is made of it.
    Arch,
    /// Another Linux.
    Linux,
    /// macOS.
    MacOs,
    /// Windows.
    Windows,
    /// Another one.
    Other,
}

/// What tells a Linux from others.
const RELEASE: &str = "/etc/os-release";

impl System {
    /// Which Linux it is.
    #[must_use]
    pub fn of_linux(environment: &dyn Environment) -> Self {
        let text = environment.read(Path::new(RELEASE)).unwrap_or_default();
        let lines = text.lines().filter_map(|line| line.split_once('='));
        let lines = lines.filter(|(key, _)| ["ID", "ID_LIKE"].contains(key));
        let names: Vec<_> =
            lines.flat_map(|(_, names)| names.trim_matches(['"', '\'']).split(' ')).collect();
        let is = |all: &[&str]| all.iter().any(|name| names.contains(name));
        match () {
            () if is(&["debian", "ubuntu"]) => Self::Debian,
            () if is(&["fedora", "rhel"]) => Self::Fedora,
            () if is(&["arch"]) => Self::Arch,
            () => Self::Linux,
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Debian => "Debian or Ubuntu",
            Self::Fedora => "Fedora",
            Self::Arch => "Arch Linux",
            Self::Linux => "Linux",
            Self::MacOs => "macOS",
            Self::Windows => "Windows",
            Self::Other => "unknown",
        }
    }

    /// Whether it is a Linux.
    #[must_use]
    pub fn is_linux(self) -> bool {
        matches!(self, Self::Debian | Self::Fedora | Self::Arch | Self::Linux)
    }

    /// The group whose members may use serial ports.
    #[must_use]
    pub fn group_of_ports(self) -> &'static str {
        if self == Self::Arch { "uucp" } else { "dialout" }
    }
}
