//! The instrument in a vehicle with something wrong: every fault is survived or refused for its reason,
//! and no rotation that was lost is hidden.

use bench::instrument::{VehicleRun, align_stops};
use firmware::ports::NoRecorder;
use firmware::simulated::fault::Sickness;
use firmware::simulated::vehicle::VehicleScenario;
use firmware::simulated::vehicle::fault::VehicleFault;
use hal_mock::chip::Select;
use orientation::align::conclusion::Azimuth;
use orientation::device::{Device, Trouble};
use orientation::error::Refusal;

/// What a fault must come to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// An azimuth within 3.5 σ.
    Survived,
    /// The device is given up for its reason.
    Named(Device, Trouble),
    /// Rotation was lost, and the session was told.
    Lost,
    /// A gyro clipped.
    Clipped,
    /// It did not stand, or drive, as it must: in the time allowed too few stops were found.
    TooFewStops,
    /// The sensors could not tell rest from motion, or could: either is honest.
    SurvivedOrNot,
}

fn expected(fault: VehicleFault) -> End {
    match fault {
        VehicleFault::Chip(select, sickness) => of_chip(select, sickness),
        VehicleFault::OutOfStep => End::Named(Device::RightGyro, Trouble::OutOfStep),
        VehicleFault::SaturationOnce | VehicleFault::Saturation => End::Clipped,
        VehicleFault::OverloadOnce => End::Survived,
        VehicleFault::Overload => End::Named(Device::Accelerometer, Trouble::Saturated),
        VehicleFault::Overflow => End::Lost,
        VehicleFault::NeverDrives | VehicleFault::NeverStops | VehicleFault::ShortStops => {
            End::TooFewStops
        }
        VehicleFault::Sway | VehicleFault::Bumps => End::SurvivedOrNot,
    }
}

/// The accelerometer's bus has no checksum: flipped bits make it look as if it had nothing new.
fn of_chip(select: Select, sickness: Sickness) -> End {
    let device = match select {
        Select::Gyro => Device::ForwardGyro,
        Select::GyroRight => Device::RightGyro,
        Select::GyroDown => Device::DownGyro,
        _ => Device::Accelerometer,
    };
    let is_gyro = device != Device::Accelerometer;
    match sickness {
        Sickness::Identity => End::Named(device, Trouble::Identity),
        Sickness::ChecksumAlways if is_gyro => End::Named(device, Trouble::Checksum),
        Sickness::ChecksumAlways | Sickness::Silent => End::Named(device, Trouble::Silent),
        Sickness::Stuck => End::Named(device, Trouble::Stuck),
        Sickness::BusAlways => End::Named(device, Trouble::Bus),
        Sickness::Reset | Sickness::Hang => End::Lost,
        Sickness::ChecksumOnce | Sickness::SilentOnce | Sickness::BusOnce if is_gyro => End::Lost,
        Sickness::ChecksumOnce | Sickness::SilentOnce | Sickness::BusOnce => End::Survived,
    }
}

fn run(fault: VehicleFault) -> VehicleRun {
    let scenario = VehicleScenario { stops: 2, stop_s: 30.0, ..VehicleScenario::usual(1) };
    align_stops(&scenario, Some(fault), NoRecorder, &()).expect("the scenario is possible")
}

fn verdict(found: &VehicleRun) -> Result<Azimuth, Refusal> {
    found.run.replay.conclusion().expect("every run concludes").verdict
}

/// What it came to.
fn end(found: &VehicleRun) -> Option<End> {
    match verdict(found) {
        Ok(azimuth) => {
            let off = azimuth.angle - found.truth.attitude.azimuth_rad;
            let sigmas = off.sin().atan2(off.cos()) / azimuth.sigma;
            (sigmas.abs() < 3.5).then_some(End::Survived)
        }
        Err(Refusal::Device { device, trouble }) => Some(End::Named(device, trouble)),
        Err(Refusal::RotationMissing { .. }) => Some(End::Lost),
        Err(Refusal::RotationClipped { .. }) => Some(End::Clipped),
        Err(Refusal::NoStop | Refusal::OneStop { .. } | Refusal::StopTooShort { .. }) => {
            Some(End::TooFewStops)
        }
        Err(_) => None,
    }
}

#[test]
fn every_fault_is_survived_or_refused_for_its_reason_and_nothing_hangs() {
    for fault in VehicleFault::all() {
        let found = run(fault);
        let (end, expected) = (end(&found), expected(fault));
        let is_right = match expected {
            End::SurvivedOrNot => matches!(end, Some(End::Survived | End::TooFewStops)),
            expected => end == Some(expected),
        };
        assert!(is_right, "{fault}: {:?}, not {expected:?}", verdict(&found));
        assert!(found.run.seconds < 720.0, "{fault}: {} s", found.run.seconds);
        // Who asks a chip that has just lost its supply is too early, and learns so.
        if !matches!(fault, VehicleFault::Chip(_, Sickness::Reset)) {
            assert_eq!(found.run.violations, [""; 0], "{fault}");
        }
    }
}

#[test]
fn one_lost_conversion_of_any_axis_is_told_as_a_gap_of_its_length() {
    for select in [Select::Gyro, Select::GyroRight, Select::GyroDown] {
        let found = run(VehicleFault::Chip(select, Sickness::ChecksumOnce));
        assert_eq!(found.run.health.missing, 1, "{select:?}");
        let Err(Refusal::RotationMissing { seconds, .. }) = verdict(&found) else {
            panic!("{select:?}: {:?}", verdict(&found));
        };
        assert!((seconds - 0.02).abs() < 1e-4, "{select:?}: {seconds} s");
    }
}

#[test]
fn a_converter_that_comes_late_is_named_and_the_others_are_not_blamed() {
    let found = run(VehicleFault::OutOfStep);
    let lines: Vec<String> = found.run.events.iter().map(|(_, event)| event.to_string()).collect();
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
    let mut names: Vec<String> = VehicleFault::all().map(|fault| fault.to_string()).collect();
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!((names.len(), count), (51, 51));
}
