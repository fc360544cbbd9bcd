//! The report of `campaign spin`: Figs. 7 and 8 of Nekrasova 2017, and the tables.

use super::{covered, normal};
use crate::campaign::spin::cases::{Row, Spot};
use crate::campaign::spin::paper::{FRAGMENT_S, Paper, TURNS_PER_S};
use crate::campaign::spin::world::{RATE_HZ, SCALE_ERROR};
use crate::report::{Axis, Figure, Lines, Part, Report, Series, Style, Table};
use crate::spin::{METHODS, name};

/// Points of a curve at most.
const POINTS: usize = 2000;

/// The page for a campaign.
#[must_use]
pub fn report(paper: &Paper, rows: &[Row]) -> Report {
    let [uncorrected, extrema, interpolated, locked] = &paper.curves;
    let methods = [extrema, interpolated, locked];
    let whole: Vec<(&str, &[(f64, f64)])> =
        vec![("1: without correction", uncorrected), ("2: with correction at extrema", extrema)];
    let named_methods = || METHODS.map(name).into_iter().zip(methods);
    let end_s = extrema.last().map_or(0.0, |(time_s, _)| *time_s);
    let fragment: Vec<_> =
        named_methods().map(|(name, curve)| (name, from(curve, end_s - FRAGMENT_S))).collect();
    let beside: Vec<_> = named_methods().skip(1).map(|(name, curve)| (name, &curve[..])).collect();
    let parts: Vec<Part> = vec![
        of_paper(paper).into(),
        figure("Error of the roll over a second (Fig. 7)", &whole).into(),
        figure("A fragment of it between corrections (Fig. 8)", &fragment).into(),
        figure("Interpolated extrema and phase lock on the same samples", &beside).into(),
        of_rows(rows).into(),
        of_spots(rows).into(),
    ];
    let percent = 100.0 * SCALE_ERROR;
    Report {
        title: "Roll of a spinning body".to_owned(),
        subtitle: vec![
            format!("Nekrasova 2017, section 5: {TURNS_PER_S} turns a second, gyro {percent} % too fast, {RATE_HZ} Hz"),
            "with noise: 60 to 100 turns a second, changing by up to 5 % a second, a lift of 30 m/s²".to_owned(),
            normal(),
        ],
        parts,
    }
}

/// The paper's second, without noise.
fn of_paper(paper: &Paper) -> Lines {
    let mut lines = Lines::new("The paper's second, without noise");
    lines.add("uncorrected", format!("{:.4}° after a second (Fig. 7)", paper.uncorrected_deg));
    lines.add("growth", format!("{:.4}° between corrections (Fig. 8)", paper.growth_deg));
    lines.add("corrections", format!("{:.2} a turn", paper.corrections_per_turn));
    for (name, rms) in &paper.methods {
        lines.add(name, format!("{rms:.5}° RMS error"));
    }
    lines.add("scale error", format!("found by phase lock, off by {:.1e}", paper.scale_miss));
    lines
}

/// The end of a curve.
fn from(curve: &[(f64, f64)], from_s: f64) -> &[(f64, f64)] {
    &curve[curve.partition_point(|(time_s, _)| *time_s < from_s)..]
}

fn figure(title: &str, curves: &[(&str, &[(f64, f64)])]) -> Figure {
    let series = curves.iter().map(|(name, curve)| {
        let every = (curve.len() / POINTS).max(1);
        Series::new(name, Style::Line, curve.iter().step_by(every).copied())
    });
    Figure {
        title: title.to_owned(),
        x: Axis::linear("time", "s"),
        y: Axis::linear("roll error", "°"),
        series: series.collect(),
    }
}

fn of_rows(rows: &[Row]) -> Table {
    let line = |row: &Row| {
        let methods = row.rms_deg.map(|rms| format!("{rms:.4}"));
        let scale = [row.scale_rms, row.scale_sigma].map(|scale| format!("{scale:.1e}"));
        let counts = [row.miscounted, row.lost, row.runs].map(|count| count.to_string());
        let cells = [row.case.to_owned()].into_iter().chain(methods);
        cells.chain([format!("{:.4}", row.limit_deg)]).chain(counts).chain(scale).collect()
    };
    let head = ["flights"].into_iter().chain(METHODS.map(name));
    let more = ["limit", "turns miscounted", "roll lost", "runs", "scale error, RMS", "its σ"];
    let head: Vec<&str> = head.chain(more).collect();
    let table = Table::new("RMS errors after the first 0.1 s, °", &head);
    Table { rows: rows.iter().map(line).collect(), ..table }
}

fn of_spots(rows: &[Row]) -> Table {
    let line = |case: &str, when: &str, spot: &Spot| {
        vec![
            case.to_owned(),
            when.to_owned(),
            format!("{:.4}", spot.rms_deg),
            format!("{:.4}", spot.sigma_deg),
            format!("{:.4}", spot.limit_deg),
            covered(&spot.coverage_percent),
        ]
    };
    let both = rows.iter().flat_map(|row| {
        let end = line(row.case, "at the end", &row.end);
        let held = row.held.as_ref();
        [Some(end), held.map(|held| line(row.case, "before the lift comes back", held))]
    });
    let head = ["flights", "when", "RMS error, °", "σ, °", "limit, °", "within 1, 2, 3 σ, %"];
    let table = Table::new("The phase lock at a moment", &head);
    Table { rows: both.flatten().collect(), ..table }
}
