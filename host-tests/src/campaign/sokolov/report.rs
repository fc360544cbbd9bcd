//! `campaign sokolov`: its entry in the registry, and its report: Table 1 of Sokolov 2019, then maximum likelihood through fixed point.

use serde_json::json;

use super::{AlphaRow, FixedPoint, TABLE_RUNS, TURNS, Table as Turn, fixed_point, tabulate};
use crate::campaign::columns::{Columns, list, normal};
use crate::campaign::{Asked, Campaign, Done, Tick, one_by_one};
use crate::output::positive_zero;
use crate::report::{Lines, Part, Report};

/// The paper's table, and the precision, of both schedules.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "sokolov",
    meaning: "The numerical experiment of Sokolov 2019: stepwise gyrocompassing, all five criteria",
    runs: 5000,
    steps: "alignments",
    count: |asked| TURNS.len() * (3 * TABLE_RUNS + asked.runs),
    run,
};

/// Both schedules: the paper's table, then the precision.
fn run(asked: &Asked, tick: Tick<'_>) -> Result<Done, String> {
    let tables = one_by_one(TURNS, tick, |turn| tabulate(turn, tick));
    let tables = tables.into_iter().collect::<Result<Vec<_>, _>>()?;
    let precisions = one_by_one(TURNS, tick, |turn| fixed_point(turn, asked.runs, tick));
    let precisions = precisions.into_iter().collect::<Result<Vec<_>, _>>()?;
    let object = json!({ "tables": tables, "precision": precisions });
    let report = report(&tables, &precisions);
    Ok(Done { object, report, refusal: None })
}

/// Both schedules: the paper's table, then the precision.
fn report(turns: &[Turn], precisions: &[FixedPoint]) -> Report {
    let parts = turns.iter().flat_map(of_turn).chain([of_precisions(precisions)]);
    Report::new("Sokolov 2019, Table 1", parts).below([
        "60 dwells of 1 s, 0.15 °/h per sample at 100 Hz, 47°35′",
        "three azimuths (28°10′, 28°30′, 28°50′, off the grid); errors in arc seconds",
        &normal(),
    ])
}

fn of_turn(turn: &Turn) -> [Part; 2] {
    let table = Columns::of(turn.schedule, &turn.rows)
        .column("criterion", |row| row.criterion)
        .column("runs", |row| row.precision.runs)
        .column("refused", |row| row.precision.refused)
        .fixed("RMS, ″", 1, |row| 3600.0 * row.precision.rms_deg)
        .fixed("stated σ, ″", 1, |row| 3600.0 * row.sigma_deg)
        .fixed("limit, ″", 1, |row| 3600.0 * row.precision.limit_deg)
        .fixed("Ω_h free, ″", 1, |row| 3600.0 * row.limit_free_deg)
        .fixed("RMS / limit", 2, |row| row.precision.rms_deg / row.precision.limit_deg)
        .column("least of 90 each, ″", |row| in_arcseconds(row.least_deg))
        .column("paper's least, ″", |_| in_arcseconds(turn.paper_least_deg));
    let rules = turn.stop_rules.iter().map(|rule| {
        let reached = format!("all 60 reached in {} of {}", rule.all_positions, rule.runs);
        format!("{}: median step {}, {reached}", rule.rule, rule.median_step)
    });
    let alphas = turn.paper_alpha.iter().map(|row| {
        let AlphaRow { alpha_deg_h, runs, nothing, whole_range, mean_width_deg } = row;
        let whole =
            format!("all of 0…90° in {whole_range}; mean width {mean_width_deg:.1}° of the circle");
        format!("as {alpha_deg_h:.4} °/h accepts nothing in {nothing} of {runs} runs, {whole}")
    });
    let lines = Lines::default().with_found("stop rule", rules);
    [table.into(), lines.with_found("the paper's α", alphas).into()]
}

/// Three angles in degrees as arc seconds.
fn in_arcseconds(angles: [f64; 3]) -> String {
    list(&angles.map(|angle| 3600.0 * angle))
}

fn of_precisions(precisions: &[FixedPoint]) -> Part {
    let added = |row: &FixedPoint| positive_zero(100.0 * (row.fixed_point_ratio - 1.0), 5e-4);
    Columns::of("Maximum likelihood through fixed point, azimuths off the grid", precisions)
        .column("schedule", |row| row.schedule)
        .column("runs", |row| row.precision.runs)
        .column("refused", |row| row.precision.refused)
        .fixed("RMS, ″", 2, |row| 3600.0 * row.precision.rms_deg)
        .fixed("limit, ″", 2, |row| 3600.0 * row.precision.limit_deg)
        .fixed("RMS / limit", 4, |row| row.precision.rms_deg / row.precision.limit_deg)
        .fixed("in f64, ″", 2, |row| 3600.0 * row.rms_floating_point_deg)
        .column("fixed point adds, %", |row| format!("{:+.3}", added(row)))
        .covered(|row| row.precision.coverage_percent)
        .into()
}
