//! What `firmware/BUDGET.md` says of the cost of each carrier's image is what executions show.
//!
//! `MERIDIAN_GOLDEN=write cargo test -p emulated-board --test executed budget` writes it anew.

use std::path::PathBuf;

use execution::built::root;
use execution::report::Report;
use firmware::platform::Platform;

use super::support::executed::executed;

/// Greatest relative deviation of a figure: where an image is built moves its code, and with it what runs when.
const ALIKE: f64 = 0.03;

/// Greatest relative deviation of the stack, which is deepest where the tasks of interrupts come at the deepest moment of
/// a conclusion, as some executions show and others do not: by 3.4 % of it, as was seen; twice that is allowed.
const STACK_ALIKE: f64 = 0.07;

/// A row of the table: its name, its figure of a report, and how far it may be off.
type Row = (&'static str, fn(&Report) -> f64, f64);

/// The rows.
const ROWS: [Row; 5] = [
    (
        "instructions a sample, all in",
        |report| report.instructions_per_sample.expect("it has measured"),
        ALIKE,
    ),
    ("percent of the time asleep", |report| 100.0 * report.idle, ALIKE),
    ("bytes of flash", |report| report.flash_bytes.into(), ALIKE),
    ("bytes of static RAM", |report| report.static_bytes.into(), ALIKE),
    ("bytes of stack at its deepest", |report| report.stack_bytes.into(), STACK_ALIKE),
];

/// The page.
fn page() -> PathBuf {
    root().join("firmware/BUDGET.md")
}

/// A row as the page has it.
fn line(name: &str, figures: &[f64]) -> String {
    let figures: Vec<_> = figures.iter().map(|figure| format!(" {figure:.0} |")).collect();
    format!("| {name} |{}", figures.concat())
}

/// The figures of a row of the page.
fn figures(line: &str) -> Option<Vec<f64>> {
    line.split('|')
        .map(str::trim)
        .filter(|part| !part.is_empty())
        .skip(1)
        .map(|part| part.parse().ok())
        .collect()
}

#[test]
fn the_cost_of_each_carriers_image_on_its_page_is_that_of_its_execution() {
    let mut text = std::fs::read_to_string(page()).expect("the page is there");
    let is_written = std::env::var_os("MERIDIAN_GOLDEN").is_some_and(|what| what == "write");
    for (name, of, alike) in ROWS {
        let found = Platform::ALL.map(|carrier| of(&executed(carrier, 1).report));
        let row = |line: &&str| {
            line.starts_with(&format!("| {name} |")) && line.matches('|').count() == 7
        };
        let kept = text.lines().find(row).unwrap_or_else(|| panic!("no row {name}")).to_owned();
        if is_written {
            text = text.replace(&kept, &line(name, &found));
            continue;
        }
        let shown = figures(&kept).unwrap_or_else(|| panic!("no figures in {kept}"));
        let is_alike = |(shown, found): (&f64, f64)| (shown - found).abs() <= alike * found + 1.0;
        let agree = shown.len() == found.len() && shown.iter().zip(found).all(is_alike);
        assert!(
            agree,
            "{kept}\n{}\nfirmware/BUDGET.md; MERIDIAN_GOLDEN=write writes it anew",
            line(name, &found)
        );
    }
    if is_written {
        std::fs::write(page(), text).expect("the page is ours");
    }
}
