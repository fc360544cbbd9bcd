//! The azimuth is found anew at stops.

use super::{drive, frames, keep, reported, sigmas, vehicle};
use firmware::event::Event;
use host::instrument::kept::KeptPlan;
use orientation::attitude::Realigned;
use orientation::navigation::Progress;
use simulated::hold::Hold;

#[test]
fn the_stop_that_ends_a_session_in_a_vehicle_begins_the_next() {
    for seed in [2, 3] {
        let hold = Hold { realigns: true, drive_s: 480.0, stop_s: 100.0, ..Hold::of(1500.0) };
        let found = drive(&vehicle(seed, hold));
        let handed = |(_, event): &(_, Event)| match event {
            Event::Navigation(Progress::HandedOver(_, outcome)) => Some(*outcome),
            _ => None,
        };
        let outcomes: Vec<Realigned> = found.run.events.iter().filter_map(handed).collect();
        let is_fused = matches!(outcomes[..], [Realigned::Taken, Realigned::Fused { .. }, ..]);
        assert!(is_fused, "seed {seed}: {outcomes:?}");
        let [worst, _] = sigmas(&found.run.kept);
        assert!(worst < 4.5, "seed {seed}: {worst} σ");
    }
}

#[test]
fn a_mount_returns_to_gyrocompassing_where_the_vehicle_stands_and_back_to_the_vertical() {
    let hold = Hold { realigns: true, drive_s: 100.0, stop_s: 320.0, ..Hold::of(500.0) };
    let found = keep(&frames(1, hold), &KeptPlan::of(None));
    let lines = reported(&found.run);
    let fused = lines.iter().position(|line| line.starts_with("realigned: "));
    let fused = fused.unwrap_or_else(|| panic!("it is realigned: {lines:#?}"));
    assert!(lines[..fused].iter().any(|line| line == "the vehicle stands: aligning anew"));
    assert!(lines[fused..].iter().any(|line| line.starts_with("gyro vertical")));
    let [worst, _] = sigmas(&found.run.kept);
    assert!(worst < 4.0, "{worst} σ");
}

#[test]
fn a_vehicle_that_drives_on_ends_the_new_alignment_and_keeps_the_azimuth() {
    let hold = Hold { realigns: true, drive_s: 100.0, stop_s: 80.0, ..Hold::of(400.0) };
    let found = keep(&frames(2, hold), &KeptPlan::of(None));
    let lines = reported(&found.run);
    assert!(
        lines.iter().any(|line| line == "no azimuth: the vehicle drove on before it was aligned")
    );
    assert!(found.run.kept.last().is_some_and(|point| point.report.azimuth.is_some()));
    let [worst, _] = sigmas(&found.run.kept);
    assert!(worst < 4.0, "{worst} σ");
}

#[test]
fn an_azimuth_that_disagrees_is_reported_and_never_fused() {
    let wrong = Hold { handover: Some(([12.0, 0.1], 1600.0)), ..Hold::of(300.0) };
    let found = drive(&vehicle(1, wrong));
    let lines = reported(&found.run);
    let line = lines.iter().find(|line| line.contains("disagrees with what was kept"));
    assert!(line.is_some_and(|line| line.ends_with("neither is believed")), "{lines:#?}");
    assert!(lines.iter().any(|line| line.contains("the azimuth is lost")));
    assert!(found.run.kept.last().is_some_and(|point| point.report.azimuth.is_none()));
}
