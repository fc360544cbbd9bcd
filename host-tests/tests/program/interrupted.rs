//! Ctrl-C: what was done so far is shown and written, and the exit code is 1 with the reason.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use serde_json::Value;

use crate::support::files::{Scratch, stored, unpacked};
use crate::support::program::{code, command, meridian, object, reason, text};

/// What a program that was interrupted ended with: exit code, standard output, and standard error after that.
type Ended = (Option<i32>, String, String);

/// The program, whose streams are ours.
fn started(arguments: &[&str]) -> Child {
    let pipe = Stdio::piped;
    let child = command().args(arguments).stdin(pipe()).stdout(pipe()).stderr(pipe()).spawn();
    child.expect("it starts")
}

/// Presses Ctrl-C.
fn interrupt(child: &Child) {
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.expect("there is kill").success());
}

/// What a program ended with that was interrupted when a line of its progress held these words.
fn interrupted_at(words: &str, arguments: &str) -> Ended {
    let mut child = started(&arguments.split(' ').collect::<Vec<_>>());
    let mut error = BufReader::new(child.stderr.take().expect("it is piped"));
    let mut line = String::new();
    while !line.contains(words) || line.is_empty() {
        line.clear();
        let length = error.read_line(&mut line).expect("it says how far it is");
        assert!(length > 0, "{arguments} never says {words}");
    }
    interrupt(&child);
    let mut rest = String::new();
    error.read_to_string(&mut rest).expect("it is text");
    let output = child.wait_with_output().expect("it ends");
    (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned(), rest)
}

/// What a program ended with that was interrupted at its first sign of progress.
fn interrupted(arguments: &str) -> Ended {
    interrupted_at("", arguments)
}

/// What a program ended with that was interrupted when it had read the first part of its standard input.
fn interrupted_between([first, rest]: [&str; 2], arguments: &[&str]) -> Ended {
    let mut child = started(arguments);
    let mut input = child.stdin.take().expect("it is piped");
    input.write_all(first.as_bytes()).expect("it reads");
    // It listens as soon as it reads, and what lies in the pipe is read before long.
    sleep(Duration::from_millis(500));
    interrupt(&child);
    sleep(Duration::from_millis(200));
    // It may read no further.
    let _ = input.write_all(rest.as_bytes());
    drop(input);
    let output = child.wait_with_output().expect("it ends");
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

/// The reason in the last line of standard error.
#[track_caller]
fn assert_reason(said: &str, begin: &str) {
    let reason = said.lines().last().unwrap_or_default();
    assert!(reason.starts_with(&format!("meridian: {begin}")), "{said}");
}

/// The object of a program that was interrupted.
#[track_caller]
fn ended((code, printed, said): &Ended) -> Value {
    let object: Value = serde_json::from_str(printed).expect("one object");
    assert_eq!((*code, &object["status"]), (Some(1), &"interrupted".into()), "{said}");
    let reason = object["reason"].as_str().expect("a reason");
    assert!(reason.contains("interrupted"), "{reason}");
    object
}

/// The lines of a text, of which a part in a hundred is the first half.
fn parted(text: &str, percent: usize) -> [String; 2] {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let (first, rest) = lines.split_at(lines.len() * percent / 100);
    [first.concat(), rest.concat()]
}

#[test]
fn a_campaign_prints_the_tables_of_the_runs_that_were_done() {
    for (name, table) in [("spin", "RMS errors"), ("sokolov", "runs"), ("faults", "greatest error")]
    {
        let (code, printed, said) = interrupted(&format!("campaign {name} --runs 100000"));
        assert_eq!(code, Some(1), "{name}: {said}");
        assert!(printed.contains(table), "{name}: {printed}");
        assert_reason(&said, "interrupted at ");
        assert!(said.trim_end().ends_with("the tables rest on the runs that were done"), "{said}");
    }
}

#[test]
fn a_run_that_has_measured_nothing_yet_says_how_far_it_was() {
    for platform in ["stage", "two-frame", "turntable"] {
        let (code, printed, said) = interrupted(&format!("run {platform} --hold 14400"));
        assert_eq!(code, Some(1), "{platform}: {said}");
        assert!(printed.starts_with("No azimuth from the simulated run"), "{platform}: {printed}");
        assert!(printed.contains("reason             interrupted at "), "{platform}: {printed}");
        assert_reason(&said, "interrupted at ");
    }
}

#[test]
fn a_run_that_is_interrupted_in_its_alignment_says_what_sigma_it_had_by_then() {
    for run in [
        "stage --rate 50 --dwell 120 --hold 0",
        "two-frame --rate 50 --dwell 120 --hold 0",
        "turntable --rate 50 --turns 60 --hold 0",
    ] {
        let steps = if run.starts_with("turntable") { "turn 70 of" } else { "dwell 12 of" };
        let after = interrupted_at(steps, &format!("run {run} --json -v"));
        let object = ended(&after);
        let reason = object["reason"].as_str().expect("a reason");
        assert!(reason.contains("what was measured until then gives 1σ of 0."), "{run}: {reason}");
        assert!(object.get("azimuth_deg").is_none() && object.get("kept").is_none(), "{object}");
        assert!(object["positions"].as_u64().is_some_and(|count| count > 0), "{object}");
    }
}

#[test]
fn a_run_that_is_interrupted_later_has_its_result_and_what_was_kept_until_then() {
    // In the vehicle the next alignment has begun by then.
    let runs = [
        ("stage --rate 50 --hold 14400", "coasting for 3"),
        ("vehicle --rate 50 --hold 14400 --realign", "1694.112725 stop 1: the vehicle stands"),
    ];
    for (run, words) in runs {
        let (code, printed, said) = interrupted_at(words, &format!("run {run} -v"));
        assert_eq!(code, Some(1), "{run}: {said}");
        let heading = printed.lines().next().unwrap_or_default();
        assert!(heading.ends_with(", which was interrupted"), "{run}: {heading}");
        for words in ["True north found", "reason", "interrupted at ", "Kept for"] {
            assert!(printed.contains(words), "{run}: {words} in {printed}");
        }
        assert_reason(&said, "interrupted at ");
        let object = ended(&interrupted_at(words, &format!("run {run} --json -v")));
        assert!(object["azimuth_deg"].is_number(), "{object}");
        assert!(object["kept"]["azimuth_deg"].is_number(), "{object}");
    }
}

#[test]
fn the_inputs_of_a_run_that_was_interrupted_replay_to_what_it_had() {
    let scratch = Scratch::new("interrupted");
    let path = scratch.with("run.jsonl.gz", "before");
    let run = format!("run stage --rate 50 --hold 14400 --record {path} --json -v");
    let ran = ended(&interrupted_at("coasting for 3", &run));
    let output = meridian(&["replay", &path, "--json"]);
    assert_eq!(code(&output), 0, "{}", reason(&output));
    let replayed = object(&output);
    for key in ["azimuth_deg", "sigma_deg", "pitch_deg", "dwells"] {
        assert_eq!(replayed[key], ran[key], "{key}");
    }
    for key in ["seconds", "azimuth_deg", "sigma_deg", "state"] {
        assert_eq!(replayed["kept"][key], ran["kept"][key], "{key}");
    }
    assert!(replayed["warnings"].to_string().contains("the inputs break off here"), "{replayed}");
    assert_eq!(std::fs::read_dir(scratch.folder()).expect("it is there").count(), 1);
}

#[test]
fn the_inputs_of_an_alignment_that_was_interrupted_are_no_result_and_tell_its_sigma() {
    let scratch = Scratch::new("interrupted");
    let path = scratch.path("run.jsonl");
    let run = format!("run stage --rate 50 --dwell 120 --hold 0 --record {path} --json -v");
    let ran = ended(&interrupted_at("dwell 12 of", &run));
    let output = meridian(&["replay", &path, "--json"]);
    assert_eq!(code(&output), 1);
    let replayed = object(&output);
    assert_eq!(replayed["dwells"], ran["dwells"]);
    let [ran, replayed] = [&ran, &replayed].map(|of| of["reason"].as_str().expect("a reason"));
    let sigma = |reason: &str| reason.split_once("; what was").map(|(_, sigma)| sigma.to_owned());
    assert!(sigma(ran).is_some() && sigma(ran) == sigma(replayed), "{ran}, {replayed}");
    assert!(replayed.starts_with("the file breaks off before the alignment is over"), "{replayed}");
}

#[test]
fn the_samples_of_a_run_that_was_interrupted_are_a_recording_too() {
    let scratch = Scratch::new("interrupted");
    let path = scratch.path("run.csv.gz");
    let run = format!("run stage --rate 50 --dwell 120 --hold 0 --record {path} --json -v");
    let ran = ended(&interrupted_at("dwell 12 of", &run));
    let replayed = object(&meridian(&["replay", &path, "--json"]));
    assert_eq!(replayed["dwells"], ran["dwells"]);
    assert!(replayed["azimuth_deg"].is_number(), "{replayed}");
}

#[test]
fn a_replay_that_is_interrupted_says_what_sigma_it_had_by_then() {
    let recording = unpacked("stepwise-circle");
    let [first, rest] = parted(&recording, 70);
    let after = interrupted_between([&first, &rest], &["replay", "-", "--json"]);
    let object = ended(&after);
    assert!(object["reason"].to_string().contains("gives 1σ of 0."), "{object}");
    assert!(object.get("azimuth_deg").is_none(), "{object}");
    let (code, printed, said) = interrupted_between([&first, &rest], &["replay", "-"]);
    assert_eq!(code, Some(1));
    assert!(printed.starts_with("No azimuth from standard input"), "{printed}");
    assert_reason(&said, "standard input: interrupted");
    // Two lines are too few for anything.
    let (first, rest) =
        recording.split_at(recording.match_indices('\n').nth(1).map_or(0, |(at, _)| at + 1));
    let (code, printed, said) = interrupted_between([first, rest], &["replay", "-"]);
    assert_eq!((code, printed.as_str()), (Some(1), ""));
    assert_reason(&said, "interrupted");
}

#[test]
fn a_noise_analysis_that_is_interrupted_is_that_of_the_rows_that_were_read() {
    let [first, rest] = parted(&unpacked("static-gyro-1h"), 50);
    let after = interrupted_between([&first, &rest], &["allan", "-", "--json"]);
    let object = ended(&after);
    let samples = object["samples"].as_u64().expect("a number");
    assert!((10_000..30_000).contains(&samples), "{samples}");
    assert!(object["reason"].to_string().contains(&format!("interrupted at {samples} rows")));
    assert!(object["n_deg_sqrt_h"].is_number(), "{object}");
    let (code, printed, said) = interrupted_between([&first, &rest], &["allan", "-"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(printed.contains("interrupted at ") && printed.contains("°/√h"), "{printed}");
}

/// What a program ended with that was interrupted while its standard input, which began like this, stayed open.
fn interrupted_while_it_waits(first: &[u8], arguments: &[&str]) -> Ended {
    let mut child = started(arguments);
    let mut input = child.stdin.take().expect("it is piped");
    input.write_all(first).expect("it reads");
    sleep(Duration::from_millis(500));
    interrupt(&child);
    let output = child.wait_with_output().expect("it ends although its input does not");
    drop(input);
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn an_interruption_ends_what_waits_for_standard_input_that_stays_open() {
    let scratch = Scratch::new("open-input");
    let (page, hour) = (scratch.path("page.html"), unpacked("static-gyro-1h"));
    // The last line lacks its end, and the compressed stream its own.
    let half = &hour[..hour.len() / 2];
    let packed = std::fs::read(stored("static-gyro-1h")).expect("it is there");
    for first in [half.as_bytes(), &packed[..packed.len() / 2]] {
        let after = interrupted_while_it_waits(first, &["allan", "-", "--json"]);
        let object = ended(&after);
        assert!(object["samples"].as_u64().is_some_and(|samples| samples > 1000), "{object}");
        assert!(object["n_deg_sqrt_h"].is_number(), "{object}");
    }
    let (code, printed, _) =
        interrupted_while_it_waits(half.as_bytes(), &["allan", "-", "--report", &page]);
    assert_eq!(code, Some(1));
    assert!(printed.contains("interrupted at ") && printed.contains("°/√h"), "{printed}");
    assert!(scratch.read("page.html").contains(">interrupted<"));
    let circle = unpacked("stepwise-circle");
    let first = &circle.as_bytes()[..circle.len() * 7 / 10];
    let object = ended(&interrupted_while_it_waits(first, &["replay", "-", "--json"]));
    assert!(object["reason"].to_string().contains("gives 1σ of 0."), "{object}");
    let (code, printed, said) = interrupted_while_it_waits(b"", &["allan", "-"]);
    assert_eq!((code, printed.as_str()), (Some(1), ""));
    assert_reason(&said, "interrupted");
}

#[test]
fn a_page_of_what_was_interrupted_is_drawn() {
    let scratch = Scratch::new("interrupted");
    let path = scratch.path("run.html");
    let (code, ..) =
        interrupted_at("keeping, ", &format!("run --rate 50 --hold 14400 --report {path}"));
    assert_eq!(code, Some(1));
    let page = scratch.read("run.html");
    assert!(page.contains("True north found") && page.contains("interrupted at keeping"));
    assert!(page.contains(">interrupted</span>") && !page.contains(">degraded</span>"));
}

#[test]
fn what_waits_for_its_input_ends_at_once_and_leaves_what_was_there_and_nothing_beside_it() {
    let scratch = Scratch::new("interrupted");
    let there = scratch.with("page.html", "before");
    let mut child = started(&["replay", "-", "--report", &there]);
    sleep(Duration::from_millis(500));
    interrupt(&child);
    sleep(Duration::from_millis(500));
    let ended = child.try_wait().expect("it is ours");
    assert_eq!(ended.and_then(|status| status.code()), Some(1));
    assert_eq!(scratch.read("page.html"), "before");
    assert_eq!(std::fs::read_dir(scratch.folder()).expect("it is there").count(), 1);
}

#[test]
fn a_pair_of_interruptions_counts_as_one() {
    let child = started(&["campaign", "sokolov", "--runs", "100000"]);
    sleep(Duration::from_secs(1));
    for _ in 0..2 {
        interrupt(&child);
        sleep(Duration::from_millis(1));
    }
    let output = child.wait_with_output().expect("it ends");
    let (printed, said) = (text(&output.stdout), text(&output.stderr));
    assert!(printed.contains("Interrupted") || printed.contains("reason"), "{printed}");
    assert!(said.trim_end().ends_with("the tables rest on the runs that were done"), "{said}");
}
