//! The report of `campaign disturbed`.

use super::precisions;
use crate::campaign::disturbed::{HealthyRow, Row, WRONG_SIGMAS};
use crate::report::{Lines, Part, Report, Table};

/// Reasons of refusals that are shown for each class.
const REASONS: usize = 4;

/// What healthy recordings gave, and what became of each class of faults.
#[must_use]
pub fn report(healthy: &[HealthyRow], rows: &[Row]) -> Report {
    let named = healthy.iter().map(|row| (row.method.to_string(), &row.precision));
    let table = (!healthy.is_empty()).then(|| precisions("Healthy recordings", "method", named));
    let reasons = Some(reasons(rows)).filter(|lines| !lines.lines.is_empty());
    let parts = table.into_iter().map(Part::from);
    let subtitle = [
        format!("an answer is wrong beyond {WRONG_SIGMAS} of its σ"),
        "a fault is harmless where it moves the answer by less than the healthy σ".to_owned(),
    ];
    Report {
        title: "Recordings with faults of any severity".to_owned(),
        subtitle: subtitle.to_vec(),
        parts: parts.chain([classes(rows).into()]).chain(reasons.map(Part::from)).collect(),
    }
}

fn classes(rows: &[Row]) -> Table {
    let head = [
        "class",
        "runs",
        "answered",
        "wrong (few, told)",
        "worst, σ",
        "harmless answered",
        "healthy refused",
        "met",
        "severity",
    ];
    let line = |row: &Row| {
        let [low, high] = row.fault.severity;
        vec![
            row.fault.name.clone(),
            row.runs.to_string(),
            row.answered.to_string(),
            format!("{} ({}, {})", row.wrong, row.wrong_of_few, row.wrong_told),
            format!("{:.1}", row.worst_sigmas),
            format!("{} of {}", row.harmless_answered, row.harmless),
            row.healthy_refused.to_string(),
            if row.is_met { "yes" } else { "NO" }.to_owned(),
            format!("{low} to {high} {}", row.fault.unit),
        ]
    };
    Table { rows: rows.iter().map(line).collect(), ..Table::new("Classes of faults", &head) }
}

/// The most frequent reasons of refusals, class by class.
fn reasons(rows: &[Row]) -> Lines {
    let mut lines = Lines::new("Most frequent reasons of refusals");
    for row in rows {
        for (reason, count) in row.reasons.iter().take(REASONS) {
            lines.add(&row.fault.name, format!("{count:>4} × {reason}"));
        }
    }
    lines
}
