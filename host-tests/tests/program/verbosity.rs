//! How much is told: progress without being asked, the log where it is asked for, errors alone where that is.

use std::time::Duration;

use host::output::progress::is_due;

use crate::support::files::{Scratch, stored};
use crate::support::program::{assert_misuse, code, meridian, object, text};

/// Runs and replays with a result.
fn commands() -> Vec<Vec<String>> {
    let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let stage = stored("stepwise-nudged");
    vec![
        words("run --rate 50 --dwell 2 --positions 6 --hold 10"),
        words("run two-frame --rate 50 --dwell 2 --passes 2"),
        words("run spin --flight-seconds 0.5"),
        vec!["replay".to_owned(), stage],
        words("plan --arw 0.001 --latitude 48 --sigma 0.05"),
    ]
}

fn told(arguments: &[String], more: &[&str]) -> std::process::Output {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).chain(more.to_vec()).collect();
    let output = meridian(&arguments);
    assert_eq!(code(&output), 0, "{arguments:?}: {}", text(&output.stderr));
    output
}

#[test]
fn a_quiet_command_with_a_result_says_nothing_on_standard_error_and_two_lines_at_most() {
    for arguments in commands() {
        for quiet in ["-q", "--quiet"] {
            let output = told(&arguments, &[quiet]);
            assert_eq!(text(&output.stderr), "", "{arguments:?}");
            let lines = text(&output.stdout).lines().count();
            assert!((1..=2).contains(&lines), "{arguments:?}: {}", text(&output.stdout));
        }
    }
}

#[test]
fn the_log_of_a_run_is_shown_only_where_it_is_asked_for() {
    for arguments in commands().iter().take(3) {
        let usual = text(&told(arguments, &[]).stderr);
        let verbose = text(&told(arguments, &["-v"]).stderr);
        let part = "identity and self-test passed";
        assert!(!usual.contains(part) && verbose.contains(part), "{arguments:?}: {usual}");
        assert!(usual.lines().all(|line| line.contains(" %, ")), "{arguments:?}: {usual}");
    }
}

#[test]
fn progress_has_its_part_and_the_time_that_is_left_from_the_first_line() {
    for arguments in commands().iter().take(2) {
        let usual = text(&told(arguments, &[]).stderr);
        let first = usual.lines().next().unwrap_or_default();
        let rest = first.split(" %, ").nth(1).unwrap_or_default();
        let left = rest.split(' ').next().unwrap_or_default();
        let digits = left.split(':').all(|part| part.parse::<u32>().is_ok());
        assert!(digits && rest.contains(" left"), "{arguments:?}: {usual}");
    }
}

#[test]
fn progress_counts_no_more_than_is_planned_and_names_what_comes_after_the_alignment() {
    let run = "run vehicle --rate=50 --stops=2 --stop-seconds=30 --realign --hold=700";
    let run: Vec<String> = run.split(' ').map(str::to_owned).collect();
    let told = text(&told(&run, &[]).stderr);
    let steps = told.lines().filter_map(|line| line.strip_prefix("stops ")?.split_once(','));
    for (steps, _) in steps {
        let (done, planned) = steps.split_once('/').expect("so many of so many");
        let [done, planned] = [done, planned].map(|count| count.parse::<u32>().expect("a number"));
        assert!(done <= planned, "{told}");
    }
    let kept = told.lines().skip_while(|line| !line.starts_with("keeping, "));
    assert!(
        kept.clone().count() > 2 && kept.clone().all(|line| line.starts_with("keeping, ")),
        "{told}"
    );
}

#[test]
fn who_reads_objects_gets_no_progress_and_the_same_object_however_much_is_told() {
    for arguments in commands() {
        let usual = told(&arguments, &["--json"]);
        assert_eq!(text(&usual.stderr), "", "{arguments:?}");
        for how in ["-v", "-q"] {
            assert_eq!(object(&told(&arguments, &["--json", how])), object(&usual));
        }
    }
}

#[test]
fn a_refusal_is_said_to_a_quiet_command_too() {
    let stage = stored("stepwise-circle");
    let output = meridian(&["replay", &stage, "--latitude", "86", "-q"]);
    assert_eq!(code(&output), 1);
    assert_eq!(text(&output.stderr).lines().count(), 1);
    assert!(text(&output.stderr).contains("latitude 86.00° is beyond ±85°"));
}

#[test]
fn quiet_and_verbose_do_not_go_together_wherever_they_stand() {
    for wrong in [&["-q", "-v"][..], &["-v", "run", "-q"], &["run", "--quiet", "--verbose"]] {
        assert_misuse(wrong, "--quiet");
    }
}

#[test]
fn options_of_every_command_name_no_platform() {
    let of_the_stage = meridian(&["run", "stage", "-q"]);
    for before in [&[][..], &["run"]] {
        assert_eq!(meridian(&[before, &["-q"]].concat()), of_the_stage, "{before:?}");
    }
}

#[test]
fn what_every_run_is_given_is_no_assumption_of_its_text_but_one_of_its_object() {
    let run = ["run", "--rate", "50", "--dwell", "2", "--hold", "0"];
    let told = text(&meridian(&[&run[..], &["-v"]].concat()).stdout);
    assert!(!told.contains("What was assumed"), "{told}");
    let assumed = object(&meridian(&[&run[..], &["--json"]].concat()))["assumed"].clone();
    assert_eq!(assumed[0], "what the board was given about place and instrument");
}

#[test]
fn a_quiet_noise_analysis_still_says_that_the_unit_may_be_wrong() {
    let sound = meridian(&["allan", &stored("static-gyro-1h"), "-q"]);
    assert_eq!((code(&sound), text(&sound.stderr)), (0, String::new()));
    let scratch = Scratch::new("quiet-units");
    let rows = (0..2000_u32).map(|row| {
        let rate = 1.0 + 1e-6 * f64::from(row.wrapping_mul(2_654_435_761) >> 16);
        format!("{:.1},{rate:.6e}\n", f64::from(row) / 10.0)
    });
    let content = "# kind: static\nt_s,g_rad_s\n".to_owned() + &rows.collect::<String>();
    let doubtful = meridian(&["allan", &scratch.with("degrees.csv", content), "-q"]);
    let said = text(&doubtful.stderr);
    assert!(
        said.starts_with("warning: g_rad_s was read in rad/s, as every rate is, but "),
        "{said}"
    );
}

#[test]
fn short_work_on_recordings_prints_no_progress_and_long_work_a_line_now_and_then() {
    let stage = stored("stepwise-circle");
    let output = meridian(&["replay", &stage, &stored("stepwise-nudged")]);
    assert_eq!((code(&output), text(&output.stderr)), (0, String::new()));
    let seconds = Duration::from_secs_f64;
    assert!(!is_due(seconds(0.1), Some(seconds(0.7)), seconds(0.0)));
    assert!(is_due(seconds(0.1), Some(seconds(60.0)), seconds(0.0)));
    assert!(!is_due(seconds(2.0), Some(seconds(60.0)), seconds(3.1)));
    assert!(!is_due(seconds(2.0), None, seconds(0.0)));
}
