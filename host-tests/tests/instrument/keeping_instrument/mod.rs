//! The instrument goes on after its alignment: it keeps what it found, on a vehicle, two frames and a stage.

mod behind;
mod faults;
mod handing;
mod healthy;
mod learning;
mod realigning;
mod recalling;
mod remembering;
mod restart;
mod restarting;
mod showing;

use embassy_time::Instant;
use firmware::event::Event;
use host::instrument::kept::{Kept, KeptPlan};
use host::instrument::{FramesRun, Run, Trial, VehicleRun};
use simulated::hold::Hold;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::vehicle::VehicleScenario;

/// A vehicle that goes on like this.
fn vehicle(seed: u64, hold: Hold) -> VehicleScenario {
    let usual = VehicleScenario::usual(seed);
    VehicleScenario { base: Scenario { hold, ..usual.base }, ..usual }
}

fn drive(scenario: &VehicleScenario) -> VehicleRun {
    Trial::of(scenario).run().expect("the scenario is possible")
}

/// Two passes of a mount on a base with a coarse IMU, at 100 Hz.
fn frames(seed: u64, hold: Hold) -> FramesScenario {
    let base =
        Scenario { hold, has_base_imu: true, sample_rate_hz: 100.0, ..Scenario::usual(seed) };
    FramesScenario { base, passes: 2, ..FramesScenario::default() }
}

fn keep(scenario: &FramesScenario, plan: &KeptPlan) -> FramesRun {
    Trial::of(scenario).plan(plan.clone()).run().expect("the scenario is possible")
}

/// When the base sets off, s.
fn departure(scenario: &FramesScenario) -> f64 {
    scenario
        .base
        .day(scenario.alignment_seconds())
        .legs
        .first()
        .map_or(0.0, hal_mock::vehicle::Leg::seconds)
}

/// What was reported.
fn reported<R, T>(run: &Run<R, T>) -> Vec<String> {
    run.events.iter().map(|(_, event)| event.to_string()).collect()
}

/// When the first event of a kind was reported, s.
fn when<R, T>(run: &Run<R, T>, is_it: impl Fn(&Event) -> bool) -> Option<f64> {
    let seconds = |at: &Instant| at.as_micros() as f64 * 1e-6;
    run.events.iter().find(|(_, event)| is_it(event)).map(|(at, _)| seconds(at))
}

/// The greatest error in σ, and the share of errors within three.
fn sigmas(kept: &Kept) -> [f64; 2] {
    let all: Vec<f64> =
        kept.with_azimuth().map(|(_, [error, sigma])| error.abs() / sigma).collect();
    let within = all.iter().filter(|sigmas| **sigmas <= 3.0).count();
    [all.iter().copied().fold(0.0, f64::max), within as f64 / all.len().max(1) as f64]
}

/// Errors of the azimuth, 1σ and the greater of pitch and roll at a time, °.
fn at(kept: &Kept, seconds: f64) -> [Option<f64>; 3] {
    let point = kept.points.iter().find(|point| point.seconds() >= seconds);
    let point = point.expect("it was kept until then");
    let azimuth = point.azimuth_error();
    let [pitch, roll] = point.level_error();
    [
        azimuth.map(|[error, _]| error.to_degrees()),
        azimuth.map(|[_, sigma]| sigma.to_degrees()),
        Some(pitch.abs().max(roll.abs()).to_degrees()),
    ]
}
