//! A run that aligns itself anew tells what it found, beside what it kept, also where it ends while it aligns.

use crate::support::files::Scratch;
use crate::support::program::{code, meridian, object, page, reason, text};

/// Runs that end while another alignment is under way, or before one begins.
const RUNS: [&str; 4] = [
    "stage --rate 50 --dwell 2 --realign --hold 450",
    "two-frame --rate 50 --dwell 2 --passes 1 --realign --hold 450",
    "turntable --rate 50 --turns 3 --realign --hold 480",
    "vehicle --rate 50 --stops 2 --stop-seconds 30 --realign --hold 420",
];

#[test]
fn the_alignment_stands_beside_what_was_kept_and_its_replay_says_the_same() {
    let scratch = Scratch::new("realigned");
    let path = scratch.path("run.jsonl");
    for run in RUNS {
        let arguments: Vec<&str> = ["run"].into_iter().chain(run.split(' ')).collect();
        let output = meridian(&[&arguments[..], &["--json", "--record", &path]].concat());
        assert_eq!(code(&output), 0, "{run}: {}", reason(&output));
        let found = object(&output);
        assert_ne!(found["method"], "kept", "{run}");
        for key in ["azimuth_deg", "sigma_deg", "error_deg"] {
            assert!(found[key].is_number() && found["kept"][key].is_number(), "{run}: {key}");
        }
        assert!(found["budget"].is_object() && found["positions"].is_u64(), "{run}");
        let sigmas = found["error_deg"].as_f64().zip(found["sigma_deg"].as_f64());
        assert!(sigmas.is_some_and(|(error, sigma)| error.abs() < 5.0 * sigma), "{run}");
        let told = text(&meridian(&arguments).stdout);
        for part in ["azimuth of body x", "Error budget", "Kept for"] {
            assert!(told.contains(part), "{run}: {part} in {told}");
        }
        let replayed = object(&meridian(&["replay", &path, "--json"]));
        for key in ["method", "azimuth_deg", "sigma_deg", "budget", "alignments", "kept"] {
            assert_eq!(found[key], replayed[key], "{run}: {key}");
        }
    }
}

#[test]
fn each_of_several_alignments_stands_in_the_output() {
    let run = ["run", "vehicle", "--rate=50", "--stops=2", "--stop-seconds=30", "--realign"];
    let found = object(&meridian(&[&run[..], &["--hold=1200", "--json"]].concat()));
    let all = found["alignments"].as_array().expect("there are several");
    let latest = all.last().expect("there are several");
    assert!(all.len() > 1 && all.is_sorted_by_key(|one| one["at_s"].as_f64()), "{all:?}");
    for key in ["azimuth_deg", "sigma_deg"] {
        let apart = latest[key].as_f64().zip(found[key].as_f64()).map(|(a, b)| (a - b).abs());
        assert!(apart.is_some_and(|apart| apart < 1e-9), "{key}: {latest} beside {}", found[key]);
    }
    let told = text(&meridian(&[&run[..], &["--hold=1200"]].concat()).stdout);
    for one in all {
        let [azimuth, sigma] = ["azimuth_deg", "sigma_deg"].map(|key| one[key].as_f64());
        for value in [azimuth, sigma].map(|value| format!("{:.4}", value.expect("a number"))) {
            assert!(told.contains(&value), "{value} in {told}");
        }
    }
}

#[test]
fn an_azimuth_of_an_alignment_after_one_that_was_refused_stands_beside_its_own_truth() {
    let run = ["run", "stage", "--pitch=20", "--seconds=60", "--realign", "--hold=600", "--seed=3"];
    let found = object(&meridian(&[&run[..], &["--json"]].concat()));
    let [error, sigma] =
        ["error_deg", "sigma_deg"].map(|key| found[key].as_f64().expect("a number"));
    assert!(error.abs() < 4.0 * sigma, "{error}° at a σ of {sigma}°");
    let told = text(&meridian(&run).stdout);
    assert!(told.contains("first alignment    refused at "), "{told}");
    assert!(told.contains("by the latest alignment"), "{told}");
}

#[test]
fn a_run_of_which_no_alignment_found_an_azimuth_says_why() {
    let run = ["run", "vehicle", "--rate=50", "--gyro=mems", "--latitude=84", "--realign"];
    let output = meridian(&run);
    assert_eq!(code(&output), 1);
    let told = text(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(told.contains("reason no alignment found it: the latest was refused at "), "{told}");
    assert!(told.contains("first alignment refused at "), "{told}");
}

/// The words of a page's timeline in the row of this name.
fn told_in_row(page: &str, name: &str) -> Vec<String> {
    let (_, row) = page.split_once(&format!("<span>{name}</span>")).expect("the row is there");
    let (row, _) = row.split_once("</div>").expect("it ends");
    let words = row.split("title=\"").skip(1).filter_map(|rest| rest.split_once('"'));
    words.map(|(words, _)| words.to_owned()).collect()
}

#[test]
fn the_timeline_has_what_the_alignments_before_the_latest_did() {
    let scratch = Scratch::new("before");
    let inputs = scratch.path("run.jsonl");
    let runs = [
        ("stage --rate 50 --dwell 2 --realign --hold 500", "dwell 25"),
        ("turntable --rate 50 --turns 3 --realign --hold 600", "turns"),
        ("vehicle --rate 50 --stops 2 --stop-seconds 30 --realign --hold 600", "stop 2"),
    ];
    for (run, words) in runs {
        let run: Vec<&str> = ["run"].into_iter().chain(run.split(' ')).collect();
        let (_, ran) = page(&[&run[..], &["--record", &inputs]].concat());
        let before = told_in_row(&ran, "alignments before");
        assert!(before.iter().any(|told| told.contains(words)), "{run:?}: {before:?}");
        let (_, replayed) = page(&["replay", &inputs]);
        assert_eq!(told_in_row(&replayed, "alignments before"), before, "{run:?}");
    }
}
