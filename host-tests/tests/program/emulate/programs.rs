//! The programs around an emulation: cargo, QEMU, and `meridian` without them.

use std::fs;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use execution::built::root;
use host::emulate::images::{Images, artifacts};
use host::emulate::qemu;
use serde_json::Value;

use crate::support::program::command;

#[test]
fn cargos_messages_name_the_images() {
    let message = |name: &str, path: &str| {
        format!(
            r#"{{"reason":"compiler-artifact","target":{{"name":"{name}"}},"executable":{path}}}"#
        )
    };
    let text = [
        message("hal-mock", "null"),
        message("cost", "\"/t/cost\""),
        "not json".to_owned(),
        message("emulator", "\"/t/emulator\""),
    ];
    let images = artifacts(&text.join("\n")).expect("both");
    assert_eq!(images, Images { emulator: "/t/emulator".into(), cost: "/t/cost".into() });
    let error = artifacts(&text[..3].join("\n")).expect_err("one is missing");
    assert_eq!(error, "cargo built no image `emulator`");
}

#[test]
fn the_emulators_options_are_those_of_the_runner() {
    let path = root().join(".cargo/config.toml");
    let configuration = fs::read_to_string(path).expect("it is there");
    let runner = format!("runner = \"{} {}\"", qemu::PROGRAM, qemu::OPTIONS);
    assert!(configuration.lines().any(|line| line == runner), "{runner}");
}

#[cfg(unix)]
#[test]
fn a_program_that_does_not_end_is_stopped() {
    let mut command = Command::new("sh");
    command.args(["-c", "echo begun; exec sleep 600"]);
    let mut seen = Vec::new();
    let begun = Instant::now();
    let keep = |bytes: &[u8]| {
        seen.extend_from_slice(bytes);
        Ok(())
    };
    let error = qemu::watch(command, Duration::from_millis(500), keep).expect_err("it is stopped");
    assert_eq!(error, "sh did not end within 500ms and was stopped");
    assert_eq!(seen, b"begun\n");
    assert!(begun.elapsed() < Duration::from_mins(1));
}

#[cfg(unix)]
#[test]
fn a_program_that_ends_gives_its_code_and_all_it_printed() {
    let mut command = Command::new("sh");
    command.args(["-c", "head -c 100000 /dev/zero; exit 3"]);
    let mut count = 0;
    let add = |bytes: &[u8]| {
        count += bytes.len();
        Ok(())
    };
    let status = qemu::watch(command, Duration::from_mins(5), add).expect("it ends");
    assert_eq!((status.code(), count), (Some(3), 100_000));
}

/// The program where nothing can be found.
fn without_programs(arguments: &[&str]) -> Output {
    command().args(arguments).env("PATH", "").output().expect("it starts")
}

#[test]
fn without_the_emulator_one_line_says_what_to_install() {
    let output = without_programs(&["emulate"]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0));
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(text.starts_with("meridian: qemu-system-arm is not installed: install "), "{text}");
}

#[test]
fn without_the_emulator_json_says_so_too() {
    let output = without_programs(&["emulate", "--seed", "3", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let object: Value = serde_json::from_slice(&output.stdout).expect("one object");
    assert_eq!(object["status"], "failed");
    assert!(object["reason"].as_str().is_some_and(|reason| reason.contains("qemu-system-arm")));
}

#[test]
fn a_seed_that_is_no_number_is_misuse() {
    for seed in ["north", "-1", "1.5"] {
        assert_eq!(without_programs(&["emulate", "--seed", seed]).status.code(), Some(2), "{seed}");
    }
}
