//! `campaign keep`: its entry in the registry, and its report: what every class keeps, and how errors grow beside σ(t).

use serde_json::json;

use super::{COUNT, Growth, Row, row};
use crate::campaign::burov::LATITUDE_DEG;
use crate::campaign::columns::Columns;
use crate::campaign::statistics::Spread;
use crate::campaign::{Asked, Campaign, Done, Tick, one_by_one, unless};
use crate::report::{Figure, Part, Report, Series, Style};

/// Azimuth, pitch and roll through half an hour of driving.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "keep",
    meaning: "Storage of the azimuth, pitch and roll in vehicles that drive: Burov's classes",
    runs: 500,
    steps: "vehicles",
    count: |asked| COUNT * asked.runs,
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where every row that is to be met is.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let rows = one_by_one(0..COUNT, tick, |case| row(case, asked.runs, tick));
    let found = rows.iter().all(|row| row.is_met || !row.is_wanted);
    let refusal = unless(found, "a class does not meet its row; with few runs that may be chance");
    Done { report: report(&rows), refusal, object: json!({ "classes": rows }) }
}

/// The page for a campaign.
fn report(rows: &[Row]) -> Report {
    let figures = rows.iter().flat_map(|row| {
        let name = format!("{}, {}", row.class, row.mount);
        let (azimuth, level) = (row.wanted_azimuth_deg, row.wanted_level_deg);
        [
            growth(row, &format!("Azimuth: {name}"), azimuth, |at| at.azimuth),
            growth(row, &format!("Pitch and roll: {name}"), level, |at| at.level),
        ]
    });
    let parts = [of_classes(rows), of_errors(rows)].into_iter().chain(figures);
    Report::new("Azimuth, pitch and roll, kept for half an hour", parts).below([format!(
        "Burov, Table 1; a vehicle that drives without a halt, at {LATITUDE_DEG}° of latitude"
    )])
}

/// Errors and σ over the time.
fn growth(row: &Row, title: &str, wanted_deg: f64, of: impl Fn(&Growth) -> Spread) -> Part {
    let curve = |name, style, value: &dyn Fn(Spread) -> f64| {
        let points = row.growth.iter().map(|at| (at.seconds / 60.0, value(of(at))));
        Series::new(name, style, points)
    };
    let series = [
        curve("error", Style::LineAndPoints, &|spread| spread.rms_deg),
        curve("σ(t)", Style::Line, &|spread| spread.sigma_deg),
        curve("wanted", Style::Dashed, &|_| wanted_deg),
    ];
    let time = ["time since the azimuth was handed over", "min"];
    Figure::new(title, time, ["error, RMS over the runs", "°"], series).into()
}

/// The gyros of each class, and what became of it.
fn of_classes(rows: &[Row]) -> Part {
    Columns::of("Classes", rows)
        .column("class", |row| row.class)
        .column("gyro", |row| format!("{} ({})", row.gyro, row.grade))
        .column("mount", |row| &row.mount)
        .column("azimuth", |row| &row.way)
        .column("runs", |row| row.runs)
        .column("azimuth lost", |row| row.lost)
        .column("outcome", |row| {
            let met = if row.is_met { "met" } else { "not met" };
            format!("{met}{}", if row.is_wanted { "" } else { " (for comparison)" })
        })
        .into()
}

/// Errors of each class, quantity by quantity.
fn of_errors(rows: &[Row]) -> Part {
    let lines = rows.iter().flat_map(|row| {
        let (azimuth, level) = (row.wanted_azimuth_deg, row.wanted_level_deg);
        let limit = Some(row.azimuth_limit_deg);
        [
            (row, "azimuth after 0.5 h", row.azimuth, Some(azimuth), limit),
            (row, "azimuth while driving", row.azimuth_driving, None, None),
            (row, "pitch, roll on the way", row.level, Some(level), None),
            (row, "pitch, roll at rest", row.level_at_rest, None, None),
        ]
    });
    let or_empty = |value: Option<f64>, places: usize| {
        value.map_or_else(String::new, |value| format!("{value:.places$}"))
    };
    Columns::of("Table 1: what is kept after half an hour", &lines.collect::<Vec<_>>())
        .column("class", |(row, what, ..)| format!("{}: {what}", row.class))
        .column("mount", |(row, ..)| &row.mount)
        .fixed("RMS, °", 3, |(_, _, spread, ..)| spread.rms_deg)
        .fixed("σ, °", 3, |(_, _, spread, ..)| spread.sigma_deg)
        .covered(|(_, _, spread, ..)| spread.coverage_percent)
        .column("wanted, 1σ, °", |(.., wanted, _)| or_empty(*wanted, 2))
        .column("limit, °", |(.., limit)| or_empty(*limit, 3))
        .into()
}
