//! `meridian run --fault`: the catalogue of faults on the command line.

use host::output::manner::Manner;
use orientation::device::Device;
use serde_json::json;
use simulated::fault::{Fault, Platform};

use super::Answer;
use super::mistyped::nearest;

/// A fault that is asked for, or the wish to see the names.
#[derive(Clone, Copy, Debug)]
pub enum FaultChoice {
    /// The names of the platform's faults.
    List,
    /// One fault of the catalogue.
    One(Fault),
}

impl FaultChoice {
    /// Whether it is a fault of the coarse IMU, which comes with it then.
    pub fn is_of_base_imu(self) -> bool {
        matches!(self, Self::One(Fault::Chip(Device::Base, _)))
    }
}

/// A fault of any platform by its name, or `list`.
///
/// # Errors
/// A name that no fault bears.
pub fn parse(text: &str) -> Result<FaultChoice, String> {
    if text == "list" {
        return Ok(FaultChoice::List);
    }
    let faults = || Platform::ALL.into_iter().flat_map(Fault::all);
    let found = faults().find(|fault| fault.to_string() == text);
    found.map(FaultChoice::One).ok_or_else(|| {
        let meant = nearest(text, faults().map(|fault| fault.to_string()));
        format!("no such fault; `--fault list` names them{meant}")
    })
}

/// A platform by its name.
///
/// # Errors
/// A name that no platform bears.
pub fn platform(text: &str) -> Result<Platform, String> {
    let found = Platform::ALL.into_iter().find(|platform| platform.name() == text);
    let names = Platform::ALL.map(Platform::name).join(", ");
    found.ok_or_else(|| {
        let meant = nearest(text, Platform::ALL.map(Platform::name).into_iter());
        format!("no such platform; there are {names}{meant}")
    })
}

/// Refuses a fault that cannot happen on a platform.
///
/// # Errors
/// The platforms that have the fault.
pub fn check(fault: Fault, platform: Platform) -> Result<(), String> {
    let having: Vec<_> = fault.platforms().map(Platform::name).collect();
    if having.contains(&platform.name()) {
        return Ok(());
    }
    Err(format!(
        "--fault: {fault} is a fault of {}, not of {platform}; `--fault list` names those that it has",
        listed(&having)
    ))
}

/// Names in a row: a, b and c.
fn listed(names: &[&str]) -> String {
    match names {
        [before @ .., last] if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        few => few.concat(),
    }
}

/// The names of the faults of a platform.
pub fn names(platform: Platform) -> impl Iterator<Item = String> {
    Fault::all(platform).map(|fault| fault.to_string())
}

/// Lists the faults of a platform.
///
/// # Errors
/// The object cannot be serialised.
pub fn list(platform: Platform, manner: Manner) -> Result<Answer, String> {
    let names: Vec<String> = names(platform).collect();
    let object = json!({ "status": "ok", "faults": names });
    Answer::of(None, manner, &object, || names.join("\n"))
}
