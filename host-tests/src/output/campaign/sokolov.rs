//! The report of `campaign sokolov`: Table 1 of Sokolov 2019, then maximum likelihood through fixed point.

use super::{covered, normal};
use crate::campaign::sokolov::{AlphaRow, Precision, Table as Turn};
use crate::output::positive_zero;
use crate::report::{Lines, Part, Report, Table};

/// Both schedules: the paper's table, then the precision.
#[must_use]
pub fn report(turns: &[Turn], precisions: &[Precision]) -> Report {
    let parts = turns.iter().flat_map(of_turn).chain([of_precisions(precisions).into()]);
    let subtitle = [
        "60 dwells of 1 s, 0.15 °/h per sample at 100 Hz, 47°35′",
        "three azimuths (28°10′, 28°30′, 28°50′, off the grid); errors in arc seconds",
    ];
    Report {
        title: "Sokolov 2019, Table 1".to_owned(),
        subtitle: subtitle.map(str::to_owned).into_iter().chain([normal()]).collect(),
        parts: parts.collect(),
    }
}

fn of_turn(turn: &Turn) -> [Part; 2] {
    let head = [
        "criterion",
        "runs",
        "refused",
        "RMS, ″",
        "stated σ, ″",
        "limit, ″",
        "Ω_h free, ″",
        "RMS / limit",
        "least of 90 each, ″",
        "paper's least, ″",
    ];
    let rows = turn.rows.iter().map(|row| {
        vec![
            row.criterion.to_string(),
            row.runs.to_string(),
            row.refused.to_string(),
            format!("{:.1}", row.rms_arcsec),
            format!("{:.1}", row.sigma_arcsec),
            format!("{:.1}", row.limit_arcsec),
            format!("{:.1}", row.limit_free_arcsec),
            format!("{:.2}", row.ratio),
            list(&row.least_arcsec),
            list(&turn.paper_least_arcsec),
        ]
    });
    let table = Table { rows: rows.collect(), ..Table::new(turn.schedule, &head) };
    let mut lines = Lines::default();
    for rule in &turn.stop_rules {
        let reached = format!("all 60 reached in {} of {}", rule.all_positions, rule.runs);
        let text = format!("{}: median step {}, {reached}", rule.rule, rule.median_step);
        lines.add("stop rule", text);
    }
    for row in &turn.paper_alpha {
        let AlphaRow { alpha_deg_h, runs, nothing, whole_range, mean_width_deg } = row;
        let whole =
            format!("all of 0…90° in {whole_range}; mean width {mean_width_deg:.1}° of the circle");
        let text =
            format!("as {alpha_deg_h:.4} °/h accepts nothing in {nothing} of {runs} runs, {whole}");
        lines.add("the paper's α", text);
    }
    [table.into(), lines.into()]
}

fn list(values: &[f64; 3]) -> String {
    values.map(|value| format!("{value:.1}")).join(", ")
}

fn of_precisions(precisions: &[Precision]) -> Table {
    let head = [
        "schedule",
        "runs",
        "refused",
        "RMS, ″",
        "limit, ″",
        "RMS / limit",
        "in f64, ″",
        "fixed point adds, %",
        "within 1, 2, 3 σ, %",
    ];
    let rows = precisions.iter().map(|row| {
        let added = positive_zero(100.0 * (row.fixed_point_ratio - 1.0), 5e-4);
        vec![
            row.schedule.to_string(),
            row.runs.to_string(),
            row.refused.to_string(),
            format!("{:.2}", row.rms_arcsec),
            format!("{:.2}", row.limit_arcsec),
            format!("{:.4}", row.ratio),
            format!("{:.2}", row.rms_floating_point_arcsec),
            format!("{added:+.3}"),
            covered(&row.coverage_percent),
        ]
    });
    let title = "Maximum likelihood through fixed point, azimuths off the grid";
    Table { rows: rows.collect(), ..Table::new(title, &head) }
}
