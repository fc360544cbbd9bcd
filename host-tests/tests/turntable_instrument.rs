//! The whole instrument on a turning platform.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]
use bench::instrument::align_turning;
use firmware::ports::NoRecorder;
use firmware::simulated::fault::Fault;
use firmware::simulated::turntable::TurntableScenario;

#[test]
fn try_it() {
    let fault = std::env::var("FAULT").ok();
    let fault = Fault::all().find(|f| Some(f.to_string()) == fault);
    let scenario = match std::env::var("KIND").as_deref() { Ok("met") => TurntableScenario::molecular(1), Ok("usual") => TurntableScenario::usual(1), _ => TurntableScenario::brief(1) };
    let run = align_turning(&scenario, fault, NoRecorder, &()).expect("possible");
    for (at, event) in &run.events {
        println!("{:.3} {event}", at.as_micros() as f64 * 1e-6);
    }
    println!("{:?}", run.replay.conclusion());
    println!("{:?} {:?} {}", run.health, run.violations, run.seconds);
}
