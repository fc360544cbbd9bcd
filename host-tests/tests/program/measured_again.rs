//! Dwells that were disturbed and measured again are told in the text, on the page, in the object and to the progress.

use crate::support::files::Scratch;
use crate::support::program::{code, meridian, object, page, reason, text};

/// Faults by which one dwell is measured again, on platforms that stop.
const RUNS: [[&str; 4]; 4] = [
    ["stage", "--rate=50", "--fault", "base-nudge"],
    ["stage", "--rate=50", "--fault", "door-slam"],
    ["stage", "--rate=50", "--fault", "saturation-once"],
    ["two-frame", "--rate=50", "--fault", "door-slam"],
];

#[test]
fn text_page_and_object_tell_which_dwells_were_measured_again_and_why() {
    for run in RUNS {
        let (output, page) = page(&[&["run"], &run[..]].concat());
        let told = text(&output.stdout);
        assert!(told.contains("measured again     1 dwell: "), "{run:?}: {told}");
        assert!(page.contains(", measured again: "), "{run:?}");
        let found = object(&meridian(&[&["run", "--json"], &run[..]].concat()));
        let again = found["measured_again"].as_array().expect("it is a list");
        assert_eq!(again.len(), 1, "{run:?}: {again:?}");
        let [dwell, why] = ["dwell", "reason"].map(|key| again[0][key].to_string());
        assert!(told.contains(&format!("1 dwell: {dwell}\n")), "{run:?}: {told}");
        assert!(why.len() > 4, "{run:?}: {why}");
    }
}

#[test]
fn a_run_in_which_no_dwell_was_measured_again_tells_nothing_of_it() {
    let run = ["run", "--rate", "50", "--dwell", "2", "--hold", "0"];
    assert!(!text(&meridian(&run).stdout).contains("measured again"));
    let found = object(&meridian(&[&run[..], &["--json"]].concat()));
    assert!(found.get("measured_again").is_none(), "{found}");
}

#[test]
fn a_replay_of_the_run_tells_the_same() {
    let scratch = Scratch::new("measured-again");
    for name in ["run.csv", "run.jsonl"] {
        let path = scratch.path(name);
        let ran = meridian(&["run", "--fault", "door-slam", "--json", "--record", &path]);
        assert_eq!(code(&ran), 0, "{}", reason(&ran));
        let replayed = object(&meridian(&["replay", &path, "--json"]));
        assert_eq!(replayed["measured_again"], object(&ran)["measured_again"], "{name}");
        assert!(replayed["measured_again"].is_array(), "{name}: {replayed}");
    }
}

/// The whole time, s, that the latest line of a run's progress expects.
fn expected(arguments: &[&str]) -> f64 {
    let said = text(&meridian(arguments).stderr);
    let line = said.lines().rfind(|line| line.contains(" left")).expect("it shows progress");
    let (_, behind) = line.split_once(" of ").expect("a time of the whole");
    behind.split(' ').next().and_then(|time| time.parse().ok()).expect("a number")
}

#[test]
fn the_progress_expects_a_dwell_that_is_measured_again() {
    let [sound, disturbed] = [&["--hold", "0"], &["--fault", "door-slam"]]
        .map(|more| expected(&[&["run"], &more[..]].concat()));
    assert!((9.0..13.0).contains(&(disturbed - sound)), "{sound} s, {disturbed} s");
}

#[test]
fn a_run_that_is_given_its_azimuth_keeps_it_from_then_on_and_ends_when_it_says() {
    for platform in ["stage", "two-frame", "turntable", "vehicle"] {
        let run = ["run", platform, "--handover", "213.7,0.1", "--hold", "100"];
        let said = text(&meridian(&run).stderr);
        let shown: Vec<&str> = said.lines().filter(|line| line.contains(" left")).collect();
        assert!(shown.len() > 5, "{platform}: {said}");
        let last = shown.last().expect("there are some");
        assert!(last.starts_with("keeping, "), "{platform}: {said}");
        let share = last.split(", ").find_map(|part| part.strip_suffix(" %"));
        let share = share.and_then(|share| share.parse::<u32>().ok()).expect("a share");
        assert!(share > 85, "{platform}: {said}");
    }
}

#[test]
fn a_run_that_is_given_its_azimuth_says_where_with_which_gyro_and_how_long() {
    for platform in ["stage", "two-frame", "turntable", "vehicle"] {
        let (_, page) = page(&["run", platform, "--handover", "213.7,0.1", "--hold", "30"]);
        let head = page.split("</header>").next().expect("a head");
        for words in ["<dt>place</dt>", "latitude 4", "<dt>gyro</dt>", "<dt>time</dt>", "kept for "]
        {
            assert!(head.contains(words), "{platform}: {words} in {head}");
        }
    }
}

#[test]
fn a_run_at_a_pole_ends_with_its_refusal_and_tells_no_time_of_no_dwells() {
    for platform in ["stage", "two-frame", "turntable", "vehicle"] {
        let run = ["run", platform, "--latitude", "89", "--hold", "14400", "-v"];
        let output = meridian(&run);
        let (told, said) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(code(&output), 1, "{platform}: {said}");
        assert!(reason(&output).contains("latitude 89.00° is beyond ±85°"), "{platform}: {said}");
        let refused = said.lines().find(|line| line.contains("no azimuth: latitude 89.00°"));
        let at_s = refused.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
        assert_eq!(at_s, Some(0.0), "{platform}: {said}");
        assert!(!told.contains("0.0 s in 0 "), "{platform}: {told}");
        let seconds =
            object(&meridian(&[&run[..], &["--json"]].concat()))["simulated_seconds"].as_f64();
        assert!(seconds.is_some_and(|seconds| seconds < 30.0), "{platform}: {seconds:?}");
    }
}

#[test]
fn an_azimuth_that_is_given_at_a_pole_is_kept() {
    let run = ["run", "--latitude", "89", "--handover", "213.7,0.1", "--hold", "60"];
    assert!(text(&meridian(&run).stdout).contains("Kept for"));
}
