//! Options, and images that are none or another carrier's.

use std::thread::sleep;
use std::time::{Duration, Instant};

use execution::built::{executable, of_firmware, root};
use firmware::platform::Platform;
use serde_json::{Value, json};

use crate::images::path;
use crate::started::{Waiting, output, text};

#[test]
fn a_value_that_an_option_cannot_have_is_misuse() {
    let values: [(&str, &[&str], &str); 4] = [
        (
            "--cycles",
            &["-1", "NaN", "inf", "-inf", "0.4", "20.1", "many", ""],
            "0.5 to 20 are meant",
        ),
        (
            "--afterwards",
            &["-1", "nan", "inf", "-inf", "3600.1", "long", ""],
            "0 to 3600 are meant",
        ),
        ("--link", &["5000", "tcp", "tcp:", "tcp:-1", "tcp:65536", "udp:5000"], "as in tcp:5000"),
        ("--carrier", &["ship", "all", ""], "stage, two-frame, turntable, vehicle, spin"),
    ];
    for (option, wrong, words) in values {
        for value in wrong {
            let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_emulated-board"));
            command.arg("nowhere.elf").args([option, value]);
            if option != "--carrier" {
                command.args(["--carrier", "stage"]);
            }
            let output = command.output().expect("it starts");
            let said = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{option} {value}: {said}");
            assert!(said.contains(words), "{option} {value}: {said}");
        }
    }
}

#[test]
fn a_file_that_is_no_image_is_named_with_the_reason() {
    let checks = of_firmware(&["--package", "core-checks"]).expect("they build");
    let semihosting = executable(&checks, "core-checks-semihosting").expect("it was built");
    let files = [
        (root().join("nowhere.elf"), "No such file"),
        (root().join("Cargo.toml"), ""),
        (env!("CARGO_BIN_EXE_emulated-board").into(), "no image: "),
        (semihosting, "no symbol _SEGGER_RTT"),
    ];
    for (file, reason) in files {
        let file = file.to_str().expect("a name in UTF-8");
        let output = output(file, Platform::Stage, &[]);
        let said = text(&output.stderr);
        assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{said}");
        assert!(said.starts_with(&format!("error: {file}: {reason}")), "{said}");
    }
}

#[test]
fn an_image_that_states_no_carrier_is_refused() {
    let checks = of_firmware(&["--package", "core-checks"]).expect("they build");
    let probe = executable(&checks, "core-checks-probe").expect("it was built");
    let file = probe.to_str().expect("a name in UTF-8");
    let said = text(&output(file, Platform::Stage, &[]).stderr);
    assert_eq!(
        said.trim(),
        format!("error: {file}: no image of a board for the carrier stage: it states no carrier")
    );
}

#[test]
fn the_image_of_another_carrier_is_refused_with_the_names_of_both() {
    let file = path(Platform::Spin).to_str().expect("a name in UTF-8");
    let output = output(file, Platform::TwoFrame, &[]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0));
    assert_eq!(
        text(&output.stderr).trim(),
        format!("error: {file}: the image was built for the carrier spin, not for two-frame")
    );
}

/// The crystal is waited for two and a half seconds, and a spinning body has five seconds in all.
#[test]
fn a_flight_with_a_dead_crystal_begins_without_it_and_is_as_long_as_another() {
    let file = path(Platform::Spin).to_str().expect("a name in UTF-8");
    let [sound, dead]: [Value; 2] = [&[][..], &["--dead-crystal"]].map(|arguments| {
        serde_json::from_slice(&output(file, Platform::Spin, arguments).stdout).expect("a report")
    });
    assert_eq!((&dead["resets"], &sound["resets"]), (&json!([]), &json!([])));
    let start = dead["start_seconds"].as_f64().expect("a number");
    assert!((2.4..2.7).contains(&start), "{start}");
    let read = |report: &Value| report["service"][0]["read"].as_f64().expect("a number");
    let more = read(&dead) / read(&sound);
    assert!((0.9..2.0).contains(&more), "{dead}\n{sound}");
}

/// Whether a process ends within so many seconds.
fn ends(waiting: &mut Waiting, seconds: u64) -> bool {
    let end = Instant::now() + Duration::from_secs(seconds);
    while Instant::now() < end {
        if waiting.child.try_wait().expect("it can be asked").is_some() {
            return true;
        }
        sleep(Duration::from_millis(20));
    }
    false
}

#[test]
fn the_program_ends_with_the_one_that_started_it_while_it_waits_and_while_it_executes() {
    for connects in [false, true] {
        let mut waiting = Waiting::new(Platform::Spin, &["--while-stdin", "--afterwards", "3600"]);
        let client = connects.then(|| std::net::TcpStream::connect(&waiting.address));
        assert!(!ends(&mut waiting, 1), "its standard input is open");
        drop(waiting.child.stdin.take());
        assert!(ends(&mut waiting, 20), "its standard input is closed");
        drop(client);
    }
}

#[test]
fn the_program_needs_no_standard_input_where_nobody_asks_for_it() {
    let mut waiting = Waiting::new(Platform::Spin, &[]);
    drop(waiting.child.stdin.take());
    assert!(!ends(&mut waiting, 1));
}
