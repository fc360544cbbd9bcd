//! Recordings of runs from the command line: a run gives the same with and without one, whatever it was asked for, and
//! a replay the same again.

use serde_json::Value;

use crate::support::files::Scratch;
use crate::support::program::{code, meridian, object, reason, text};

/// Short runs of every platform, with every option that a session is given beside its samples.
const RUNS: [&[&str]; 16] = [
    &["stage", "--rate=50", "--dwell=2"],
    &["stage", "--rate=50", "--dwell=2", "--hold=9", "--sway=0.1"],
    &["stage", "--rate=50", "--sigma=0.5"],
    &["stage", "--rate=50", "--sigma=0.001", "--seconds=100"],
    &["stage", "--rate=50", "--seconds=60", "--survey=60"],
    &["stage", "--rate=50", "--dwell=20", "--positions=2", "--half=west", "--gyro=mems"],
    &["stage", "--rate=50", "--dwell=2", "--fault=base-nudge"],
    // A sway that was not measured, one that takes the gyro to its lower limit, and a gyro that stays at it.
    &["stage", "--rate=50", "--dwell=2", "--fault=coarse-imu-identity"],
    &["stage", "--rate=50", "--dwell=2", "--sway=2", "--sway-hertz=5"],
    &["stage", "--rate=50", "--dwell=2", "--fault=saturation-always"],
    &["turntable", "--rate=50", "--turns=4", "--fault=saturation-always"],
    &["two-frame", "--rate=50", "--passes=2", "--dwell=2"],
    &["two-frame", "--rate=50", "--sigma=0.5"],
    &["turntable", "--rate=50", "--turns=4"],
    &["vehicle", "--rate=50", "--stops=2", "--stop-seconds=30"],
    &["spin", "--flight-seconds=0.6"],
];

/// What is found: all keys that no other kind of source changes.
fn found(mut object: Value) -> Value {
    let keys = object.as_object_mut().expect("it is an object");
    let of_the_source = ["seed", "file", "simulated_seconds", "health", "kept", "stored"];
    let of_the_mechanism = ["truth_off_vertical_deg", "recalled"];
    keys.retain(|key, _| !of_the_source.iter().chain(&of_the_mechanism).any(|other| key == other));
    object
}

/// The object of a command.
fn answered(arguments: &[&str]) -> Value {
    let output = meridian(&[arguments, &["--json"]].concat());
    assert!(code(&output) < 2, "{arguments:?}: {}", reason(&output));
    object(&output)
}

#[test]
fn a_run_gives_the_same_with_and_without_a_recording_and_its_replay_gives_it_again() {
    let scratch = Scratch::new("records");
    let path = scratch.path("run.csv.gz");
    for options in RUNS {
        let run = [&["run"], options].concat();
        let plain = answered(&run);
        let recorded = answered(&[&run[..], &["--record", &path]].concat());
        assert_eq!(recorded, plain, "{options:?}");
        let replayed = answered(&["replay", &path]);
        assert_eq!(found(replayed), found(plain), "{options:?}");
    }
}

#[test]
fn what_the_user_states_at_a_replay_takes_the_place_of_what_the_run_was_given() {
    let scratch = Scratch::new("stated");
    let path = scratch.path("run.csv");
    answered(&["run", "--rate=50", "--dwell=2", "--record", &path]);
    let refused = answered(&["replay", &path, "--require-sigma=1e-5"]);
    assert_eq!(refused["status"], "refused");
    let other = answered(&["replay", &path, "--criterion=least-squares"]);
    assert_eq!(other["criterion"], "least-squares");
}

#[test]
fn a_header_that_was_changed_after_the_run_is_refused_with_its_line() {
    let scratch = Scratch::new("changed");
    for options in [&["stage", "--rate=50", "--dwell=2"][..], &["spin", "--flight-seconds=0.6"]] {
        let path = scratch.path("run.csv");
        answered(&[&["run"], options, &["--record", &path]].concat());
        let recording = scratch.read("run.csv");
        let head = recording.lines().filter(|line| line.starts_with("# "));
        let of_truth = |line: &&str| line.contains("truth") || line.contains("kind");
        for line in head.filter(|line| !of_truth(line)) {
            // A digit that another one takes the place of.
            let digit = line.rfind(char::is_numeric).expect("it has a number");
            let other = if line[digit..].starts_with('1') { "2" } else { "1" };
            let changed = format!("{}{other}{}", &line[..digit], &line[digit + 1..]);
            let path = scratch.with("changed.csv", recording.replacen(line, &changed, 1));
            let output = meridian(&["replay", &path]);
            assert_eq!(code(&output), 1, "{changed}");
            let why = text(&output.stderr);
            assert!(why.contains("key session: the header was changed"), "{changed}: {why}");
        }
    }
}

#[test]
fn a_run_that_ends_before_its_first_sample_says_that_there_is_nothing_to_record() {
    let scratch = Scratch::new("nothing");
    let path = scratch.path("run.csv");
    let output = meridian(&["run", "stage", "--latitude=90", "--record", &path]);
    assert_eq!(code(&output), 1);
    let why = text(&output.stderr);
    assert!(why.contains("ended before its session got a sample"), "{why}");
}

#[test]
fn displacements_that_the_forces_of_a_recorded_drive_contradict_are_refused() {
    let scratch = Scratch::new("displaced");
    let path = scratch.path("run.csv");
    answered(&["run", "vehicle", "--rate=50", "--stops=2", "--stop-seconds=30", "--record", &path]);
    for wrong in ["0,0;-12000,-9000", "0,0;0,0", "0,0;-2.672,-2.023"] {
        let refused = answered(&["replay", &path, "--displacements", wrong]);
        assert_ne!(refused["status"], "ok", "{wrong}");
    }
    let right = answered(&["replay", &path, "--displacements", "0,0;-2672,-2023"]);
    assert_eq!(right["status"], "ok");
}

#[test]
fn a_run_by_the_name_of_its_method_is_that_of_its_platform() {
    let spin = ["--flight-seconds=0.6", "--json"];
    let of_platform = meridian(&[&["run", "spin"], &spin[..]].concat());
    for by_method in [&["--method", "spin"][..], &["--method=spin"]] {
        let of_method = meridian(&[&["run"], by_method, &spin].concat());
        assert_eq!(object(&of_method), object(&of_platform));
    }
    assert_eq!(code(&meridian(&["run", "--method", "vertical"])), 2);
}
