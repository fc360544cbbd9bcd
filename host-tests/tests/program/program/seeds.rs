//! Any seed, any legal sample rate, and statuses that agree with the exit code.

use std::path::Path;

use crate::support::files::{Scratch, stored};
use crate::support::program::{assert_misuse, code, meridian, object, reason, text};

/// What can be run, as shortly as it can be.
const RUNS: [&[&str]; 8] = [
    &["stage", "--rate", "50", "--dwell", "2", "--positions", "6", "--hold", "0"],
    &["stage", "--rate", "50", "--dwell", "2", "--positions", "6", "--hold", "20"],
    &["stage", "--rate", "50", "--sway", "0.2", "--dwell", "2", "--positions", "8"],
    &["stage", "--rate", "50", "--seconds", "60", "--gyro", "fog"],
    &["two-frame", "--rate", "50", "--dwell", "2", "--passes", "2"],
    &["turntable", "--rate", "50", "--turns", "2", "--modulated-turns", "4"],
    &["vehicle", "--rate", "50", "--stops", "2", "--drive-seconds", "240", "--hold", "10"],
    &["spin", "--flight-seconds", "0.5"],
];

#[test]
fn every_seed_of_64_bits_runs_on_every_platform() {
    for run in RUNS {
        for seed in ["0", "2635249153387078803", "9223372036854775808", "18446744073709551615"] {
            let arguments = [&["run"], run, &["--seed", seed, "--json"]].concat();
            let output = meridian(&arguments);
            assert!(code(&output) <= 1, "{arguments:?}: {}", text(&output.stderr));
            assert_eq!(object(&output)["seed"].to_string(), seed, "{arguments:?}");
        }
    }
}

#[test]
fn the_default_run_finds_north_with_seed_zero_and_with_246_which_took_noise_for_a_start() {
    for seed in ["0", "246", "18446744073709551615"] {
        let output = meridian(&["run", "--seed", seed, "--json"]);
        assert_eq!(code(&output), 0, "{seed}: {}", reason(&output));
        let object = object(&output);
        let number = |key: &str| object[key].as_f64().expect("a number");
        assert!((number("azimuth_deg") - 213.7).abs() < 5.0 * number("sigma_deg"), "{seed}");
    }
}

#[test]
fn what_is_no_seed_of_64_bits_is_misuse() {
    for wrong in ["-1", "18446744073709551616", "1.5", "one", ""] {
        assert_misuse(
            &["run", "--seed", wrong],
            "not a whole number from 0 to 18446744073709551615",
        );
        assert_misuse(&["emulate", "--seed", wrong], "not a whole number");
    }
}

#[test]
fn a_healthy_run_tells_no_sample_beside_its_time_at_any_rate() {
    for rate in ["20", "50", "60", "100", "400", "1200", "2400"] {
        for platform in [&["stage", "--positions", "4"][..], &["two-frame", "--passes", "1"]] {
            let hold = if rate == "20" { "0" } else { "10" };
            let short = ["--json", "--dwell", "2", "--hold", hold, "--rate", rate];
            let output = meridian(&[&["run"], platform, &short[..]].concat());
            let object = object(&output);
            let count = |what: &str| object["health"][what].as_u64().expect("a count");
            assert_eq!(count("late"), 0, "{rate} {platform:?}: {}", reason(&output));
            assert!(!text(&output.stderr).contains("beside its time"), "{rate} {platform:?}");
            // Two frames' chips and the base's share what a period at 2400 Hz has: one conversion in a minute is lost.
            let lost = u64::from(rate == "2400" && platform[0] == "two-frame");
            assert!(count("missing") <= lost, "{rate} {platform:?}: {}", count("missing"));
        }
    }
}

#[test]
fn the_status_is_ok_exactly_where_the_exit_code_is_zero() {
    let (stage, rest, imu) =
        (stored("stepwise-circle"), stored("static-gyro-1h"), stored("imu-broad-24"));
    let plan = ["plan", "--arw", "0.01", "--latitude", "48"];
    let nowhere = ["--report", "/nowhere/page.html"];
    let (stage, rest) = (["replay", stage.as_str()], ["allan", rest.as_str()]);
    let run = ["run", "--rate", "50", "--dwell", "2", "--hold", "0"];
    let cases: [(Vec<&str>, i32); 13] = [
        (stage.to_vec(), 0),
        ([&stage[..], &nowhere].concat(), 1),
        ([&stage[..], &["--require-sigma", "0.001"], &nowhere].concat(), 1),
        (rest.to_vec(), 0),
        ([&rest[..], &nowhere].concat(), 1),
        ([&plan[..], &["--seconds", "300"]].concat(), 0),
        ([&plan[..], &["--seconds", "300"], &nowhere].concat(), 1),
        ([&plan[..], &["--seconds", "5"]].concat(), 1),
        (run.to_vec(), 0),
        ([&run[..], &nowhere].concat(), 1),
        (vec!["run", "--fault", "list"], 0),
        (vec!["campaign", "spin", "--runs", "1", "--report", "/nowhere/page.html"], 1),
        (
            vec!["replay", &imu, "--method", "vertical", "--attitude-out", "/nowhere/attitude.csv"],
            1,
        ),
    ];
    for (arguments, expected) in cases {
        let output = meridian(&[&arguments[..], &["--json"]].concat());
        let object = object(&output);
        assert_eq!(code(&output), expected, "{arguments:?}: {}", reason(&output));
        assert_eq!(object["status"] == "ok", expected == 0, "{arguments:?}");
        assert_eq!(object["reason"].is_string(), expected != 0, "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_whose_page_cannot_be_written_is_printed_all_the_same() {
    let stage = stored("stepwise-circle");
    let arguments = ["replay", &stage, "--report", "/dev/full"];
    let output = meridian(&[&arguments[..], &["--json"]].concat());
    let object = object(&output);
    assert!(object["azimuth_deg"].is_number());
    assert_eq!(object["status"], "failed");
    let why = object["reason"].as_str().expect("a reason");
    assert!(why.contains("/dev/full: the report cannot be written: the disk is full"), "{why}");
    assert!(text(&meridian(&arguments).stdout).contains("azimuth of body x"));
    // Where there is no result, both are reported.
    let refused = meridian(&[&arguments[..], &["--require-sigma", "0.001"]].concat());
    let stated = text(&refused.stderr);
    assert!(stated.contains("above the accepted 0.001°"), "{stated}");
    assert!(stated.contains("warning: /dev/full: the report cannot be written"), "{stated}");
}

#[test]
fn a_flash_that_cannot_be_written_is_no_ok() {
    let scratch = Scratch::new("flash");
    let path = scratch.path("no-folder/flash");
    assert!(!Path::new(&path).exists());
    let turning = ["run", "turntable", "--turns", "2", "--modulated-turns", "4"];
    let output = meridian(&[&turning[..], &["--rate", "50", "--flash", &path, "--json"]].concat());
    assert_eq!((code(&output), &object(&output)["status"]), (1, &"failed".into()));
}

#[test]
fn what_a_base_that_sways_from_power_on_keeps_is_within_its_sigma() {
    for seed in ["3", "4", "6", "10"] {
        for sway in ["0.05", "0.5"] {
            let output = meridian(&["run", "stage", "--sway", sway, "--seed", seed, "--json"]);
            let kept = &object(&output)["kept"];
            let [sigmas, sigma] = ["greatest_sigmas", "sigma_deg"].map(|key| kept[key].as_f64());
            assert!(sigmas.is_some_and(|sigmas| sigmas < 3.0), "{sway}° {seed}: {sigmas:?} σ");
            assert!(sigma.is_some_and(|sigma| sigma < 6.0), "{sway}° {seed}: ± {sigma:?}°");
        }
    }
}
