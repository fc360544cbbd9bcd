//! What is written is neither what is read nor what else is written.

use std::fs;

use crate::support::files::{Scratch, stored};
use crate::support::program::{assert_misuse, code, meridian, reason};

use super::recorded;

/// A folder with a copy of a recording, and its content.
fn copy(name: &str, of: &str) -> (Scratch, String, Vec<u8>) {
    let scratch = Scratch::new(name);
    let path = scratch.path("copy.csv.gz");
    fs::copy(stored(of), &path).expect("the folder is ours");
    let content = fs::read(&path).expect("it is there");
    (scratch, path, content)
}

#[test]
fn no_output_of_any_command_is_the_recording_by_whatever_name() {
    for (command, of, options) in [
        ("replay", "stepwise-bumped", &["--report"][..]),
        ("replay", "imu-broad-24", &["--attitude-out", "--report"]),
        ("allan", "static-gyro-1h", &["--report"]),
    ] {
        let (scratch, path, content) = copy(&format!("{command}-{of}"), of);
        let (hard, soft) = (scratch.path("hard"), scratch.path("soft"));
        fs::hard_link(&path, &hard).expect("one device");
        #[cfg(unix)]
        std::os::unix::fs::symlink("copy.csv.gz", &soft).expect("the folder is ours");
        let folder =
            scratch.folder().file_name().expect("it has a name").to_string_lossy().into_owned();
        let round = scratch.path(&format!("../{folder}/./copy.csv.gz"));
        let vertical = if of.starts_with("imu") { &["--method", "vertical"][..] } else { &[] };
        for option in options {
            for output in [&path, &hard, &soft, &round] {
                let arguments = [&[command, &path, option, output], vertical].concat();
                assert_misuse(&arguments, &format!("{option}: {output} is the recording itself"));
                assert!(fs::read(&path).expect("it is there") == content, "{arguments:?}");
            }
        }
    }
}

#[test]
fn no_output_is_another_output_by_whatever_name_even_before_either_is_there() {
    let scratch = Scratch::new("outputs");
    let (one, other) = (scratch.path("one"), scratch.path("./one"));
    let soft = scratch.path("soft");
    #[cfg(unix)]
    std::os::unix::fs::symlink("one", &soft).expect("the folder is ours");
    let imu = stored("imu-broad-24");
    let vertical = ["replay", &imu, "--method", "vertical", "--attitude-out", &one];
    let flash = ["run", "turntable", "--flash", &one];
    for again in [&one, &other, &soft] {
        assert_misuse(&["run", "--record", &one, "--report", again], "takes the recording already");
        assert_misuse(
            &[&vertical[..], &["--report", again]].concat(),
            "takes the attitude already",
        );
        assert_misuse(&[&flash[..], &["--report", again]].concat(), "takes the flash already");
    }
    let beside = scratch.path("one.new");
    assert_misuse(&[&flash[..], &["--report", &beside]].concat(), "takes the flash already");
    assert!(!scratch.folder().join("one").exists());
}

#[test]
fn a_folder_is_no_file_and_neither_is_nothing() {
    let scratch = Scratch::new("folders");
    let folder = scratch.folder().display().to_string();
    let stage = stored("stepwise-bumped");
    assert_misuse(&["replay", &folder], "is a directory; name a file in it");
    assert_misuse(&["allan", &folder], "is a directory; name a file in it");
    for (arguments, option) in [
        (&["run", "--report"][..], "--report"),
        (&["run", "--record"], "--record"),
        (&["run", "turntable", "--flash"], "--flash"),
        (&["replay", &stage, "--report"], "--report"),
        (&["replay", &stage, "--method", "vertical", "--attitude-out"], "--attitude-out"),
        (&["campaign", "spin", "--report"], "--report"),
        (&["plan", "--arw", "1", "--latitude", "1", "--sigma", "1", "--report"], "--report"),
    ] {
        assert_misuse(&[arguments, &[&folder]].concat(), option);
        assert_misuse(&[arguments, &[""]].concat(), option);
    }
}

#[test]
fn a_file_in_a_folder_that_is_not_there_is_refused_in_words_that_name_both() {
    let scratch = Scratch::new("nowhere");
    let (folder, beneath) = (scratch.path("none"), scratch.with("plain", ""));
    let short = ["run", "--rate", "50", "--dwell", "2"];
    let turning = ["run", "turntable", "--rate", "50", "--turns", "2"];
    let imu = stored("imu-broad-24");
    let vertical = ["replay", &imu, "--method", "vertical"];
    for (arguments, option, what) in [
        (&short[..], "--record", "the recording"),
        (&short, "--report", "the report"),
        (&turning, "--flash", "the flash"),
        (&vertical, "--attitude-out", "the attitude"),
    ] {
        let file = format!("{folder}/x");
        let output = meridian(&[arguments, &[option, &file]].concat());
        let reported = format!(
            "meridian: {file}: {what} cannot be written: there is no such folder: {folder}"
        );
        assert_eq!((code(&output), reason(&output)), (1, reported));
    }
    let file = format!("{beneath}/x");
    let output = meridian(&[&short[..], &["--record", &file]].concat());
    assert!(reason(&output).contains("a part of its path is a file"), "{}", reason(&output));
}

#[test]
fn what_was_recorded_before_may_be_written_over_and_dev_null_takes_everything() {
    let scratch = Scratch::new("again");
    let first = recorded(&scratch);
    assert_eq!(recorded(&scratch), first);
    let null = ["--record", "/dev/null", "--report", "/dev/null"];
    let output = meridian(&[&["run", "--rate", "50", "--dwell", "2"][..], &null].concat());
    assert_eq!(code(&output), 0, "{}", reason(&output));
}
