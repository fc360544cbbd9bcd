//! `campaign faults`: its entry in the registry, and its report.

use serde_json::json;
use simulated::fault::Platform;

use std::fmt::Display;

use super::{Row, count, rows};
use crate::campaign::columns::Columns;
use crate::campaign::{Asked, Campaign, Done, Tick, unless};
use crate::report::{Part, Report};

/// Every fault of one platform or of all with every seed.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "faults",
    meaning: "Every fault on every platform: what the board notices, and what comes of it",
    runs: 1,
    steps: "faults",
    count: |asked| count(&platforms(asked)) * asked.runs,
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where none was answered wrongly or missed.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let rows = rows(&platforms(asked), 1..=asked.runs as u64, tick);
    let is_good = rows.iter().all(|row| !row.is_bad());
    let reason = "a fault gave a wrong north or roll, came to no end, or went unnoticed";
    let (report, refusal) = (report(&rows), unless(is_good, reason));
    Done { report, refusal, object: json!({ "faults": rows }) }
}

fn platforms(asked: &Asked) -> Vec<Platform> {
    asked.platform.map_or_else(|| Platform::ALL.to_vec(), |platform| vec![platform])
}

/// What came of all faults together, of those that did what no fault may, and of each.
fn report(rows: &[Row]) -> Report {
    let bad: Vec<&Row> = rows.iter().filter(|row| row.is_bad()).collect();
    let bad = table("Wrong, failed or not noticed", &bad);
    let all = table("Faults", &rows.iter().collect::<Vec<_>>());
    Report::new("Every fault on every platform", [summary(rows), bad, all.detail()])
}

/// What came of these faults, one by one.
fn table(title: &str, rows: &[&Row]) -> Part {
    Columns::of(title, rows)
        .column("platform", |row| row.platform)
        .column("fault", |row| &row.fault)
        .column("outcome", |row| row.outcome)
        .column("error, σ", |row| or_dash(row.error_sigmas.map(|sigmas| format!("{sigmas:+.2}"))))
        .column("faults", |row| row.faults)
        .column("repeated", |row| or_dash(row.repeated))
        .column("left out", |row| or_dash(row.left_out))
        .fixed("after, s", 1, |row| row.seconds)
        .column("noticed", |row| or_dash(row.is_noticed.map(|is| if is { "yes" } else { "no" })))
        .column("what the board noticed first → why it refused", |row| {
            let reason = row.reason.as_ref().map(|reason| format!(" → {reason}"));
            let first = row.noticed.as_deref().unwrap_or("nothing");
            format!("{first}{}", reason.unwrap_or_default())
        })
        .into()
}

/// What came of all faults of each platform together.
fn summary(rows: &[Row]) -> Part {
    let platforms: Vec<&[Row]> = rows.chunk_by(|a, b| a.platform == b.platform).collect();
    let ended = |outcome: &'static str| {
        move |rows: &&[Row]| rows.iter().filter(|row| row.outcome == outcome).count()
    };
    Columns::of("What came of them", &platforms)
        .column("platform", |rows| rows[0].platform)
        .column("faults", |rows| rows.len())
        .column("ok", ended("ok"))
        .column("refused", ended("refused"))
        .column("wrong", ended("wrong"))
        .column("failed", ended("failed"))
        .column("not noticed", |rows| {
            rows.iter().filter(|row| row.is_noticed == Some(false)).count()
        })
        .found("greatest error, σ", 2, |rows| {
            rows.iter().filter_map(|row| Some(row.error_sigmas?.abs())).reduce(f64::max)
        })
        .into()
}

fn or_dash(value: Option<impl Display>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| value.to_string())
}
