//! What campaigns print: one report for terminal and page, whose figures only the page shows.

pub mod burov;
pub mod disturbed;
pub mod faults;
pub mod instrument;
pub mod keep;
pub mod rotating;
pub mod sokolov;
pub mod spin;
pub mod szymanowski;

use crate::campaign::statistics::{NORMAL_COVERAGE, Precision};
use crate::report::Table;

/// Columns of what many alignments amount to.
const PRECISION: [&str; 7] =
    ["runs", "refused", "RMS, °", "limit, °", "error / limit", "within 1, 2, 3 σ, %", "worst, σ"];

/// What many alignments amount to, under [`PRECISION`].
fn precision(row: &Precision) -> [String; 7] {
    [
        row.runs.to_string(),
        row.refused.to_string(),
        format!("{:.4}", row.rms_deg),
        format!("{:.4}", row.limit_deg),
        format!("{:.3}", row.ratio),
        covered(&row.coverage_percent),
        format!("{:.2}", row.worst_sigmas),
    ]
}

/// Per cent of errors within 1, 2 and 3 σ.
fn covered([one, two, three]: &[f64; 3]) -> String {
    format!("{one:.1}, {two:.1}, {three:.1}")
}

/// A table of what many alignments amount to, a row for each name.
fn precisions<'a>(
    title: &str,
    name: &str,
    rows: impl IntoIterator<Item = (String, &'a Precision)>,
) -> Table {
    let head: Vec<&str> = [name].into_iter().chain(PRECISION).collect();
    let row =
        |(name, row): (String, &Precision)| [name].into_iter().chain(precision(row)).collect();
    Table { rows: rows.into_iter().map(row).collect(), ..Table::new(title, &head) }
}

/// First reasons of refusals, a line each.
fn reasons<'a>(rows: impl IntoIterator<Item = &'a Precision>) -> Vec<String> {
    let reasons = rows.into_iter().filter_map(|row| row.first_reason.as_ref());
    reasons.map(|reason| format!("first refusal: {reason}")).collect()
}

/// What a normal distribution has within 1, 2 and 3 σ.
fn normal() -> String {
    let [one, two, three] = NORMAL_COVERAGE;
    format!("a normal distribution has {one}, {two}, {three} % within 1, 2, 3 σ")
}
