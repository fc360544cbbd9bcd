//! The instrument in a vehicle with something wrong: every fault is survived or refused for its reason,
//! and rotation that was lost is in σ.

use host::instrument::{Trial, VehicleRun};
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stops::Refusal as Stops;
use orientation::device::{Device, Trouble};
use simulated::fault::{ChipFault, Fault, Platform};
use simulated::vehicle::VehicleScenario;

use crate::support::campaign::{Extent, campaigns};

/// What a fault must come to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// An azimuth within 3.5 σ.
    Survived,
    /// The device is given up for its reason.
    Named(Device, Trouble),
    /// A gyro clipped.
    Clipped,
    /// It did not stand, or drive, as it must: in the time allowed too few stops were found.
    TooFewStops,
    /// The sensors could not tell rest from motion, or could: either is honest.
    SurvivedOrNot,
}

fn expected(fault: Fault) -> End {
    match fault {
        Fault::Chip(device, fault) => of_chip(device, fault),
        Fault::OutOfStep => End::Named(Device::RightGyro, Trouble::OutOfStep),
        Fault::SaturationOnce | Fault::Saturation => End::Clipped,
        Fault::OverloadOnce | Fault::Overflow => End::Survived,
        Fault::Overload => End::Named(Device::Accelerometer, Trouble::Saturated),
        Fault::NeverDrives | Fault::NeverStops | Fault::ShortStops => End::TooFewStops,
        Fault::Sway | Fault::Bumps => End::SurvivedOrNot,
        other => panic!("{other} is none of a vehicle"),
    }
}

/// The accelerometer's bus has no checksum: flipped bits make it look as if it had nothing new.
fn of_chip(device: Device, fault: ChipFault) -> End {
    let is_gyro = device != Device::Accelerometer;
    match fault {
        ChipFault::Identity => End::Named(device, Trouble::Identity),
        ChipFault::ChecksumAlways if is_gyro => End::Named(device, Trouble::Checksum),
        ChipFault::ChecksumAlways | ChipFault::Silent => End::Named(device, Trouble::Silent),
        ChipFault::Stuck => End::Named(device, Trouble::Stuck),
        ChipFault::BusAlways => End::Named(device, Trouble::Bus),
        // Gaps of up to half a second.
        ChipFault::Reset
        | ChipFault::Hang
        | ChipFault::ChecksumOnce
        | ChipFault::SilentOnce
        | ChipFault::BusOnce => End::Survived,
    }
}

fn run(fault: Fault) -> VehicleRun {
    let scenario = VehicleScenario { stops: 2, stop_s: 30.0, ..VehicleScenario::usual(1) };
    Trial::of(&scenario).fault(Some(fault)).run().expect("the scenario is possible")
}

fn verdict(found: &VehicleRun) -> Result<Azimuth, Refusal> {
    found.replay.conclusion().expect("every run concludes").verdict
}

/// What it came to.
fn end(found: &VehicleRun) -> Option<End> {
    match verdict(found) {
        Ok(azimuth) => {
            let off = azimuth.angle.0 - found.truth.attitude.azimuth_rad;
            let sigmas = off.sin().atan2(off.cos()) / azimuth.sigma.0;
            (sigmas.abs() < 3.5).then_some(End::Survived)
        }
        Err(Refusal::Device { device, trouble }) => Some(End::Named(device, trouble)),
        Err(Refusal::Stops(Stops::RotationClipped { .. })) => Some(End::Clipped),
        Err(Refusal::Stops(Stops::NoStop | Stops::OneStop { .. } | Stops::StopTooShort { .. })) => {
            Some(End::TooFewStops)
        }
        Err(_) => None,
    }
}

campaigns! {
    every_fault_is_survived_or_refused_for_its_reason_and_nothing_hangs;
}

fn every_fault_is_survived_or_refused_for_its_reason_and_nothing_hangs(extent: Extent) {
    // `cargo test` tries every fourth.
    let step = if extent == Extent::Whole { 1 } else { 4 };
    for fault in Fault::all(Platform::Vehicle).step_by(step) {
        let found = run(fault);
        let (end, expected) = (end(&found), expected(fault));
        let is_right = match expected {
            End::SurvivedOrNot => matches!(end, Some(End::Survived | End::TooFewStops)),
            expected => end == Some(expected),
        };
        assert!(is_right, "{fault}: {:?}, not {expected:?}", verdict(&found));
        assert!(found.seconds < 720.0, "{fault}: {} s", found.seconds);
        // Who asks a chip that has just lost its supply is too early, and learns so.
        if !matches!(fault, Fault::Chip(_, ChipFault::Reset)) {
            assert_eq!(found.violations, [""; 0], "{fault}");
        }
    }
}

#[test]
fn one_lost_conversion_of_any_axis_is_missing_and_costs_sigma_alone() {
    let whole = verdict(&run(Fault::OverloadOnce)).expect("it loses no conversion").sigma;
    for device in [Device::ForwardGyro, Device::RightGyro, Device::DownGyro] {
        let found = run(Fault::Chip(device, ChipFault::ChecksumOnce));
        assert_eq!(found.health.missing, 1, "{device}");
        assert_eq!(end(&found), Some(End::Survived), "{device}: {:?}", verdict(&found));
        let sigma = verdict(&found).expect("it has survived").sigma;
        println!("{device}: {:.4}° of {:.4}°", sigma.degrees(), whole.degrees());
        assert!(sigma > whole && sigma.0 < 1.5 * whole.0, "{device}: {sigma:?} of {whole:?}");
    }
}

#[test]
fn a_converter_that_comes_late_is_named_and_the_others_are_not_blamed() {
    let found = run(Fault::OutOfStep);
    let lines: Vec<String> = found.events.iter().map(|(_, event)| event.to_string()).collect();
    let stray = "right gyro: reading lost: out of step with the others";
    assert!(lines.iter().any(|line| line == stray), "{lines:?}");
    let again = "right gyro: out of step with the others: starting it again";
    assert_eq!(lines.iter().filter(|line| *line == again).count(), 5);
    let others = [
        "forward gyro: out of",
        "down gyro: out of",
        "forward gyro: reading",
        "down gyro: reading",
    ];
    let is_blamed = |line: &&String| others.iter().any(|other| line.starts_with(other));
    assert_eq!(lines.iter().find(is_blamed), None);
}

#[test]
fn every_fault_has_a_name_of_its_own() {
    let mut names: Vec<String> =
        Fault::all(Platform::Vehicle).map(|fault| fault.to_string()).collect();
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!((names.len(), count), (51, 51));
}
