//! Recordings of runs from the command line: a run gives the same with and without one, whatever it was asked for, and
//! a replay the same again.

use serde_json::Value;

use crate::support::files::Scratch;
use crate::support::program::{
    assert_drawn, assert_misuse, code, meridian, object, page, reason, text,
};

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

/// What is found: all keys that no other kind of source changes. What is noted of a run holds faults of its board, too.
fn found(mut object: Value) -> Value {
    let keys = object.as_object_mut().expect("it is an object");
    let of_the_source =
        ["seed", "file", "simulated_seconds", "health", "fault", "noted", "kept", "stored"];
    let of_the_mechanism = ["truth_off_vertical_deg", "recalled"];
    keys.retain(|key, _| !of_the_source.iter().chain(&of_the_mechanism).any(|other| key == other));
    object
}

/// Short runs of every platform that keep what they found, align anew, take it from outside, or fail.
const KEEPING: [&[&str]; 15] = [
    &["stage", "--rate=50", "--dwell=2", "--positions=6", "--hold=9", "--sway=0.1"],
    &["stage", "--rate=50", "--dwell=2", "--realign", "--hold=700"],
    &["stage", "--rate=50", "--sigma=0.5", "--survey=60", "--hold=20"],
    &["stage", "--rate=50", "--dwell=20", "--positions=2", "--half=west", "--gyro=mems"],
    &["stage", "--latitude=90"],
    &["two-frame", "--rate=50", "--dwell=2", "--passes=1", "--realign", "--hold=700"],
    &["two-frame", "--rate=50", "--handover=213.7,0.16", "--hold=100"],
    &["two-frame", "--rate=50", "--sigma=0.5", "--survey=60", "--fault=base-nudge", "--hold=9"],
    &["turntable", "--rate=50", "--turns=3", "--realign", "--hold=700"],
    &["turntable", "--rate=50", "--handover=213.7,0.2"],
    &["turntable", "--rate=50", "--turns=3", "--modulated-turns=0"],
    &["turntable", "--rate=50", "--turns=4", "--fault=saturation-always", "--hold=9"],
    &["vehicle", "--rate=50", "--stops=2", "--stop-seconds=30", "--realign", "--hold=700"],
    &["vehicle", "--rate=50", "--handover=213.7,0.16", "--realign", "--hold=700"],
    &["vehicle", "--rate=50", "--stops=2", "--no-displacement", "--fault=never-drives"],
];

/// What both halves find: all keys but those of source and board.
fn of_halves(mut object: Value) -> Value {
    let keys = object.as_object_mut().expect("it is an object");
    let of_the_source = ["seed", "file", "simulated_seconds", "health", "fault", "recalled"];
    let of_the_mechanism = ["stored", "truth_off_vertical_deg"];
    keys.retain(|key, _| !of_the_source.iter().chain(&of_the_mechanism).any(|other| key == other));
    // What devices reported is no input.
    if let Some(noted) = keys.get_mut("noted").and_then(Value::as_array_mut) {
        let of_a_device = |words: &str| words.starts_with("reported on the way: ");
        noted.retain(|words| !words.as_str().is_some_and(of_a_device));
    }
    keys.retain(|key, value| key != "noted" || value.as_array().is_none_or(|all| !all.is_empty()));
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
fn inputs_of_a_run_replay_to_all_that_it_came_to_keeping_included() {
    let scratch = Scratch::new("inputs");
    for (options, name) in KEEPING.iter().zip(["run.jsonl", "run.JSONL.gz"].iter().cycle()) {
        let path = scratch.path(name);
        let recorded = answered(&[&["run"], *options, &["--record", &path]].concat());
        let replayed = answered(&["replay", &path]);
        let [of_replay, of_run] = [replayed, recorded].map(of_halves);
        assert_eq!(of_replay.to_string(), of_run.to_string(), "{options:?}");
    }
}

#[test]
fn a_run_gives_the_same_whether_its_inputs_are_recorded_or_not() {
    let scratch = Scratch::new("beside");
    let path = scratch.path("run.jsonl");
    for platform in ["stage", "two-frame", "turntable", "vehicle"] {
        let is_its = |run: &&&[&str]| run[0] == platform && !run.contains(&"--realign");
        let keeping = KEEPING.iter().find(is_its).expect("there is one");
        let run = [&["run"], *keeping].concat();
        let recorded = answered(&[&run[..], &["--record", &path]].concat());
        assert_eq!(recorded, answered(&run), "{platform}");
    }
}

#[test]
fn what_a_board_recalled_from_its_flash_is_in_its_inputs() {
    let scratch = Scratch::new("recalled");
    let (flash, path) = (scratch.path("flash.gz"), scratch.path("run.jsonl"));
    let run =
        ["run", "turntable", "--rate=50", "--turns=4", "--flash", &flash, "--date=2026-03-14"];
    assert_eq!(answered(&run)["status"], "ok");
    let again = ["--modulated-turns=0", "--record", &path];
    let recorded = answered(&[&run[..], &again].concat());
    assert_eq!(recorded["recalled"].as_array().map(Vec::len), Some(1));
    assert_eq!(of_halves(answered(&["replay", &path])), of_halves(recorded));
}

#[test]
fn text_and_page_of_replayed_inputs_say_what_was_kept() {
    let scratch = Scratch::new("said");
    let path = scratch.path("run.jsonl");
    let run = ["run", "turntable", "--rate=50", "--turns=3", "--hold=60", "--record", &path];
    let said = text(&meridian(&run).stdout);
    let (output, drawn) = page(&["replay", &path]);
    // Between the title and what else there is.
    let below = |text: &str| {
        let (said, _) = text.split_once("\n  --verbose adds").expect("there is more");
        said.trim().lines().skip(1).map(str::to_owned).collect::<Vec<_>>()
    };
    let replayed = text(&output.stdout);
    assert_eq!(below(&replayed), below(&said));
    assert!(replayed.contains(&format!("True north found in {path}")), "{replayed}");
    assert_drawn(&drawn, &["Error of the kept azimuth", "true pitch"]);
}

#[test]
fn inputs_of_a_run_that_was_stopped_say_so_and_what_was_known_by_then() {
    let scratch = Scratch::new("stopped");
    let path = scratch.path("run.jsonl");
    answered(&["run", "--rate=50", "--dwell=2", "--positions=4", "--record", &path]);
    let inputs = scratch.read("run.jsonl");
    let of_alignment = inputs.find("\"found\"").expect("north was found");
    for (length, reason) in [
        (of_alignment / 2, Value::from("the file breaks off before the alignment is over")),
        (of_alignment + 5000, Value::Null),
    ] {
        let replayed = answered(&["replay", &scratch.with("cut.jsonl", &inputs[..length])]);
        assert_eq!(replayed["reason"], reason);
        let warning = replayed["warnings"][0].as_str().expect("it warns");
        assert!(warning.contains("the inputs break off here"), "{warning}");
        assert!(replayed["error_deg"].is_null());
    }
}

#[test]
fn inputs_replay_as_they_came_or_not_at_all() {
    let scratch = Scratch::new("asked");
    let path = scratch.path("run.jsonl");
    for option in ["--method=vertical", "--latitude=1", "--half=east", "--attitude-out=x"] {
        let words = "inputs of a run replay as its board took them; leave it out";
        assert_misuse(&["replay", &path, option], words);
    }
    assert_misuse(&["run", "spin", "--record", &path], "its CSV replays whole; name FILE.csv");
    assert_misuse(&["run", "--realign", "--record", "x.csv"], "or name FILE.jsonl");
    assert!(!scratch.folder().join("run.jsonl").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn inputs_that_cannot_be_written_fail_with_their_file_and_the_result_is_not_lost() {
    let scratch = Scratch::new("full");
    let path = scratch.path("run.jsonl");
    std::os::unix::fs::symlink("/dev/full", &path).expect("the folder is ours");
    let output = meridian(&["run", "--rate=50", "--dwell=2", "--json", "--record", &path]);
    assert_eq!(code(&output), 1);
    let full = format!("meridian: {path}: the recording cannot be written: the disk is full");
    assert_eq!((reason(&output), &object(&output)["reason"]), (full.clone(), &full[10..].into()));
    assert!(object(&output)["azimuth_deg"].is_number());
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
fn a_run_that_ends_before_its_first_sample_leaves_an_older_recording_as_it_was_and_says_that_it_wrote_none()
 {
    let scratch = Scratch::new("older");
    let path = scratch.path("run.csv");
    answered(&["run", "stage", "--rate=50", "--dwell=2", "--record", &path]);
    assert_eq!(answered(&["replay", &path])["status"], "ok");
    let older = scratch.read("run.csv");
    let output = meridian(&["run", "stage", "--latitude=90", "--record", &path]);
    assert_eq!(code(&output), 1);
    assert!(text(&output.stderr).contains("the recording cannot be written"));
    assert_eq!(scratch.read("run.csv"), older);
}

#[test]
fn two_frames_without_what_their_run_was_given_are_not_taken_for_a_stage() {
    let scratch = Scratch::new("frames");
    let path = scratch.path("run.csv");
    for passes in ["--passes=1", "--passes=2"] {
        answered(&["run", "two-frame", "--rate=50", "--dwell=2", passes, "--record", &path]);
        let text = std::fs::read_to_string(&path).expect("it was written");
        let bare: Vec<_> = text.lines().filter(|line| !line.starts_with("# session")).collect();
        std::fs::write(&path, bare.join("\n")).expect("it can be written");
        let why = reason(&meridian(&["replay", &path]));
        assert!(why.contains("column elevation_rad: two frames replay"), "{why}");
    }
}

#[test]
fn an_azimuth_that_the_board_withdrew_is_no_result() {
    // The azimuth from outside is five of its σ off: the board believes neither it nor what it finds later.
    let scratch = Scratch::new("withdrawn");
    let path = scratch.path("run.jsonl");
    let run = [
        "run",
        "two-frame",
        "--rate=50",
        "--handover=214.7,0.16",
        "--realign",
        "--hold=1500",
        "--seed=5",
    ];
    for object in
        [answered(&[&run[..], &["--record", &path]].concat()), answered(&["replay", &path])]
    {
        assert_eq!(object["status"], "refused");
        let why = object["reason"].as_str().expect("there is a reason");
        assert!(why.contains("disagrees with what was kept"), "{why}");
        assert!(object.get("azimuth_deg").is_none() && object["kept"]["azimuth_deg"].is_null());
    }
}

#[test]
fn an_azimuth_found_after_one_from_outside_is_held_to_the_truth_of_its_time() {
    for seed in ["--seed=1", "--seed=4"] {
        let options = ["--handover=213.7,0.16", "--realign", "--hold=1200", "--rate=50", seed];
        let object = answered(&[&["run", "stage"], &options[..]].concat());
        let [error, sigma] = ["error_deg", "sigma_deg"].map(|key| object[key].as_f64());
        let (error, sigma) = (error.expect("it is known"), sigma.expect("north is found"));
        assert!(error.abs() < 4.0 * sigma, "{seed}: {error} ± {sigma}");
    }
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
