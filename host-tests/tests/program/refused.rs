//! What the system refuses, in words.

use std::fs::File;
use std::io::Error;

use host::refused::{cause, unwritten};

use crate::support::files::Scratch;
use crate::support::program::{code, command, meridian, reason, text};

/// Numbers of errors that systems have.
const NUMBERS: std::ops::RangeInclusive<i32> = 1..=133;

#[test]
fn no_error_of_the_system_is_told_by_its_number() {
    let place = Scratch::new("numbers").path("file.csv");
    for error in NUMBERS.map(Error::from_raw_os_error) {
        let whole = unwritten("the page", place.as_ref(), &error);
        for told in [cause(&error), whole] {
            assert!(!told.contains("os error") && !told.is_empty(), "{error}: {told}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn what_standard_output_does_not_take_is_a_failure_that_names_the_full_disk() {
    let commands: [&[&str]; 6] = [
        &["run", "--rate", "50", "--hold", "0", "-q"],
        &["run", "--rate", "50", "--hold", "0", "--json"],
        &["plan", "--arw", "0.1", "--latitude", "40", "--seconds", "300"],
        &["--help"],
        &["run", "vehicle", "--help"],
        &["man"],
    ];
    for arguments in commands {
        let full = File::options().write(true).open("/dev/full").expect("Linux has it");
        let output = command().args(arguments).stdout(full).output().expect("it starts");
        assert_eq!(code(&output), 1, "{arguments:?}");
        let why = "meridian: standard output: the result cannot be written: the disk is full";
        assert_eq!(reason(&output), why, "{arguments:?}");
    }
}

#[cfg(unix)]
#[test]
fn output_that_nobody_reads_further_is_no_failure() {
    let (reader, writer) = std::io::pipe().expect("the system has pipes");
    drop(reader);
    let help = command().arg("--help").stdout(writer).output().expect("it starts");
    assert_eq!((code(&help), text(&help.stderr)), (0, String::new()));
}

#[test]
fn a_file_or_folder_that_is_not_there_is_named() {
    let scratch = Scratch::new("not-there");
    let (missing, beyond) = (scratch.path("no.csv"), scratch.path("no/page.html"));
    let replay = meridian(&["replay", &missing]);
    assert!(reason(&replay).ends_with("no.csv: there is no such file"), "{}", reason(&replay));
    let plan = ["plan", "--arw", "0.1", "--latitude", "40", "--seconds", "300", "--report"];
    let page = meridian(&[&plan[..], &[&beyond]].concat());
    assert!(reason(&page).contains("there is no such folder"), "{}", reason(&page));
}
