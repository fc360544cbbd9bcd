//! Many recordings: a table, an array of the ordinary objects, and standard input.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Output, Stdio};

use serde_json::Value;

use crate::support::files::{Scratch, stored, unpacked};
use crate::support::program::{
    assert_misuse, code, command, meridian, object, reason, text, words,
};

/// Recordings of all kinds, with results and without.
const NAMES: [&str; 6] = [
    "stepwise-circle",
    "drive-fog-1dph",
    "static-gyro-1h",
    "rotating-gyro",
    "parked-swaying",
    "spin-80rps-noisy",
];

/// A folder with recordings of all kinds.
fn folder(name: &str) -> (Scratch, Vec<String>) {
    let scratch = Scratch::new(name);
    let mut names: Vec<String> = NAMES.iter().map(|name| format!("{name}.csv.gz")).collect();
    names.sort();
    for name in &names {
        fs::copy(stored(name.trim_end_matches(".csv.gz")), scratch.path(name)).expect("it is ours");
    }
    scratch.with("notes.txt", "no recording");
    scratch.with(".hidden.csv", "no recording");
    fs::create_dir(scratch.folder().join("deeper.csv")).expect("the folder is ours");
    let paths = names.iter().map(|name| scratch.path(name)).collect();
    (scratch, paths)
}

/// The program with a file as its standard input.
fn fed(arguments: &[&str], path: &str) -> Output {
    let input = File::open(path).expect("it is there");
    command().args(arguments).stdin(Stdio::from(input)).output().expect("it starts")
}

#[test]
fn a_folder_is_all_recordings_in_it_by_name_and_each_object_is_that_of_the_recording_alone() {
    let (scratch, paths) = folder("many");
    let whole = meridian(&["replay", &scratch.folder().display().to_string(), "--json"]);
    let listed: Vec<&str> =
        ["replay", "--json"].into_iter().chain(paths.iter().map(String::as_str)).collect();
    assert_eq!(object(&whole), object(&meridian(&listed)));
    let results = object(&whole)["results"].as_array().cloned().expect("an array");
    let alone: Vec<Value> =
        paths.iter().map(|path| object(&meridian(&["replay", path, "--json"]))).collect();
    for (mut alone, found) in alone.into_iter().zip(&results) {
        // What could not be replayed names its file among others.
        if alone["status"] == "failed" {
            alone["file"] = found["file"].clone();
        }
        assert_eq!(&alone, found);
    }
    assert_eq!(results.len(), paths.len());
    let bad = results.iter().filter(|result| result["status"] != "ok").count();
    assert!(bad > 0);
    assert_eq!((code(&whole), &object(&whole)["status"]), (1, &"refused".into()));
    assert!(
        reason(&whole).ends_with(&format!("{bad} of {} recordings gave no result", paths.len()))
    );
}

#[test]
fn what_a_single_recording_or_none_of_several_gave_is_said_in_words() {
    let scratch = Scratch::new("none");
    let reasons = ["one.csv", "two.csv"].map(|name| {
        scratch.with(name, "# kind: stage\n");
        reason(&meridian(&["replay", &scratch.folder().display().to_string()]))
    });
    assert_eq!(reasons[0], "meridian: the recording gave no result");
    assert_eq!(reasons[1], "meridian: none of 2 recordings gave a result");
}

#[test]
fn the_table_has_a_row_for_each_recording_and_tells_what_each_found() {
    let (scratch, paths) = folder("table");
    let output = meridian(&["replay", &scratch.folder().display().to_string()]);
    let table = text(&output.stdout);
    for path in &paths {
        let name = Path::new(path).file_name().expect("it has a name").to_string_lossy();
        let row = table.lines().find(|line| line.contains(&*name)).expect("it has a row");
        let alone = meridian(&["replay", path, "--json"]);
        let found = object(&alone);
        match (found["azimuth_deg"].as_f64(), found["sigma_deg"].as_f64()) {
            (Some(azimuth), Some(sigma)) => {
                assert!(row.contains(&format!("{azimuth:.4}° ± {sigma:.4}°")), "{row}");
            }
            (None, Some(sigma)) => assert!(row.contains(&format!("± {sigma:.4}°")), "{row}"),
            _ => assert!(row.contains(found["status"].as_str().expect("a status")), "{row}"),
        }
    }
    assert!(paths.iter().is_sorted());
}

#[test]
fn the_table_is_narrow_and_below_it_stands_the_whole_reason_of_each_recording_without_a_result() {
    let (scratch, paths) = folder("narrow");
    let folder = scratch.folder().display().to_string();
    for more in [&[][..], &["-v"]] {
        let output = meridian(&[&["replay", &folder], more].concat());
        let told = text(&output.stdout);
        let (table, reasons) = told.split_once("Why there is no result").expect("some have none");
        let unfolded = reasons.split_whitespace().collect::<Vec<_>>().join(" ");
        for line in table.lines() {
            assert!(line.chars().count() <= 100 && !line.contains(&folder), "{line}");
        }
        for path in &paths {
            let alone = object(&meridian(&["replay", path, "--json"]));
            let Some(reason) = alone["reason"].as_str() else { continue };
            let reason = reason.strip_prefix(&format!("{path}: ")).unwrap_or(reason);
            assert!(unfolded.contains(reason), "{reason} in {reasons}");
        }
    }
}

#[test]
fn a_quiet_table_has_a_line_for_each_recording_with_what_was_found_or_why_nothing_was() {
    let (scratch, paths) = folder("quiet");
    let output = meridian(&["replay", &scratch.folder().display().to_string(), "-q"]);
    let told = text(&output.stdout);
    assert_eq!(told.lines().count(), paths.len(), "{told}");
    for (line, path) in told.lines().zip(&paths) {
        let alone = object(&meridian(&["replay", path, "--json"]));
        let name = Path::new(path).file_name().expect("it has a name").to_string_lossy();
        let what = match alone["reason"].as_str() {
            Some(reason) => reason.strip_prefix(&format!("{path}: ")).unwrap_or(reason).to_owned(),
            None => format!("{:.4}°", alone["sigma_deg"].as_f64().expect("a number")),
        };
        assert!(line.starts_with(&format!("{name}: ")) && line.contains(&what), "{line}, {what}");
    }
}

#[test]
fn recordings_of_one_name_are_told_apart_by_their_folders() {
    let scratch = Scratch::new("names");
    let paths = ["one", "other"].map(|name| {
        let folder = scratch.folder().join(name);
        fs::create_dir(&folder).expect("the folder is ours");
        let path = folder.join("stage.csv.gz");
        fs::copy(stored("stepwise-circle"), &path).expect("it is ours");
        path.display().to_string()
    });
    let gyro = stored("rotating-gyro");
    let told = text(&meridian(&["replay", &paths[0], &paths[1], &gyro]).stdout);
    for shown in [&paths[0], &paths[1], "  rotating-gyro.csv.gz"] {
        assert!(told.contains(shown), "{shown} in {told}");
    }
}

/// How often words stand in all that a command printed.
fn told(output: &Output, what: &str) -> usize {
    let printed = [&output.stdout, &output.stderr].map(|bytes| words(&text(bytes))).join(" ");
    printed.matches(what).count()
}

#[test]
fn a_recording_that_has_no_page_is_named_and_the_reason_is_told_once() {
    let scratch = Scratch::new("no-page");
    let (empty, good) = (scratch.with("empty.csv", ""), stored("stepwise-circle"));
    let (pages, page) = (scratch.path("pages"), scratch.path("page.html"));
    let many = meridian(&["replay", &empty, &good, "--report", &pages]);
    let [one, noise] = ["replay", "allan"].map(|of| meridian(&[of, &empty, "--report", &page]));
    let warning = format!("warning: {empty}: there is no page for --report");
    for output in [&many, &one, &noise] {
        assert!(text(&output.stderr).contains(&warning), "{}", text(&output.stderr));
        assert_eq!(told(output, "the file is empty"), 1, "{}", text(&output.stderr));
    }
    assert_eq!(fs::read_dir(&pages).expect("it is there").count(), 1);
    assert!(!Path::new(&page).exists());
}

#[cfg(unix)]
#[test]
fn a_name_that_would_steer_the_terminal_is_shown_escaped_and_stands_in_objects_as_it_is() {
    let scratch = Scratch::new("steering");
    let name = "red\u{1b}[31m\u{7}\nline.csv.gz";
    let (good, bad) = (scratch.path(name), scratch.with("bad\u{1b}[0m.csv", "no recording"));
    fs::copy(stored("stepwise-circle"), &good).expect("it is ours");
    let (folder, report) = (scratch.folder().display().to_string(), scratch.path("page.html"));
    let pages = scratch.path("pages");
    let commands: [&[&str]; 9] = [
        &["replay", &good],
        &["replay", &good, "--report", &report],
        &["replay", &bad],
        &["allan", &bad, "--report", &report],
        &["allan", &good, "--column", "g_rad_s"],
        &["replay", &folder],
        &["replay", &folder, "-q"],
        &["replay", &folder, "--report", &pages],
        &["log", &bad, &good],
    ];
    for command in commands {
        let output = meridian(command);
        for printed in [&output.stdout, &output.stderr].map(|bytes| text(bytes)) {
            let is_hidden = |c: char| c.is_control() && c != '\n';
            assert!(!printed.contains(is_hidden), "{command:?}: {printed:?}");
            assert!(!printed.lines().any(|line| line.starts_with("line.csv")), "{command:?}");
        }
        let escaped =
            if command.contains(&&*bad) { "bad\\u{1b}[0m" } else { "red\\u{1b}[31m\\u{7}\\nline" };
        assert!(told(&output, escaped) > 0, "{command:?}: {}", text(&output.stdout));
    }
    assert_eq!(object(&meridian(&["replay", &good, "--json"]))["file"], good.as_str());
}

#[test]
fn recordings_that_all_have_a_result_are_a_result() {
    let (one, other) = (stored("stepwise-circle"), stored("rotating-gyro"));
    let output = meridian(&["replay", &one, &other, "--json"]);
    assert_eq!((code(&output), &object(&output)["status"]), (0, &"ok".into()));
    assert!(object(&output).get("reason").is_none());
}

#[test]
fn pages_and_attitudes_of_several_recordings_go_into_a_folder() {
    let scratch = Scratch::new("pages");
    let (one, other) = (stored("imu-broad-06"), stored("imu-broad-24"));
    let (pages, tables) = (scratch.path("pages"), scratch.path("a/tables"));
    let both = ["replay", &one, &other, "--method", "vertical"];
    let output = meridian(&[&both[..], &["--report", &pages, "--attitude-out", &tables]].concat());
    assert_eq!(code(&output), 0, "{}", reason(&output));
    for name in ["imu-broad-06", "imu-broad-24"] {
        assert!(scratch.read(&format!("pages/{name}.html")).starts_with("<!DOCTYPE"));
        assert!(scratch.read(&format!("a/tables/{name}.csv")).starts_with("t_s,"));
    }
    assert_eq!(fs::read_dir(&pages).expect("it is there").count(), 2);
    let file = scratch.path("page.html");
    assert_misuse(&[&both[..], &["--report", &file]].concat(), "name a folder");
    let twice = ["replay", &one, &one, "--method", "vertical", "--report", &pages];
    assert_misuse(&twice, "two recordings would have the file imu-broad-06");
}

#[test]
fn what_is_written_for_several_recordings_is_none_of_them() {
    let scratch = Scratch::new("themselves");
    let [plain, compressed] = ["plain", "compressed"].map(|name| scratch.path(name));
    for folder in [&plain, &compressed] {
        fs::create_dir(folder).expect("it is made");
    }
    let (there, linked) = (format!("{plain}/imu-broad-06.csv"), scratch.path("linked.csv"));
    fs::write(&there, "before").expect("it is written");
    fs::hard_link(&there, &linked).expect("it is linked");
    let stored = stored("imu-broad-06");
    fs::copy(&stored, format!("{compressed}/imu-broad-06.csv.gz")).expect("it is copied");
    let options = ["--method", "vertical", "--attitude-out"];
    for read in [&[plain.as_str()][..], &[&stored, &linked]] {
        let arguments = [&["replay"], read, &options, &[&plain]].concat();
        assert_misuse(&arguments, "is one of the recordings itself");
    }
    assert_eq!(fs::read_to_string(&there).expect("it is text"), "before");
    let beside = meridian(&[&["replay", &compressed][..], &options, &[&compressed]].concat());
    assert_eq!(code(&beside), 0, "{}", reason(&beside));
}

/// A command makes the same of standard input as of the file.
#[track_caller]
fn assert_taken_as_the_file(command: &str, path: &str) {
    let mut file = object(&meridian(&[command, path, "--json"]));
    let input = fed(&[command, "-", "--json"], path);
    assert_eq!(code(&input), 0, "{path}: {}", reason(&input));
    file["file"] = "standard input".into();
    assert_eq!(object(&input), file, "{path}");
}

#[test]
fn standard_input_replays_as_the_file_does_whether_it_is_compressed_or_not() {
    let scratch = Scratch::new("input");
    let plain = scratch.with("stage.csv", unpacked("stepwise-circle"));
    let run = ["run", "--rate", "50", "--dwell", "2", "--hold", "20", "--record"];
    let (lines, packed) = (scratch.path("run.jsonl"), scratch.path("run.jsonl.gz"));
    for path in [&lines, &packed] {
        assert_eq!(code(&meridian(&[&run[..], &[path]].concat())), 0);
    }
    for path in [&plain, &stored("stepwise-circle"), &lines, &packed] {
        assert_taken_as_the_file("replay", path);
    }
}

#[test]
fn standard_input_is_analysed_as_the_file_is_whether_it_is_compressed_or_not() {
    let scratch = Scratch::new("allan-input");
    let plain = scratch.with("hour.csv", unpacked("static-gyro-1h"));
    for path in [&plain, &stored("static-gyro-1h")] {
        assert_taken_as_the_file("allan", path);
    }
}

#[test]
fn standard_input_is_refused_as_a_file_is_and_read_once() {
    let scratch = Scratch::new("bad-input");
    let empty = scratch.with("empty", "");
    let output = fed(&["replay", "-"], &empty);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).contains("standard input: the file is empty"), "{}", reason(&output));
    assert_misuse(&["replay", "-", "-"], "standard input can be read once");
}
