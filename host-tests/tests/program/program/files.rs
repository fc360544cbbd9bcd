//! What is written is neither what is read nor what else is written.

use std::fs;

use crate::support::files::{Scratch, stored};
use crate::support::program::{assert_misuse, code, command, meridian, reason};

use super::recorded_anew;

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
    let (one, other) = (scratch.path("one.csv"), scratch.path("./one.csv"));
    let soft = scratch.path("soft");
    #[cfg(unix)]
    std::os::unix::fs::symlink("one.csv", &soft).expect("the folder is ours");
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
    let beside = scratch.path("one.csv.new");
    assert_misuse(&[&flash[..], &["--report", &beside]].concat(), "takes the flash already");
    assert!(!scratch.folder().join("one.csv").exists());
}

#[test]
fn a_folder_is_no_file_and_neither_is_nothing() {
    let scratch = Scratch::new("folders");
    let folder = scratch.folder().display().to_string();
    let stage = stored("stepwise-bumped");
    assert_misuse(&["replay", &folder], "no recording is in this folder (.csv, .csv.gz, .jsonl");
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
    // None of these would end before somebody loses his patience.
    let long = ["campaign", "keep", "--runs", "1000000"];
    for (arguments, option, name, what) in [
        (&short[..], "--record", "x.csv", "the recording"),
        (&short, "--record", "x.jsonl.gz", "the recording"),
        (&short, "--report", "x.html", "the report"),
        (&long, "--report", "x.html", "the report"),
        (&turning, "--flash", "x", "the flash"),
        (&vertical, "--attitude-out", "x.csv", "the attitude"),
    ] {
        let file = format!("{folder}/{name}");
        let output = meridian(&[arguments, &[option, &file]].concat());
        let reported = format!(
            "meridian: {file}: {what} cannot be written: there is no such folder: {folder}"
        );
        assert_eq!((code(&output), reason(&output)), (1, reported));
    }
    let file = format!("{beneath}/x.csv");
    let output = meridian(&[&short[..], &["--record", &file]].concat());
    assert!(reason(&output).contains("a part of its path is a file"), "{}", reason(&output));
}

#[test]
fn what_was_recorded_before_may_be_written_over_and_dev_null_takes_everything() {
    let scratch = Scratch::new("again");
    let first = recorded_anew(&scratch);
    assert_eq!(recorded_anew(&scratch), first);
    let null = ["--record", "/dev/null", "--report", "/dev/null"];
    let output = meridian(&[&["run", "--rate", "50", "--dwell", "2"][..], &null].concat());
    assert_eq!(code(&output), 0, "{}", reason(&output));
}

/// Options that write a file, with the ends that its name may have, and a command before each.
const ENDS: [(&str, &str, &[&str]); 6] = [
    ("run --rate 50 --dwell 2 --hold 0", "--report", &[".html", ".htm"]),
    ("run --rate 50 --dwell 2 --hold 0", "--record", &[".csv", ".csv.gz", ".jsonl", ".jsonl.gz"]),
    ("replay STAGE", "--report", &[".html", ".htm"]),
    ("replay IMU --method vertical", "--attitude-out", &[".csv"]),
    ("plan --arw 1 --latitude 1 --sigma 100", "--report", &[".html", ".htm"]),
    ("campaign spin --runs 1", "--report", &[".html", ".htm"]),
];

#[test]
fn a_name_that_ends_otherwise_than_what_is_written_is_refused_with_the_ends_that_it_may_have() {
    let scratch = Scratch::new("ends");
    let (stage, imu) = (stored("stepwise-bumped"), stored("imu-broad-24"));
    for (command, option, ends) in ENDS {
        let command = command.replace("STAGE", &stage).replace("IMU", &imu);
        let words: Vec<&str> = command.split(' ').collect();
        for name in ["page", "page.txt", "page.json", "page.csv.zip", "html", "csv", ".gz"] {
            let path = scratch.path(name);
            let words = [&words[..], &[option, &path]].concat();
            assert_misuse(&words, &format!("ends in {}", ends.join(", ")));
        }
        for end in ends.iter().flat_map(|end| [(*end).to_owned(), end.to_uppercase()]) {
            let path = scratch.path(&format!("good{end}"));
            let output = meridian(&[&words[..], &[option, &path]].concat());
            assert_eq!(code(&output), 0, "{path}: {}", reason(&output));
            assert!(fs::metadata(&path).is_ok_and(|file| file.len() > 0), "{path}");
            fs::remove_file(path).expect("it is ours");
        }
        assert_eq!(fs::read_dir(scratch.folder()).expect("it is there").count(), 0, "{command}");
    }
}

#[test]
fn what_is_there_stays_where_nothing_comes_of_the_work() {
    let scratch = Scratch::new("kept");
    let spoilt = scratch.with("spoilt.csv", "# kind: stage\nt_s,stage_rad\n0,x\n");
    let (page, table) = (scratch.with("page.html", "before"), scratch.with("table.csv", "before"));
    let vertical = ["replay", &spoilt, "--method", "vertical", "--attitude-out", &table];
    for arguments in [&["replay", &spoilt][..], &vertical, &["allan", &spoilt]] {
        let output = meridian(&[arguments, &["--report", &page]].concat());
        assert_eq!(code(&output), 1, "{arguments:?}: {}", reason(&output));
        assert_eq!(scratch.read("page.html") + &scratch.read("table.csv"), "beforebefore");
        assert_eq!(fs::read_dir(scratch.folder()).expect("it is there").count(), 3);
    }
}

#[cfg(unix)]
#[test]
fn a_link_leads_to_what_is_written_and_stays_one() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let scratch = Scratch::new("links");
    scratch.with("page.html", "before");
    let there = scratch.folder().join("page.html");
    fs::set_permissions(&there, fs::Permissions::from_mode(0o640)).expect("it is ours");
    symlink("page.html", scratch.path("soft.html")).expect("the folder is ours");
    symlink("later.html", scratch.path("to-be.html")).expect("the folder is ours");
    for link in ["soft.html", "to-be.html"] {
        let path = scratch.path(link);
        let plan = ["plan", "--arw", "1", "--latitude", "1", "--sigma", "100", "--report", &path];
        assert_eq!(code(&meridian(&plan)), 0);
        assert!(fs::symlink_metadata(&path).is_ok_and(|of| of.is_symlink()), "{link}");
    }
    assert!(scratch.read("page.html").starts_with("<!DOCTYPE"));
    assert!(scratch.read("later.html").starts_with("<!DOCTYPE"));
    let mode = fs::metadata(there).expect("it is there").permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
    assert_eq!(fs::read_dir(scratch.folder()).expect("it is there").count(), 4);
}

#[cfg(unix)]
#[test]
fn an_output_may_have_any_name_that_the_system_lets_it_have() {
    use std::os::unix::ffi::OsStringExt as _;
    let scratch = Scratch::new("any-name");
    let stage = stored("stepwise-circle");
    let named = |name: &[u8]| scratch.folder().join(std::ffi::OsString::from_vec(name.to_vec()));
    let [page, csv, again] = [&b"b\xe4d.html"[..], b"r\xe4d.csv", b"b\xe4d.csv"].map(named);
    let runs = [
        (&["run", "--report"][..], &page),
        (&["run", "--record"], &csv),
        (&["replay", &stage, "--report"], &page),
        (&["replay", &stored("imu-broad-24"), "--method", "vertical", "--attitude-out"], &again),
    ];
    for (arguments, path) in runs {
        let output = command().args(arguments).arg(path).arg("-q").output().expect("it starts");
        assert_eq!(code(&output), 0, "{arguments:?}: {}", reason(&output));
        assert!(fs::metadata(path).is_ok_and(|file| file.len() > 0), "{arguments:?}");
    }
}
