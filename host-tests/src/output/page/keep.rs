//! The page of `campaign keep`: the table, and how errors grow beside σ(t).

use crate::campaign::keep::{Growth, Row, Spread};
use crate::output::named;
use crate::report::{Axis, Figure, Part, Report, Series, Style, Table};

/// The page for a campaign.
#[must_use]
pub fn report(rows: &[Row]) -> Report {
    let mut parts: Vec<Part> = vec![table(rows).into()];
    for row in rows {
        let name = format!("{}, {}", row.class, row.mount);
        let (azimuth, level) = (row.wanted_azimuth_deg, row.wanted_level_deg);
        parts.push(figure(row, &format!("Azimuth: {name}"), azimuth, |at| at.azimuth).into());
        parts.push(figure(row, &format!("Pitch and roll: {name}"), level, |at| at.level).into());
    }
    Report {
        title: "Azimuth, pitch and roll, kept for half an hour".to_owned(),
        subtitle: vec!["Burov, Table 1; a vehicle that drives without a halt".to_owned()],
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

fn table(rows: &[Row]) -> Table {
    let line = |row: &Row| {
        let covered = |spread: &Spread| {
            let [one, two, three] = spread.coverage_percent;
            format!("{one:.1}, {two:.1}, {three:.1}")
        };
        vec![
            row.class.to_owned(),
            row.mount.clone(),
            row.way.clone(),
            format!("{:.2}", row.wanted_azimuth_deg),
            format!("{:.3}", row.azimuth.rms_deg),
            format!("{:.3}", row.azimuth_limit_deg),
            covered(&row.azimuth),
            format!("{:.2}", row.wanted_level_deg),
            format!("{:.3}", row.level.rms_deg),
            covered(&row.level),
            row.runs.to_string(),
            if row.is_met { "yes" } else { "no" }.to_owned(),
        ]
    };
    Table {
        title: "Table 1: what is kept after half an hour, °".to_owned(),
        head: named(&[
            "class",
            "gyro",
            "azimuth",
            "azimuth wanted",
            "RMS",
            "limit",
            "within 1, 2, 3 σ, %",
            "pitch, roll wanted",
            "RMS",
            "within 1, 2, 3 σ, %",
            "runs",
            "met",
        ]),
        rows: rows.iter().map(line).collect(),
    }
}
