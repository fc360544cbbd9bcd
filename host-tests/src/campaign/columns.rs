//! What the reports of campaigns are made of: one report for terminal and page, whose figures only the page shows.

use super::statistics::{NORMAL_COVERAGE, Precision};
pub(super) use crate::report::Columns;

impl<'a, R> Columns<'a, R> {
    /// Per cent of errors within 1, 2 and 3 σ.
    pub(super) fn covered(self, of: impl Fn(&'a R) -> [f64; 3]) -> Self {
        self.column("within 1, 2, 3 σ, %", |row| list(&of(row)))
    }

    /// What many alignments amount to.
    pub(super) fn precision(self, of: impl Fn(&'a R) -> &'a Precision) -> Self {
        self.column("runs", |row| of(row).runs)
            .column("refused", |row| of(row).refused)
            .fixed("RMS, °", 4, |row| of(row).rms_deg)
            .fixed("limit, °", 4, |row| of(row).limit_deg)
            .fixed("error / limit", 3, |row| of(row).ratio)
            .covered(|row| of(row).coverage_percent)
            .fixed("worst, σ", 2, |row| of(row).worst_sigmas)
    }
}

/// Three numbers with one decimal place, and a dash for one that there is not.
pub(super) fn list(values: &[f64; 3]) -> String {
    let text = |value: f64| if value.is_nan() { "-".to_owned() } else { format!("{value:.1}") };
    values.map(text).join(", ")
}

/// First reasons of refusals, a line each.
pub(super) fn reasons<'a>(
    rows: impl IntoIterator<Item = &'a Precision>,
) -> impl Iterator<Item = String> {
    let reasons = rows.into_iter().filter_map(|row| row.first_reason.as_ref());
    reasons.map(|reason| format!("first refusal: {reason}"))
}

/// What a normal distribution has within 1, 2 and 3 σ.
pub(super) fn normal() -> String {
    let [one, two, three] = NORMAL_COVERAGE;
    format!("a normal distribution has {one}, {two}, {three} % within 1, 2, 3 σ")
}
