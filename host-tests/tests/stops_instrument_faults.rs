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

#[test]
fn explore_classes() {
    use firmware::simulated::scenario::{GyroClass, Scenario};
    let classes = [
        ("fog", GyroClass::FIBRE_OPTIC),
        ("coarse", GyroClass::FIBRE_OPTIC_COARSE),
        ("ln200", GyroClass { n_deg_sqrt_h: 0.05, b_deg_h: 0.1, k_deg_h_sqrt_h: 0.0, bias_sigma_deg_h: 1.0 }),
    ];
    for (name, gyro) in classes {
        for seed in 1..10 {
            let usual = VehicleScenario::usual(seed);
            let scenario = VehicleScenario { base: Scenario { gyro, ..usual.base }, ..usual };
            let found = align_stops(&scenario, None, NoRecorder, &()).expect("possible");
            let conclusion = found.run.replay.conclusion().expect("concludes");
            let said = match conclusion.verdict {
                Ok(azimuth) => {
                    let off = azimuth.angle - found.truth.attitude.azimuth_rad;
                    format!("{:.2} sigma of {:.4}", off.sin().atan2(off.cos()) / azimuth.sigma, azimuth.sigma.to_degrees())
                }
                Err(reason) => reason.to_string(),
            };
            println!("{name} {seed}: {said}");
            if conclusion.verdict.is_err() {
                for (at, event) in &found.run.events {
                    println!("   {:10.3} {event}", at.as_micros() as f64 * 1e-6);
                }
            }
        }
    }
}
