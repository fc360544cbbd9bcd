//! Golden files: what the commands of `golden/commands.txt` print, as text, as JSON and as a page, and the
//! bits that the emulated firmware is compared with.
//!
//! Wall-clock times, versions and commits are masked. `MERIDIAN_GOLDEN=write cargo test --test golden` writes the files anew; a
//! commit that does so says why.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/mod.rs"]
mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::Output;

use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use host::emulate::jobs::JOBS;
use host::emulate::outcome::Row;
use host::methods::METHODS;
use host::methods::asked::Asked;
use serde_json::Value;
use simulated::trace::ABSENT;

use support::files::{Scratch, recording, recordings};
use support::pages::figures;
use support::program::command;

/// A command, and the name of its files.
struct Golden<'a> {
    name: &'a str,
    arguments: Vec<&'a str>,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

/// The commands of the list whose names begin so.
fn goldens<'a>(list: &'a str, family: &str) -> Vec<Golden<'a>> {
    let entries = list.lines().filter_map(|line| line.split_once(": "));
    let chosen = entries.filter(|(name, _)| !name.starts_with('#') && name.starts_with(family));
    chosen
        .map(|(name, rest)| Golden { name, arguments: rest.split_whitespace().collect() })
        .collect()
}

fn meridian(arguments: &[&str]) -> Output {
    command().current_dir(recordings()).args(arguments).output().expect("it starts")
}

/// The exit code, then what stands on standard output, without the times that a clock on the wall gave.
fn printed(output: &Output) -> String {
    let code = output.status.code().expect("no signal ended it");
    format!("exit {code}\n{}", without_times(&String::from_utf8_lossy(&output.stdout)))
}

/// A text without what its lines tell of how quick something was.
fn without_times(text: &str) -> String {
    text.lines().flat_map(|line| [masked(line), "\n"]).collect()
}

/// The exit code and the JSON object on standard output, a key a line.
fn printed_object(output: &Output) -> String {
    let code = output.status.code().expect("no signal ended it");
    let object: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    format!("exit {code}\n{object:#}\n")
}

/// A line without what it tells at its end of how quick something was.
fn masked(line: &str) -> &str {
    if line.starts_with("<p class=\"origin\">") {
        return "(masked)";
    }
    let cut = line.find(" Hz in ").map(|at| at + " Hz".len());
    &line[..cut.unwrap_or(line.len())]
}

/// Holds a text to its file, or writes the file where that is asked for.
fn hold(file: &str, found: &str, differing: &mut Vec<String>) {
    let path = folder().join(file);
    if std::env::var_os("MERIDIAN_GOLDEN").is_some_and(|what| what == "write") {
        fs::write(path, packed(file, found)).expect("the folder is ours");
        return;
    }
    let kept = fs::read(&path).map(|bytes| unpacked(file, &bytes)).unwrap_or_default();
    let (mut lines, mut kept) = (found.lines(), kept.lines());
    let mut number = 0;
    loop {
        number += 1;
        match (lines.next(), kept.next()) {
            (None, None) => return,
            (found, kept) if found == kept => {}
            (found, kept) => {
                return differing
                    .push(format!("{file}:{number}\n  kept  {kept:?}\n  found {found:?}"));
            }
        }
    }
}

fn is_packed(file: &str) -> bool {
    Path::new(file).extension().is_some_and(|ending| ending == "gz")
}

fn packed(file: &str, text: &str) -> Vec<u8> {
    if !is_packed(file) {
        return text.as_bytes().to_vec();
    }
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(text.as_bytes()).expect("memory takes it");
    encoder.finish().expect("memory takes it")
}

fn unpacked(file: &str, bytes: &[u8]) -> String {
    let mut text = String::new();
    if is_packed(file) {
        GzDecoder::new(bytes).read_to_string(&mut text).expect("a golden page is text in gzip");
    } else {
        text.push_str(std::str::from_utf8(bytes).expect("a golden file is text"));
    }
    text
}

/// Runs every command of a family for JSON, and once more for text with a page unless its name is that of one file.
fn hold_family(family: &str) {
    let list = fs::read_to_string(folder().join("commands.txt")).expect("the list is there");
    let mut differing = Vec::new();
    for Golden { name, arguments } in goldens(&list, family) {
        let json = meridian(&[&arguments[..], &["--json"]].concat());
        let only = name.strip_suffix(".json");
        let stem = only.unwrap_or(name);
        hold(&format!("{stem}.json"), &printed_object(&json), &mut differing);
        if only.is_some() {
            continue;
        }
        let scratch = Scratch::new("golden");
        let page = scratch.path(&format!("golden-{name}.html"));
        let report = [&arguments[..], &["--report", page.as_str()]].concat();
        let text = meridian(&report);
        hold(&format!("{name}.txt"), &printed(&text), &mut differing);
        if let Ok(html) = fs::read_to_string(&page) {
            hold(&format!("{name}.html.gz"), &without_times(&html), &mut differing);
        }
    }
    assert!(differing.is_empty(), "{}", differing.join("\n"));
}

#[test]
fn simulated_runs_print_what_they_printed() {
    hold_family("run");
}

#[test]
fn replays_print_what_they_printed() {
    hold_family("replay");
}

#[test]
fn campaigns_print_what_they_printed() {
    hold_family("campaign");
}

/// What `.ci/full` runs: the table of faults over all platforms, where every test run holds one platform's.
#[test]
#[ignore = "every fault on every platform; .ci/full runs it"]
fn the_table_of_faults_over_all_platforms_is_what_it_was() {
    hold_family("whole");
}

#[test]
fn noise_analyses_and_plans_print_what_they_printed() {
    hold_family("allan");
    hold_family("plan");
}

#[test]
fn the_bits_that_the_emulated_firmware_is_compared_with_are_what_they_were() {
    let mut found = String::new();
    for seed in [1, 2] {
        for job in JOBS {
            let outcome = (job.on_host)(seed).expect("the simulated board comes to an end");
            writeln!(found, "{}, seed {seed}: {:?}", job.word, outcome.reason)
                .expect("memory takes it");
            outcome.rows.iter().for_each(|row| describe(&mut found, row));
        }
    }
    let mut differing = Vec::new();
    hold("emulator.txt", &found, &mut differing);
    assert!(differing.is_empty(), "{}", differing.join("\n"));
}

/// Writes the bits of a dwell, a turn, a stop, a second that was kept, or the azimuth.
fn describe(text: &mut String, row: &Row) {
    let bits = row.bits.iter().map(|bits| match *bits {
        ABSENT => "-".to_owned(),
        bits => format!("{bits:x}"),
    });
    writeln!(text, "{} {}", row.kind(), bits.collect::<Vec<_>>().join(" "))
        .expect("memory takes it");
}

/// What `README.md` says of the keys.
fn readme() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let text = fs::read_to_string(path).expect("the page is there");
    let (_, keys) = text.split_once("\n## Keys of the objects\n").expect("the list is there");
    keys.to_owned()
}

/// The keys that a text has between its code marks.
fn marked(text: &str) -> impl Iterator<Item = String> + '_ {
    text.split('`').skip(1).step_by(2).map(str::to_owned)
}

/// The keys that `README.md` lists in its tables: those of objects, and those of what objects hold.
fn listed() -> [BTreeSet<String>; 2] {
    let text = readme();
    let rows = text.lines().filter(|line| line.starts_with("| `"));
    let (of_objects, held): (Vec<_>, Vec<_>) =
        rows.filter_map(|row| row[1..].split_once('|')).unzip();
    [of_objects, held].map(|cells| cells.into_iter().flat_map(marked).collect())
}

/// The keys without an asterisk that an object of a method has.
fn needed(method: &str) -> Vec<String> {
    let text = readme();
    let section = |heading: &str| {
        let found = text.split("\n### ").find(|section| section.starts_with(heading));
        found.expect("the section is there").lines()
    };
    let of_all = section("What every method has").map(|row| (row, true));
    let of_methods = section("What a method adds").map(|row| {
        let methods = row.split('|').nth(2).unwrap_or_default();
        (row, methods.split(',').any(|named| named.trim() == method))
    });
    let cells = of_all.chain(of_methods).filter(|(row, is_its)| *is_its && row.starts_with("| `"));
    let cells = cells.filter_map(|(row, _)| row.split('|').nth(1));
    let plain = cells.filter(|cell| !cell.contains('*'));
    plain.flat_map(marked).collect()
}

/// All keys of a value, those of what it holds too.
fn keys(value: &Value, into: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields {
                into.insert(key.clone());
                keys(value, into);
            }
        }
        Value::Array(values) => values.iter().for_each(|value| keys(value, into)),
        _ => {}
    }
}

#[test]
fn every_object_of_a_run_or_replay_keeps_the_contract_of_the_readme() {
    let list = fs::read_to_string(folder().join("commands.txt")).expect("the list is there");
    let [of_objects, held] = listed();
    let mut found = BTreeSet::new();
    for Golden { name, .. } in ["run", "replay"].iter().flat_map(|family| goldens(&list, family)) {
        let file = folder().join(format!("{name}.json"));
        let text = fs::read_to_string(file).expect("every command has its golden files");
        let (exit, object) = text.split_once('\n').expect("the exit code stands first");
        let object: Value = serde_json::from_str(object).expect("an object follows");
        keys(&object, &mut found);
        let is_ok = object["status"] == "ok";
        assert_eq!(is_ok, exit == "exit 0", "{name}");
        assert!(!is_ok || !name.ends_with("refused"), "{name}");
        assert_eq!(is_ok, object.get("reason").is_none(), "{name}: a refusal has a reason");
        if object["status"] == "failed" {
            continue;
        }
        assert_eq!(object["schema"], 1, "{name}");
        assert!(object["file"].is_string() != object["seed"].is_u64(), "{name}: one of both");
        assert!(is_ok || object.get("azimuth_deg").is_none(), "{name}: none where refused");
        let method = object["method"].as_str().expect("it has a method");
        let needed = needed(method).into_iter().filter(|key| is_ok && object.get(key).is_none());
        assert_eq!(needed.collect::<Vec<_>>(), [""; 0], "{name} lacks keys of README.md");
        let sigma = object.get("sigma_deg").and_then(Value::as_f64);
        assert!(!is_ok || sigma.is_some_and(|sigma| sigma > 0.0), "{name}: a result has its σ");
    }
    let unlisted: Vec<_> = found.difference(&(&of_objects | &held)).cloned().collect();
    assert!(unlisted.is_empty(), "not in README.md: {unlisted:?}");
    // No recording of these has a warning.
    let unmet: Vec<_> = of_objects.difference(&found).filter(|key| *key != "warnings").collect();
    assert!(unmet.is_empty(), "in README.md, but in no object: {unmet:?}");
}

#[test]
fn a_quantity_has_one_colour_on_the_pages_of_all_commands() {
    let mut colours: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let files = fs::read_dir(folder()).expect("the folder is ours");
    let paths = files.map(|file| file.expect("a file").path());
    for path in paths.filter(|path| path.to_string_lossy().ends_with(".html.gz")) {
        let page = unpacked("page.html.gz", &fs::read(path).expect("it is there"));
        let all =
            figures(&page).into_iter().filter_map(|figure| figure["series"].as_array().cloned());
        for series in all.flatten() {
            let [name, class] = ["name", "class"].map(|key| series[key].to_string());
            colours.entry(name).or_default().insert(class);
        }
    }
    // The stretches of a turntable are named by their speeds, which each has of its own.
    colours.retain(|name, colours| !name.contains(" Hz") && colours.len() > 1);
    assert!(colours.is_empty(), "{colours:?}");
}

/// A recording of every kind.
const KINDS: [&str; 6] = [
    "stepwise-circle",
    "positions-four-fog",
    "rotating-gyro",
    "drive-fog-three-stops",
    "spin-80rps-noisy",
    "static-gyro-1h",
];

#[test]
fn every_method_answers_some_kinds_by_its_name_with_listed_keys_and_says_why_it_refuses_the_others()
{
    let [of_objects, held] = listed();
    let listed = &of_objects | &held;
    for method in &METHODS {
        let mut answered = 0;
        for name in KINDS {
            let (header, body, truth) = recording(name).into_parts();
            let asked = Asked { method: Some(method.name), ..Asked::default() };
            let finished = match (method.replay)(&header, &body, &asked, &|_| {}) {
                Ok(finished) => finished,
                Err(why) => {
                    assert!(!why.to_string().is_empty(), "{} of {name}", method.name);
                    continue;
                }
            };
            let outcome = finished.outcome(&truth);
            assert_eq!(outcome.method, method.name, "{name}");
            assert!(!outcome.assumed.is_empty() && outcome.seconds > 0.0, "{name}");
            assert!(!outcome.parts.is_empty(), "{name} is shown to people, too");
            let mut found = BTreeSet::new();
            keys(&serde_json::to_value(&outcome).expect("it is an object"), &mut found);
            let unlisted: Vec<_> = found.difference(&listed).collect();
            assert!(unlisted.is_empty(), "{}, not in README.md: {unlisted:?}", method.name);
            answered += 1;
        }
        assert!(answered > 0, "{} answers nothing", method.name);
    }
}
