//! The instrument in a vehicle with something wrong: every fault is survived or refused for its reason.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

use bench::instrument::{VehicleRun, align_stops};
use firmware::ports::NoRecorder;
use firmware::simulated::vehicle::VehicleScenario;
use firmware::simulated::vehicle::fault::VehicleFault;

fn run(fault: VehicleFault) -> VehicleRun {
    let scenario = VehicleScenario { stops: 2, stop_s: 30.0, ..VehicleScenario::usual(1) };
    align_stops(&scenario, Some(fault), NoRecorder, &()).expect("the scenario is possible")
}

#[test]
fn explore() {
    for fault in VehicleFault::all() {
        let found = run(fault);
        let conclusion = found.run.replay.conclusion().expect("concludes");
        let said = match conclusion.verdict {
            Ok(azimuth) => {
                let off = azimuth.angle - found.truth.attitude.azimuth_rad;
                format!("{:.2} sigma", off.sin().atan2(off.cos()) / azimuth.sigma)
            }
            Err(reason) => reason.to_string(),
        };
        println!("{fault:32} {said} | {:?} {:.0} s {:?}", found.run.health, found.run.seconds, found.run.violations);
    }
}
