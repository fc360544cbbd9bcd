//! The whole instrument on simulated chips: it finds north, repeats itself bit for bit, records what
//! it saw, tells what it did, and never reports a wrong north.

use std::path::PathBuf;
use std::thread;

use firmware::event::Event;
use host::instrument::recorder::{self, Samples};
use host::instrument::{Run, Trial};
use host::methods::asked::Asked;
use host::methods::stepwise::replay;
use host::output::azimuth_error;
use host::recording::{self, Header};
use orientation::alignment::stepwise::conclusion::Conclusion;
use simulated::scenario::Scenario;

use crate::support::files::Scratch;
use crate::support::link::states;

/// A short alignment, for what does not depend on its length.
fn short(seed: u64) -> Scenario {
    Scenario { seed, sample_rate_hz: 100.0, positions: 8, dwell_s: 4.0, ..Scenario::default() }
}

fn run(scenario: &Scenario) -> Run {
    Trial::of(scenario).run().expect("the scenario is possible")
}

fn conclusion(run: &Run) -> &Conclusion {
    run.conclusion().expect("every run concludes")
}

/// All that a run found, as bits.
fn bits(run: &Run) -> Vec<u64> {
    let azimuth = conclusion(run).verdict.expect("a healthy run");
    let dwells = run.replay.session.dwells().iter();
    let mut bits: Vec<u64> = dwells
        .flat_map(|dwell| {
            [u64::from(dwell.stage.0), dwell.rate.0.to_bits(), dwell.middle.0.to_bits()]
        })
        .collect();
    bits.extend([azimuth.angle.0.to_bits(), azimuth.sigma.0.to_bits()]);
    bits
}

#[test]
fn the_default_run_finds_north_and_breaks_no_rule_of_a_chip() {
    let scenario = Scenario::default();
    let run = run(&scenario);
    let azimuth = conclusion(&run).verdict.expect("a healthy run");
    let error = azimuth_error(azimuth.angle.degrees(), scenario.azimuth_deg);
    assert!(error.abs() < 4.0 * azimuth.sigma.degrees(), "off by {error}°");
    assert_eq!(run.violations, Vec::<String>::new());
    assert_eq!(run.health.faults(), 0, "{:?}", run.health);
    assert_eq!(run.replay.session.dwells().len(), 25);
    let tilt = &conclusion(&run).tilt;
    assert!((tilt.pitch().degrees() - scenario.pitch_deg).abs() < 0.01);
    assert!((tilt.roll().degrees() - scenario.roll_deg).abs() < 0.01);
}

#[test]
fn a_seed_gives_one_run_and_another_seed_another() {
    assert_eq!(bits(&run(&short(3))), bits(&run(&short(3))));
    assert_ne!(bits(&run(&short(3))), bits(&run(&short(4))));
}

#[test]
fn four_runs_side_by_side_give_their_single_runs_results() {
    let single: Vec<Vec<u64>> = (1..=4).map(|seed| bits(&run(&short(seed)))).collect();
    let threads = [1, 2, 3, 4].map(|seed| thread::spawn(move || bits(&run(&short(seed)))));
    let side_by_side: Vec<Vec<u64>> =
        threads.into_iter().map(|thread| thread.join().expect("it does not panic")).collect();
    assert_eq!(side_by_side, single);
}

#[test]
fn a_recorded_run_replays_to_the_same_azimuth_without_what_its_session_was_given() {
    for scenario in [short(5), Scenario { sample_rate_hz: 400.0, ..short(6) }] {
        let scratch = Scratch::new("recorded");
        let path = PathBuf::from(scratch.path("recorded.csv"));
        let mut samples = Samples::default();
        let run = Trial::of(&scenario).record(&mut samples).run().expect("it is possible");
        recorder::write(&path, &scenario, &run, &samples.taken).expect("the folder is ours");
        let (header, body, truth) = recording::read(&path).expect("it is well-formed").into_parts();
        assert_eq!(truth.azimuth_deg, Some(scenario.azimuth_deg));
        let header = Header { session: None, ..header };
        let again = replay(&header, &body, &Asked::default(), |_| {}).expect("it has dwells");
        let again = again.session.conclusion().and_then(|c| c.verdict.ok()).expect("as healthy");
        let found = conclusion(&run).verdict.expect("a healthy run");
        let apart = azimuth_error(again.angle.degrees(), found.angle.degrees()).abs();
        assert!(apart < 0.1 * found.sigma.degrees(), "{apart}° of σ {}°", found.sigma.degrees());
        assert!((again.sigma.0 / found.sigma.0 - 1.0).abs() < 0.02);
    }
}

#[test]
fn the_log_tells_what_the_board_did_in_order() {
    let run = run(&short(1));
    let reported: Vec<String> = run.events.iter().map(|(_, event)| event.to_string()).collect();
    let mut rest = reported.iter();
    for part in [
        "begin: 9 positions of 4.0 s at latitude 47.58",
        "identity and self-test passed",
        "looking for its index",
        "index found at -",
        "stage: to 0.000°",
        "stage: stands at ",
        "level: platform inclined",
        "dwell 1 of 9",
        "stage: to 45.000°",
        "stage: to 360.000°",
        "dwell 9 of 9",
        "azimuth 213.",
    ] {
        assert!(
            rest.any(|line| line.contains(part)),
            "{part} is missing or misplaced in {reported:#?}"
        );
    }
    assert!(run.events.is_sorted_by_key(|(at, _)| *at));
    let states = states(&run.lines);
    assert!(states.iter().any(|state| state[0] == "aligning" && state[6..8] == ["5", "9"]));
    assert!(states.iter().all(|state| state[4] == "0"), "{}", run.lines);
}

#[test]
fn nothing_is_reported_of_a_healthy_run_that_is_not_so() {
    let run = run(&short(2));
    let wrong = run.events.iter().find(|(_, event)| {
        matches!(
            event,
            Event::Lost(..) | Event::Restarting(..) | Event::Missing(_) | Event::Late(_)
        )
    });
    assert_eq!(wrong, None);
}
