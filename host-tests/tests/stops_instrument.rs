//! The whole instrument in a vehicle, on simulated chips.

use bench::instrument::{VehicleRun, align_stops};
use firmware::ports::NoRecorder;
use firmware::simulated::vehicle::VehicleScenario;
use firmware::simulated::vehicle::fault::VehicleFault;

fn run(scenario: &VehicleScenario, fault: Option<VehicleFault>) -> VehicleRun {
    align_stops(scenario, fault, NoRecorder, &()).expect("the scenario is possible")
}

#[test]
fn explore() {
    let began = std::time::Instant::now();
    for seed in 1..4 {
        let scenario = VehicleScenario::usual(seed);
        let found = run(&scenario, None);
        for (at, event) in &found.run.events {
            println!("{:10.3} {event}", at.as_micros() as f64 * 1e-6);
        }
        println!("{}", found.run.lines.lines().last().unwrap());
        println!("truth {:?}", found.truth);
        println!("{:?} {:?}", found.run.health, found.run.violations);
        println!("{:?}", found.run.replay.conclusion().map(|c| &c.verdict));
        println!("{:?}", began.elapsed());
    }
}
