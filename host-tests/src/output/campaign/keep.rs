//! The report of `campaign keep`: what every class keeps, and how errors grow beside σ(t).

use super::covered;
use crate::campaign::burov::LATITUDE_DEG;
use crate::campaign::keep::{Growth, Row, Spread};
use crate::report::{Axis, Figure, Part, Report, Series, Style, Table};

/// The page for a campaign.
#[must_use]
pub fn report(rows: &[Row]) -> Report {
    let mut parts: Vec<Part> = vec![classes(rows).into(), table(rows).into()];
    for row in rows {
        let name = format!("{}, {}", row.class, row.mount);
        let (azimuth, level) = (row.wanted_azimuth_deg, row.wanted_level_deg);
        parts.push(figure(row, &format!("Azimuth: {name}"), azimuth, |at| at.azimuth).into());
        parts.push(figure(row, &format!("Pitch and roll: {name}"), level, |at| at.level).into());
    }
    Report {
        title: "Azimuth, pitch and roll, kept for half an hour".to_owned(),
        subtitle: vec![format!(
            "Burov, Table 1; a vehicle that drives without a halt, at {LATITUDE_DEG}° of latitude"
        )],
        parts,
    }
}

/// Errors and σ over the time.
fn figure(row: &Row, title: &str, wanted_deg: f64, of: impl Fn(&Growth) -> Spread) -> Figure {
    let over = |part: fn(&Spread) -> f64| -> Vec<(f64, f64)> {
        row.growth.iter().map(|at| (at.seconds / 60.0, part(&of(at)))).collect()
    };
    let wanted = row.growth.iter().map(|at| (at.seconds / 60.0, wanted_deg));
    Figure {
        title: title.to_owned(),
        x: Axis::linear("time since the azimuth was handed over", "min"),
        y: Axis::linear("error, RMS over the runs", "°"),
        series: vec![
            Series::new("error", Style::LineAndPoints, over(|spread| spread.rms_deg)),
            Series::new("σ(t)", Style::Line, over(|spread| spread.sigma_deg)),
            Series::new("wanted", Style::Dashed, wanted),
        ],
    }
}

/// The gyros of each class, and what became of it.
fn classes(rows: &[Row]) -> Table {
    let line = |row: &Row| {
        let grade = &row.grade;
        let (n, b, k, r) =
            (grade.n_deg_sqrt_h, grade.b_deg_h, grade.k_deg_h_sqrt_h, grade.r_deg_h2);
        let met = if row.is_met { "met" } else { "not met" };
        vec![
            row.class.to_owned(),
            format!("{} (N {n} °/√h, B {b} °/h, K {k} °/h/√h, R {r} °/h²)", row.gyro),
            row.mount.clone(),
            row.way.clone(),
            row.runs.to_string(),
            row.lost.to_string(),
            format!("{met}{}", if row.is_wanted { "" } else { " (for comparison)" }),
        ]
    };
    let head = ["class", "gyro", "mount", "azimuth", "runs", "azimuth lost", "outcome"];
    Table { rows: rows.iter().map(line).collect(), ..Table::new("Classes", &head) }
}

/// Errors of each class, quantity by quantity.
fn table(rows: &[Row]) -> Table {
    let lines = rows.iter().flat_map(|row| {
        let line = |what: &str, spread: &Spread, wanted: String, limit: String| {
            vec![
                format!("{}: {what}", row.class),
                format!("{:.3}", spread.rms_deg),
                format!("{:.3}", spread.sigma_deg),
                covered(&spread.coverage_percent),
                wanted,
                limit,
            ]
        };
        let [azimuth, level] =
            [row.wanted_azimuth_deg, row.wanted_level_deg].map(|wanted| format!("{wanted:.2}"));
        let limit = format!("{:.3}", row.azimuth_limit_deg);
        let none = String::new;
        [
            line("azimuth after 0.5 h", &row.azimuth, azimuth, limit),
            line("azimuth while driving", &row.azimuth_driving, none(), none()),
            line("pitch, roll on the way", &row.level, level, none()),
            line("pitch, roll at rest", &row.level_at_rest, none(), none()),
        ]
    });
    let head = ["class", "RMS, °", "σ, °", "within 1, 2, 3 σ, %", "wanted, 1σ, °", "limit, °"];
    Table { rows: lines.collect(), ..Table::new("Table 1: what is kept after half an hour", &head) }
}
