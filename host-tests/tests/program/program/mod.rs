//! The `meridian` program where a user goes wrong: what it refuses, how it explains, what it never does.

mod causes;
mod files;
mod misuses;
mod options;
mod reasons;
mod seeds;
mod warnings;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// Runs the built program.
fn meridian(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_meridian")).args(arguments).output().expect("it starts")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("no signal ended it")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn object(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

/// The last line on standard error: the reason.
fn reason(output: &Output) -> String {
    text(&output.stderr).lines().last().unwrap_or_default().to_owned()
}

/// A misuse: exit code 2, one line, nothing on standard output.
fn assert_misuse(arguments: &[&str], words: &str) {
    let output = meridian(arguments);
    let told = text(&output.stderr);
    assert_eq!(code(&output), 2, "{arguments:?}: {told}");
    assert_eq!(told.lines().count(), 1, "{arguments:?}: {told}");
    assert!(told.starts_with("error: ") && told.contains(words), "{arguments:?}: {told}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
}

fn stored(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/recordings");
    path.join(format!("{name}.csv.gz")).display().to_string()
}

/// A folder of its own for one test, gone with it.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("program-{name}"));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("the folder is ours");
        Self(path)
    }

    /// The path of a file in it.
    fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    /// The path of a file in it that holds this.
    fn with(&self, name: &str, content: &str) -> String {
        fs::write(self.0.join(name), content).expect("the folder is ours");
        self.path(name)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // A folder that is left behind does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// What a board on a stage shows, as it records it: 24 positions of 2 s at 50 Hz.
fn recorded(scratch: &Scratch) -> String {
    let path = scratch.path("stage.csv");
    let output = meridian(&["run", "--rate", "50", "--dwell", "2", "--record", &path]);
    assert_eq!(code(&output), 0, "{}", reason(&output));
    fs::read_to_string(path).expect("it was written")
}

/// A stored recording as text.
fn unpacked(name: &str) -> String {
    let file = fs::File::open(stored(name)).expect("it is there");
    let mut text = String::new();
    std::io::Read::read_to_string(&mut flate2::read::MultiGzDecoder::new(file), &mut text)
        .expect("it is gzip");
    text
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
