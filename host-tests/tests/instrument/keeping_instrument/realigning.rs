//! The azimuth is found anew at stops.

use rayon::prelude::*;

use super::{drive, frames, keep, reported, sigmas, vehicle};
use firmware::event::Event;
use host::campaign::statistics::rms;
use host::instrument::Trial;
use host::instrument::kept::KeptPlan;
use host::output::azimuth_error;
use orientation::attitude::Realigned;
use orientation::navigation::Progress;
use simulated::hold::Hold;
use simulated::scenario::{Aim, Scenario};
use simulated::turntable::TurntableScenario;

use crate::support::campaign::{Extent, campaigns};

#[test]
fn the_stop_that_ends_a_session_in_a_vehicle_begins_the_next() {
    for seed in [2, 3] {
        let hold = Hold { realigns: true, drive_s: 480.0, stop_s: Some(100.0), ..Hold::of(1500.0) };
        let found = drive(&vehicle(seed, hold));
        let handed = |(_, event): &(_, Event)| match event {
            Event::Navigation(Progress::HandedOver(_, outcome)) => Some(*outcome),
            _ => None,
        };
        let outcomes: Vec<Realigned> = found.events.iter().filter_map(handed).collect();
        let is_fused = matches!(outcomes[..], [Realigned::Taken, Realigned::Fused { .. }, ..]);
        assert!(is_fused, "seed {seed}: {outcomes:?}");
        let [worst, _] = sigmas(&found.kept);
        assert!(worst < 4.5, "seed {seed}: {worst} σ");
    }
}

#[test]
fn an_alignment_that_ends_in_motion_has_the_truth_of_its_last_sample_and_a_budget_that_adds_up() {
    for seed in [2, 6] {
        // Its stops are too short for it, so that its time ends in the middle of a drive.
        let hold = Hold { realigns: true, stop_s: Some(60.0), ..Hold::of(1800.0) };
        let run = drive(&vehicle(seed, hold));
        assert!(run.is_realigned(), "seed {seed}");
        let conclusion = run.replay.conclusion().expect("it is over");
        let azimuth = conclusion.verdict.expect("it is aligned anew");
        let sigma = azimuth.sigma.0;
        // The vehicle turns by degrees until the next second.
        let truth_deg = run.azimuth_rad().to_degrees();
        let error = azimuth_error(azimuth.angle.degrees(), truth_deg).to_radians();
        assert!(error.abs() < 5.0 * sigma, "seed {seed}: {} σ", error / sigma);
        let budget = conclusion.found.as_ref().expect("there is a solution").budget;
        assert!((budget.sigma().0 / sigma - 1.0).abs() < 1e-6, "seed {seed}: {budget:?}");
    }
}

#[test]
fn what_sensors_on_a_swaying_base_showed_on_the_way_is_not_in_the_alignment_after_it() {
    let errors: Vec<f64> = (1..=6)
        .into_par_iter()
        .map(|seed| {
            let hold = Hold { realigns: true, ..Hold::of(1500.0) };
            let sways = Scenario { sway_deg: 0.2, has_base_imu: true, ..Scenario::usual(seed) };
            let base = Scenario { sample_rate_hz: 100.0, hold, ..sways };
            let run = Trial::of(&base).run().expect("the scenario is possible");
            assert!(run.is_realigned(), "seed {seed}: {:?}", reported(&run));
            let azimuth = run.conclusion().expect("it is over").verdict.expect("it is found");
            let truth_deg = run.azimuth_deg(base.azimuth_deg);
            azimuth_error(azimuth.angle.degrees(), truth_deg) / azimuth.sigma.degrees()
        })
        .collect();
    println!("{errors:.1?}");
    assert!(errors.iter().all(|error| error.abs() < 4.0), "{errors:?}");
    assert!(rms(&errors) < 1.6, "{errors:?}");
}

campaigns! {
    azimuths_found_anew_are_as_good_as_sigma_says;
}

fn azimuths_found_anew_are_as_good_as_sigma_says(extent: Extent) {
    let runs = extent.of(60);
    let sigmas = |seed: u64| {
        let run = drive(&vehicle(seed, Hold { realigns: true, ..Hold::of(1800.0) }));
        assert!(run.is_realigned(), "seed {seed}");
        let azimuth = run.replay.conclusion().and_then(|conclusion| conclusion.verdict.ok());
        let azimuth = azimuth.expect("the latest alignment found an azimuth");
        let truth_deg = run.azimuth_rad().to_degrees();
        azimuth_error(azimuth.angle.degrees(), truth_deg) / azimuth.sigma.degrees()
    };
    let all: Vec<f64> = (0..runs as u64).into_par_iter().map(sigmas).collect();
    let within = [1.0, 2.0, 3.0].map(|most| {
        let inside = all.iter().filter(|sigmas| sigmas.abs() <= most).count();
        100.0 * inside as f64 / runs as f64
    });
    let off = rms(&all);
    let [one, two, three] = within.map(|share| format!("{share:.1}"));
    extent.assert_in_accuracy(&[format!(
        "RMS of error over σ {off:.2}, within 1, 2, 3 σ {one}, {two}, {three} %"
    )]);
    assert!((off - 1.0).abs() < extent.rms(0.25, runs), "{off}");
}

#[test]
fn a_mount_returns_to_gyrocompassing_where_the_vehicle_stands_and_back_to_the_vertical() {
    let hold = Hold { realigns: true, drive_s: 100.0, stop_s: Some(320.0), ..Hold::of(500.0) };
    let found = keep(&frames(1, hold), &KeptPlan::of(None));
    let lines = reported(&found);
    let fused = lines.iter().position(|line| line.starts_with("realigned: "));
    let fused = fused.unwrap_or_else(|| panic!("it is realigned: {lines:#?}"));
    assert!(lines[..fused].iter().any(|line| line == "the vehicle stands: aligning anew"));
    assert!(lines[fused..].iter().any(|line| line.starts_with("gyro vertical")));
    let [worst, _] = sigmas(&found.kept);
    assert!(worst < 4.0, "{worst} σ");
}

/// A stage whose vehicle stops for as long as another alignment takes.
fn stage(hold: Hold) -> Scenario {
    Scenario { hold, has_base_imu: true, sample_rate_hz: 100.0, ..Scenario::usual(4) }
}

#[test]
fn a_stage_and_a_turntable_align_anew_where_the_vehicle_stands_for_as_long_as_that_takes() {
    let hold = Hold { realigns: true, drive_s: 100.0, ..Hold::of(1000.0) };
    let on_stage = Trial::of(&stage(hold)).run().expect("the scenario is possible");
    let usual = TurntableScenario::default();
    let turntable = TurntableScenario { base: stage(hold), turns: 4, ..usual };
    let turning = Trial::of(&turntable).run().expect("the scenario is possible");
    for (name, lines, kept) in [
        ("stage", reported(&on_stage), &on_stage.kept),
        ("turntable", reported(&turning), &turning.kept),
    ] {
        let realigned = lines.iter().filter(|line| line.starts_with("realigned: ")).count();
        assert!(realigned >= 2, "{name}: {lines:#?}");
        let [worst, _] = sigmas(kept);
        assert!(worst < 4.0, "{name}: {worst} σ");
    }
}

#[test]
fn the_truth_of_an_alignment_at_a_later_stop_is_that_of_the_stop() {
    let hold = Hold { realigns: true, drive_s: 100.0, ..Hold::of(400.0) };
    let scenario = frames(1, hold);
    let run = keep(&scenario, &KeptPlan::of(None));
    let found = run.conclusion().and_then(|conclusion| conclusion.verdict.ok());
    let azimuth = found.expect("it is aligned anew");
    let first_deg = scenario.base.azimuth_deg;
    let error = |truth_deg: f64| azimuth_error(azimuth.angle.degrees(), truth_deg).abs();
    let sigma_deg = azimuth.sigma.degrees();
    assert!(error(first_deg) > 100.0 * sigma_deg, "the vehicle did not turn");
    assert!(error(run.azimuth_deg(first_deg)) < 4.0 * sigma_deg);
}

#[test]
fn a_base_stays_until_an_alignment_in_a_stated_time_has_ended() {
    for seconds in [300.0, 1200.0] {
        let usual = stage(Hold::of(5.0));
        let run = Trial::of(&Scenario { aim: Aim::Time(seconds), ..usual }).run();
        let lines = reported(&run.expect("the scenario is possible"));
        assert!(lines.iter().any(|line| line.contains("it is kept")), "{seconds} s: {lines:#?}");
    }
}

#[test]
fn a_vehicle_that_drives_on_ends_the_new_alignment_and_keeps_the_azimuth() {
    let hold = Hold { realigns: true, drive_s: 100.0, stop_s: Some(80.0), ..Hold::of(400.0) };
    let found = keep(&frames(2, hold), &KeptPlan::of(None));
    let lines = reported(&found);
    assert!(
        lines.iter().any(|line| line == "no azimuth: it was in motion after a rest before it was aligned: the vehicle drove on, or it sways")
    );
    assert!(found.kept.last().is_some_and(|point| point.report.azimuth.is_some()));
    let [worst, _] = sigmas(&found.kept);
    assert!(worst < 4.0, "{worst} σ");
}

#[test]
fn an_azimuth_that_disagrees_is_reported_and_never_fused() {
    let wrong = Hold { handover: Some(([12.0, 0.1], 1600.0)), ..Hold::of(300.0) };
    let found = drive(&vehicle(1, wrong));
    let lines = reported(&found);
    let line = lines.iter().find(|line| line.contains("disagrees with what was kept"));
    assert!(line.is_some_and(|line| line.ends_with("neither is believed")), "{lines:#?}");
    assert!(lines.iter().any(|line| line.contains("the azimuth is lost")));
    assert!(found.kept.last().is_some_and(|point| point.report.azimuth.is_none()));
}
