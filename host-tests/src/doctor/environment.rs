//! What a check sees of the computer: programs, files, ports and probes.

use std::fs::{self, OpenOptions};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serial2::{KeepSettings, SerialPort};

use super::system::System;

/// Where Linux has the devices at USB; all others that are opened are serial ports.
const USB: &str = "/dev/bus/usb";

/// A debug probe, and the chip behind it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Probe {
    /// Its name.
    pub name: String,
    /// The identity of the chip behind it; or why that could not be read.
    pub chip: Result<Chip, String>,
}

/// The identity of a chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chip {
    /// Identity of the device (`DBGMCU_IDCODE`, RM0351 section 48.6.1): the kind in bits 0 to 11, the revision in bits 16 to 31.
    pub device: u32,
    /// The unique identity of this one (RM0351 section 49.1).
    pub unique: [u32; 3],
}

/// A computer.
pub trait Environment {
    /// Its operating system.
    fn system(&self) -> System;

    /// What a program prints with these arguments; none where it is not there or fails.
    fn run(&self, program: &str, arguments: &[&str]) -> Option<String>;

    /// The text of a file; none where it cannot be read.
    fn read(&self, path: &Path) -> Option<String>;

    /// What is in a folder, by name; nothing where that is not there.
    fn list(&self, folder: &Path) -> Vec<PathBuf>;

    /// Whether a device can be opened for reading and writing.
    ///
    /// # Errors
    /// Why not.
    fn open(&self, path: &Path) -> Result<(), ErrorKind>;

    /// The serial ports.
    fn ports(&self) -> Vec<PathBuf>;

    /// The debug probes; none where this program cannot look for them.
    fn probes(&self) -> Option<Vec<Probe>>;
}

/// The computer that the program runs on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Here;

impl Environment for Here {
    fn system(&self) -> System {
        match std::env::consts::OS {
            "linux" => System::of_linux(self),
            "macos" => System::MacOs,
            "windows" => System::Windows,
            _ => System::Other,
        }
    }

    fn run(&self, program: &str, arguments: &[&str]) -> Option<String> {
        let mut command = Command::new(program);
        let output = command.args(arguments).stdin(Stdio::null()).stderr(Stdio::null()).output();
        let output = output.ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    fn read(&self, path: &Path) -> Option<String> {
        fs::read_to_string(path).ok()
    }

    fn list(&self, folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut paths: Vec<_> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        paths
    }

    fn open(&self, path: &Path) -> Result<(), ErrorKind> {
        let opened = if path.starts_with(USB) {
            OpenOptions::new().read(true).write(true).open(path).map(drop)
        } else {
            SerialPort::open(path, KeepSettings).map(drop)
        };
        opened.map_err(|error| error.kind())
    }

    fn ports(&self) -> Vec<PathBuf> {
        let mut ports = SerialPort::available_ports().unwrap_or_default();
        ports.sort();
        ports
    }

    #[cfg(feature = "probe")]
    fn probes(&self) -> Option<Vec<Probe>> {
        Some(super::probe::all())
    }

    #[cfg(not(feature = "probe"))]
    fn probes(&self) -> Option<Vec<Probe>> {
        None
    }
}
