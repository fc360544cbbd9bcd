//! Ctrl-C: what was done so far is printed, and the exit code is 1 with the reason.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::support::files::Scratch;
use crate::support::program::command;

/// What a program that was interrupted after its first sign of progress ended with: exit code, standard output, and what
/// came to standard error after that sign.
fn interrupted(arguments: &str) -> (Option<i32>, String, String) {
    let mut child = command()
        .args(arguments.split(' '))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut error = BufReader::new(child.stderr.take().expect("it is piped"));
    let mut first = String::new();
    error.read_line(&mut first).expect("it says how far it is");
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.expect("there is kill").success());
    let mut rest = String::new();
    error.read_to_string(&mut rest).expect("it is text");
    let output = child.wait_with_output().expect("it ends");
    (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned(), rest)
}

#[test]
fn a_campaign_prints_the_tables_of_the_runs_that_were_done() {
    for (name, table) in [("spin", "RMS errors"), ("sokolov", "runs"), ("faults", "outcome")] {
        let (code, printed, said) = interrupted(&format!("campaign {name} --runs 100000"));
        assert_eq!(code, Some(1), "{name}: {said}");
        assert!(printed.contains(table), "{name}: {printed}");
        let reason = said.lines().last().unwrap_or_default();
        assert!(reason.starts_with("meridian: interrupted at "), "{name}: {said}");
        assert!(reason.ends_with("the tables rest on the runs that were done"), "{name}: {said}");
    }
}

#[test]
fn a_run_that_is_interrupted_says_how_far_it_was() {
    let (code, printed, said) = interrupted("run --hold 14400");
    assert_eq!((code, printed.as_str()), (Some(1), ""));
    let reason = said.lines().last().unwrap_or_default();
    assert!(reason.starts_with("meridian: interrupted at "), "{said}");
}

#[test]
fn a_recording_that_is_interrupted_leaves_what_was_there_and_nothing_beside_it() {
    let scratch = Scratch::new("interrupted");
    let there = scratch.with("run.jsonl", "before");
    let (code, ..) = interrupted(&format!("run --hold 14400 --record {there}"));
    assert_eq!((code, scratch.read("run.jsonl").as_str()), (Some(1), "before"));
    assert_eq!(std::fs::read_dir(scratch.folder()).expect("it is there").count(), 1);
}

#[test]
fn an_object_says_that_it_was_interrupted_too() {
    let (code, printed, _) = interrupted("run --hold 14400 --json -v");
    let object: Value = serde_json::from_str(&printed).expect("one object");
    assert_eq!((code, &object["status"]), (Some(1), &"failed".into()));
    assert!(object["reason"].as_str().is_some_and(|reason| reason.starts_with("interrupted")));
}
