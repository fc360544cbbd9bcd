//! The page of `campaign spin`: the paper's Figs. 7 and 8, and the tables.

use crate::campaign::spin::cases::{Row, Spot};
use crate::campaign::spin::paper::{FRAGMENT_S, Paper};
use crate::output::named;
use crate::report::{Axis, Figure, Part, Report, Series, Style, Table};
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
        figure("Error of the roll over a second (Fig. 7)", &whole).into(),
        figure("A fragment of it between corrections (Fig. 8)", &fragment).into(),
        figure("Interpolated extrema and phase lock on the same samples", &beside).into(),
        of_rows(rows).into(),
        of_spots(rows).into(),
    ];
    let Paper { uncorrected_deg, growth_deg, .. } = paper;
    Report {
        title: "Roll of a spinning body".to_owned(),
        subtitle: vec![
            "Nekrasova 2017, section 5, and the same with noise".to_owned(),
            format!(
                "uncorrected {uncorrected_deg:.2}° after a second; {growth_deg:.3}° from a correction to the next"
            ),
        ],
        parts,
    }
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
        let limit = format!("{:.4}", row.limit_deg);
        let counts = [row.miscounted, row.lost, row.runs].map(|count| count.to_string());
        [row.case.to_owned()].into_iter().chain(methods).chain([limit]).chain(counts).collect()
    };
    let head = ["flights"].into_iter().chain(METHODS.map(name));
    let more = ["limit", "turns miscounted", "roll lost", "runs"];
    Table {
        title: "RMS errors after the first 0.1 s, °".to_owned(),
        head: named(&head.chain(more).collect::<Vec<_>>()),
        rows: rows.iter().map(line).collect(),
    }
}

fn of_spots(rows: &[Row]) -> Table {
    let line = |case: &str, when: &str, spot: &Spot| {
        let [one, two, three] = spot.coverage_percent;
        vec![
            case.to_owned(),
            when.to_owned(),
            format!("{:.4}", spot.rms_deg),
            format!("{:.4}", spot.sigma_deg),
            format!("{:.4}", spot.limit_deg),
            format!("{one:.1}, {two:.1}, {three:.1}"),
        ]
    };
    let both = rows.iter().flat_map(|row| {
        let end = line(row.case, "at the end", &row.end);
        let held = row.held.as_ref();
        [Some(end), held.map(|held| line(row.case, "before the lift comes back", held))]
    });
    Table {
        title: "The phase lock at a moment".to_owned(),
        head: named(&[
            "flights",
            "when",
            "RMS error, °",
            "σ, °",
            "limit, °",
            "within 1, 2, 3 σ, %",
        ]),
        rows: both.flatten().collect(),
    }
}
