//! Values of the options that `meridian emulate --board` hands on to `emulated-board`, from their texts.

use firmware::platform::Platform;

/// A carrier by its name.
///
/// # Errors
/// The names that there are.
pub fn carrier(name: &str) -> Result<Platform, String> {
    let found = Platform::ALL.into_iter().find(|carrier| carrier.name() == name);
    found.ok_or_else(|| Platform::ALL.map(Platform::name).join(", "))
}

/// Cycles of the core for an instruction.
///
/// # Errors
/// The range.
pub fn cycles(text: &str) -> Result<f64, String> {
    within(text, [0.5, 20.0])
}

/// Time for which an execution goes on after its result, s.
///
/// # Errors
/// The range.
pub fn afterwards(text: &str) -> Result<f64, String> {
    within(text, [0.0, 3600.0])
}

/// A number within a range.
fn within(text: &str, [least, most]: [f64; 2]) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("{least} to {most} are meant"))
}

/// The port at which the link is offered as a byte stream, from "tcp:PORT"; 0 is any that is free.
///
/// # Errors
/// What is meant.
pub fn port(address: &str) -> Result<u16, String> {
    let port = address.strip_prefix("tcp:").and_then(|port| port.parse().ok());
    port.ok_or_else(|| "tcp: and a port are meant, as in tcp:5000".to_owned())
}
