//! The serial port that a board's ST-LINK offers, and who may use it.

use std::io::ErrorKind;
use std::path::Path;

use super::board::MAKER;
use super::environment::Environment;
use super::{Finding, Need, State};

/// Where Linux shows its terminals, serial ports among them.
const TERMINALS: &str = "/sys/class/tty";

/// The serial port.
#[must_use]
pub fn port(of: &dyn Environment) -> Finding {
    let ports = of.ports();
    let its = ports.iter().find(|port| is_of_link(of, port));
    let names = ports.iter().map(|port| port.display().to_string()).collect::<Vec<_>>().join(", ");
    let connect = || "connect the board's connector CN7; its serial port comes with it".to_owned();
    let state = match its {
        Some(port) => usable(of, port),
        None if ports.is_empty() => State::Missing("no serial port".to_owned(), connect()),
        None if of.system().is_linux() => {
            State::Missing(format!("none is an ST-LINK's; there are {names}"), connect())
        }
        // Which of them it is these systems do not say.
        None => State::Found(names),
    };
    Finding { what: "serial port", need: Need::Link, state }
}

/// Whether a port is that of an ST-LINK, as far as the system says it.
fn is_of_link(of: &dyn Environment, port: &Path) -> bool {
    let Some(name) = port.file_name() else { return false };
    let maker = Path::new(TERMINALS).join(name).join("device/../idVendor");
    let maker = of.read(&maker).and_then(|text| u16::from_str_radix(text.trim(), 16).ok());
    maker == Some(MAKER)
}

/// Whether the user may use the port.
fn usable(of: &dyn Environment, port: &Path) -> State {
    let name = port.display();
    match of.open(port) {
        Ok(()) => State::Found(format!("{name}, of an ST-LINK")),
        Err(ErrorKind::PermissionDenied) => State::Missing(
            format!("{name} is protected"),
            format!(
                "sudo usermod -aG {} \"$USER\"   # then log in anew",
                of.system().group_of_ports()
            ),
        ),
        Err(ErrorKind::ResourceBusy) => {
            State::Found(format!("{name}, of an ST-LINK; another program has it in use"))
        }
        Err(kind) => State::Missing(
            format!("{name}: {}", crate::refused::words(kind, &kind.to_string())),
            "take the board's cable out and put it in again".to_owned(),
        ),
    }
}
