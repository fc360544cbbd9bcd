//! The `meridian` program where a user goes wrong: what it refuses, how it explains, what it never does.

mod causes;
mod files;
mod misuses;
mod options;
mod reasons;
mod seeds;
mod warnings;

use std::sync::OnceLock;

use crate::support::files::Scratch;
use crate::support::program::{code, meridian, object, reason};

/// What a board on a stage shows: 24 positions of 2 s at 50 Hz, as a recorder beside it has them, which does not know
/// what its session was given. Recorded once for all tests.
fn recorded() -> &'static str {
    static RECORDED: OnceLock<String> = OnceLock::new();
    RECORDED.get_or_init(|| {
        let all = recorded_anew(&Scratch::new("recorded"));
        all.split_inclusive('\n').filter(|line| !line.starts_with("# session:")).collect()
    })
}

/// The same recording, made at each call, with the keys that tell what its session was given.
fn recorded_anew(scratch: &Scratch) -> String {
    let path = scratch.path("stage.csv");
    let output = meridian(&["run", "--rate", "50", "--dwell", "2", "--record", &path]);
    assert_eq!(code(&output), 0, "{}", reason(&output));
    scratch.read("stage.csv")
}

/// The reason for which a recording is refused.
fn refused(scratch: &Scratch, recording: &str) -> String {
    let path = scratch.with("refused.csv", recording);
    let output = meridian(&["replay", &path, "--json"]);
    assert_eq!(code(&output), 1, "it is refused");
    let why = object(&output)["reason"].as_str().expect("a reason").to_owned();
    assert!(!why.contains("keep the"), "{why}");
    assert!(reason(&output).contains(&why), "{}", reason(&output));
    why
}

/// A recording with every value of some columns times a factor.
fn scaled(recording: &str, columns: &[&str], factor: f64) -> String {
    mapped(recording, columns, |text| (text.parse::<f64>().expect("a number") * factor).to_string())
}

/// A recording with every value of some columns made anew.
fn mapped(recording: &str, columns: &[&str], value: impl Fn(&str) -> String) -> String {
    let mut names: Option<Vec<&str>> = None;
    let lines = recording.lines().map(|line| match &names {
        _ if line.starts_with('#') => line.to_owned(),
        None => {
            names = Some(line.split(',').collect());
            line.to_owned()
        }
        Some(names) => {
            let fields = line.split(',').zip(names);
            let field = |(text, name): (&str, &&str)| {
                if columns.contains(name) { value(text) } else { text.to_owned() }
            };
            fields.map(field).collect::<Vec<_>>().join(",")
        }
    });
    lines.fold(String::new(), |all, line| all + &line + "\n")
}
