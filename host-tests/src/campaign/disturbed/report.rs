//! `campaign disturbed`: its entry in the registry, and its report.

use serde_json::json;

use super::{Class, HealthyRow, Row, classes, healthy, row};
use crate::campaign::columns::Columns;
use crate::campaign::faults::WRONG_SIGMAS;
use crate::campaign::{Asked, Campaign, Done, Tick, one_by_one, unless};
use crate::report::{Lines, Part, Report};

/// Every class of faults in recordings, or one, and healthy recordings beside all.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "disturbed",
    meaning: "Recordings with faults of any severity: what gets past, and what is refused without need",
    runs: 200,
    steps: "recordings",
    count: |asked| chosen(asked).count() * asked.runs + healthy_runs(asked),
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where each class passes.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let all = asked.class.is_none().then(|| healthy(healthy_runs(asked), tick));
    let healthy = all.unwrap_or_default();
    let rows = one_by_one(chosen(asked), tick, |class| row(&class, asked.runs, tick));
    let reason = "a class of faults gets past, or is refused without need";
    Done {
        report: report(&healthy, &rows),
        refusal: unless(rows.iter().all(|row| row.is_met), reason),
        object: json!({ "healthy": healthy, "classes": rows }),
    }
}

/// Reasons of refusals that are shown for each class.
const REASONS: usize = 4;

/// The classes that are asked for.
fn chosen(asked: &Asked) -> impl Iterator<Item = Class> {
    classes().filter(|of| asked.class.as_ref().is_none_or(|name| of.fault.name == *name))
}

/// Healthy recordings beside all classes.
fn healthy_runs(asked: &Asked) -> usize {
    if asked.class.is_none() { HEALTHY * asked.runs } else { 0 }
}

/// Healthy recordings for each run of a class.
const HEALTHY: usize = 15;
/// What healthy recordings gave, and what became of each class of faults.
fn report(healthy: &[HealthyRow], rows: &[Row]) -> Report {
    let of_healthy = (!healthy.is_empty()).then(|| of_healthy(healthy));
    let parts = of_healthy.into_iter().chain([of_classes(rows), reasons(rows).into()]);
    Report::new("Recordings with faults of any severity", parts).below([
        &format!("an answer is wrong beyond {WRONG_SIGMAS} of its σ"),
        "a fault is harmless where it moves the answer by less than the healthy σ",
    ])
}

fn of_healthy(rows: &[HealthyRow]) -> Part {
    let table = Columns::of("Healthy recordings", rows).column("method", |row| row.method);
    table.precision(|row| &row.precision).into()
}

fn of_classes(rows: &[Row]) -> Part {
    Columns::of("Classes of faults", rows)
        .column("class", |row| &row.fault.name)
        .column("runs", |row| row.runs)
        .column("answered", |row| row.answered)
        .column("wrong (few, stated)", |row| {
            format!("{} ({}, {})", row.wrong, row.wrong_of_few, row.wrong_stated)
        })
        .fixed("worst, σ", 1, |row| row.worst_sigmas)
        .column("harmless answered", |row| format!("{} of {}", row.harmless_answered, row.harmless))
        .column("healthy refused", |row| row.healthy_refused)
        .column("met", |row| if row.is_met { "yes" } else { "no" })
        .column("severity", |row| {
            let [low, high] = row.fault.severity;
            format!("{low} to {high} {}", row.fault.unit)
        })
        .into()
}

/// The most frequent reasons of refusals, class by class.
fn reasons(rows: &[Row]) -> Lines {
    rows.iter().fold(Lines::new("Most frequent reasons of refusals"), |lines, row| {
        let first = row.reasons.iter().take(REASONS);
        let words = first.map(|(reason, count)| format!("{count:>4} × {reason}"));
        lines.with_found(&row.fault.name, words)
    })
}
