//! The instrument goes on after its alignment.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

use bench::instrument::{VehicleRun, align_stops};
use firmware::ports::NoRecorder;
use firmware::simulated::keep::Hold;
use firmware::simulated::vehicle::VehicleScenario;

fn run(scenario: &VehicleScenario) -> VehicleRun {
    align_stops(scenario, None, NoRecorder, &()).expect("the scenario is possible")
}

#[test]
fn probe() {
    let scenario = VehicleScenario { hold: Hold::of(600.0), ..VehicleScenario::usual(1) };
    let found = run(&scenario);
    for (at, event) in &found.run.events {
        println!("{:>12.4} {event}", at.as_micros() as f64 * 1e-6);
    }
    for (point, [error, sigma]) in found.kept.with_azimuth().step_by(20) {
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
    println!("{:?} {:?}", found.run.health, found.run.violations);
    println!("{}", &found.run.lines[found.run.lines.len() - 400..]);
}
