//! Numbers and tables as they are printed: nothing is empty, and nothing is less than zero by nothing.

use host::output::{azimuth, counted, fixed, in_number, signed, significant};
use host::report::{Columns, Lines, Part, Report, Table};
use proptest::prelude::*;
use serde_json::Value;

use crate::support::files::{Scratch, stored};
use crate::support::pages::figures;
use crate::support::program::{code, meridian, object, text, words};

proptest! {
    #[test]
    fn what_rounds_to_zero_has_no_minus(value in -2.0_f64..2.0, places in 0_usize..6) {
        let value = value * 10.0_f64.powi(-i32::try_from(places).expect("it is small"));
        for (text, plain) in [(fixed(value, places), format!("{value:.places$}")), (signed(value, places), format!("{value:+.places$}"))] {
            let number: f64 = text.parse().expect("a number");
            prop_assert_eq!(number, plain.parse::<f64>().expect("a number"));
            prop_assert!(number != 0.0 || !text.contains('-'), "{}", text);
            prop_assert!(number == 0.0 || text == plain, "{}", text);
        }
    }
}

proptest! {
    #[test]
    fn an_azimuth_stands_within_a_circle_however_it_is_rounded(degrees in -720.0_f64..720.0, places in 0_usize..6) {
        for degrees in [degrees, degrees.round(), degrees.round() - 1e-9] {
            let text = azimuth(degrees, places);
            let number: f64 = text.parse().expect("a number");
            prop_assert!((0.0..360.0).contains(&number) && !text.starts_with('-'), "{}", text);
            let off = (number - degrees).rem_euclid(360.0);
            let least = 0.5001 * 10.0_f64.powi(-i32::try_from(places).expect("it is small")) + 1e-9;
            prop_assert!(off.min(360.0 - off) <= least, "{} of {}", text, degrees);
        }
    }

    #[test]
    fn a_number_of_so_many_digits_is_right_to_the_last_of_them(exponent in -6.0_f64..6.0, digits in 1_i32..8) {
        let value = 10.0_f64.powf(exponent);
        let text = significant(value, digits);
        let number: f64 = text.parse().expect("a number");
        prop_assert!(!text.contains('e') && (number / value - 1.0).abs() <= 5.001 * 10.0_f64.powi(-digits), "{}", text);
    }
}

#[test]
fn what_is_counted_has_the_number_that_its_count_asks_for() {
    let all = [counted(0, "turn"), counted(1, "turn"), counted(2, "turn"), counted(2, "pass")];
    assert_eq!(all, ["0 turns", "1 turn", "2 turns", "2 passes"]);
}

#[test]
fn lines_and_tables_without_content_are_left_out() {
    let none: [f64; 0] = [];
    let empty = Columns::of("Nothing", &none).fixed("number", 1, |number| *number);
    let parts: [Part; 3] = [empty.into(), Lines::new("No lines").into(), Table::default().into()];
    assert_eq!(Report::new("A title", parts).parts, []);
}

/// Runs that end before they measured, or whose numbers are near zero.
const RUNS: [&str; 13] = [
    "stage --no-base-imu --sway 0.05",
    "stage --latitude 90",
    "stage --positions 2",
    "turntable --fault encoder-stuck",
    "turntable --latitude=-86",
    "stage --fault gyro-identity",
    "stage --latitude 86",
    "stage --handover 213.7,0.1 --hold 30",
    "two-frame --fault base-nudge",
    "two-frame --handover 213.7,0.16",
    "turntable --fault gyro-identity",
    "vehicle --fault forward-gyro-identity",
    "spin --fault forward-gyro-identity",
];

/// What a run tells, in full, and its page.
fn told(run: &str) -> [String; 2] {
    let scratch = Scratch::new("numbers");
    let page = scratch.path("page.html");
    let beside = ["-v", "--report", &page];
    let arguments: Vec<&str> = ["run"].into_iter().chain(run.split(' ')).chain(beside).collect();
    [text(&meridian(&arguments).stdout), scratch.read("page.html")]
}

/// What of a page stands outside of its tags: texts, and the numbers of figures.
fn outside_of_tags(page: &str) -> String {
    let pieces = page.split('<').filter_map(|piece| piece.split_once('>'));
    pieces.fold(String::new(), |all, (_, text)| all + text + "\n")
}

/// That no number in a text is less than zero by nothing.
#[track_caller]
fn assert_no_negative_zero(of: &str, told: &str) {
    let told = told.replace('−', "-");
    for word in told.split([' ', '°', '\n', ',', ';', '[', ']']) {
        let is_zero = word.parse::<f64>().is_ok_and(|number| number == 0.0);
        assert!(!(is_zero && word.starts_with('-')), "{of}: {word} in {told}");
    }
}

/// That no heading of a text stands above nothing.
#[track_caller]
fn assert_no_empty_table(of: &str, told: &str) {
    let lines: Vec<&str> = told.lines().chain([""]).collect();
    for pair in lines.windows(3) {
        let is_heading = pair[0].starts_with("  ") && !pair[0].starts_with("   ");
        let is_empty = is_heading && pair[1].starts_with("    ") && pair[2].is_empty();
        assert!(!is_empty || pair[0].contains(':'), "{of}: {pair:?} in {told}");
    }
}

#[test]
fn no_run_shows_a_table_without_rows_a_figure_without_points_or_a_negative_zero() {
    for run in RUNS {
        let [told, page] = told(run);
        assert_no_empty_table(run, &told);
        assert_no_negative_zero(run, &told);
        assert_no_negative_zero(run, &outside_of_tags(&page));
        let drawn = figures(&page);
        let is_empty = |series: &Value| series["points"].as_array().is_some_and(Vec::is_empty);
        let has_none = |figure: &&Value| {
            figure["series"].as_array().is_some_and(|all| all.iter().all(is_empty))
        };
        assert_eq!(drawn.iter().find(has_none), None, "{run}");
    }
}

#[test]
fn a_run_in_which_nothing_was_fitted_names_no_model() {
    for run in ["turntable --fault gyro-identity", "turntable --latitude 86", "stage --latitude 90"]
    {
        let [told, page] = told(run);
        assert!(!told.contains("  model "), "{run}: {told}");
        assert!(!page.contains("<dt>model</dt>"), "{run}");
    }
}

#[test]
fn a_run_that_never_knew_its_azimuth_kept_nothing() {
    for run in ["stage --latitude 90", "stage --positions 2", "two-frame --latitude 86"] {
        let [told, page] = told(run);
        for words in ["Kept for", "RMS on the way", "not known any more"] {
            assert!(!told.contains(words), "{run}: {told}");
        }
        assert!(!page.contains("Kept for") && !page.contains(">keeping<"), "{run}");
        let arguments: Vec<&str> = ["run", "--json"].into_iter().chain(run.split(' ')).collect();
        assert!(object(&meridian(&arguments)).get("kept").is_none(), "{run}");
    }
}

#[test]
fn a_truth_that_rounds_to_a_whole_circle_is_north() {
    let run = ["run", "--azimuth", "359.99999", "--rate", "50", "--dwell", "2", "--hold", "0"];
    let told = text(&meridian(&run).stdout);
    assert!(told.contains("truth              0.0000°"), "{told}");
}

/// Panics where a text has a number with an exponent.
#[track_caller]
fn assert_no_exponent(told: &str) {
    let is_exponent = |of: &[char]| {
        of[0].is_ascii_digit() && of[1] == 'e' && (of[2] == '-' || of[2].is_ascii_digit())
    };
    assert!(!told.chars().collect::<Vec<_>>().windows(3).any(is_exponent), "{told}");
}

#[test]
fn results_have_no_exponents() {
    let recordings = ["static-gyro-1h", "spin-100rps", "spin-80rps-noisy", "drive-fog-1dph"];
    let [rest, spin, noisy, drive] = recordings.map(stored);
    let commands: [&[&str]; 7] = [
        &["allan", &rest],
        &["replay", &spin],
        &["replay", &noisy, "-v"],
        &["replay", &drive],
        &["run", "spin"],
        &["run", "spin", "--fault", "forward-gyro-identity"],
        &["plan", "--arw", "0.001", "--latitude", "48", "--seconds", "600"],
    ];
    for command in commands {
        assert_no_exponent(&text(&meridian(command).stdout));
    }
}

#[test]
fn a_plan_counts_one_pass() {
    let output = meridian(&["plan", "--arw", "0.001", "--latitude", "48", "--seconds", "600"]);
    assert!(text(&output.stdout).contains("1 pass\n"), "{}", text(&output.stdout));
}

#[test]
fn what_the_core_leaves_open_between_one_and_several_is_decided_by_the_number() {
    for (open, decided) in [
        ("1 undisturbed position(s): three", "1 undisturbed position: three"),
        ("0 whole even turn(s) clockwise", "0 whole even turns clockwise"),
        ("2 dwell(s) at the end", "2 dwells at the end"),
        ("1 turn(s), then 12 turn(s)", "1 turn, then 12 turns"),
        ("nothing of the kind", "nothing of the kind"),
    ] {
        assert_eq!(in_number(open), decided);
    }
}

#[test]
fn what_is_refused_prints_no_empty_line() {
    let output = meridian(&[
        "plan",
        "--arw",
        "0.1",
        "--bias-instability",
        "9",
        "--latitude",
        "48",
        "--sigma",
        "0.0001",
    ]);
    assert_eq!((code(&output), text(&output.stdout).as_str()), (1, ""));
}

#[test]
fn a_plan_on_the_equator_from_the_south_has_no_negative_latitude() {
    let output = meridian(&["plan", "--latitude=-0", "--arw", "0.001", "--seconds", "600"]);
    assert_no_negative_zero("plan", &text(&output.stdout));
}

#[test]
fn a_latitude_in_place_of_the_recordings_is_told_unless_it_is_the_same() {
    let noted = |latitude: &str| {
        let output = meridian(&["replay", &stored("stepwise-circle"), "--latitude", latitude]);
        words(&text(&output.stdout)).contains("the recording states 47.5833°")
    };
    for other in ["-47.58", "47.7", "47.3"] {
        assert!(noted(other), "{other}");
    }
    for same in ["47.58", "47°35′"] {
        assert!(!noted(same), "{same}");
    }
}

#[test]
fn a_recording_from_a_pole_is_refused_without_numbers_that_mean_nothing() {
    for name in ["stepwise-circle", "rotating-gyro", "drive-fog-three-stops"] {
        let output = meridian(&["replay", &stored(name), "--latitude", "90", "-v"]);
        assert_eq!(code(&output), 1, "{name}");
        let printed = text(&output.stdout);
        assert!(printed.contains("latitude 90.00° is beyond ±85°"), "{name}: {printed}");
        for told in ["Error budget", "Earth rate  ", "limit  "] {
            assert!(!printed.contains(told), "{name}: {printed}");
        }
    }
}
