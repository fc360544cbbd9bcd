//! The whole instrument in a vehicle, on simulated chips: a healthy run, what the log tells, and what a
//! lost conversion costs.

use crate::support::link::words;
use firmware::event::Event;
use host::instrument::{Trial, VehicleRun};
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::{Progress, stops};
use orientation::units::Radians;
use simulated::fault::Fault;
use simulated::vehicle::{Place, VehicleScenario};

fn run(scenario: &VehicleScenario, fault: Option<Fault>) -> VehicleRun {
    Trial::of(scenario).fault(fault).run().expect("the scenario is possible")
}

fn verdict(found: &VehicleRun) -> Result<Azimuth, Refusal> {
    found.replay.conclusion().expect("every run concludes").verdict
}

/// What was reported, without the times.
fn reported(found: &VehicleRun) -> Vec<String> {
    found.events.iter().map(|(_, event)| event.to_string()).collect()
}

/// Error of the azimuth, rad, the short way.
fn error(found: &VehicleRun, azimuth: &Azimuth) -> f64 {
    let off = azimuth.angle.0 - found.truth.attitude.azimuth_rad;
    off.sin().atan2(off.cos())
}

#[test]
fn north_is_found_within_its_sigma_and_no_rule_of_a_chip_is_broken() {
    let mut squares = 0.0;
    for seed in 1..=4 {
        let found = run(&VehicleScenario::usual(seed), None);
        let azimuth = verdict(&found).unwrap_or_else(|reason| panic!("seed {seed}: {reason}"));
        let sigmas = error(&found, &azimuth) / azimuth.sigma.0;
        assert!(sigmas.abs() < 3.5, "seed {seed}: {sigmas} σ");
        assert!(azimuth.sigma.degrees() < 0.2, "seed {seed}: {}", azimuth.sigma.degrees());
        squares += sigmas * sigmas;
        assert_eq!(found.violations, [""; 0], "seed {seed}");
        assert_eq!(found.health.faults(), 0, "seed {seed}");
    }
    // Chi-square of 4 degrees of freedom: 0.09 and 16.9 are its 0.1 and 99.8 % points (scipy).
    assert!((0.09..16.9).contains(&squares), "{squares}");
}

#[test]
fn three_headings_tell_the_biases_that_the_gyros_have() {
    let found = run(&VehicleScenario::usual(1), None);
    let conclusion = found.replay.conclusion().expect("it concludes");
    let solved = conclusion.found.expect("something was found");
    let truth = found.truth.gyro_bias_rad_s;
    for ((bias, sigma), truth) in solved.biases.into_iter().zip(solved.bias_sigmas).zip(truth) {
        assert!((bias.0 - truth).abs() < 3.5 * sigma.0, "{bias:?} is not {truth} within {sigma:?}");
    }
    let of_gyros = reported(&found).iter().filter(|line| line.contains("gyro: bias ")).count();
    assert_eq!(of_gyros, if solved.are_biases_observed { 3 } else { 0 });
}

#[test]
fn the_log_tells_what_the_board_did_in_order() {
    let found = run(&VehicleScenario::usual(1), None);
    let lines = reported(&found);
    let expected = [
        "begin: level, drive, stop and level again",
        "accelerometer: identity and self-test passed",
        "forward gyro: identity and self-test passed",
        "right gyro: identity and self-test passed",
        "down gyro: identity and self-test passed",
        "stop 1 levelled for 6",
        "driving",
        "stop 2 found after 6",
        "stop 2 is ",
        "stop 2 levelled for 6",
        "driving",
        "stop 3 found after 6",
        "stop 3 is ",
    ];
    let mut following = lines.iter();
    for beginning in expected {
        let is_there = following.any(|line| line.starts_with(beginning));
        assert!(is_there, "{beginning} is missing or late: {lines:?}");
    }
    assert!(lines.last().is_some_and(|line| line.starts_with("azimuth ")), "{lines:?}");
    let told = words(&found.lines);
    let steps = ["levelling at stop 1", "stop 1 done; may drive", "driving", "levelling at stop 2"];
    assert_eq!(told[..4], steps, "nothing is homed, and each step is told once");
    assert!(told.last().is_some_and(|words| words.starts_with("azimuth ")), "{told:?}");
}

#[test]
fn a_stop_is_levelled_as_the_ground_lies_there() {
    let scenario = VehicleScenario::usual(1);
    let found = run(&scenario, None);
    let day = scenario.day(None);
    let hal_mock::vehicle::Leg::Stop(first) = day.legs[0] else { panic!("a day begins at rest") };
    let level = found.events.iter().find_map(|(_, event)| match event {
        Event::Alignment(Progress::Stops(stops::Progress::MayDrive(1, _, level))) => Some(*level),
        _ => None,
    });
    let [pitch, roll] = level.expect("the first stop is levelled").map(Radians::degrees);
    // 0.1 mg of bias is 0.006°; the road itself rocks for the first seconds.
    assert!((pitch - first.pitch_deg).abs() < 0.03, "{pitch} is not {}", first.pitch_deg);
    assert!((roll - first.roll_deg).abs() < 0.03, "{roll} is not {}", first.roll_deg);
}

#[test]
fn an_unknown_displacement_costs_accuracy_and_no_truth() {
    let sigma = |place| {
        let found = run(&VehicleScenario { place, ..VehicleScenario::usual(1) }, None);
        let azimuth = verdict(&found).unwrap_or_else(|reason| panic!("{reason}"));
        assert!(error(&found, &azimuth).abs() < 3.5 * azimuth.sigma.0);
        let is_reported = reported(&found).iter().any(|line| line.contains(" north and "));
        assert_eq!(is_reported, place != Place::Unknown);
        azimuth.sigma
    };
    assert!(sigma(Place::Unknown) > sigma(Place::Known { sigma_m: 2.0 }));
}

#[test]
fn a_seed_gives_one_run_and_another_seed_another() {
    let angle = |seed| verdict(&run(&VehicleScenario::usual(seed), None)).map(|found| found.angle);
    assert_eq!(angle(1), angle(1));
    assert_ne!(angle(1), angle(4));
}
