//! The instrument goes on after its alignment.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

use bench::instrument::kept::{Kept, KeptPlan};
use bench::instrument::{Run, VehicleRun, align_and_keep, align_frames_and_keep, align_stops};
use firmware::ports::NoRecorder;
use firmware::simulated::keep::Hold;
use firmware::simulated::mount::FramesScenario;
use firmware::simulated::scenario::Scenario;
use firmware::simulated::vehicle::VehicleScenario;

#[test]
fn probe_vehicle() {
    let base = Scenario { hold: Hold::of(600.0), ..VehicleScenario::usual(1).base };
    let found = run(&VehicleScenario { base, ..VehicleScenario::usual(1) });
    show(&found.run, &found.kept);
}

fn run(scenario: &VehicleScenario) -> VehicleRun {
    align_stops(scenario, None, NoRecorder, &()).expect("the scenario is possible")
}

fn show<R>(run: &Run<R>, kept: &Kept) {
    for (at, event) in &run.events {
        println!("{:>12.4} {event}", at.as_micros() as f64 * 1e-6);
    }
    for (point, [error, sigma]) in kept.with_azimuth().step_by(20) {
        println!(
            "{:>8.1} {:+.4} {:.4} {:?} {} {}",
            point.seconds(),
            error.to_degrees(),
            sigma.to_degrees(),
            point.level_error().map(f64::to_degrees),
            point.report.state,
            point.report.is_at_rest
        );
    }
    println!("{:?} {:?}", run.health, run.violations);
    println!("{}", &run.lines[run.lines.len() - 400..]);
}

#[test]
fn probe_stage() {
    let scenario = Scenario {
        hold: Hold::of(300.0),
        has_base_imu: true,
        positions: 8,
        dwell_s: 5.0,
        ..Scenario::usual(1)
    };
    let found =
        align_and_keep(&scenario, &KeptPlan::of(None), NoRecorder, &(), ()).expect("possible");
    show(&found.run, &found.kept);
}

#[test]
fn probe_frames() {
    let base = Scenario {
        hold: Hold { realigns: true, stop_s: 240.0, ..Hold::of(700.0) },
        has_base_imu: true,
        dwell_s: 5.0,
        ..Scenario::usual(1)
    };
    let scenario = FramesScenario { base, passes: 2, ..FramesScenario::default() };
    let found = align_frames_and_keep(&scenario, &KeptPlan::of(None), &(), ()).expect("possible");
    show(&found.run, &found.kept);
}
