//! The built program: its runs, and what they give.

use std::process::{Command, Output};

use serde_json::Value;

use super::files::Scratch;

/// The program, to be started otherwise than [`meridian`] does.
pub fn command() -> Command {
    Command::new(env!("CARGO_BIN_EXE_meridian"))
}

/// Runs the program.
pub fn meridian(arguments: &[&str]) -> Output {
    command().args(arguments).output().expect("it starts")
}

pub fn code(output: &Output) -> i32 {
    output.status.code().expect("no signal ended it")
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("it prints UTF-8")
}

/// The words of a text, which may stand in lines of any width.
pub fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

pub fn object(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

/// The last line on standard error: the reason.
pub fn reason(output: &Output) -> String {
    text(&output.stderr).lines().last().unwrap_or_default().to_owned()
}

/// A misuse: exit code 2, one line with these words, nothing on standard output.
#[track_caller]
pub fn assert_misuse(arguments: &[&str], words: &str) {
    let output = meridian(arguments);
    let reported = text(&output.stderr);
    assert_eq!(code(&output), 2, "{arguments:?}: {reported}");
    assert_eq!(reported.lines().count(), 1, "{arguments:?}: {reported}");
    assert!(
        reported.starts_with("error: ") && reported.contains(words),
        "{arguments:?}: {reported}"
    );
    assert!(!reported.contains("For more information"), "{arguments:?}: {reported}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
}

/// A run with a result, and the page that it draws.
#[track_caller]
pub fn page(arguments: &[&str]) -> (Output, String) {
    let scratch = Scratch::new("page");
    let path = scratch.path("page.html");
    let output = meridian(&[arguments, &["--report", &path]].concat());
    assert_eq!(code(&output), 0, "{arguments:?}: {}", reason(&output));
    (output, scratch.read("page.html"))
}

/// That a page has all of these words.
#[track_caller]
pub fn assert_drawn(page: &str, words: &[&str]) {
    let lacks: Vec<_> = words.iter().filter(|words| !page.contains(**words)).collect();
    assert!(lacks.is_empty(), "the page lacks {lacks:?}");
}
