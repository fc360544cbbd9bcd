//! Numbers and tables as they are printed: nothing is empty, and nothing is less than zero by nothing.

use host::output::{fixed, signed};
use host::report::{Columns, Lines, Part, Report, Table};
use proptest::prelude::*;

use crate::support::program::{meridian, text};

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

#[test]
fn lines_and_tables_without_content_are_left_out() {
    let none: [f64; 0] = [];
    let empty = Columns::of("Nothing", &none).fixed("number", 1, |number| *number);
    let parts: [Part; 3] = [empty.into(), Lines::new("No lines").into(), Table::default().into()];
    assert_eq!(Report::new("A title", parts).parts, []);
}

/// Runs that end before they measured, or whose numbers are near zero.
const RUNS: [&str; 8] = [
    "stage --fault gyro-identity",
    "stage --latitude 86",
    "stage --handover 213.7,0.1 --hold 30",
    "two-frame --fault base-nudge",
    "two-frame --handover 213.7,0.16",
    "turntable --fault gyro-identity",
    "vehicle --fault gyro-identity",
    "spin --fault gyro-identity",
];

#[test]
fn no_run_prints_a_table_without_rows_or_a_negative_zero() {
    for run in RUNS {
        let arguments: Vec<&str> = ["run"].into_iter().chain(run.split(' ')).collect();
        let told = text(&meridian(&arguments).stdout);
        let lines: Vec<&str> = told.lines().chain([""]).collect();
        for pair in lines.windows(3) {
            let is_heading = pair[0].starts_with("  ") && !pair[0].starts_with("   ");
            let is_empty = is_heading && pair[1].starts_with("    ") && pair[2].is_empty();
            assert!(!is_empty || pair[0].contains(':'), "{run}: {pair:?} in {told}");
        }
        for word in told.split([' ', '°', '\n', ',', ';']) {
            let is_zero = word.parse::<f64>().is_ok_and(|number| number == 0.0);
            assert!(!(is_zero && word.starts_with('-')), "{run}: {word} in {told}");
        }
    }
}
